// See UserBuffers.h.
#include "Rendering/OpenGL2/UserBuffers.h"

#include "Rendering/Core/Tracing/Surface.h"

#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkTypeInt64Array.h"

#include <algorithm>
#include <functional>
#include <limits>

namespace hrt
{
namespace gl
{
namespace
{

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

// One pixel that hit something.
struct Pixel
{
  TriangleId triangle;
  std::size_t part;
  const Hit& hit;
  const SurfacePoint& point;
};

// How a buffer is filled: its components and, for a pixel, its values.
struct Recipe
{
  int components;
  bool isId;
  std::function<void(const Snapshot&, const Pixel&, double*)> fill;
};

const std::map<std::string, Recipe>& recipes()
{
  const auto put = [](double* out, const glm::dvec3& v) {
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
  };
  static const std::map<std::string, Recipe> all = {
    { "triangle",
      { 1, true,
        [](const Snapshot&, const Pixel& p, double* out) { out[0] = double(p.triangle); } } },
    { "cell",
      { 1, true,
        [](const Snapshot& s, const Pixel& p, double* out) {
          const Part& part = s.parts[p.part];
          out[0] = double(part.geometry->cellIds[part.indexOf(p.triangle)]);
        } } },
    { "prop",
      { 1, true,
        [](const Snapshot& s, const Pixel& p, double* out) {
          out[0] = double(s.parts[p.part].source.prop);
        } } },
    { "block",
      { 1, true,
        [](const Snapshot& s, const Pixel& p, double* out) {
          out[0] = double(s.parts[p.part].source.block);
        } } },
    { "glyph",
      { 1, true,
        [](const Snapshot& s, const Pixel& p, double* out) {
          const Part& part = s.parts[p.part];
          out[0] = part.copies ? double(part.copies->id(part.copyOf(p.triangle))) : -1.0;
        } } },
    { "barycentric",
      { 2, false,
        [](const Snapshot&, const Pixel& p, double* out) {
          out[0] = p.hit.u;
          out[1] = p.hit.v;
        } } },
    { "position",
      { 3, false,
        [put](const Snapshot& s, const Pixel& p, double* out) {
          put(out, p.point.position + s.origin);
        } } },
    { "normal",
      { 3, false,
        // The shading normal is on the wrong side under a mirroring matrix, as VTK's own is.
        [put](const Snapshot&, const Pixel& p, double* out) { put(out, p.point.opticalNormal); } } },
    { "depth",
      { 1, false,
        [](const Snapshot& s, const Pixel& p, double* out) {
          const glm::dvec3 world = p.point.position + s.origin;
          out[0] = -(s.camera.worldToView * glm::dvec4(world, 1.0)).z;
        } } },
  };
  return all;
}

vtkSmartPointer<vtkImageData> makeImage(
  const Camera& camera, const std::string& name, vtkDataArray* values)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(camera.width, camera.height, 1);
  values->SetName(name.c_str());
  image->GetPointData()->SetScalars(values);
  return image;
}

// Calls visit(first, end) for the pixels of each row within the bounds.
template <class Visit>
void forEachRow(const PixelBounds& bounds, int width, Visit visit)
{
  for (int row = bounds.y0; row < bounds.y1; ++row)
  {
    const std::size_t left = std::size_t(row) * std::size_t(width);
    visit(left + std::size_t(bounds.x0), left + std::size_t(bounds.x1));
  }
}

// Ids are exact in a double up to 2^53, triangle and cell numbers stay far below.
template <class Array>
vtkSmartPointer<vtkDataArray> makeArray(const std::vector<double>& values, int components)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / components);
  std::transform(values.begin(), values.end(), array->GetPointer(0),
    [](double v) { return static_cast<typename Array::ValueType>(v); });
  return array;
}

} // namespace

//------------------------------------------------------------------------------
const std::vector<std::string>& UserBuffers::knownNames()
{
  static const std::vector<std::string> names = { "triangle", "cell", "prop", "block",
    "glyph", "barycentric", "position", "normal", "depth", "shadow" };
  return names;
}

//------------------------------------------------------------------------------
void UserBuffers::setNames(const std::vector<std::string>& names)
{
  this->Names = names;
  this->Images.clear();
  this->Current = false;
}

