// See ShadowMaps.h.
#include "Rendering/OpenGL2/ShadowMaps.h"

#include "Rendering/OpenGL2/OffscreenState.h"

#include "Rendering/Core/Shading/ShadingFrame.h"

#include "vtkOpenGLRenderWindow.h"
#include "vtkShaderProgram.h"

#include "ShadowMap_fs.h"
#include "ShadowMap_vs.h"

#include <glm/gtc/matrix_inverse.hpp>

#include <algorithm>
#include <cmath>

namespace hrt
{
namespace gl
{
namespace
{

// How many faces fitLightFaces makes for a light, known before the casters are.
int faceCount(const Light& light)
{
  return light.kind == Light::Kind::Positional && light.coneAngle > kWidestSpot ? 6 : 1;
}

// distance = (x + y * depth) / (z + w * depth) for a stored depth.
glm::vec4 depthToDistance(const LightFace& face, bool reversed)
{
  const double n = face.near;
  const double f = face.far;
  // In terms of s, 0 at the near and 1 at the far plane: orthographic n + s (f - n), perspective
  // n f / (f - s (f - n)).
  const glm::dvec4 k =
    face.perspective ? glm::dvec4(n * f, 0.0, f, n - f) : glm::dvec4(n, f - n, 1.0, 0.0);
  return reversed ? glm::vec4(k.x + k.y, -k.y, k.z + k.w, -k.w) : glm::vec4(k);
}

} // namespace

//------------------------------------------------------------------------------
ShadowMaps::ShadowMaps(ObjectPool& pool, const DepthConvention& convention)
  : Atlas(pool)
  , Faces(pool, GL_RGBA32F)
  , Framebuffer(pool.makeFramebuffer())
  , Convention(convention)
  , Transfer(pool)
{
}

//------------------------------------------------------------------------------
glm::ivec2 ShadowMaps::tile(int face) const
{
  return this->Resolution * glm::ivec2(face % this->Columns, face / this->Columns);
}

//------------------------------------------------------------------------------
std::vector<bool> ShadowMaps::prepare(
  const Snapshot& snapshot, const std::vector<bool>& wanted, int resolution)
{
  std::vector<Map> maps(snapshot.lights.size());
  int faces = 0;
  for (std::size_t i = 0; i < maps.size(); ++i)
  {
    maps[i].key = snapshot.lights[i].key;
    maps[i].firstFace = faces;
    maps[i].faceCount = wanted[i] ? faceCount(snapshot.lights[i]) : 0;
    faces += maps[i].faceCount;
  }
  const int columns = std::max(1, static_cast<int>(std::ceil(std::sqrt(double(faces)))));
  const int rows = std::max(1, (faces + columns - 1) / columns);
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  const auto affordable =
    static_cast<int>(std::sqrt(kAtlasBytes / sizeof(float) / double(columns * rows)));
  const int fitted = std::min({ resolution, static_cast<int>(limit) / columns, affordable });

  bool lost = fitted != this->Resolution || columns != this->Columns;
  this->Resolution = fitted;
  this->Columns = columns;
  if (faces > 0)
  {
    lost = this->Atlas.allocate(columns * fitted, rows * fitted, GL_DEPTH_COMPONENT32F,
             GL_DEPTH_COMPONENT, GL_FLOAT) ||
      lost;
  }
  std::vector<bool> present(maps.size(), false);
  for (std::size_t i = 0; i < maps.size() && !lost; ++i)
  {
    const auto old = std::find_if(this->Maps.begin(), this->Maps.end(), [&](const Map& m) {
      return m.key == maps[i].key && m.firstFace == maps[i].firstFace &&
        m.faceCount == maps[i].faceCount && m.drawn;
    });
    if (old != this->Maps.end())
    {
      maps[i] = *old;
      present[i] = true;
    }
  }
  this->Maps = maps;
  this->Slots.assign(maps.size(), ShadowSlot());
  for (std::size_t i = 0; i < maps.size(); ++i)
  {
    this->Slots[i].firstFace = maps[i].firstFace;
    this->Slots[i].faceCount = static_cast<int>(maps[i].faces.size());
  }
  return present;
}

//------------------------------------------------------------------------------
bool ShadowMaps::draw(vtkOpenGLRenderWindow* window, const Snapshot& snapshot,
  const DepthPrograms::Tables& tables, const std::vector<bool>& draw)
{
  this->TrianglesDrawn = 0;
  OffscreenState target(
    window, this->Framebuffer, this->Atlas.width(), this->Atlas.height());
  glFramebufferTexture2D(
    GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, this->Atlas.name(), 0);
  target.useDepthOnly();
  if (!target.complete("shadow maps"))
  {
    return false;
  }
  DepthPrograms programs(
    window, snapshot, { ShadowMap_vs, ShadowMap_fs, ShadowMap_fs }, false, tables);
  target.beginDepthPass(this->Convention);
  ScopedDepthConvention depth(this->Convention);
  const GLfloat clear = this->Convention.clearDepth();
  for (std::size_t i = 0; i < this->Maps.size(); ++i)
  {
    Map& map = this->Maps[i];
    if (!draw[i] || map.faceCount == 0)
    {
      continue;
    }
    const std::vector<bool> casters = castersFor(snapshot, snapshot.lights[i]);
    map.faces = fitLightFaces(snapshot, snapshot.lights[i], casters, this->Resolution,
      this->Convention.reversed ? kNearestRatioReversed : kNearestRatioPlain);
    map.drawn = true;
    map.onHost = false;
    for (std::size_t k = 0; k < map.faces.size(); ++k)
    {
      const glm::ivec2 at = this->tile(map.firstFace + static_cast<int>(k));
      target.setViewport(at.x, at.y, this->Resolution, this->Resolution);
      glClearBufferfv(GL_DEPTH, 0, &clear);
      const glm::dmat4 toClip = this->Convention.drawMatrix(map.faces[k].worldToClip);
      for (std::size_t p = 0; p < casters.size(); ++p)
      {
        if (casters[p])
        {
          if (!programs.draw(p, toClip))
          {
            return false;
          }
          this->TrianglesDrawn += snapshot.parts[p].triangleCount();
        }
      }
    }
    this->Slots[i].faceCount = static_cast<int>(map.faces.size());
  }
  return true;
}

//------------------------------------------------------------------------------
// In texels: see ShadowLookup.h.
double ShadowMaps::snapping() const
{
  GLint bits = 4; // the least that OpenGL allows
  glGetIntegerv(GL_SUBPIXEL_BITS, &bits);
  return std::exp2(-bits - 1) +
    kInterpolation * std::max(this->Atlas.width(), this->Atlas.height());
}

//------------------------------------------------------------------------------
std::vector<glm::vec4> ShadowMaps::faceTable(const Snapshot& snapshot) const
{
  const ShadingFrame frame(snapshot);
  const glm::dmat4 toWorld = glm::inverse(frame.fromWorld);
  const double snapping = this->snapping();

  std::vector<glm::vec4> table;
  for (const Map& map : this->Maps)
  {
    for (int k = 0; k < map.faceCount; ++k)
    {
      // A face that is not drawn keeps its place; its slot says that nobody looks there.
      const bool drawn = static_cast<std::size_t>(k) < map.faces.size();
      LightFace face = drawn ? map.faces[static_cast<std::size_t>(k)] : LightFace();
      const glm::dmat4 toStored =
        this->Convention.storedDepthMatrix(face.worldToClip) * toWorld;
      const glm::dmat4 planes = glm::inverseTranspose(toStored);
      for (int column = 0; column < 4; ++column)
      {
        table.emplace_back(toStored[column]);
      }
      for (int column = 0; column < 4; ++column)
      {
        table.emplace_back(planes[column]);
      }
      face.near *= frame.scale; // lengths from here on
      face.far *= frame.scale;
      face.texelConstant *= frame.scale;
      table.push_back(depthToDistance(face, this->Convention.reversed));
      table.emplace_back(glm::vec2(this->tile(map.firstFace + k)),
        static_cast<float>(this->Resolution), static_cast<float>(snapping));
      // Without reversed depth, the float of a perspective map near 1 resolves 2^-24 d^2 / near.
      const double quadratic =
        face.perspective && !this->Convention.reversed ? kShadowRounding / face.near : 0.0;
      table.emplace_back(static_cast<float>(face.texelConstant),
        static_cast<float>(face.texelLinear), static_cast<float>(face.near),
        static_cast<float>(quadratic));
    }
  }
  return table;
}

//------------------------------------------------------------------------------
void ShadowMaps::updateTable(const Snapshot& snapshot)
{
  const std::vector<glm::vec4> table = this->faceTable(snapshot);
  this->Faces.upload(table.data(), table.size() * sizeof(glm::vec4), GL_STREAM_DRAW);
}

//------------------------------------------------------------------------------
bool ShadowMaps::readBack(vtkOpenGLRenderWindow* window, std::uint64_t& bytes)
{
  std::vector<PixelReadBack::Piece> pieces;
  for (Map& map : this->Maps)
  {
    for (std::size_t k = 0; k < map.faces.size() && !map.onHost; ++k)
    {
      const glm::ivec2 at = this->tile(map.firstFace + static_cast<int>(k));
      PixelReadBack::cut(
        { at.x, at.y, this->Resolution, this->Resolution }, kReadBackRows, pieces);
    }
    map.onHost = map.drawn;
  }
  if (!this->HostDepths || this->HostDepths.use_count() > 1)
  {
    this->HostDepths = this->HostDepths ? std::make_shared<std::vector<float>>(*this->HostDepths)
                                        : std::make_shared<std::vector<float>>();
  }
  const auto width = static_cast<std::size_t>(this->Atlas.width());
  this->HostDepths->resize(width * static_cast<std::size_t>(this->Atlas.height()));
  if (pieces.empty())
  {
    return true;
  }
  OffscreenState state(window, this->Framebuffer, this->Atlas.width(), this->Atlas.height());
  return this->Transfer.read(pieces, { GL_DEPTH_COMPONENT, GL_FLOAT, sizeof(float) },
    [&](const PixelReadBack::Piece& piece, const void* texels) {
      const auto* row = static_cast<const float*>(texels);
      for (int y = piece.y; y < piece.y + piece.height; ++y, row += piece.width)
      {
        std::copy(row, row + piece.width,
          this->HostDepths->begin() + static_cast<std::ptrdiff_t>(y * width + piece.x));
      }
      bytes += sizeof(float) * piece.width * piece.height;
    });
}

//------------------------------------------------------------------------------
std::shared_ptr<const ShadowMapTables> ShadowMaps::hostTables(const Snapshot& snapshot) const
{
  auto tables = std::make_shared<ShadowMapTables>();
  tables->faces = this->faceTable(snapshot);
  tables->slots = this->Slots;
  tables->depths = this->HostDepths;
  tables->width = this->Atlas.width();
  tables->clearDepth = this->clearDepth();
  return tables;
}

//------------------------------------------------------------------------------
void ShadowMaps::bindTables(int firstUnit) const
{
  this->Faces.bind(firstUnit);
  this->Atlas.bind(firstUnit + 1);
}

} // namespace gl
} // namespace hrt
