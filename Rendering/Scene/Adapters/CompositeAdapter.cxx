// Mappers of composite data: a tree of blocks, each drawn as a mesh of its own, with a visibility, a
// colour and an opacity that blocks inherit from the ones above them.
#include "Rendering/Scene/Adapters/AdapterRegistry.h"

#include "vtkActor.h"
#include "vtkColorTransferFunction.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkCompositePolyDataMapper.h"
#include "vtkDataObjectTree.h"
#include "vtkDataObjectTreeIterator.h"
#include "vtkLookupTable.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkScalarsToColors.h"
#include "vtkVersion.h"

#include <map>
#include <utility>

// Composite mappers have settings of single blocks' scalars since VTK 9.3.
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 3, 0)
#define HRT_BLOCK_SCALARS 1
#else
#define HRT_BLOCK_SCALARS 0
#endif

namespace hrt
{
namespace scene
{
namespace
{

//------------------------------------------------------------------------------
vtkCompositeDataDisplayAttributes* attributesOfCoreMapper(vtkMapper* mapper)
{
#if HRT_BLOCK_SCALARS
  return vtkCompositePolyDataMapper::SafeDownCast(mapper)->GetCompositeDataDisplayAttributes();
#else
  static_cast<void>(mapper); // of this release it draws all blocks alike
  return nullptr;
#endif
}

//------------------------------------------------------------------------------
bool missingArraysAreNaNInCoreMapper(vtkMapper* mapper)
{
#if HRT_BLOCK_SCALARS
  return vtkCompositePolyDataMapper::SafeDownCast(mapper)->GetColorMissingArraysWithNanColor();
#else
  static_cast<void>(mapper);
  return false;
#endif
}

//------------------------------------------------------------------------------
using Registry = std::map<std::string, CompositeMapperClass>;

Registry& registry()
{
  static Registry all = { { "vtkCompositePolyDataMapper",
    { &attributesOfCoreMapper, &missingArraysAreNaNInCoreMapper } } };
  return all;
}

//------------------------------------------------------------------------------
const Registry::value_type* entryOf(vtkMapper* mapper)
{
  for (const Registry::value_type& entry : registry())
  {
    if (mapper->IsA(entry.first.c_str()))
    {
      return &entry;
    }
  }
  return nullptr;
}

// What blocks inherit.
struct BlockState
{
  bool visible = true;
  PieceOverrides overrides;
};

//------------------------------------------------------------------------------
void apply(vtkCompositeDataDisplayAttributes* attributes, vtkDataObject* block, BlockState& state)
{
  if (!attributes)
  {
    return;
  }
  if (attributes->HasBlockVisibility(block))
  {
    state.visible = attributes->GetBlockVisibility(block);
  }
  if (attributes->HasBlockOpacity(block))
  {
    state.overrides.opacity = true;
    state.overrides.opacityValue = static_cast<float>(attributes->GetBlockOpacity(block));
  }
  if (attributes->HasBlockColor(block))
  {
    double color[3];
    attributes->GetBlockColor(block, color);
    state.overrides.color = true;
    state.overrides.colorValue = glm::vec3(color[0], color[1], color[2]);
  }
}

//------------------------------------------------------------------------------
// False where the table has no colour for it.
bool colorOfNaN(vtkScalarsToColors* table, glm::vec3& color)
{
  double rgb[4] = { 0.0, 0.0, 0.0, 1.0 };
  if (auto* const colors = vtkLookupTable::SafeDownCast(table))
  {
    colors->GetNanColor(rgb);
  }
  else if (auto* const function = vtkColorTransferFunction::SafeDownCast(table))
  {
    function->GetNanColor(rgb);
  }
  else
  {
    return false;
  }
  color = glm::vec3(rgb[0], rgb[1], rgb[2]);
  return true;
}

//------------------------------------------------------------------------------
// Whether a block's own mapper finds nothing to colour it by, though it should.
bool lacksScalars(vtkMapper* own, vtkDataSet* block)
{
  int attachment = 0;
  return own->GetScalarVisibility() &&
    !vtkAbstractMapper::GetAbstractScalars(block, own->GetScalarMode(), own->GetArrayAccessMode(),
      own->GetArrayId(), own->GetArrayName(), attachment);
}

#if HRT_BLOCK_SCALARS
//------------------------------------------------------------------------------
void copyBlockScalars(
  vtkCompositeDataDisplayAttributes* attributes, vtkDataObject* block, vtkMapper* colors)
{
  if (!attributes)
  {
    return;
  }
  if (attributes->HasBlockScalarVisibility(block))
  {
    colors->SetScalarVisibility(attributes->GetBlockScalarVisibility(block));
  }
  if (attributes->HasBlockUseLookupTableScalarRange(block))
  {
    colors->SetUseLookupTableScalarRange(attributes->GetBlockUseLookupTableScalarRange(block));
  }
  if (attributes->HasBlockScalarRange(block))
  {
    const vtkVector2d range = attributes->GetBlockScalarRange(block);
    colors->SetScalarRange(range[0], range[1]);
  }
  if (attributes->HasBlockInterpolateScalarsBeforeMapping(block))
  {
    colors->SetInterpolateScalarsBeforeMapping(
      attributes->GetBlockInterpolateScalarsBeforeMapping(block));
  }
  if (attributes->HasBlockColorMode(block))
  {
    colors->SetColorMode(attributes->GetBlockColorMode(block));
  }
  if (attributes->HasBlockScalarMode(block))
  {
    colors->SetScalarMode(attributes->GetBlockScalarMode(block));
  }
  if (attributes->HasBlockArrayAccessMode(block))
  {
    colors->SetArrayAccessMode(attributes->GetBlockArrayAccessMode(block));
  }
  if (attributes->HasBlockArrayComponent(block))
  {
    colors->SetArrayComponent(attributes->GetBlockArrayComponent(block));
  }
  if (attributes->HasBlockArrayId(block))
  {
    colors->SetArrayId(attributes->GetBlockArrayId(block));
  }
  if (attributes->HasBlockArrayName(block))
  {
    colors->SetArrayName(attributes->GetBlockArrayName(block).c_str());
  }
  if (attributes->HasBlockFieldDataTupleId(block))
  {
    colors->SetFieldDataTupleId(attributes->GetBlockFieldDataTupleId(block));
  }
  if (attributes->HasBlockLookupTable(block))
  {
    colors->SetLookupTable(attributes->GetBlockLookupTable(block));
  }
}
#endif

class CompositeAdapter final : public MapperAdapter
{
public:
  MapperReading read(vtkMapper* mapper, vtkActor*) override
  {
    MapperReading reading;
    vtkDataObject* const data = updatedInput(mapper);
    if (!data)
    {
      reading.problem = "the mapper has no input; nothing is drawn";
      return reading;
    }
    const CompositeMapperClass& how = entryOf(mapper)->second;
    vtkCompositeDataDisplayAttributes* const attributes = how.attributes(mapper);
    this->MissingArraysAreNaN = how.missingArraysAreNaN(mapper);
    this->followSettings(mapper, attributes);
    std::int64_t flatIndex = 0;
    this->visit(data, attributes, BlockState(), mapper, flatIndex, reading.pieces);
    return reading;
  }

private:
  // Changed settings come to the blocks' own mappers when these are made anew.
  void followSettings(vtkMapper* mapper, vtkCompositeDataDisplayAttributes* attributes)
  {
    const std::pair<vtkMTimeType, vtkMTimeType> settings(
      mapper->GetMTime(), HRT_BLOCK_SCALARS && attributes ? attributes->GetMTime() : 0);
    if (settings != this->Settings)
    {
      this->Mappers.clear();
      this->Settings = settings;
    }
  }

