// A message about bad input is of use only if it says which object it means: the name that the user
// gave it (vtkObject::SetObjectName, newer VTK releases), else its class, always with its address.
#pragma once

#include "vtkObject.h"

#include <sstream>
#include <string>

namespace hrt
{
namespace scene
{

// Chosen when the VTK release at hand has vtkObject::GetObjectName.
template <typename T>
auto givenName(T* object, int) -> decltype(std::string(object->GetObjectName()))
{
  return object->GetObjectName();
}

template <typename T>
std::string givenName(T*, long)
{
  return std::string();
}

inline std::string nameOf(vtkObject* object)
{
  std::ostringstream text;
  const std::string given = givenName(object, 0);
  if (!given.empty())
  {
    text << '"' << given << "\", ";
  }
  text << object->GetClassName() << " (" << static_cast<void*>(object) << ")";
  return text.str();
}

} // namespace scene
} // namespace hrt
