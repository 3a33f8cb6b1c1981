// See GeometryCache.h.

#include "Rendering/Scene/GeometryCache.h"

#include "Rendering/Scene/ColorExtraction.h"
#include "Rendering/Scene/SideExtraction.h"

#include "vtkDataArray.h"
#include "vtkMapper.h"
#include "vtkPolyData.h"

#include <atomic>

namespace hrt
{
namespace scene
{
namespace
{

//------------------------------------------------------------------------------
// All but the version; the bounds follow from the positions.
bool sameContent(const Geometry& a, const Geometry& b)
{
  return a.origin == b.origin && a.givenFrom == b.givenFrom && a.colorSource == b.colorSource &&
    a.lookupWidth == b.lookupWidth && a.lookupHeight == b.lookupHeight &&
    a.triangles == b.triangles && a.cellIds == b.cellIds && a.positions == b.positions &&
    a.normals == b.normals && a.colors == b.colors &&
    a.coordinates == b.coordinates && a.textureCoordinates == b.textureCoordinates &&
    a.sides == b.sides && a.lookup == b.lookup;
}

//------------------------------------------------------------------------------
bool sameProblems(const Extraction& a, const Extraction& b)
{
  return a.report == b.report && a.colorsComplete == b.colorsComplete;
}

//------------------------------------------------------------------------------
void nameOriginalCells(vtkDataArray* originals, Geometry& geometry)
{
  if (!originals)
  {
    return;
  }
  CellIds named;
  named.reserve(geometry.cellIds.size());
  for (std::size_t i = 0; i < geometry.cellIds.size(); ++i)
  {
    named.push_back(static_cast<std::int64_t>(originals->GetComponent(geometry.cellIds[i], 0)));
  }
  geometry.cellIds = named;
}

} // anonymous namespace

//------------------------------------------------------------------------------
std::uint64_t nextGeometryVersion()
{
  static std::atomic<std::uint64_t> last{ 0 };
  return ++last;
}

//------------------------------------------------------------------------------
GeometryCache::Signature GeometryCache::signatureOf(const GeometrySource& source)
{
  // A mapper's modification time includes that of its look-up table.
  return Signature(source.input, source.input->GetMTime(), source.mapper,
    source.mapper->GetMTime(), source.flat, source.plain, source.textured,
    source.edges);
}

//------------------------------------------------------------------------------
ExtractionPointer GeometryCache::extract(const GeometrySource& source, const Extraction* before)
{
  auto geometry = std::make_shared<Geometry>();
  auto extraction = std::make_shared<Extraction>();
  TriangleReport& report = extraction->report;
  const VertexPoints pointOf = writeVertices(source.input, source.flat,
    triangulate(source.input, readPoints(source.input), report), *geometry, report);
  extraction->colorsComplete =
    source.plain || writeColors(source.mapper, source.input, pointOf, *geometry);
  if (source.textured)
  {
    writeTextureCoordinates(source.input, pointOf, *geometry);
  }
  if (source.edges)
  {
    writeSides(source.input, pointOf, *geometry);
  }
  nameOriginalCells(source.originalCells, *geometry);

  if (before && sameContent(*before->geometry, *geometry))
  {
    extraction->geometry = before->geometry;
  }
  else
  {
    geometry->version = nextGeometryVersion();
    extraction->geometry = geometry;
  }
  return extraction;
}

//------------------------------------------------------------------------------
ExtractionPointer GeometryCache::get(std::uint64_t part, const GeometrySource& source, bool& fresh)
{
  Record& record = this->Records[part];
  if (record.actor != source.actor)
  {
    record = Record();
    record.actor = source.actor;
  }
  record.used = true;
  fresh = false;
  Signature signature = signatureOf(source);
  if (record.extraction && record.signature == signature)
  {
    return record.extraction;
  }
  const auto shared = this->Shared.find(signature);
  ExtractionPointer extraction =
    shared != this->Shared.end() ? shared->second : this->extract(source, record.extraction.get());
  fresh = shared == this->Shared.end() &&
    (!record.extraction || record.extraction->geometry != extraction->geometry ||
      !sameProblems(*record.extraction, *extraction));
  // Mapping scalars may have modified the mapper or its table; what counts is the state after it.
  record.signature = signatureOf(source);
  record.extraction = extraction;
  this->Shared[record.signature] = extraction;
  return extraction;
}

//------------------------------------------------------------------------------
void GeometryCache::keep(std::uint64_t part)
{
  const auto record = this->Records.find(part);
  if (record != this->Records.end())
  {
    record->second.used = true;
  }
}

//------------------------------------------------------------------------------
void GeometryCache::endFrame()
{
  this->Shared.clear();
  for (auto it = this->Records.begin(); it != this->Records.end();)
  {
    if (!it->second.used)
    {
      it = this->Records.erase(it);
      continue;
    }
    it->second.used = false;
    if (it->second.extraction)
    {
      this->Shared[it->second.signature] = it->second.extraction;
    }
    ++it;
  }
}

} // namespace scene
} // namespace hrt
