// The class that scripts use: a render pass that gives a vtkRenderer shadows, mirrors and glass.
/**
 * @class   vtkHybridRayTracingPass
 * @brief   hybrid ray tracing of a renderer's surfaces
 *
 * A drop-in render pass: `renderer->SetPass(pass)` is all a script needs. The pass rasterises an
 * object intersection buffer (the triangle visible at each pixel) and one shadow map per light in
 * VTK's own OpenGL context, shades the primary image with VTK's own lighting equations on the GPU,
 * and traces what mirrors and glass show on the CPU. A still scene costs one blit; a scene without
 * mirror or glass in view traces no ray and reads nothing back. See GetStatistics().
 *
 * It implements P. C. D. Robert, S. Schoepke and H. Bieri, "Hybrid Ray Tracing: Ray Tracing Using
 * GPU-Accelerated Image-Space Methods".
 *
 * What is read from VTK: actors (also in assemblies) with polygonal data, data sets, composite data or
 * glyphs, their properties, textures, visible edges, clipping planes, polygon offsets and scalar colours,
 * all kinds of vtkLight, the camera's composed matrices, the background. Mirrors and glass are asked for per
 * actor with vtkHybridMaterial. Everything else - lines, points, text,
 * physically based and translucent actors, volumes, 2D props - is drawn by VTK itself,
 * after and against the traced picture's depth. Picking with vtkHardwareSelector works as without
 * the pass.
 *
 * One ray or sample a pixel: vtkRenderWindow::SetMultiSamples smooths what VTK draws, not the traced
 * surfaces; vtkRenderer::UseFXAA smooths both.
 *
 * Framebuffer in: the one bound when Render is called: the renderer's, or that of the render state
 * when another pass has this one as its delegate. Framebuffer out: its colour and depth within the
 * renderer's viewport, or wholly. The render state is not modified. vtkRenderer::UseSSAO and
 * UseHiddenLineRemoval have no effect, as with any pass.
 *
 * @sa vtkHybridMaterial
 */

#ifndef vtkHybridRayTracingPass_h
#define vtkHybridRayTracingPass_h

#include "vtkHybridRenderingOpenGL2Module.h" // for export macro
#include "vtkRenderPass.h"

#include <memory> // for std::unique_ptr
#include <string> // for std::string
#include <vector> // for std::vector

class vtkImageData;
class vtkOpenGLRenderWindow;
class vtkProp;

namespace hrt
{
struct PixelBounds;
}

class VTKHYBRIDRENDERINGOPENGL2_EXPORT vtkHybridRayTracingPass : public vtkRenderPass
{
public:
  static vtkHybridRayTracingPass* New();
  vtkTypeMacro(vtkHybridRayTracingPass, vtkRenderPass);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Draws the renderer of the state. Called by vtkRenderer.
   */
  void Render(const vtkRenderState* s) override;

  /**
   * Frees every OpenGL object. Called by vtkRenderer; also done when the pass is deleted.
   */
  void ReleaseGraphicsResources(vtkWindow* window) override;

  enum VisibilityType
  {
    ItemBuffer = 0,
    DirectRendering = 1,
    RayCasting = 2
  };

  ///@{
  /**
   * How the first hit of each pixel is found (paper, section 2.1). ItemBuffer: the rasteriser gives
   * the triangle, exactly one ray-triangle intersection gives the point. DirectRendering: the
   * rasteriser also interpolates (u, v), no intersection is computed; the point is off by up to a
   * few thousandths of a pixel.
   * RayCasting: a ray through each pixel's centre, on the CPU, in double precision; no rasteriser
   * is involved. Default: ItemBuffer.
   */
  void SetVisibility(int visibility);
  vtkGetMacro(Visibility, int);
  void SetVisibilityToItemBuffer() { this->SetVisibility(ItemBuffer); }
  void SetVisibilityToDirectRendering() { this->SetVisibility(DirectRendering); }
  void SetVisibilityToRayCasting() { this->SetVisibility(RayCasting); }
  ///@}

  enum PrimaryShadingType
  {
    GPU = 0,
    CPU = 1
  };

  ///@{
  /**
   * Where the first hits are shaded. GPU: by the fragment shader of the primary image (paper, section 3.2).
   * CPU: on all cores, starting with the first rows of the object intersection buffer that are
   * read back (paper, section 3.1); with RayCasting this is the paper's traditional ray tracer, every
   * ray on the CPU. Both use the same shading equations and look up the same shadow maps, see
   * SetShadowMode. Default: GPU.
   */
  void SetPrimaryShading(int shading);
  vtkGetMacro(PrimaryShading, int);
  void SetPrimaryShadingToGPU() { this->SetPrimaryShading(GPU); }
  void SetPrimaryShadingToCPU() { this->SetPrimaryShading(CPU); }
  ///@}

