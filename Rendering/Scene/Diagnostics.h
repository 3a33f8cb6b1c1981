// What is told of bad input, and how often. A state that lasts - a matrix without inverse, a light
// without direction - is told of in the update in which it begins, and again when it comes back. And
// whatever there is to tell in one update takes one line: a scene of a thousand broken parts must not
// bury the one message that matters under a thousand others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace hrt
{
namespace scene
{

struct Extraction;

// What was refused or left out in the triangles of one part; empty when nothing was. Triangles
// without area and normals without direction are counted only: VTK says nothing of them either.
std::string describeProblems(const Extraction& extraction);

class Diagnostics
{
public:
  // So many objects are spoken of by name in an update; the others are counted.
  static constexpr std::size_t kNamed = 3;

  // Something that happened in this update.
  void addEvent(const std::string& text) { this->News.push_back(text); }

  // A state that the object of this key is in, and told of unless it was so in the last update.
  void addState(std::uint64_t key, const std::string& text);

  // The update's line, empty when there is nothing new to tell. Ends the update.
  std::string endUpdate();

  // Forgets an update that came to nothing; what was told before counts as told.
  void abandonUpdate();

private:
  using States = std::set<std::pair<std::uint64_t, std::string>>;
  States Told; // in the last update
  States Telling;
  std::vector<std::string> News;
};

} // namespace scene
} // namespace hrt
