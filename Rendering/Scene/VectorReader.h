// The three-component tuples of a vtkDataArray in double, read where they lie: a mesh's points and
// normals need not be copied to be looked at. Arrays of float and double are read without a call.
#pragma once

#include "vtkAOSDataArrayTemplate.h"
#include "vtkDataArray.h"

#include <glm/glm.hpp>

#include <cstddef>

namespace hrt
{
namespace scene
{

class VectorReader
{
public:
  // No array: no tuples. Else it has three components and stays as it is while this is in use.
  explicit VectorReader(vtkDataArray* array)
    : Array(array)
    , Size(array ? static_cast<std::size_t>(array->GetNumberOfTuples()) : 0)
  {
    if (auto* floats = vtkAOSDataArrayTemplate<float>::FastDownCast(array))
    {
      this->Floats = floats->GetPointer(0);
    }
    else if (auto* doubles = vtkAOSDataArrayTemplate<double>::FastDownCast(array))
    {
      this->Doubles = doubles->GetPointer(0);
    }
  }

  std::size_t size() const { return this->Size; }
  bool isSinglePrecision() const { return this->Floats != nullptr; }
  glm::dvec3 operator[](std::size_t i) const
  {
    if (this->Floats)
    {
      const float* x = this->Floats + 3 * i;
      return { x[0], x[1], x[2] };
    }
    if (this->Doubles)
    {
      const double* x = this->Doubles + 3 * i;
      return { x[0], x[1], x[2] };
    }
    double x[3];
    this->Array->GetTuple(static_cast<vtkIdType>(i), x);
    return { x[0], x[1], x[2] };
  }

private:
  vtkDataArray* Array;
  std::size_t Size;
  const float* Floats = nullptr;
  const double* Doubles = nullptr;
};

} // namespace scene
} // namespace hrt
