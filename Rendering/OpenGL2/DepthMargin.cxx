// See DepthMargin.h.
#include "Rendering/OpenGL2/DepthMargin.h"

#include <algorithm>
#include <cmath>

namespace hrt
{
namespace gl
{
namespace
{

constexpr double kRoundings = 3.0 * 0x1p-24; // 3 u

//------------------------------------------------------------------------------
// Whether VTK's vertex buffers hold coordinates relative to the middle of the data and scaled, as they do
// where these lie far from their origin for their size, or are very large or very small.
bool isShifted(const glm::dvec3& middle, const glm::dvec3& size)
{
  constexpr double kFar = 1e6;   // distance to diagonal, squared
  constexpr double kOtherSize = 3.0; // decimal logarithm of the squared diagonal
  const double diagonal = glm::dot(size, size);
  return glm::dot(middle, middle) > kFar * diagonal || std::abs(std::log10(diagonal)) > kOtherSize;
}

//------------------------------------------------------------------------------
// S(z) + S(w) of a part, by the box of its mesh.
double productsOf(const Part& part, const glm::dmat4& worldToClip)
{
  const glm::dvec3 lower = part.geometry->origin + glm::dvec3(part.geometry->boundsMin);
  const glm::dvec3 upper = part.geometry->origin + glm::dvec3(part.geometry->boundsMax);
  const glm::dvec3 middle = 0.5 * (lower + upper), size = upper - lower;
  glm::dmat4 toClip = worldToClip * part.localToWorld;
  glm::dvec3 largest = glm::max(glm::abs(lower), glm::abs(upper));
  if (part.copies)
  {
    // Of glyphs the copy's matrix is one more factor.
    const glm::dvec3 ends =
      glm::max(glm::abs(part.copies->boundsMin), glm::abs(part.copies->boundsMax));
    largest = glm::max(largest, ends);
  }
  else if (isShifted(middle, size))
  {
    toClip[3] = toClip * glm::dvec4(middle, 1.0);
    largest = 0.5 * size;
  }
  const auto sum = [&](int row) {
    return std::abs(toClip[0][row]) * largest.x + std::abs(toClip[1][row]) * largest.y +
      std::abs(toClip[2][row]) * largest.z + std::abs(toClip[3][row]);
  };
  return sum(2) + sum(3);
}

} // namespace

//------------------------------------------------------------------------------
DepthMargin DepthMargin::of(const Snapshot& snapshot)
{
  const Camera& camera = snapshot.camera;
  const glm::dmat4 worldToClip = camera.viewToClip * camera.worldToView;
  double products = 0.0;
  for (const Part& part : snapshot.parts)
  {
    if (part.visibleToCamera)
    {
      products = std::max(products, productsOf(part, worldToClip));
    }
  }
  DepthMargin margin;
  margin.byW = static_cast<float>(kRoundings * products);
  // z = a e + b and w = c e + d for the depth e before the eye, wherever in the picture; e drops out.
  const double a = camera.viewToClip[2][2], b = camera.viewToClip[3][2];
  const double c = camera.viewToClip[2][3], d = camera.viewToClip[3][3];
  const double determinant = a * d - b * c;
  if (determinant != 0.0)
  {
    margin.perW[0] = static_cast<float>(a / determinant);
    margin.perW[1] = static_cast<float>(-c / determinant);
  }
  return margin;
}

} // namespace gl
} // namespace hrt