//------------------------------------------------------------------------------
vtkImageData* UserBuffers::image(const std::string& name) const
{
  const auto found = this->Images.find(name);
  return found == this->Images.end() ? nullptr : found->second.GetPointer();
}

//------------------------------------------------------------------------------
std::string UserBuffers::update(FrameRenderer& frame, const Snapshot& snapshot)
{
  this->Images.clear();
  this->Current = false;
  const Camera& camera = snapshot.camera;
  const std::size_t pixels = static_cast<std::size_t>(camera.width) * camera.height;

  // When nothing is in view the frame has drawn no ids: the last ones are not this frame's.
  std::vector<std::uint32_t> ids(pixels, 0);
  // Direct rendering shows what it has: the rasteriser's (u, v) and the points they give.
  std::vector<glm::dvec2> rasterised;
  if (frame.statistics().plan[Stage::Blit].run)
  {
    const std::vector<std::uint32_t>& all = frame.ids();
    if (all.size() != pixels)
    {
      return "the object intersection buffer could not be read back";
    }
    forEachRow(frame.bounds(), camera.width, [&](std::size_t first, std::size_t end) {
      std::copy(all.begin() + static_cast<std::ptrdiff_t>(first),
        all.begin() + static_cast<std::ptrdiff_t>(end),
        ids.begin() + static_cast<std::ptrdiff_t>(first));
    });
    frame.readBarycentrics(rasterised);
  }

  std::map<std::string, std::vector<double>> values;
  for (const std::string& name : this->Names)
  {
    const auto recipe = recipes().find(name);
    if (recipe != recipes().end())
    {
      values[name].assign(
        pixels * recipe->second.components, recipe->second.isId ? -1.0 : kNothing);
    }
  }
  const Surfaces surfaces(snapshot);
  const CameraRays rays = camera.worldRays(snapshot.origin);
  for (std::size_t i = 0; i < pixels && !values.empty(); ++i)
  {
    if (ids[i] == 0 || ids[i] > snapshot.triangleCount)
    {
      continue;
    }
    const double x = (double(i % camera.width) + 0.5) / camera.width * 2.0 - 1.0;
    const double y = (double(i / camera.width) + 0.5) / camera.height * 2.0 - 1.0;
    Ray ray;
    ray.origin = rays.origin(x, y);
    ray.direction = rays.direction(x, y);
    Hit hit;
    if (!surfaces.primaryHit(ids[i] - 1, ray, hit))
    {
      continue;
    }
    if (!rasterised.empty())
    {
      hit.u = rasterised[i].x;
      hit.v = rasterised[i].y;
    }
    const SurfacePoint point = surfaces.at(hit, ray.direction);
    const Pixel pixel{ hit.triangle, point.part, hit, point };
    for (auto& buffer : values)
    {
      const Recipe& recipe = recipes().at(buffer.first);
      recipe.fill(snapshot, pixel, &buffer.second[i * recipe.components]);
    }
  }
  for (const auto& buffer : values)
  {
    const Recipe& recipe = recipes().at(buffer.first);
    this->Images[buffer.first] = makeImage(camera, buffer.first,
      recipe.isId ? makeArray<vtkTypeInt64Array>(buffer.second, recipe.components)
                  : makeArray<vtkDoubleArray>(buffer.second, recipe.components));
  }

  if (std::find(this->Names.begin(), this->Names.end(), "shadow") != this->Names.end())
  {
    const int lights = static_cast<int>(snapshot.lights.size());
    vtkNew<vtkFloatArray> shares;
    shares->SetNumberOfComponents(std::max(lights, 1));
    shares->SetNumberOfTuples(static_cast<vtkIdType>(pixels));
    shares->Fill(kNothing);
    for (int light = 0; light < lights && frame.statistics().plan[Stage::Blit].run; ++light)
    {
      std::vector<float> share;
      if (!frame.readShadow(light, share))
      {
        return "the shadow buffer could not be drawn";
      }
      forEachRow(frame.bounds(), camera.width, [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i)
        {
          shares->SetComponent(static_cast<vtkIdType>(i), light, share[i]);
        }
      });
    }
    this->Images["shadow"] = makeImage(camera, "shadow", shares);
  }
  this->Current = true;
  return {};
}

} // namespace gl
} // namespace hrt
