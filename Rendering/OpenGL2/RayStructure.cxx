// See RayStructure.h.
#include "Rendering/OpenGL2/RayStructure.h"

#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Core/Structures/KdTreeStructure.h"

namespace hrt
{
namespace gl
{
namespace
{

std::unique_ptr<Structure> makeStructure(Accelerator kind)
{
  if (kind == Accelerator::KdTree)
  {
    return std::make_unique<KdTreeStructure>();
  }
  return std::make_unique<BvhStructure>();
}

} // namespace

//------------------------------------------------------------------------------
StructureReport RayStructure::update(const Snapshot& snapshot, Accelerator kind)
{
  try
  {
    if (!this->Present || this->Kind != kind)
    {
      this->Present = makeStructure(kind);
      this->Kind = kind;
    }
    return this->Present->update(snapshot);
  }
  catch (...)
  {
    this->Present.reset();
    throw;
  }
}

//------------------------------------------------------------------------------
const Structure& RayStructure::getOrEmpty(Accelerator kind)
{
  if (!this->Present)
  {
    this->Present = makeStructure(kind);
    this->Kind = kind;
  }
  return *this->Present;
}

} // namespace gl
} // namespace hrt
