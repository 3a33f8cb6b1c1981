/**
 * @class   vtkHybridBARTImporter
 * @brief   the animated scenes of BART as actors, lights and a camera
 *
 * BART is the benchmark for animated ray tracing of J. Lext, U. Assarsson and T. Moeller (2000): a
 * kitchen, a museum and a parade of robots, in a text format (AFF) that extends NFF. This class
 * reads any AFF or NFF scene:
 *
 * @code{.py}
 * importer = vtkHybridBARTImporter()
 * importer.SetFileName("Robot.aff")
 * if importer.Read():
 *     importer.AddTo(renderer)
 *     for frame in range(importer.GetNumberOfFrames()):
 *         importer.SetTime(importer.GetFrameTime(frame))
 *         window.Render()
 * @endcode
 *
 * It is not a vtkImporter because a vtkImporter always makes a renderer, and a window if it has
 * none, and its Read() cannot say that it failed. Here nothing is made but what the file describes,
 * and either all of it or nothing: an error names the file, the line and what was expected there.
 *
 * **Actors.** Each mesh, sphere, cone or run of loose faces in the scene's hierarchy is one
 * vtkActor. Its user matrix is the composed transform of all that is around it; the actors of one
 * transform share that matrix, the actors of one material one vtkProperty, the instances of one
 * mesh one vtkPolyData. SetTime changes matrices, visibilities, lights and the camera, never
 * geometry; the one exception are AFF's animated triangles ("tpa"), whose corners are what moves.
 *
 * **Materials.** AFF's twelve numbers become:
 *   - ambient colour (multiplied by the scene's ambient light), diffuse colour, specular colour,
 * and specular power, with coefficients of 1, so that local shading is BART's own sum;
 *   - reflectance (vtkHybridMaterial), the mean of the specular colour's channels, at most 1. BART
 *     follows Whitted (1980): the mirror image counts by the specular colour. Whitted adds it to
 * the local colour; vtkHybridRayTracingPass takes its share from the local colour, so that no
 * surface gives back more light than it gets;
 *   - opacity, 1 - transmittance;
 *   - glass (vtkHybridMaterial), where the transmittance is above 0 and the index of refraction
 * above
 *     1. The hybrid pass does not ask for the opacity of glass, other renderers do. Its mirror
 * image follows from Fresnel's equations, hence no reflectance. With an index of 1 or less (BART's
 * robots have panes with 0) light goes straight on, which is plain transparency.
 *
 * **Textures** are PPM files beside the scene, or in its folder TextureFiles; they multiply the
 * shaded colour and repeat, as in BART. AFF counts texture coordinates from the image's top row,
 * VTK from the bottom one, hence (u, v) becomes (u, 1 - v). Textures are interpolated but have no
 * mipmaps; all actors with the same image share one vtkTexture, on which MipmapOn() can be called.
 *
 * **Lights** are scene lights that shine in all directions, without attenuation.
 *
 * **Camera.** Before keys move it, the file's viewpoint; with the keys named "camera", those.
 *
 * @sa
 * vtkHybridMaterial vtkHybridRayTracingPass vtkImporter
 */

#ifndef vtkHybridBARTImporter_h
#define vtkHybridBARTImporter_h

#include "vtkHybridIOBARTModule.h" // For export macro
#include "vtkHybridVersion.h"      // For the ABI namespace
#include "vtkObject.h"

#include <memory> // for the implementation

VTK_ABI_NAMESPACE_BEGIN

class vtkActorCollection;
class vtkCamera;
class vtkLightCollection;
class vtkRenderer;

class VTKHYBRIDIOBART_EXPORT vtkHybridBARTImporter : public vtkObject
{
public:
  static vtkHybridBARTImporter* New();
  vtkTypeMacro(vtkHybridBARTImporter, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Set/Get the scene's file. Files that it includes are found relative to the file that includes
   * them. Default: none.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * Set/Get whether surfaces get their textures. Off, texture files need not exist and surfaces
   * keep their material's colours. Takes effect at the next Read(). Default: on.
   */
  vtkSetMacro(Textures, bool);
  vtkGetMacro(Textures, bool);
  vtkBooleanMacro(Textures, bool);
  ///@}

  /**
   * Read the file and make actors, lights and the camera, at the time of the first frame. Returns
   * false, after an error event with file, line and what was expected there, when the scene is not
   * right; the importer is then empty. What a former Read() made is left to those who hold it, and
   * no longer moved by SetTime.
   */
  bool Read();

  /**
   * Add the actors and lights to a renderer, make the camera its active one and set its background.
   * Without a viewpoint in the file, the renderer's camera is reset to show everything.
   */
  void AddTo(vtkRenderer* renderer);

  ///@{
  /**
   * What the last successful Read() made. Empty collections before it. The camera is null where the
   * file has neither viewpoint nor camera keys.
   */
  vtkActorCollection* GetActors();
  vtkLightCollection* GetLights();
  vtkCamera* GetCamera();
  ///@}

  ///@{
  /**
   * Set/Get the moment that is shown, in the scene's own unit of time (BART means seconds). Any
   * finite time will do: before its first and after its last key a movement stands still. Another
   * value is refused with an error. Default: the time of the first frame.
   */
  void SetTime(double time);
  vtkGetMacro(Time, double);
  ///@}

  ///@{
  /**
   * The times of the first and the last frame, both 0 for a scene without an animation.
   */
  vtkGetVector2Macro(TimeRange, double);
  ///@}

  /**
   * The number of frames of the animation, 1 for a scene without one, 0 before Read().
   */
  vtkGetMacro(NumberOfFrames, int);

  /**
   * The time of a frame; frames are spread evenly over the time range, both ends included. The
   * frame is clamped to [0, GetNumberOfFrames() - 1].
   */
  double GetFrameTime(int frame);

  ///@{
  /**
   * The triangles of all actors, a polygon of n corners counted as n - 2, and those of them that
   * the file gives a texture.
   */
  vtkGetMacro(NumberOfTriangles, vtkIdType);
  vtkGetMacro(NumberOfTexturedTriangles, vtkIdType);
  ///@}

  ///@{
  /**
   * The transforms that may move, and those of them for which there are keys; the others stay as
   * they are.
   */
  vtkGetMacro(NumberOfAnimatedTransforms, int);
  vtkGetMacro(NumberOfKeyedTransforms, int);
  ///@}

  ///@{
  /**
   * The width and height in pixels that the file asks for. Default: 800, 600.
   */
  vtkGetVector2Macro(Resolution, int);
  ///@}

protected:
  vtkHybridBARTImporter();
  ~vtkHybridBARTImporter() override;

private:
  vtkHybridBARTImporter(const vtkHybridBARTImporter&) = delete;
  void operator=(const vtkHybridBARTImporter&) = delete;

  void TakeFigures();

  char* FileName = nullptr;
  bool Textures = true;
  double Time = 0.0;
  double TimeRange[2] = { 0.0, 0.0 };
  int NumberOfFrames = 0;
  vtkIdType NumberOfTriangles = 0;
  vtkIdType NumberOfTexturedTriangles = 0;
  int NumberOfAnimatedTransforms = 0;
  int NumberOfKeyedTransforms = 0;
  int Resolution[2] = { 800, 600 };

  struct Internals;
  std::unique_ptr<Internals> Inside;
};

VTK_ABI_NAMESPACE_END
#endif
