// What every snapshot promises to the engines, whatever was handed to the scene's door. The fuzzer and
// the stress suite hold snapshots of garbage to it.
#pragma once

#include "Rendering/Core/Geometry/Coordinates.h"
#include "Rendering/Core/Snapshot.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace hrt
{
namespace invariants
{

template <class Vector>
bool isFinite(const Vector& v)
{
  for (int k = 0; k < Vector::length(); ++k)
  {
    if (!std::isfinite(v[k]))
    {
      return false;
    }
  }
  return true;
}

inline bool isFinite(const glm::dmat4& m)
{
  return isFinite(m[0]) && isFinite(m[1]) && isFinite(m[2]) && isFinite(m[3]);
}

template <class Values>
bool areFinite(const Values& values)
{
  for (const auto& v : values)
  {
    if (!isFinite(v))
    {
      return false;
    }
  }
  return true;
}

// Whether an attribute has as many values as it is attached to.
template <class T>
bool isComplete(const Geometry& g, const Attribute<T>& attribute)
{
  return attribute.values.size() ==
    (attribute.attachment == Attachment::Vertices ? g.vertexCount() : g.triangleCount());
}

// The first promise that a geometry breaks, in words; empty: none.
inline std::string broken(const Geometry& g)
{
  const bool byCorner = g.colorSource == ColorSource::Corner;
  const bool byLookup = g.colorSource == ColorSource::Lookup;
  if (g.version == 0)
  {
    return "no version";
  }
  if (g.cellIds.size() != g.triangleCount())
  {
    return "triangles and cell ids differ in number";
  }
  std::vector<bool> used(g.vertexCount(), false);
  for (const auto& triangle : g.triangles)
  {
    for (const std::uint32_t vertex : triangle)
    {
      if (vertex >= g.vertexCount())
      {
        return "a triangle names a vertex that does not exist";
      }
      used[vertex] = true;
    }
  }
  if (std::find(used.begin(), used.end(), false) != used.end())
  {
    return "no triangle uses a vertex";
  }
  if (!g.normals.empty() && !isComplete(g, g.normals))
  {
    return "not all have normals";
  }
  if (byCorner ? !isComplete(g, g.colors) : !g.colors.empty())
  {
    return "there are too few or too many colours";
  }
  if (byLookup ? !isComplete(g, g.coordinates) : !g.coordinates.empty())
  {
    return "there are too few or too many coordinates";
  }
  if (byLookup &&
    (g.lookupWidth <= 0 || g.lookupHeight <= 0 ||
      g.lookup.size() != std::size_t(g.lookupWidth) * std::size_t(g.lookupHeight)))
  {
    return "the lookup table has not its size";
  }
  if (!areFinite(g.positions) || !areFinite(g.normals.values) || !areFinite(g.coordinates.values) ||
    !isFinite(g.origin))
  {
    return "a position, normal, coordinate or origin is not finite";
  }
  for (const glm::vec3& p : g.positions)
  {
    for (int k = 0; k < 3; ++k)
    {
      if (p[k] < g.boundsMin[k] || p[k] > g.boundsMax[k])
      {
        return "a position lies outside of its box";
      }
    }
  }
  return {};
}

inline std::string broken(const Snapshot& s)
{
  TriangleId first = 0;
  for (const Part& part : s.parts)
  {
    if (!part.geometry)
    {
      return "a part without geometry";
    }
    const std::string wrong = broken(*part.geometry);
    if (!wrong.empty())
    {
      return wrong;
    }
    if (part.firstTriangle != first)
    {
      return "triangles are not numbered in the order of the parts";
    }
    first += static_cast<TriangleId>(part.geometry->triangleCount());
    if (!isFinite(part.localToWorld) || !isFinite(glm::inverse(part.positionsToWorld())))
    {
      return "a matrix, or its inverse, is not finite";
    }
    glm::dvec3 lower, upper;
    worldBounds(part, lower, upper);
    if (!isAdmissible(lower) || !isAdmissible(upper))
    {
      return "a part lies beyond the largest coordinate";
    }
  }
  if (s.triangleCount != first)
  {
    return "the sum of the triangles is wrong";
  }
  if (!isFinite(s.origin))
  {
    return "the origin is not finite";
  }
  if (!s.empty() && (!isFinite(s.boundsMin) || !isFinite(s.boundsMax)))
  {
    return "the box is not finite";
  }
  for (TriangleId id = 0; id < s.triangleCount; id += 1 + s.triangleCount / 64)
  {
    const Part& part = s.parts[s.partOf(id)];
    if (id < part.firstTriangle || id - part.firstTriangle >= part.geometry->triangleCount())
    {
      return "partOf names a part that does not hold the triangle";
    }
  }
  return {};
}

} // namespace invariants
} // namespace hrt
