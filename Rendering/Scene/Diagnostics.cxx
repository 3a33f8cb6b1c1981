// See Diagnostics.h.

#include "Rendering/Scene/Diagnostics.h"

#include "Rendering/Scene/GeometryCache.h"

#include <algorithm>
#include <sstream>

namespace hrt
{
namespace scene
{
namespace
{

//------------------------------------------------------------------------------
// Adds ", 3 triangles with ..." to a list.
void append(std::ostream& text, std::uint64_t count, const char* what)
{
  if (count > 0)
  {
    text << (text.tellp() > 0 ? ", " : "") << count << (count == 1 ? " triangle " : " triangles ")
         << what;
  }
}

} // anonymous namespace

//------------------------------------------------------------------------------
std::string describeProblems(const Extraction& extraction)
{
  std::ostringstream refused;
  const TriangleReport& report = extraction.report;
  append(refused, report.nonFinitePoints, "with points that are not finite");
  append(refused, report.invalidIndices, "that name points that do not exist");

  std::ostringstream text;
  const char* separator = "";
  if (refused.tellp() > 0)
  {
    text << "refused " << refused.str();
    separator = "; ";
  }
  if (!extraction.colorsComplete)
  {
    text << separator << "its scalars do not cover the data, coloured by its property";
  }
  return text.str();
}

//------------------------------------------------------------------------------
void Diagnostics::addState(std::uint64_t key, const std::string& text)
{
  const bool news = this->Told.count({ key, text }) == 0;
  if (this->Telling.emplace(key, text).second && news)
  {
    this->News.push_back(text);
  }
}

//------------------------------------------------------------------------------
std::string Diagnostics::endUpdate()
{
  std::ostringstream line;
  const std::size_t named = std::min(this->News.size(), kNamed);
  for (std::size_t i = 0; i < named; ++i)
  {
    line << (i > 0 ? ". " : "") << this->News[i];
  }
  if (const std::size_t others = this->News.size() - named)
  {
    line << ". And " << others << " more of the like";
  }
  this->Told.swap(this->Telling);
  this->Telling.clear();
  this->News.clear();
  return line.str();
}

//------------------------------------------------------------------------------
void Diagnostics::abandonUpdate()
{
  this->Telling.clear();
  this->News.clear();
}

} // namespace scene
} // namespace hrt
