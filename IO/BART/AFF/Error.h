// What is wrong with an AFF scene, and where. Thrown inside the parser only: whoever calls it from
// VTK catches it and reports it in VTK's way.
#pragma once

#include "IO/BART/AFF/Scene.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace hrt
{
namespace bart
{

class ReadError : public std::runtime_error
{
public:
  ReadError(Location where, const std::string& what)
    : std::runtime_error(prefix(where) + what)
    , Where(std::move(where))
  {
  }
  const Location& where() const { return this->Where; }

private:
  // Line 0: the file as a whole.
  static std::string prefix(const Location& where)
  {
    return where.file + (where.line == 0 ? "" : ":" + std::to_string(where.line)) + ": ";
  }

  Location Where;
};

} // namespace bart
} // namespace hrt
