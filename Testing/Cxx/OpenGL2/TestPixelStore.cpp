// A host draws with OpenGL too, and leaves the context as it pleases: rows of pictures padded,
// shifted or in the other byte order, a pixel buffer bound. The pass must neither move its own
// pictures by the host's rules nor change them. Each setting is tried alone, in every way in which
// the pass brings pixels to the host or back, with a new pass, so that its first allocations are
// among what is tried.
#include "Rendering/OpenGL2/GLHeader.h"
#include "Rendering/OpenGL2/vtkHybridRayTracingPass.h"
#include "Rendering/Scene/vtkHybridMaterial.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkLight.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkPlaneSource.h"
#include "vtkPointData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderPass.h"
#include "vtkRenderState.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace
{

// Odd, so that a row of four-byte texels is no multiple of eight bytes.
constexpr int kWidth = 301;
constexpr int kHeight = 203;

struct Parameter
{
  const char* name;
  GLenum parameter;
  GLint strange;
};

// Other values than the defaults, none of which suits the pass.
const std::array<Parameter, 10> kParameters{ {
  { "PACK_ALIGNMENT", GL_PACK_ALIGNMENT, 8 },
  { "PACK_ROW_LENGTH", GL_PACK_ROW_LENGTH, 307 },
  { "PACK_SKIP_PIXELS", GL_PACK_SKIP_PIXELS, 5 },
  { "PACK_SKIP_ROWS", GL_PACK_SKIP_ROWS, 3 },
  { "PACK_SWAP_BYTES", GL_PACK_SWAP_BYTES, GL_TRUE },
  { "UNPACK_ALIGNMENT", GL_UNPACK_ALIGNMENT, 8 },
  { "UNPACK_ROW_LENGTH", GL_UNPACK_ROW_LENGTH, 307 },
  { "UNPACK_SKIP_PIXELS", GL_UNPACK_SKIP_PIXELS, 5 },
  { "UNPACK_SKIP_ROWS", GL_UNPACK_SKIP_ROWS, 3 },
  { "UNPACK_SWAP_BYTES", GL_UNPACK_SWAP_BYTES, GL_TRUE },
} };

struct Binding
{
  const char* name;
  GLenum target;
  GLenum query;
};

const std::array<Binding, 2> kBindings{ {
  { "PIXEL_PACK_BUFFER", GL_PIXEL_PACK_BUFFER, GL_PIXEL_PACK_BUFFER_BINDING },
  { "PIXEL_UNPACK_BUFFER", GL_PIXEL_UNPACK_BUFFER, GL_PIXEL_UNPACK_BUFFER_BINDING },
} };

GLint valueOf(GLenum query)
{
  GLint value = 0;
  glGetIntegerv(query, &value);
  return value;
}

// The host's part: calls the pass with something strange, looks at what the pass left of it, and
// puts all back, because VTK's own drawing expects that. VTK remembers some of the state, and is
// told, as its windows within a host's window tell it.
class HostPass : public vtkRenderPass
{
public:
  static HostPass* New();
  vtkTypeMacro(HostPass, vtkRenderPass);

  vtkNew<vtkHybridRayTracingPass> Pass;
  std::function<void()> Before = [] {};
  std::function<void()> After = [] {};

  void Render(const vtkRenderState* state) override
  {
    auto* window =
      vtkOpenGLRenderWindow::SafeDownCast(state->GetRenderer()->GetRenderWindow());
    this->Before();
    window->GetState()->Reset();
    this->Pass->Render(state);
    this->After();
    window->GetState()->Reset();
    this->NumberOfRenderedProps = this->Pass->GetNumberOfRenderedProps();
  }

  void ReleaseGraphicsResources(vtkWindow* window) override
  {
    this->Pass->ReleaseGraphicsResources(window);
  }
};
vtkStandardNewMacro(HostPass);

// All that a user can see of a frame, byte by byte.
struct Frame
{
  std::vector<unsigned char> picture;
  std::vector<std::string> buffers;

  bool operator==(const Frame& o) const
  {
    return this->picture == o.picture && this->buffers == o.buffers;
  }
};

// A ball above a mirror, lit from the side.
class PixelStore : public testing::Test
{
protected:
  using Mode = std::function<void(vtkHybridRayTracingPass*)>;

  void SetUp() override
  {
    vtkNew<vtkPlaneSource> plane;
    plane->SetOrigin(-2.0, -2.0, 0.0);
    plane->SetPoint1(2.0, -2.0, 0.0);
    plane->SetPoint2(-2.0, 2.0, 0.0);
    vtkNew<vtkSphereSource> ball;
    ball->SetCenter(0.2, 0.1, 0.8);
    ball->SetThetaResolution(24);
    ball->SetPhiResolution(16);
    vtkHybridMaterial::SetReflectance(this->add(plane, 0.9, 0.8, 0.6), 0.4);
    this->add(ball, 0.3, 0.5, 0.9);

    vtkNew<vtkLight> light;
    light->SetLightTypeToSceneLight();
    light->SetPositional(true);
    light->SetConeAngle(60.0);
    light->SetPosition(3.0, -2.0, 4.0);
    light->SetFocalPoint(0.0, 0.0, 0.0);
    this->Renderer->AddLight(light);
    this->Renderer->AutomaticLightCreationOff();
    this->Renderer->SetBackground(0.1, 0.2, 0.3);

    this->Window->SetOffScreenRendering(true);
    this->Window->SetMultiSamples(0);
    this->Window->SetSize(kWidth, kHeight);
    this->Window->AddRenderer(this->Renderer);
    vtkCamera* camera = this->Renderer->GetActiveCamera();
    camera->SetPosition(1.0, -4.0, 3.0);
    camera->SetFocalPoint(0.0, 0.0, 0.3);
    camera->SetViewUp(0.0, 0.0, 1.0);
    this->Renderer->ResetCameraClippingRange();
  }

  vtkActor* add(vtkPolyDataAlgorithm* source, double red, double green, double blue)
  {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(source->GetOutputPort());
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(red, green, blue);
    this->Renderer->AddActor(actor);
    return actor; // kept by the renderer
  }

  Frame render(const Mode& mode, const std::function<void()>& before = [] {},
    const std::function<void()>& after = [] {})
  {
    vtkNew<HostPass> host;
    host->Before = before;
    host->After = after;
    mode(host->Pass);
    const std::vector<std::string> buffers = { "triangle", "barycentric", "shadow" };
    host->Pass->SetBuffers(buffers);
    this->Renderer->SetPass(host);
    this->Window->Render();

    Frame frame;
    vtkNew<vtkUnsignedCharArray> pixels;
    this->Window->GetPixelData(0, 0, kWidth - 1, kHeight - 1, 0, pixels);
    frame.picture.assign(
      pixels->GetPointer(0), pixels->GetPointer(0) + pixels->GetNumberOfValues());
    for (const std::string& name : buffers)
    {
      vtkImageData* image = host->Pass->GetBuffer(name.c_str());
      vtkDataArray* values = image ? image->GetPointData()->GetScalars() : nullptr;
      const auto* bytes = values ? static_cast<const char*>(values->GetVoidPointer(0)) : "";
      frame.buffers.emplace_back(bytes,
        values ? static_cast<std::size_t>(values->GetNumberOfValues() * values->GetDataTypeSize())
               : 0u);
    }
    this->Renderer->SetPass(nullptr);
    host->ReleaseGraphicsResources(this->Window);
    return frame;
  }

  // The ways in which pixels travel.
  struct Way
  {
    const char* name;
    Mode mode;
  };
  static std::vector<Way> ways()
  {
    return {
      { "ids to the host, mirrors back", [](vtkHybridRayTracingPass*) {} },
      { "the same within pixel bounds",
        [](vtkHybridRayTracingPass* pass) { pass->SetPixelBounds(20, 251, 11, 180); } },
      { "(u, v) to the host",
        [](vtkHybridRayTracingPass* pass) { pass->SetVisibilityToDirectRendering(); } },
      { "ids and shadow maps to the host, the picture back",
        [](vtkHybridRayTracingPass* pass) { pass->SetPrimaryShadingToCPU(); } },
      { "ids and depths from the host",
        [](vtkHybridRayTracingPass* pass) { pass->SetVisibilityToRayCasting(); } },
    };
  }

  vtkNew<vtkRenderer> Renderer;
  vtkNew<vtkRenderWindow> Window;
};

} // namespace

