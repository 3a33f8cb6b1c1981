// See ObjectIntersectionBuffer.h.
#include "Rendering/OpenGL2/ObjectIntersectionBuffer.h"

#include "Rendering/OpenGL2/OffscreenState.h"

#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

#include "DirectRendering_fs.h"
#include "ItemBuffer_fs.h"
#include "ItemBuffer_vs.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace hrt
{
namespace gl
{
namespace
{

// A triangle has the flat outputs of its last vertex for the time this lives: OpenGL's default, which
// a host may have changed.
class ScopedLastVertexConvention
{
public:
  ScopedLastVertexConvention()
  {
    glGetIntegerv(GL_PROVOKING_VERTEX, &this->Before);
    glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
  }
  ~ScopedLastVertexConvention() { glProvokingVertex(static_cast<GLenum>(this->Before)); }
  ScopedLastVertexConvention(const ScopedLastVertexConvention&) = delete;
  ScopedLastVertexConvention& operator=(const ScopedLastVertexConvention&) = delete;

private:
  GLint Before = 0;
};

// As VTK's property does it; both flags together hide everything.
void setCulling(vtkOpenGLState* state, const Material& material)
{
  if (!material.cullFront && !material.cullBack)
  {
    state->vtkglDisable(GL_CULL_FACE);
    return;
  }
  state->vtkglEnable(GL_CULL_FACE);
  state->vtkglCullFace(material.cullFront ? (material.cullBack ? GL_FRONT_AND_BACK : GL_FRONT)
                                          : GL_BACK);
}

// That of VTK: parts with copies are the snapshot's last.
std::vector<std::size_t> drawOrder(const Snapshot& snapshot)
{
  std::vector<std::size_t> order(snapshot.parts.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&snapshot](std::size_t a, std::size_t b) {
    return snapshot.parts[a].source.prop < snapshot.parts[b].source.prop;
  });
  return order;
}

} // namespace

//------------------------------------------------------------------------------
ObjectIntersectionBuffer::ObjectIntersectionBuffer(
  ObjectPool& pool, const DepthConvention& convention)
  : Hits(pool)
  , Depth(pool)
  , Framebuffer(pool.makeFramebuffer())
  , Convention(convention)
{
}

//------------------------------------------------------------------------------
bool ObjectIntersectionBuffer::resize(int width, int height, Visibility visibility)
{
  const bool direct = visibility == Visibility::DirectRendering;
  const bool newHits = this->Hits.allocate(width, height, direct ? GL_RGBA32UI : GL_R32UI,
    direct ? GL_RGBA_INTEGER : GL_RED_INTEGER, GL_UNSIGNED_INT);
  const bool newDepth =
    this->Depth.allocate(width, height, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT);
  this->Mode = visibility;
  return newHits || newDepth;
}

//------------------------------------------------------------------------------
bool ObjectIntersectionBuffer::draw(vtkOpenGLRenderWindow* window, const Snapshot& snapshot,
  const DepthPrograms::Tables& tables, const std::vector<bool>& parts, const PixelBounds& bounds)
{
  this->TrianglesDrawn = 0;
  OffscreenState target(window, this->Framebuffer, this->Hits.width(), this->Hits.height());
  glFramebufferTexture2D(
    GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, this->Hits.name(), 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, this->Depth.name(), 0);
  if (!target.complete("object intersection buffer"))
  {
    return false;
  }
  const bool direct = this->Mode == Visibility::DirectRendering;
  DepthPrograms programs(
    window, snapshot, { ItemBuffer_vs, ItemBuffer_fs, DirectRendering_fs }, direct, tables,
    this->Convention.direction());
  const GLuint noHit[4] = { 0, 0, 0, 0 };
  const GLfloat far = this->Convention.clearDepth();
  target.beginDepthPass(this->Convention);
  target.setScissor(bounds);
  glClearBufferuiv(GL_COLOR, 0, noHit);
  glClearBufferfv(GL_DEPTH, 0, &far);

  ScopedDepthConvention depth(this->Convention);
  const ScopedLastVertexConvention provoking;
  const glm::dmat4 toClip = this->Convention.drawMatrix(snapshot.camera.viewToClip) *
    snapshot.camera.worldToView;
  for (const std::size_t i : drawOrder(snapshot))
  {
    if (!parts[i])
    {
      continue;
    }
    setCulling(window->GetState(), snapshot.parts[i].material);
    if (!programs.draw(i, toClip))
    {
      return false;
    }
    this->TrianglesDrawn += snapshot.parts[i].triangleCount();
  }
  return true;
}

//------------------------------------------------------------------------------
void ObjectIntersectionBuffer::upload(const PrimaryHits& primary, const PixelBounds& bounds)
{
  this->TrianglesDrawn = 0;
  this->Hits.upload(primary.ids.data(), bounds);
  const DepthConvention convention = this->Convention;
  this->StoredDepths.resize(primary.clipDepths.size());
  std::transform(primary.clipDepths.begin(), primary.clipDepths.end(), this->StoredDepths.begin(),
    [convention](double z) { return convention.storedDepth(z); });
  this->Depth.upload(this->StoredDepths.data(), bounds);
}

} // namespace gl
} // namespace hrt
