// vtkGlyph3DMapper: a mesh at each point of a data set, by the rules of vtkOpenGLGlyph3DMapper. All
// glyphs of one source are the copies of one mesh (Copies.h).
#include "Rendering/Scene/Adapters/AdapterRegistry.h"

#include "vtkActor.h"
#include "vtkAlgorithm.h"
#include "vtkAlgorithmOutput.h"
#include "vtkBitArray.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataObjectTree.h"
#include "vtkDataObjectTreeIterator.h"
#include "vtkDataSet.h"
#include "vtkGlyph3DMapper.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkQuaternion.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace hrt
{
namespace scene
{
namespace
{

// VTK gives a glyph of scale zero this one, so that its matrix has an inverse.
constexpr double kScaleOfNothing = 1.0e-10;

// Which arrays the mapper reads, which VTK keeps to its subclasses.
class ArraysOf : public vtkGlyph3DMapper
{
public:
  static vtkDataArray* mask(vtkGlyph3DMapper* mapper, vtkDataSet* data)
  {
    return (mapper->*(&ArraysOf::GetMaskArray))(data);
  }
  static vtkDataArray* sourceIndex(vtkGlyph3DMapper* mapper, vtkDataSet* data)
  {
    return (mapper->*(&ArraysOf::GetSourceIndexArray))(data);
  }
  static vtkDataArray* orientation(vtkGlyph3DMapper* mapper, vtkDataSet* data)
  {
    return (mapper->*(&ArraysOf::GetOrientationArray))(data);
  }
  static vtkDataArray* scale(vtkGlyph3DMapper* mapper, vtkDataSet* data)
  {
    return (mapper->*(&ArraysOf::GetScaleArray))(data);
  }
  static vtkDataArray* selectionId(vtkGlyph3DMapper* mapper, vtkDataSet* data)
  {
    return (mapper->*(&ArraysOf::GetSelectionIdArray))(data);
  }
};

//------------------------------------------------------------------------------
std::uint64_t nextVersion()
{
  static std::atomic<std::uint64_t> last{ 0 };
  return ++last;
}

//------------------------------------------------------------------------------
// The mapper's place in the range of its table, or its share of the range.
struct Range
{
  double first, width;

  explicit Range(vtkGlyph3DMapper* mapper)
    : first(mapper->GetRange()[0])
    , width(mapper->GetRange()[1] - mapper->GetRange()[0])
  {
    this->width = this->width == 0.0 ? 1.0 : this->width;
  }
};

//------------------------------------------------------------------------------
vtkQuaterniond rotation(vtkGlyph3DMapper* mapper, const double (&o)[4])
{
  vtkQuaterniond q;
  switch (mapper->GetOrientationMode())
  {
    case vtkGlyph3DMapper::ROTATION:
    {
      const auto about = [](double degrees, int axis) {
        const double half = 0.5 * vtkMath::RadiansFromDegrees(degrees);
        double parts[4] = { std::cos(half), 0.0, 0.0, 0.0 };
        parts[axis + 1] = std::sin(half);
        return vtkQuaterniond(parts);
      };
      return about(o[2], 2) * about(o[0], 0) * about(o[1], 1);
    }
    case vtkGlyph3DMapper::DIRECTION:
      if (o[1] == 0.0 && o[2] == 0.0)
      {
        if (o[0] < 0.0)
        {
          q.Set(0.0, 0.0, 1.0, 0.0); // x turned about
        }
      }
      else
      {
        // Half a turn about the line between x and the direction.
        const double size = vtkMath::Norm(o, 3);
        double between[3] = { 0.5 * (o[0] + size), 0.5 * o[1], 0.5 * o[2] };
        vtkMath::Normalize(between);
        q.Set(0.0, between[0], between[1], between[2]);
      }
      return q;
    default:
      q.Set(o[0], o[1], o[2], o[3]);
      return q;
  }
}

// Reads the points of one data set.
class GlyphReader
{
public:
  GlyphReader(vtkGlyph3DMapper* mapper, vtkDataSet* data, std::size_t sources)
    : Mapper(mapper)
    , Data(data)
    , Sources(sources)
    , InRange(mapper)
    , Mask(mapper->GetMasking() ? vtkBitArray::SafeDownCast(ArraysOf::mask(mapper, data)) : nullptr)
    , SourceIndex(ArraysOf::sourceIndex(mapper, data))
    , Orientation(ArraysOf::orientation(mapper, data))
    , Scale(ArraysOf::scale(mapper, data))
    , Ids(mapper->GetUseSelectionIds() ? ArraysOf::selectionId(mapper, data) : nullptr)
  {
  }

  // What is wrong with the arrays, as VTK's mapper says it; then nothing is drawn.
  std::string problem() const
  {
    const int wanted = this->Mapper->GetOrientationMode() == vtkGlyph3DMapper::QUATERNION ? 4 : 3;
    if (this->Orientation && this->Orientation->GetNumberOfComponents() != wanted)
    {
      return "its orientation array has " +
        std::to_string(this->Orientation->GetNumberOfComponents()) + " components, not " +
        std::to_string(wanted) + "; nothing is drawn";
    }
    if (this->Mask && this->Mask->GetNumberOfComponents() != 1)
    {
      return "its mask array has more than one component; nothing is drawn";
    }
    return {};
  }

  // The copies of each source. `colors`: one a point, or null.
  std::vector<std::shared_ptr<Copies>> read(vtkUnsignedCharArray* colors) const
  {
    std::vector<std::shared_ptr<Copies>> all;
    for (std::size_t i = 0; i < this->Sources; ++i)
    {
      all.push_back(std::make_shared<Copies>());
      all.back()->version = nextVersion();
      all.back()->origin = this->centre();
    }
    const vtkIdType points = this->Data->GetNumberOfPoints();
    const bool allCount = !this->Mask && this->Sources == 1;
    if (allCount)
    {
      all[0]->rows.reserve(static_cast<std::size_t>(points));
    }
    for (vtkIdType i = 0; i < points; ++i)
    {
      if (this->Mask && this->Mask->GetValue(i) == 0)
      {
        continue;
      }
      Copies& copies = *all[this->sourceOf(i)];
      copies.rows.push_back(this->rowsOf(i, copies.origin));
      if (colors)
      {
        unsigned char c[4];
        colors->GetTypedTuple(i, c);
        copies.colors.emplace_back(c[0], c[1], c[2], c[3]);
      }
      if (!allCount || this->Ids)
      {
        copies.ids.push_back(
          this->Ids ? static_cast<std::int64_t>(this->Ids->GetComponent(i, 0)) : i);
      }
    }
    return all;
  }

private:
  glm::dvec3 centre() const
  {
    double c[3];
    this->Data->GetCenter(c);
    return { c[0], c[1], c[2] };
  }

  std::size_t sourceOf(vtkIdType point) const
  {
    if (!this->SourceIndex)
    {
      return 0;
    }
    const double value = vtkMath::Norm(
      this->SourceIndex->GetTuple(point), this->SourceIndex->GetNumberOfComponents());
    const double index =
      (value - this->InRange.first) * static_cast<double>(this->Sources) / this->InRange.width;
    // Written so that what is no number is the first one.
    return index >= 1.0
      ? std::min(this->Sources - 1, static_cast<std::size_t>(std::min(index, 1e9)))
      : 0;
  }

  glm::dvec3 scaleOf(vtkIdType point) const
  {
    glm::dvec3 scale(1.0);
    const int mode = this->Mapper->GetScaleMode();
    if (this->Scale && mode == vtkGlyph3DMapper::SCALE_BY_MAGNITUDE)
    {
      scale = glm::dvec3(
        vtkMath::Norm(this->Scale->GetTuple(point), this->Scale->GetNumberOfComponents()));
    }
    else if (this->Scale && mode == vtkGlyph3DMapper::SCALE_BY_COMPONENTS &&
      this->Scale->GetNumberOfComponents() == 3)
    {
      this->Scale->GetTuple(point, &scale.x);
    }
    if (this->Scale && this->Mapper->GetClamping() && mode != vtkGlyph3DMapper::NO_DATA_SCALING)
    {
      const glm::dvec3 first(this->Mapper->GetRange()[0]), last(this->Mapper->GetRange()[1]);
      scale = (glm::clamp(scale, first, last) - first) / this->InRange.width;
    }
    return scale * this->Mapper->GetScaleFactor();
  }

  Copies::Rows rowsOf(vtkIdType point, const glm::dvec3& origin) const
  {
    double matrix[3][3] = { { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 } };
    if (this->Orientation)
    {
      double orientation[4] = { 0.0, 0.0, 0.0, 0.0 };
      this->Orientation->GetTuple(point, orientation);
      rotation(this->Mapper, orientation).ToMatrix3x3(matrix);
    }
    const glm::dvec3 scale = this->Mapper->GetScaling() ? this->scaleOf(point) : glm::dvec3(1.0);
    double x[3];
    this->Data->GetPoint(point, x);
    Copies::Rows rows;
    for (int row = 0; row < 3; ++row)
    {
      for (int column = 0; column < 3; ++column)
      {
        const double by = scale[column] == 0.0 ? kScaleOfNothing : scale[column];
        rows[static_cast<std::size_t>(row)][column] =
          static_cast<float>(matrix[row][column] * by);
      }
      rows[static_cast<std::size_t>(row)][3] = static_cast<float>(x[row] - origin[row]);
    }
    return rows;
  }

  vtkGlyph3DMapper* Mapper;
  vtkDataSet* Data;
  std::size_t Sources;
  Range InRange;
  vtkBitArray* Mask;
  vtkDataArray* SourceIndex;
  vtkDataArray* Orientation;
  vtkDataArray* Scale;
  vtkDataArray* Ids;
};

// The meshes of one source: one, or the leaves of a table's entry.
using Meshes = std::vector<vtkSmartPointer<vtkPolyData>>;

//------------------------------------------------------------------------------
void collect(vtkDataObject* source, Meshes& meshes)
{
  if (auto* const mesh = vtkPolyData::SafeDownCast(source))
  {
    meshes.emplace_back(mesh);
    return;
  }
  if (auto* const composite = vtkCompositeDataSet::SafeDownCast(source))
  {
    const auto leaves =
      vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (leaves->InitTraversal(); !leaves->IsDoneWithTraversal(); leaves->GoToNextItem())
    {
      collect(leaves->GetCurrentDataObject(), meshes);
    }
  }
}

//------------------------------------------------------------------------------
std::vector<Meshes> sourcesOf(vtkGlyph3DMapper* mapper)
{
  std::vector<Meshes> sources;
  for (int i = 0; i < mapper->GetNumberOfInputConnections(1); ++i)
  {
    if (!mapper->GetStatic())
    {
      vtkAlgorithmOutput* const connection = mapper->GetInputConnection(1, i);
      connection->GetProducer()->Update(connection->GetIndex());
    }
    if (!mapper->GetUseSourceTableTree())
    {
      sources.emplace_back();
      collect(mapper->GetSource(i), sources.back());
    }
  }
  vtkDataObjectTree* const table =
    mapper->GetUseSourceTableTree() ? mapper->GetSourceTableTree() : nullptr;
  if (table)
  {
    const auto children = vtkSmartPointer<vtkDataObjectTreeIterator>::Take(table->NewTreeIterator());
    children->TraverseSubTreeOff();
    children->VisitOnlyLeavesOff();
    for (children->InitTraversal(); !children->IsDoneWithTraversal(); children->GoToNextItem())
    {
      sources.emplace_back();
      collect(children->GetCurrentDataObject(), sources.back());
    }
  }
  return sources;
}

class Glyph3DAdapter final : public MapperAdapter
{
public:
  MapperReading read(vtkMapper* of, vtkActor* actor) override
  {
    MapperReading reading;
    auto* const mapper = vtkGlyph3DMapper::SafeDownCast(of);
    vtkDataObject* const data = updatedInput(mapper);
    if (!data)
    {
      reading.problem = "the mapper has no input; nothing is drawn";
      return reading;
    }
    const std::vector<Meshes> sources = sourcesOf(mapper);
    for (const Meshes& meshes : sources)
    {
      reading.left = this->judge(meshes, reading.left);
    }
    if (reading.left != LeftToVTK::No)
    {
      return reading;
    }
    this->forEachDataSet(mapper, data, [&](vtkDataSet* set, std::int64_t block, bool colored,
                                         const glm::vec3& color) {
      this->readSet(mapper, actor, set, block, sources, reading);
      for (SurfacePiece& piece : reading.pieces)
      {
        if (piece.block == block && colored)
        {
          piece.overrides.color = true;
          piece.overrides.colorValue = color;
        }
      }
    });
    return reading;
  }

private:
  // Lines beside a glyph's surface would have to be copied too.
  static LeftToVTK judge(const Meshes& meshes, LeftToVTK before)
  {
    for (vtkPolyData* mesh : meshes)
    {
      const bool surface = mesh->GetNumberOfPolys() + mesh->GetNumberOfStrips() > 0;
      if (mesh->GetNumberOfVerts() + mesh->GetNumberOfLines() > 0)
      {
        before = surface || before == LeftToVTK::GlyphLines ? LeftToVTK::GlyphLines
                                                           : LeftToVTK::NoSurface;
      }
    }
    return before;
  }

  template <class Visit>
  void forEachDataSet(vtkGlyph3DMapper* mapper, vtkDataObject* data, Visit visit)
  {
    if (auto* const set = vtkDataSet::SafeDownCast(data))
    {
      visit(set, -1, false, glm::vec3(1.0f));
      return;
    }
    auto* const composite = vtkCompositeDataSet::SafeDownCast(data);
    if (!composite)
    {
      return;
    }
    vtkCompositeDataDisplayAttributes* const attributes = mapper->GetBlockAttributes();
    const auto leaves =
      vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (leaves->InitTraversal(); !leaves->IsDoneWithTraversal(); leaves->GoToNextItem())
    {
      vtkDataObject* const leaf = leaves->GetCurrentDataObject();
      auto* const set = vtkDataSet::SafeDownCast(leaf);
      const bool hidden = attributes && attributes->HasBlockVisibility(leaf) &&
        !attributes->GetBlockVisibility(leaf);
      if (!set || hidden)
      {
        continue;
      }
      double color[3] = { 1.0, 1.0, 1.0 };
      const bool colored = attributes && attributes->HasBlockColor(leaf);
      if (colored)
      {
        attributes->GetBlockColor(leaf, color);
      }
      visit(set, static_cast<std::int64_t>(leaves->GetCurrentFlatIndex()), colored,
        glm::vec3(color[0], color[1], color[2]));
    }
  }

  // What the copies of a data set are made of; addresses are compared only.
  using Signature = std::tuple<const void*, vtkMTimeType, vtkMTimeType, std::size_t, glm::vec3>;
  struct Memory
  {
    Signature signature;
    std::vector<std::shared_ptr<Copies>> copies; // one a source
    std::string problem;
  };

  void readSet(vtkGlyph3DMapper* mapper, vtkActor* actor, vtkDataSet* set, std::int64_t block,
    const std::vector<Meshes>& sources, MapperReading& reading)
  {
    Memory& memory = this->Memories[block];
    const double* const color = actor->GetProperty()->GetColor();
    const auto now = [&] {
      return Signature(set, set->GetMTime(), mapper->GetMTime(), sources.size(),
        glm::vec3(color[0], color[1], color[2]));
    };
    if (memory.signature != now())
    {
      this->make(mapper, actor, set, sources.size(), memory);
      memory.signature = now(); // mapping colours may give the mapper its lookup table
    }
    if (!memory.problem.empty())
    {
      reading.problem = memory.problem;
      return;
    }
    for (std::size_t source = 0; source < memory.copies.size(); ++source)
    {
      for (std::size_t i = 0; i < sources[source].size(); ++i)
      {
        SurfacePiece piece;
        piece.data = sources[source][i];
        piece.colors = this->plainMapper(mapper);
        piece.copies = memory.copies[source];
        piece.block = block;
        // Blocks, sources and their leaves are few: each has sixteen bits and more.
        piece.key = (static_cast<std::uint64_t>(block + 1) << 32 | source << 16 | i) + 1;
        if (piece.copies->count() > 0)
        {
          reading.pieces.push_back(std::move(piece));
        }
      }
    }
  }

  void make(vtkGlyph3DMapper* mapper, vtkActor* actor, vtkDataSet* set, std::size_t sources,
    Memory& memory)
  {
    memory.copies.clear();
    memory.problem.clear();
    if (sources == 0)
    {
      return;
    }
    const GlyphReader reader(mapper, set, sources);
    memory.problem = reader.problem();
    if (memory.problem.empty())
    {
      vtkNew<vtkPolyDataMapper> colorMapper; // keeps what it has mapped: not for longer than needed
      colorMapper->vtkMapper::ShallowCopy(mapper);
      vtkUnsignedCharArray* const colors = colorMapper->MapScalars(set, 1.0);
      const bool complete = colors && colors->GetNumberOfComponents() == 4 &&
        colors->GetNumberOfTuples() >= set->GetNumberOfPoints();
      memory.copies = reader.read(complete ? colors : nullptr);
      if (!complete)
      {
        paint(actor->GetProperty(), memory.copies);
      }
    }
  }

  // Without scalars VTK gives each glyph the property's one colour, which is that of a plain actor
  // unless its ambient and diffuse colours differ.
  static void paint(vtkProperty* property, std::vector<std::shared_ptr<Copies>>& all)
  {
    const double *ambient = property->GetAmbientColor(), *diffuse = property->GetDiffuseColor();
    if (std::equal(ambient, ambient + 3, diffuse))
    {
      return;
    }
    const double* const c = property->GetColor();
    const auto byte = [](double x) { return static_cast<unsigned char>(x * 255.0 + 0.5); };
    for (const std::shared_ptr<Copies>& copies : all)
    {
      copies->colors.assign(
        copies->count(), glm::u8vec4(byte(c[0]), byte(c[1]), byte(c[2]), 255));
    }
  }

  // Of a source's own scalars nothing is seen.
  vtkMapper* plainMapper(vtkGlyph3DMapper* mapper)
  {
    if (!this->Plain)
    {
      this->Plain = vtkSmartPointer<vtkPolyDataMapper>::New();
      this->Plain->ScalarVisibilityOff();
    }
    this->Plain->SetClippingPlanes(mapper->GetClippingPlanes());
    return this->Plain;
  }

  std::map<std::int64_t, Memory> Memories; // by block
  vtkSmartPointer<vtkPolyDataMapper> Plain;
};

} // namespace

//------------------------------------------------------------------------------
AdapterKind glyph3DKind()
{
  return { [](vtkMapper* mapper) { return vtkGlyph3DMapper::SafeDownCast(mapper) != nullptr; },
    [] { return std::unique_ptr<MapperAdapter>(std::make_unique<Glyph3DAdapter>()); } };
}

} // namespace scene
} // namespace hrt
