// Reads an AFF scene: all of it or nothing.
//
// The Animated File Format of BART (J. Lext, U. Assarsson, T. Moeller: "BART: A Benchmark for
// Animated Ray Tracing", 2000) extends E. Haines' Neutral File Format 3.9. All commands of both are
// understood:
//
//   v b am l la          view, background, ambient light, point lights
//   f fm                 material of what follows, until the next one, across files and braces
//   c s p pp             cones and cylinders, spheres, polygons without and with normals
//   tt ttp tpa m         textured triangles, animated triangles, meshes
//   x xs k a             transforms, keys, time range
//   i d                  include a file if its level is at most the level of detail (0 unless set)
#pragma once

#include "IO/BART/AFF/Files.h"
#include "IO/BART/AFF/Scene.h"

#include <cstddef>
#include <string>

namespace hrt
{
namespace bart
{

// No scene may use more than this, so that a small file that includes itself in disguise, or
// doubles itself over and over, ends in an error, not in a machine without memory. BART's robots
// stay below a twentieth of each.
struct Limits
{
  std::size_t bytes = std::size_t(1) << 28; // of text that is read, a file counts whenever included
  std::size_t includes = 1000000;
  std::size_t instances = 1000000;
  std::size_t transforms = 1000000;
  std::size_t includeDepth = 64;
  std::size_t braceDepth = 1000;
};

// Throws ReadError with file, line and what was expected. Nothing else is thrown but
// std::bad_alloc.
Scene readScene(const std::string& path, FileSource& files, const Limits& limits = Limits());

} // namespace bart
} // namespace hrt