  enum AcceleratorType
  {
    Embree = 0,
    KdTree = 1
  };

  ///@{
  /**
   * The structure that rays are traced through. Embree: Embree's hierarchies. KdTree: the paper's
   * kd-tree, by the O(N log N) surface area heuristic of Wald and Havran (2006); slower to build.
   * Both let the same kernel decide every triangle in double precision: the picture is the same to
   * the last bit. Default: Embree.
   */
  void SetAccelerator(int accelerator);
  vtkGetMacro(Accelerator, int);
  void SetAcceleratorToEmbree() { this->SetAccelerator(Embree); }
  void SetAcceleratorToKdTree() { this->SetAccelerator(KdTree); }
  ///@}

  enum ShadowModeType
  {
    ShadowsOff = 0,
    ShadowMaps = 1,
    Exact = 2
  };

  ///@{
  /**
   * Shadows. ShadowMaps: one depth map per light (paper, section 2.2), for directional, spot and
   * point lights; what is seen in a mirror or through glass is shadowed by rays. Exact: a shadow ray
   * to each light from everything that is seen; shadow rays end on the CPU, which then shades
   * too, whatever PrimaryShading says. The traditional ray tracer (RayCasting, CPU) rasterises
   * nothing: there both names mean rays. Opaque actors cast; glass lets all light through; translucent
   * actors let it all through shadow maps and tint what passes with shadow rays. Headlights cast
   * none unless SetHeadlightShadows is on. Default: ShadowMaps.
   */
  void SetShadowMode(int mode);
  vtkGetMacro(ShadowMode, int);
  void SetShadowModeToOff() { this->SetShadowMode(ShadowsOff); }
  void SetShadowModeToShadowMaps() { this->SetShadowMode(ShadowMaps); }
  void SetShadowModeToExact() { this->SetShadowMode(Exact); }
  ///@}

  ///@{
  /**
   * Whether lights of the kind headlight (vtkLight::SetLightTypeToHeadlight) cast shadows. VTK makes one
   * for every renderer without lights; it shines from the eye, so that the shadows it casts are hidden
   * behind what casts them, or nearly. Off, as in VTK's own shadow pass, nothing is drawn or traced for
   * them. Default: off.
   */
  vtkSetMacro(HeadlightShadows, bool);
  vtkGetMacro(HeadlightShadows, bool);
  vtkBooleanMacro(HeadlightShadows, bool);
  ///@}

  ///@{
  /**
   * Texels along each side of a shadow map (of each of the six faces for a point light). Range [16,
   * 16384], clamped. All maps together take at most 256 MiB, at 4 bytes a texel, and no more than
   * one texture of the context holds: with many lights each gets less, see "shadow_map_resolution"
   * in GetStatistics. Default: 2048.
   */
  vtkSetClampMacro(ShadowMapResolution, int, 16, 16384);
  vtkGetMacro(ShadowMapResolution, int);
  ///@}

  ///@{
  /**
   * Trace what mirrors (vtkHybridMaterial::SetReflectance) and the outside of glass reflect.
   * Default: on.
   */
  vtkSetMacro(Reflections, bool);
  vtkGetMacro(Reflections, bool);
  vtkBooleanMacro(Reflections, bool);
  ///@}

  ///@{
  /**
   * Trace what is seen through glass (vtkHybridMaterial::SetGlass); off, glass is shaded as its
   * vtkProperty says. Default: on.
   */
  vtkSetMacro(Refractions, bool);
  vtkGetMacro(Refractions, bool);
  vtkBooleanMacro(Refractions, bool);
  ///@}

  ///@{
  /**
   * Number of times a ray may be reflected or refracted; what lies beyond adds nothing. Range
   * [0, 32], clamped; 0 switches secondary rays off. Default: 3, as in the paper.
   */
  vtkSetClampMacro(MaximumDepth, int, 0, 32);
  vtkGetMacro(MaximumDepth, int);
  ///@}

  enum PipelinedType
  {
    PipelinedNever = 0,
    PipelinedInAnimations = 1,
    PipelinedAutomatic = 2
  };

