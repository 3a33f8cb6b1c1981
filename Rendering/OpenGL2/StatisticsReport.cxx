// See StatisticsReport.h.
#include "Rendering/OpenGL2/StatisticsReport.h"

#include <cstdio>
#include <locale>
#include <map>
#include <numeric>
#include <sstream>

namespace hrt
{
namespace gl
{
namespace
{

std::string quoted(const std::string& text)
{
  std::string out = "\"";
  for (const char c : text)
  {
    if (c == '"' || c == '\\')
    {
      out += '\\';
      out += c;
    }
    else if (static_cast<unsigned char>(c) < 0x20)
    {
      char escape[8];
      std::snprintf(escape, sizeof(escape), "\\u%04x", static_cast<unsigned>(c));
      out += escape;
    }
    else
    {
      out += c;
    }
  }
  return out + "\"";
}

// Writes "name": value pairs of one JSON object.
class Object
{
public:
  explicit Object(std::ostream& out)
    : Out(out)
  {
    this->Out << "{";
  }
  ~Object() { this->Out << "}"; }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;

  std::ostream& key(const std::string& name)
  {
    this->Out << (this->First ? "" : ", ") << quoted(name) << ": ";
    this->First = false;
    return this->Out;
  }
  template <class T>
  void number(const std::string& name, T value)
  {
    this->key(name) << value;
  }
  void text(const std::string& name, const std::string& value) { this->key(name) << quoted(value); }
  void boolean(const std::string& name, bool value)
  {
    this->key(name) << (value ? "true" : "false");
  }

private:
  std::ostream& Out;
  bool First = true;
};

void decision(std::ostream& out, const StageDecision& stage, double milliseconds)
{
  Object object(out);
  object.boolean("ran", stage.run);
  object.text("reason", stage.reason);
  object.number("ms", milliseconds);
}

void rays(std::ostream& out, const RayCount& count)
{
  Object object(out);
  object.number("asked", count.asked);
  object.number("answered", count.answered);
  object.number("traced", count.traced);
}

// What the scene's surfaces have beside plain colours.
void surfaces(std::ostream& out, const Snapshot& snapshot)
{
  std::size_t textured = 0, withEdges = 0, physical = 0;
  std::map<std::uint64_t, std::size_t> texels; // by texture: one that several parts show counts once
  for (const Part& part : snapshot.parts)
  {
    textured += part.material.textures.layers.empty() ? 0 : 1;
    withEdges += part.showsEdges() ? 1 : 0;
    physical += part.material.physical.used ? 1 : 0;
    for (const TextureLayer& layer : part.material.textures.layers)
    {
      texels[layer.texture->version] = layer.texture->texelCount();
    }
  }
  Object object(out);
  object.number("textured", textured);
  object.number("texels",
    std::accumulate(texels.begin(), texels.end(), std::size_t(0),
      [](std::size_t sum, const auto& texture) { return sum + texture.second; }));
  object.number("with_edges", withEdges);
  object.number("physically_based", physical);
}

void props(std::ostream& out, const PropReasons& list)
{
  Object object(out);
  for (const auto& prop : list)
  {
    object.text(prop.first, prop.second);
  }
}

} // namespace

//------------------------------------------------------------------------------
std::string statisticsReport(const FrameStatistics& statistics, const Snapshot& snapshot,
  const PropReasons& leftToVTK, const PropReasons& hosted)
{
  std::ostringstream out;
  out.imbue(std::locale::classic()); // JSON knows no decimal commas
  {
    Object report(out);
    {
      Object stages(report.key("stages"));
      for (std::size_t i = 0; i < kStageCount; ++i)
      {
        decision(stages.key(stageName(static_cast<Stage>(i))), statistics.plan.stages[i],
          statistics.milliseconds[i]);
      }
    }
    {
      Object pipelined(report.key("pipelined"));
      pipelined.boolean("ran", statistics.plan.pipelined.run);
      pipelined.text("reason", statistics.plan.pipelined.reason);
    }
    std::ostream& maps = report.key("shadow_maps");
    maps << "[";
    for (std::size_t i = 0; i < statistics.plan.shadowMaps.size(); ++i)
    {
      maps << (i ? ", " : "");
      Object map(maps);
      map.boolean("ran", statistics.plan.shadowMaps[i].run);
      map.text("reason", statistics.plan.shadowMaps[i].reason);
    }
    maps << "]";
    {
      Object classes(report.key("rays"));
      rays(classes.key("primary"), statistics.rays.primary);
      rays(classes.key("reflection"), statistics.rays.reflection);
      rays(classes.key("refraction"), statistics.rays.refraction);
      rays(classes.key("shadow"), statistics.rays.shadow);
    }
    {
      Object multisampling(report.key("multisampling"));
      multisampling.number("failed", statistics.multisampling.failed);
      multisampling.number("repaired", statistics.multisampling.repaired);
      multisampling.number("interpolated", statistics.multisampling.interpolated);
      multisampling.number("unresolved", statistics.multisampling.unresolved);
    }
    {
      Object interleave(report.key("interleave"));
      interleave.number("traced", statistics.interleave.traced);
      interleave.number("interpolated", statistics.interleave.interpolated);
    }
    {
      Object structure(report.key("structure"));
      structure.number("built", statistics.structure.built);
      structure.number("refitted", statistics.structure.refitted);
      structure.number("reused", statistics.structure.reused);
      structure.number("ms", statistics.structure.milliseconds);
    }
    {
      Object refused(report.key("refused"));
      refused.number("non_finite_points", snapshot.refusals.nonFinitePoints);
      refused.number("invalid_indices", snapshot.refusals.invalidIndices);
      refused.number("degenerate_triangles", snapshot.refusals.degenerateTriangles);
      refused.number("empty_parts", snapshot.refusals.emptyParts);
      refused.number("singular_matrices", snapshot.refusals.singularMatrices);
      refused.number("out_of_range_parts", snapshot.refusals.outOfRangeParts);
    }
    surfaces(report.key("surfaces"), snapshot);
    props(report.key("left_to_vtk"), leftToVTK);
    props(report.key("hosted"), hosted);
    report.number("shadow_map_resolution", statistics.shadowMapResolution);
    report.number("triangles", snapshot.triangleCount);
    report.number("parts", snapshot.parts.size());
    report.number("lights", snapshot.lights.size());
    report.number("secondary_pixels", statistics.secondaryPixels);
    report.number("invalid_ids", statistics.invalidIds);
    report.number("triangles_drawn", statistics.trianglesDrawn);
    report.number("bytes_read_back", statistics.bytesReadBack);
    report.number("bytes_uploaded", statistics.bytesUploaded);
  }
  return out.str();
}

} // namespace gl
} // namespace hrt
