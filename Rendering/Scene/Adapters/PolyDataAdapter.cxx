// vtkPolyDataMapper, and every subclass of it whose picture is the surface of its input.
#include "Rendering/Scene/Adapters/AdapterRegistry.h"

#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"

#include <algorithm>
#include <iterator>

namespace hrt
{
namespace scene
{
namespace
{

// Subclasses that draw something else. Named by text: they live in modules that we do not link, and
// some exist in a few VTK releases only.
const char* const kOtherMappers[] = { "vtkCompositePolyDataMapper", "vtkCompositePolyDataMapper2",
  "vtkCompositeMapperHelper2", "vtkOpenGLBatchedPolyDataMapper", "vtkOpenGLGlyph3DHelper",
  "vtkPointGaussianMapper", "vtkOpenGLSphereMapper", "vtkOpenGLStickMapper", "vtkSurfaceLICMapper",
  "vtkOpenGLSurfaceProbeVolumeMapper" };

//------------------------------------------------------------------------------
bool reads(vtkMapper* mapper)
{
  return vtkPolyDataMapper::SafeDownCast(mapper) &&
    std::none_of(std::begin(kOtherMappers), std::end(kOtherMappers),
      [mapper](const char* name) { return mapper->IsA(name); });
}

class PolyDataAdapter final : public MapperAdapter
{
public:
  MapperReading read(vtkMapper* mapper, vtkActor*) override
  {
    MapperReading reading;
    // The whole input never exists at one time then.
    if (vtkPolyDataMapper::SafeDownCast(mapper)->GetNumberOfSubPieces() > 1)
    {
      reading.left = LeftToVTK::SubPieces;
      return reading;
    }
    vtkDataObject* const data = updatedInput(mapper);
    SurfacePiece piece;
    piece.data = vtkPolyData::SafeDownCast(data);
    piece.colors = mapper;
    if (piece.data)
    {
      reading.pieces.push_back(std::move(piece));
    }
    else if (data)
    {
      reading.left = LeftToVTK::OtherData;
    }
    else
    {
      reading.problem = "the mapper has no input; nothing is drawn";
    }
    return reading;
  }
};

} // namespace

//------------------------------------------------------------------------------
AdapterKind polyDataKind()
{
  return { reads,
    [] { return std::unique_ptr<MapperAdapter>(std::make_unique<PolyDataAdapter>()); } };
}

} // namespace scene
} // namespace hrt
