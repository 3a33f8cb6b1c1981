// Tells the scene's reader of the composite mappers that live in VTK's OpenGL module.
#pragma once

namespace hrt
{
namespace gl
{

// May be called again.
void registerCompositeMappers();

} // namespace gl
} // namespace hrt