TEST_F(PixelStore, TheHostsRowsAreNotOurs)
{
  for (const Way& way : ways())
  {
    const Frame expected = this->render(way.mode);
    ASSERT_TRUE(this->render(way.mode) == expected) << way.name << ": the frame varies by itself";
    // Numbers of 64 bits: -1, no hit, has no zero byte, and every triangle of this scene has some.
    ASSERT_NE(expected.buffers.front().find('\0'), std::string::npos) << "nothing is in view";
    for (const Parameter& p : kParameters)
    {
      GLint usual = 0;
      GLint left = 0;
      const Frame frame = this->render(
        way.mode,
        [&] {
          usual = valueOf(p.parameter);
          glPixelStorei(p.parameter, p.strange);
        },
        [&] {
          left = valueOf(p.parameter);
          glPixelStorei(p.parameter, usual);
        });
      EXPECT_NE(usual, p.strange) << p.name << " is not strange";
      EXPECT_EQ(left, p.strange) << way.name << ": " << p.name << " is not as the host left it";
      EXPECT_TRUE(frame.picture == expected.picture)
        << way.name << ": another picture with " << p.name;
      EXPECT_TRUE(frame.buffers == expected.buffers)
        << way.name << ": other buffers with " << p.name;
    }
  }
}

TEST_F(PixelStore, TheHostsBuffersAreNotOurs)
{
  const std::array<unsigned char, 64> content{ { 1, 2, 3, 4, 5, 6, 7, 8 } };
  for (const Way& way : ways())
  {
    const Frame expected = this->render(way.mode);
    for (const Binding& b : kBindings)
    {
      GLuint buffer = 0;
      GLint left = 0;
      std::array<unsigned char, 64> after{};
      const Frame frame = this->render(
        way.mode,
        [&] {
          glGenBuffers(1, &buffer);
          glBindBuffer(b.target, buffer);
          glBufferData(b.target, content.size(), content.data(), GL_STATIC_DRAW);
        },
        [&] {
          left = valueOf(b.query);
          glBindBuffer(b.target, buffer);
          glGetBufferSubData(b.target, 0, after.size(), after.data());
          glBindBuffer(b.target, 0);
          glDeleteBuffers(1, &buffer);
        });
      EXPECT_EQ(left, static_cast<GLint>(buffer))
        << way.name << ": " << b.name << " is not as the host left it";
      EXPECT_TRUE(after == content) << way.name << ": " << b.name << " was written to";
      EXPECT_TRUE(frame == expected) << way.name << ": another frame with " << b.name << " bound";
    }
  }
}