  ///@{
  /**
   * Pipelining (paper, section 3.3): in an animation each frame is shown one frame late, so that the
   * CPU traces its rays while the application prepares, and the GPU draws, the next one. An animation is what
   * is rendered while vtkRenderWindow::GetDesiredUpdateRate is at least 1 frame per second:
   * interactor styles see to that while the mouse is moving the scene, and a script may set it. All
   * other frames are finished at once; so is an animation's last one when the same view is rendered
   * again, as vtkWindowToImageFilter and the end of an interaction do. Also finished at once are
   * frames with actors that came or went, in stereo, with props that VTK draws itself, with another
   * renderer of the same camera in the window, and when buffers are wanted. GetStatistics says
   * whether a frame was pipelined and why not. Automatic: on where OpenGL is a graphics card's, off
   * where it is software that takes the same cores. Default: Automatic.
   */
  void SetPipelined(int pipelined);
  vtkGetMacro(Pipelined, int);
  void PipelinedOn() { this->SetPipelined(PipelinedInAnimations); }
  void PipelinedOff() { this->SetPipelined(PipelinedNever); }
  void SetPipelinedToAutomatic() { this->SetPipelined(PipelinedAutomatic); }
  ///@}

  enum MultisamplingType
  {
    MultisamplingOff = 0,
    Clamp = 1,
    Lazy3x3 = 2,
    Lazy5x5 = 3,
    Full3x3 = 4,
    Full5x5 = 5
  };

  ///@{
  /**
   * What becomes of a pixel whose ray does not meet the triangle that the rasteriser named, for what
   * the CPU traces from a rasterised item buffer: its primary shading and the start points of
   * secondary rays (paper, section 3.1). MultisamplingOff: it stays without colour. Clamp: the hit
   * of the triangle's plane is moved onto the triangle; no pixel is lost. Lazy3x3, Lazy5x5: the
   * triangles of the 3x3 or 5x5 pixels around are tried, the nearest that is met wins; where none
   * is, the colour is interpolated from the pixels around. Full3x3, Full5x5: the same, but for every
   * pixel, also where its own triangle is met. What RayCasting or DirectRendering find needs none.
   * Shading on the GPU always clamps: a warning says so when another mode is used with it. It is the
   * paper's word for the repair of edges, and smooths nothing: samples a pixel are
   * vtkRenderWindow::SetMultiSamples, for what VTK draws. A value out of range is an error and changes
   * nothing. Default: Clamp.
   */
  void SetMultisampling(int mode);
  vtkGetMacro(Multisampling, int);
  void SetMultisamplingToOff() { this->SetMultisampling(MultisamplingOff); }
  void SetMultisamplingToClamp() { this->SetMultisampling(Clamp); }
  void SetMultisamplingToLazy3x3() { this->SetMultisampling(Lazy3x3); }
  void SetMultisamplingToLazy5x5() { this->SetMultisampling(Lazy5x5); }
  void SetMultisamplingToFull3x3() { this->SetMultisampling(Full3x3); }
  void SetMultisamplingToFull5x5() { this->SetMultisampling(Full5x5); }
  ///@}

  ///@{
  /**
   * Interleaved rendering (paper, section 3.1): of what the CPU traces - its primary shading,
   * secondary rays and, with RayCasting, primary rays - only every n-th column and row of pixels is
   * traced, and the last ones; the rest is interpolated in a second pass. 1 traces every pixel. What
   * the GPU shades is not thinned. Range [1, 16], clamped. Default: 1.
   */
  vtkSetClampMacro(Interleave, int, 1, 16);
  vtkGetMacro(Interleave, int);
  ///@}

  ///@{
  /**
   * Interpolate only where the samples around a pixel saw the same surfaces and lights and have
   * nearly the same colour, and trace the other pixels. Off: the paper's plain interpolation, which
   * blurs. Without effect while Interleave is 1. Default: on.
   */
  vtkSetMacro(InterleaveErrorControl, bool);
  vtkGetMacro(InterleaveErrorControl, bool);
  vtkBooleanMacro(InterleaveErrorControl, bool);
  ///@}

