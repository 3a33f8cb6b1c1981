/**
 * @class   vtkHybridScene
 * @brief   from a vtkRenderer to the snapshot that the ray tracer draws
 *
 * vtkHybridScene reads a renderer's props, lights, camera and background into an hrt::Snapshot,
 * which holds no VTK types, and tells what differs from the snapshot before. All view props are
 * read, not only those that survived the renderer's cullers: what is outside of the picture still
 * casts shadows into it and is seen in mirrors.
 *
 * Triangles are extracted again only when the data or the mapper's colouring changed; a changed
 * matrix, property, light or camera leaves the geometry's pointers as they are.
 *
 * Bad input is refused at this door: triangles that name missing points, have coordinates that are
 * not finite, or have no area; parts whose matrix cannot be inverted. Actors whose points, or whose
 * bounds in the world, are beyond 1.844e18 are left to VTK as a whole, without a word, as VTK has
 * none for them; of triangles without area VTK draws nothing, and they are counted without a word too.
 * Of what else is refused each part is told of once; all that is new in an update takes one warning and
 * one error, which name the first three parts and count the others. The sums are in
 * hrt::Snapshot::refusals.
 *
 * @sa
 * vtkHybridRayTracingPass vtkHybridMaterial
 */

#ifndef vtkHybridScene_h
#define vtkHybridScene_h

#include "vtkHybridRenderingSceneModule.h" // For export macro
#include "vtkHybridVersion.h"              // For the ABI namespace
#include "vtkObject.h"

#include <cstddef> // For std::size_t
#include <memory>  // For std::shared_ptr
#include <vector>  // For std::vector

namespace hrt
{
struct Changes;
struct Snapshot;
}

VTK_ABI_NAMESPACE_BEGIN

class vtkActor;
class vtkProp;
class vtkRenderer;

class VTKHYBRIDRENDERINGSCENE_EXPORT vtkHybridScene : public vtkObject
{
public:
  static vtkHybridScene* New();
  vtkTypeMacro(vtkHybridScene, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Read the renderer. The pipelines of the mappers are brought up to date, as rendering them
   * would. The lights' geometry must be up to date before (vtkRenderer::UpdateLightGeometry). When
   * another renderer than the last time is given, everything counts as changed.
   */
  void Update(vtkRenderer* renderer);

  /**
   * The same for a picture of another size in pixels than the renderer's viewport: a render pass that
   * draws into a framebuffer of its own hands that size on. The projection stays the renderer's.
   */
  void Update(vtkRenderer* renderer, int width, int height);

  /**
   * The scene as of the last Update; never null, empty before the first.
   */
  std::shared_ptr<const hrt::Snapshot> GetSnapshot() const;

  /**
   * What differs between the last two snapshots.
   */
  const hrt::Changes& GetChanges() const;

  ///@{
  /**
   * Set/Get whether lights of the kind headlight (vtkLight::LightTypeIsHeadlight) cast shadows. Off,
   * as in VTK's own shadow pass. Default: false.
   */
  void SetHeadlightShadows(bool on);
  bool GetHeadlightShadows() const;
  ///@}

  /**
   * The actor with the number hrt::Source::prop of the snapshot's parts. Null when there is no such
   * number or the actor has been deleted since.
   */
  vtkProp* GetProp(std::size_t prop) const;

  /**
   * The actors that VTK has to draw over the surfaces of props that the tracer draws: the lines and
   * vertices of their data.
   */
  std::vector<vtkActor*> GetHostedActors() const;

  /**
   * Whether the tracer draws all that VTK would draw for this prop: an actor, or an assembly with
   * every visible part of it. The prop is then to be skipped when VTK draws the others. Hidden and
   * unknown props are not drawn by the tracer.
   */
  bool IsDrawnByTracer(vtkProp* prop) const;

  /**
   * Why VTK has to draw the prop itself: a short English phrase for statistics. Empty when the
   * tracer draws it or the prop is hidden or flat (a vtkActor2D).
   */
  const char* GetReasonLeftToVTK(vtkProp* prop) const;

  /**
   * Whether that reason is the prop's nature - lines, points, volumes, what light passes through -
   * and not a surface that the tracer should draw and does not.
   */
  bool IsHosted(vtkProp* prop) const;

protected:
  vtkHybridScene();
  ~vtkHybridScene() override;

private:
  vtkHybridScene(const vtkHybridScene&) = delete;
  void operator=(const vtkHybridScene&) = delete;

  class vtkInternals;
  std::unique_ptr<vtkInternals> Internals;
};

VTK_ABI_NAMESPACE_END
#endif
