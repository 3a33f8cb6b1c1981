// What the tests of this folder share: scenes from text in memory, and how close two vectors are.
#pragma once

#include "IO/BART/AFF/Error.h"
#include "IO/BART/AFF/Parser.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <string>

// Reads a scene that is one text.
inline hrt::bart::Scene parse(const std::string& text)
{
  hrt::bart::MemoryFiles files;
  files.files["main.aff"] = text;
  return hrt::bart::readScene("main.aff", files);
}

// The message with which a text is refused, empty if it is not.
inline std::string refusal(
  hrt::bart::MemoryFiles files, const hrt::bart::Limits& limits = hrt::bart::Limits())
{
  try
  {
    hrt::bart::readScene("main.aff", files, limits);
  }
  catch (const hrt::bart::ReadError& error)
  {
    return error.what();
  }
  return {};
}

inline std::string refusal(const std::string& text)
{
  hrt::bart::MemoryFiles files;
  files.files["main.aff"] = text;
  return refusal(files);
}

inline void expectNear(
  const glm::dvec3& actual, const glm::dvec3& expected, double tolerance = 1e-12)
{
  EXPECT_LE(glm::length(actual - expected), tolerance)
    << "(" << actual.x << ", " << actual.y << ", " << actual.z << ") for (" << expected.x << ", "
    << expected.y << ", " << expected.z << ")";
}