  // Depth first, as flat indices count; an empty block takes one.
  void visit(vtkDataObject* block, vtkCompositeDataDisplayAttributes* attributes,
    BlockState state, vtkMapper* mapper, std::int64_t& flatIndex, std::vector<SurfacePiece>& pieces)
  {
    const std::int64_t own = flatIndex++;
    if (!block)
    {
      return;
    }
    apply(attributes, block, state);
    if (auto* const tree = vtkDataObjectTree::SafeDownCast(block))
    {
      const auto children = vtkSmartPointer<vtkDataObjectTreeIterator>::Take(tree->NewTreeIterator());
      children->TraverseSubTreeOff();
      children->VisitOnlyLeavesOff();
      children->SkipEmptyNodesOff();
      for (children->InitTraversal(); !children->IsDoneWithTraversal(); children->GoToNextItem())
      {
        this->visit(
          children->GetCurrentDataObject(), attributes, state, mapper, flatIndex, pieces);
      }
      return;
    }
    auto* const mesh = vtkPolyData::SafeDownCast(block);
    const bool seen =
      state.visible && (!state.overrides.opacity || state.overrides.opacityValue > 0.0f);
    if (mesh && seen)
    {
      SurfacePiece piece;
      piece.data = mesh;
      piece.colors = this->mapperOf(own, mapper, attributes, block);
      piece.overrides = state.overrides;
      if (this->MissingArraysAreNaN && lacksScalars(piece.colors, mesh) &&
        colorOfNaN(piece.colors->GetLookupTable(), piece.overrides.colorValue))
      {
        piece.overrides.color = true; // before the block's own, as VTK has it
      }
      piece.key = static_cast<std::uint64_t>(own) + 1;
      piece.block = own;
      pieces.push_back(std::move(piece));
    }
  }

  // Mapping scalars leaves them in the mapper: a mapper for each block, as VTK has it.
  vtkMapper* mapperOf(std::int64_t flatIndex, vtkMapper* mapper,
    vtkCompositeDataDisplayAttributes* attributes, vtkDataObject* block)
  {
    vtkSmartPointer<vtkMapper>& own = this->Mappers[flatIndex];
    if (!own)
    {
      own = vtkSmartPointer<vtkPolyDataMapper>::New();
      own->vtkMapper::ShallowCopy(mapper); // not the input, which the mappers' own kind copies too
#if HRT_BLOCK_SCALARS
      copyBlockScalars(attributes, block, own);
#else
      static_cast<void>(attributes);
      static_cast<void>(block);
#endif
    }
    return own;
  }

  bool MissingArraysAreNaN = false;
  std::pair<vtkMTimeType, vtkMTimeType> Settings;
  std::map<std::int64_t, vtkSmartPointer<vtkMapper>> Mappers; // by flat index
};

} // namespace

//------------------------------------------------------------------------------
void registerCompositeMapper(const char* className, const CompositeMapperClass& how)
{
  registry()[className] = how;
}

//------------------------------------------------------------------------------
AdapterKind compositeKind()
{
  return { [](vtkMapper* mapper) { return entryOf(mapper) != nullptr; },
    [] { return std::unique_ptr<MapperAdapter>(std::make_unique<CompositeAdapter>()); } };
}

} // namespace scene
} // namespace hrt
