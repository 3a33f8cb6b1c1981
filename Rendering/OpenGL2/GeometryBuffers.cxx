// See GeometryBuffers.h.
#include "Rendering/OpenGL2/GeometryBuffers.h"

#include "Rendering/OpenGL2/PartTables.h"

#include <algorithm>

namespace hrt
{
namespace gl
{
namespace
{

constexpr std::size_t kCornerBytes = sizeof(glm::vec4);

// Triangles a chunk while their corners are gathered for upload: about 1 MiB.
constexpr std::size_t kChunk = 1 << 14;

// Uploads one texel for each corner of a geometry's triangles, in chunks rather than in a copy of
// the whole mesh. `cornersOf(triangle)` gives three values, `texelOf` makes a texel of one. Returns
// the bytes.
template <class CornersOf, class TexelOf>
std::size_t uploadCorners(TextureBuffer& table, std::size_t firstTriangle, std::size_t triangles,
  CornersOf cornersOf, TexelOf texelOf)
{
  using Texel = decltype(texelOf(cornersOf(0)[0]));
  std::vector<Texel> texels;
  for (std::size_t start = 0; start < triangles; start += kChunk)
  {
    texels.clear();
    for (std::size_t i = start; i < std::min(start + kChunk, triangles); ++i)
    {
      for (const auto& value : cornersOf(i))
      {
        texels.push_back(texelOf(value));
      }
    }
    table.uploadRange(
      3 * (firstTriangle + start) * sizeof(Texel), texels.data(), texels.size() * sizeof(Texel));
  }
  return 3 * triangles * sizeof(Texel);
}

} // namespace

//------------------------------------------------------------------------------
GeometryBuffers::GeometryBuffers(ObjectPool& pool)
  : Positions(pool, GL_RGBA32F)
  , Normals(pool, GL_RGBA32F)
  , Colors(pool, GL_RGBA8)
  , Coordinates(pool, GL_RG32F)
  , Lookups(pool, GL_RGBA8)
  , TrianglePart(pool, GL_R32UI)
  , Layout(pool, GL_RGBA32I)
  , VertexArray(pool.makeVertexArray())
{
}

//------------------------------------------------------------------------------
std::vector<GeometryBuffers::Slot> GeometryBuffers::layOut(const Snapshot& snapshot) const
{
  std::vector<Slot> slots;
  std::int32_t normals = 0, colors = 0, coordinates = 0, lookup = 0;
  for (const Part& part : snapshot.parts)
  {
    const Geometry& geometry = *part.geometry;
    const auto triangles = static_cast<std::int32_t>(geometry.triangleCount());
    Slot slot;
    slot.version = geometry.version;
    slot.key = part.key;
    slot.firstTriangle = part.firstTriangle;
    slot.triangles = geometry.triangleCount();
    if (!geometry.normals.empty())
    {
      slot.normals = normals;
      normals += triangles;
    }
    if (geometry.colorSource == ColorSource::Corner)
    {
      slot.colors = colors;
      colors += triangles;
    }
    if (geometry.colorSource == ColorSource::Lookup)
    {
      slot.coordinates = coordinates;
      coordinates += triangles;
      slot.lookup = lookup;
      lookup += static_cast<std::int32_t>(geometry.lookup.size());
    }
    if (!geometry.textureCoordinates.empty())
    {
      slot.textureCoordinates = coordinates;
      coordinates += triangles;
    }
    slots.push_back(slot);
  }
  return slots;
}

//------------------------------------------------------------------------------
bool GeometryBuffers::fits(const Snapshot& snapshot, std::string& error) const
{
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &limit);
  const std::uint64_t corners = 3ull * snapshot.triangleCount;
  if (corners > static_cast<std::uint64_t>(limit))
  {
    error = "the scene has " + std::to_string(snapshot.triangleCount) +
      " triangles, this OpenGL context holds at most " + std::to_string(limit / 3) +
      " in a texture buffer";
    return false;
  }
  return true;
}

//------------------------------------------------------------------------------
bool GeometryBuffers::holds(const Snapshot& snapshot) const
{
  if (!this->Uploaded || this->Slots.size() != snapshot.parts.size())
  {
    return false;
  }
  for (std::size_t i = 0; i < this->Slots.size(); ++i)
  {
    const Part& part = snapshot.parts[i];
    if (this->Slots[i].version != part.geometry->version ||
      this->Slots[i].firstTriangle != part.firstTriangle)
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------
bool GeometryBuffers::update(const Snapshot& snapshot, std::string& error)
{
  this->UploadedBytes = 0;
  if (this->holds(snapshot))
  {
    return true;
  }
  if (!this->fits(snapshot, error))
  {
    this->Uploaded = false;
    return false;
  }
  const std::vector<Slot> slots = this->layOut(snapshot);
  const bool sameStorage = this->Uploaded && slots.size() == this->Slots.size() &&
    std::equal(slots.begin(), slots.end(), this->Slots.begin(),
      [](const Slot& a, const Slot& b) { return a.samePlace(b); });
  if (!sameStorage)
  {
    this->allocate(snapshot);
  }
  for (std::size_t i = 0; i < slots.size(); ++i)
  {
    if (!sameStorage || slots[i].version != this->Slots[i].version)
    {
      this->uploadPart(snapshot.parts[i], slots[i]);
    }
  }
  this->Slots = slots;
  this->uploadLayout(snapshot);
  this->Uploaded = true;
  return true;
}

//------------------------------------------------------------------------------
void GeometryBuffers::allocate(const Snapshot& snapshot)
{
  std::size_t normals = 0, colors = 0, coordinates = 0, lookups = 0;
  for (const Part& part : snapshot.parts)
  {
    const Geometry& geometry = *part.geometry;
    normals += geometry.normals.empty() ? 0 : 3 * geometry.triangleCount();
    colors += geometry.colors.empty() ? 0 : 3 * geometry.triangleCount();
    coordinates += geometry.coordinates.empty() ? 0 : 3 * geometry.triangleCount();
    coordinates += geometry.textureCoordinates.empty() ? 0 : 3 * geometry.triangleCount();
    lookups += geometry.lookup.size();
  }
  // Bytes without data: only the storage is made; every part is uploaded into it afterwards.
  const auto reserve = [](TextureBuffer& table, std::size_t bytes) {
    table.upload(nullptr, bytes, GL_STATIC_DRAW);
  };
  reserve(this->Positions, 3 * kCornerBytes * snapshot.triangleCount);
  reserve(this->Normals, kCornerBytes * normals);
  reserve(this->Colors, sizeof(glm::u8vec4) * colors);
  reserve(this->Coordinates, sizeof(glm::vec2) * coordinates);
  reserve(this->Lookups, sizeof(glm::u8vec4) * lookups);
}

//------------------------------------------------------------------------------
void GeometryBuffers::uploadPart(const Part& part, const Slot& slot)
{
  const Geometry& geometry = *part.geometry;
  const std::size_t triangles = geometry.triangleCount();
  // Three components would need OpenGL 4.0, so a fourth is added.
  this->UploadedBytes += uploadCorners(this->Positions, slot.firstTriangle, triangles,
    [&](std::size_t i) { return geometry.cornerPositions(i); },
    [](const glm::vec3& position) { return glm::vec4(position, 1.0f); });
  const auto put = [&](TextureBuffer& table, std::int32_t first, const auto& attribute, auto texelOf) {
    if (!attribute.empty())
    {
      this->UploadedBytes += uploadCorners(table, static_cast<std::size_t>(first), triangles,
        [&](std::size_t i) { return geometry.cornersOf(attribute, i); }, texelOf);
    }
  };
  const auto asItIs = [](const auto& value) { return value; };
  put(this->Normals, slot.normals, geometry.normals,
    [](const glm::vec3& normal) { return glm::vec4(normal, 0.0f); });
  put(this->Colors, slot.colors, geometry.colors, asItIs);
  put(this->Coordinates, slot.coordinates, geometry.coordinates, asItIs);
  put(this->Coordinates, slot.textureCoordinates, geometry.textureCoordinates, asItIs);
  if (!geometry.lookup.empty())
  {
    const std::size_t bytes = geometry.lookup.size() * sizeof(geometry.lookup[0]);
    this->Lookups.uploadRange(
      static_cast<std::size_t>(slot.lookup) * sizeof(geometry.lookup[0]), geometry.lookup.data(), bytes);
    this->UploadedBytes += bytes;
  }
}

//------------------------------------------------------------------------------
void GeometryBuffers::uploadLayout(const Snapshot& snapshot)
{
  std::vector<std::uint32_t> owner(snapshot.triangleCount);
  std::vector<glm::ivec4> layout;
  for (std::size_t i = 0; i < snapshot.parts.size(); ++i)
  {
    const Part& part = snapshot.parts[i];
    const Slot& slot = this->Slots[i];
    std::fill_n(owner.begin() + part.firstTriangle, slot.triangles, static_cast<std::uint32_t>(i));
    layout.emplace_back(
      static_cast<int>(part.firstTriangle), slot.normals, slot.colors, slot.coordinates);
    layout.emplace_back(std::max(slot.lookup, 0), part.geometry->lookupWidth,
      part.geometry->lookupHeight, slot.textureCoordinates);
  }
  this->TrianglePart.upload(owner.data(), owner.size() * sizeof(owner[0]), GL_STATIC_DRAW);
  this->Layout.upload(layout.data(), layout.size() * sizeof(layout[0]), GL_STATIC_DRAW);
  this->UploadedBytes += owner.size() * sizeof(owner[0]) + layout.size() * sizeof(layout[0]);
}

//------------------------------------------------------------------------------
void GeometryBuffers::bindForDrawing(GLuint program) const
{
  const GLint position = glGetAttribLocation(program, "position");
  glBindVertexArray(this->VertexArray);
  glBindBuffer(GL_ARRAY_BUFFER, this->Positions.buffer());
  glEnableVertexAttribArray(static_cast<GLuint>(position));
  glVertexAttribPointer(static_cast<GLuint>(position), 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

//------------------------------------------------------------------------------
void GeometryBuffers::draw(const Part& part) const
{
  glDrawArrays(GL_TRIANGLES, static_cast<GLint>(3 * part.firstTriangle),
    static_cast<GLsizei>(3 * part.geometry->triangleCount()));
}

//------------------------------------------------------------------------------
void GeometryBuffers::bindTables(int firstUnit) const
{
  const TextureBuffer* tables[kUnits] = { &this->TrianglePart, &this->Positions, &this->Normals,
    &this->Colors, &this->Coordinates, &this->Lookups, &this->Layout };
  for (int i = 0; i < kUnits; ++i)
  {
    tables[i]->bind(firstUnit + i);
  }
}

} // namespace gl
} // namespace hrt
