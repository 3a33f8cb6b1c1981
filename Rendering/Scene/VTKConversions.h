// VTK keeps a matrix by rows in doubles, GLM by columns; colours are doubles there and floats here.
// These few functions are the only place where the one is turned into the other.
#pragma once

#include "vtkMatrix4x4.h"
#include "vtkSmartPointer.h"

#include <glm/glm.hpp>

namespace hrt
{
namespace scene
{

inline glm::dmat4 toMatrix(const vtkMatrix4x4* matrix)
{
  glm::dmat4 result;
  for (int row = 0; row < 4; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      result[column][row] = matrix->GetElement(row, column);
    }
  }
  return result;
}

inline vtkSmartPointer<vtkMatrix4x4> fromMatrix(const glm::dmat4& matrix)
{
  auto result = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int row = 0; row < 4; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      result->SetElement(row, column, matrix[column][row]);
    }
  }
  return result;
}

inline glm::dvec3 toVector(const double v[3])
{
  return glm::dvec3(v[0], v[1], v[2]);
}

inline glm::vec3 toColor(const double v[3])
{
  return glm::vec3(toVector(v));
}

inline bool isFinite(const glm::dvec3& v)
{
  return !glm::any(glm::isnan(v)) && !glm::any(glm::isinf(v));
}

} // namespace scene
} // namespace hrt
