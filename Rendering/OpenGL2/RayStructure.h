// The ray structure of the kind that the user chose. It is made when rays first need one, and lives
// from frame to frame, because what it is built of seldom changes.
#pragma once

#include "Rendering/Core/Plan/Settings.h"
#include "Rendering/Core/Snapshot.h"
#include "Rendering/Core/Structures/Structure.h"

#include <memory>

namespace hrt
{
namespace gl
{

class RayStructure
{
public:
  // Brings it up to date, anew when it is of another kind. Throws what building it threw; there is
  // none then.
  StructureReport update(const Snapshot& snapshot, Accelerator kind);

  // Null when there is none.
  const Structure* get() const { return this->Present.get(); }

  // The present one, of whatever kind; where there is none, an empty one, which says "no hit".
  const Structure& getOrEmpty(Accelerator kind);

private:
  std::unique_ptr<Structure> Present;
  Accelerator Kind = Accelerator::Embree;
};

} // namespace gl
} // namespace hrt
