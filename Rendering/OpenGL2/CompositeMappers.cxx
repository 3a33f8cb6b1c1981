// See CompositeMappers.h.
#include "Rendering/OpenGL2/CompositeMappers.h"

#include "Rendering/Scene/Adapters/AdapterRegistry.h"

#include "vtkVersion.h"

// A class of its own up to VTK 9.4, deprecated since 9.3.
#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 3, 0)
#include "vtkCompositePolyDataMapper2.h"
#endif

namespace hrt
{
namespace gl
{

//------------------------------------------------------------------------------
void registerCompositeMappers()
{
#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 3, 0)
  using Mapper = vtkCompositePolyDataMapper2;
  scene::registerCompositeMapper("vtkCompositePolyDataMapper2",
    { [](vtkMapper* mapper) {
       return Mapper::SafeDownCast(mapper)->GetCompositeDataDisplayAttributes();
     },
      [](vtkMapper* mapper) {
        return Mapper::SafeDownCast(mapper)->GetColorMissingArraysWithNanColor();
      } });
#endif
}

} // namespace gl
} // namespace hrt