  ///@{
  /**
   * The pixels to trace: columns [x0, x1) and rows [y0, y1) of the renderer's viewport, row 0 at the
   * bottom. Everything that the frame costs - rasterised parts, shading, read-back, rays - is
   * restricted to them, and the pixels inside are those of the unrestricted frame, bit by bit; so
   * workers that each trace some of a picture's pixels can put it together (sort first; paper,
   * section 2.1). Outside, the framebuffer keeps its background, its depth is that of the near plane,
   * which keeps out the props that VTK draws itself (overlays excepted), and buffers say that nothing
   * was hit. Values outside the viewport are clamped to it; where nothing remains nothing is drawn.
   * ResetPixelBounds: everything. Default: everything, x0 = y0 = 0 and x1 = y1 = VTK_INT_MAX.
   */
  void SetPixelBounds(int x0, int x1, int y0, int y1);
  void SetPixelBounds(const int bounds[4]);
  vtkGetVector4Macro(PixelBounds, int);
  void ResetPixelBounds() { this->SetPixelBounds(0, VTK_INT_MAX, 0, VTK_INT_MAX); }
  ///@}

  ///@{
  /**
   * Per-pixel results to keep besides the picture, by name; nothing is computed that was not asked
   * for. Names: "triangle" (number in the scene), "cell" (cell of the mapper's input, or of its
   * block; of a glyph in its source), "prop" (see GetPropFromId), "block" (flat index in composite data,
   * -1 also in other data), "glyph" (its point in the input of a vtkGlyph3DMapper, or its selection id,
   * -1 also in other data), all 64-bit with -1 where nothing was hit; "barycentric" (u, v of the second
   * and third corner; with DirectRendering as the rasteriser interpolated them), "position" (world),
   * "normal" (world, unit, on the viewer's side), "depth" (distance along the view axis), "shadow" (one
   * component a light: its visible share, 1 lit to 0 in shadow), all with NaN where nothing was hit.
   * Actors that are left to VTK are not in the buffers. An unknown name is an error and changes nothing.
   * GetKnownBuffers lists all names. Default: none.
   */
  void SetBuffers(const std::vector<std::string>& names);
  // Only to say what is wrong: a script's string is a sequence too, of letters.
  void SetBuffers(const char* name);
  std::vector<std::string> GetBuffers();
  static std::vector<std::string> GetKnownBuffers();
  ///@}

  /**
   * A buffer of the last frame as an image of the viewport's size with one point array of that
   * name, row 0 at the bottom. Null, after an error message, for a name that is unknown, was not
   * asked for with SetBuffers, or has not been rendered yet.
   */
  vtkImageData* GetBuffer(const char* name);

  /**
   * The prop of a number in the "prop" buffer: the actor, whichever of its blocks or on whichever path
   * through assemblies it is seen. Null for -1 and numbers out of range.
   */
  vtkProp* GetPropFromId(vtkIdType id);

  /**
   * What the last frame did, as JSON: which stages ran, why or why not, and the host's
   * milliseconds; rays by class; triangles drawn; bytes read back and uploaded; structures built;
   * triangles refused at the scene's door; actors left to VTK and why, and what VTK draws by its nature.
   * From Python use vtkhybrid.statistics(pass), which returns a dictionary.
   */
  std::string GetStatistics();

  /**
   * OpenGL objects that the pass holds at the moment; 0 after ReleaseGraphicsResources.
   */
  int GetNumberOfOpenGLObjects();

protected:
  vtkHybridRayTracingPass();
  ~vtkHybridRayTracingPass() override;

private:
  vtkHybridRayTracingPass(const vtkHybridRayTracingPass&) = delete;
  void operator=(const vtkHybridRayTracingPass&) = delete;

  // Draws everything into the bound framebuffer, size pixels large from origin on.
  void RenderPicture(const vtkRenderState* s, vtkOpenGLRenderWindow* window, const int size[2],
    const int origin[2]);
  // Takes the errors that OpenGL has kept; those that the pass has made are told of.
  void DrainErrors(bool own);
  hrt::PixelBounds BoundsWithin(const int size[2]) const;
  // The traced part of it; what went wrong, or empty.
  std::string TraceFrame(const vtkRenderState* s, vtkOpenGLRenderWindow* window,
    const int size[2], const int origin[2]);

  int Visibility = ItemBuffer;
  int PrimaryShading = GPU;
  int Accelerator = Embree;
  int ShadowMode = ShadowMaps;
  bool HeadlightShadows = false;
  int ShadowMapResolution = 2048;
  bool Reflections = true;
  bool Refractions = true;
  int MaximumDepth = 3;
  int Pipelined = PipelinedAutomatic;
  int Multisampling = Clamp;
  int Interleave = 1;
  bool InterleaveErrorControl = true;
  int PixelBounds[4] = { 0, VTK_INT_MAX, 0, VTK_INT_MAX };

  class vtkInternals;
  std::unique_ptr<vtkInternals> Internals;
};

#endif
