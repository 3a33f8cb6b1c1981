// See TextureExtraction.h.
#include "Rendering/Scene/TextureExtraction.h"

#include "Rendering/Scene/ActorClassification.h"

#include "vtkActor.h"
#include "vtkAlgorithm.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkMatrix4x4.h"
#include "vtkProp.h"
#include "vtkProperty.h"
#include "vtkScalarsToColors.h"
#include "vtkTransform.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <map>
#include <string>
#include <utility>

namespace hrt
{
namespace scene
{
namespace
{

//------------------------------------------------------------------------------
std::uint64_t nextVersion()
{
  static std::atomic<std::uint64_t> last{ 0 };
  return ++last;
}

//------------------------------------------------------------------------------
// The array that the texture shows, which only its own kind may ask for.
class ShownArray : public vtkTexture
{
public:
  static vtkDataArray* of(vtkTexture* texture, vtkDataObject* image)
  {
    vtkDataArray* (vtkAlgorithm::*const ask)(int, vtkDataObject*) =
      &ShownArray::GetInputArrayToProcess;
    return (texture->*ask)(0, image);
  }
};

//------------------------------------------------------------------------------
// A texture's two dimensions: those of three that are more than one point long, in VTK's order. False
// when all three are.
bool sizeOf(vtkImageData* image, vtkDataArray* scalars, glm::ivec2& size)
{
  int n[3];
  image->GetDimensions(n);
  if (image->GetNumberOfCells() == scalars->GetNumberOfTuples())
  {
    for (int& k : n)
    {
      k -= k > 1 ? 1 : 0; // the scalars are the cells'
    }
  }
  if (n[0] == 1)
  {
    size = { n[1], n[2] };
    return true;
  }
  size = { n[0], n[1] == 1 ? n[2] : n[1] };
  return n[1] == 1 || n[2] == 1;
}

//------------------------------------------------------------------------------
// Whether the array's values are colours by themselves, by the rule of vtkOpenGLTexture.
bool isDirect(vtkTexture* source, vtkDataArray* scalars)
{
  const int mode = source->GetColorMode(), type = scalars->GetDataType();
  const bool colors = (mode != VTK_COLOR_MODE_MAP_SCALARS && type == VTK_UNSIGNED_CHAR) ||
    (mode == VTK_COLOR_MODE_DIRECT_SCALARS && (type == VTK_UNSIGNED_SHORT || type == VTK_FLOAT));
  return colors && scalars->GetNumberOfComponents() >= 3;
}

//------------------------------------------------------------------------------
void readBytes(const unsigned char* values, int components, std::size_t count, Texture& texture)
{
  texture.bytes.reserve(count);
  for (std::size_t i = 0; i < count; ++i, values += components)
  {
    texture.bytes.emplace_back(values[0], values[1], values[2], components == 4 ? values[3] : 255);
  }
}

//------------------------------------------------------------------------------
void readFloats(vtkDataArray* scalars, float one, std::size_t count, Texture& texture)
{
  const int components = scalars->GetNumberOfComponents();
  texture.floats.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    glm::vec4 color(0.0f, 0.0f, 0.0f, one);
    for (int k = 0; k < components; ++k)
    {
      const auto value =
        static_cast<float>(scalars->GetComponent(static_cast<vtkIdType>(i), k));
      color[k] = std::isfinite(value) ? value : 0.0f;
    }
    texture.floats.push_back(color / one);
  }
}

//------------------------------------------------------------------------------
float linearOf(std::uint8_t value)
{
  const double c = value / 255.0;
  return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

//------------------------------------------------------------------------------
// OpenGL decodes texels before it interpolates them.
void decodeBytes(Texture& texture)
{
  texture.floats.reserve(texture.bytes.size());
  for (const glm::u8vec4& c : texture.bytes)
  {
    texture.floats.emplace_back(linearOf(c.r), linearOf(c.g), linearOf(c.b), c.a / 255.0f);
  }
  texture.bytes.clear();
}

//------------------------------------------------------------------------------
Texture::Alpha alphaOf(const Texture& texture)
{
  bool opaque = false, holes = false, mixed = false;
  const auto note = [&](float alpha)
  {
    opaque = opaque || alpha >= 1.0f;
    holes = holes || alpha <= 0.0f;
    mixed = mixed || (alpha > 0.0f && alpha < 1.0f);
  };
  for (const glm::u8vec4& c : texture.bytes)
  {
    note(c.a / 255.0f);
  }
  for (const glm::vec4& c : texture.floats)
  {
    note(c.a);
  }
  if (texture.wrap == Texture::Wrap::ClampToBorder)
  {
    note(texture.border.a);
  }
  // Between a hole and what is there, a linear filter makes all opacities.
  return mixed || (holes && opaque && texture.linear) ? Texture::Alpha::Mixed
    : holes                                           ? Texture::Alpha::Holes
                                                      : Texture::Alpha::Opaque;
}

//------------------------------------------------------------------------------
Texture::Wrap wrapOf(vtkTexture* source)
{
  switch (source->GetWrap())
  {
    case vtkTexture::ClampToEdge:
      return Texture::Wrap::ClampToEdge;
    case vtkTexture::MirroredRepeat:
      return Texture::Wrap::MirroredRepeat;
    case vtkTexture::ClampToBorder:
      return Texture::Wrap::ClampToBorder;
    default:
      return Texture::Wrap::Repeat;
  }
}

//------------------------------------------------------------------------------
// Null when there is no image of two dimensions that the texels could come from.
std::shared_ptr<Texture> readTexture(vtkTexture* source)
{
  vtkImageData* image = source->GetInput();
  vtkDataArray* scalars = image ? ShownArray::of(source, image) : nullptr;
  glm::ivec2 size;
  if (!scalars || !sizeOf(image, scalars, size))
  {
    return nullptr;
  }
  const vtkIdType count = static_cast<vtkIdType>(size.x) * size.y;
  const int components = scalars->GetNumberOfComponents();
  if (count < 1 || scalars->GetNumberOfTuples() < count || components < 1 || components > 4)
  {
    return nullptr;
  }
  auto texture = std::make_shared<Texture>();
  texture->width = size.x;
  texture->height = size.y;
  const auto texels = static_cast<std::size_t>(count);
  bool opaqueFormat = false; // has no room for opacity, of the border neither
  if (!isDirect(source, scalars))
  {
    const unsigned char* colors = source->MapScalarsToColors(scalars); // red, green, blue, opacity
    if (!colors)
    {
      return nullptr;
    }
    readBytes(colors, 4, texels, *texture);
  }
  else
  {
    opaqueFormat = components == 3;
    switch (scalars->GetDataType())
    {
      case VTK_UNSIGNED_CHAR:
        readBytes(static_cast<const unsigned char*>(scalars->GetVoidPointer(0)), components, texels,
          *texture);
        break;
      case VTK_UNSIGNED_SHORT:
        readFloats(scalars, 65535.0f, texels, *texture);
        break;
      default:
        readFloats(scalars, 1.0f, texels, *texture);
    }
  }
  if (source->GetUseSRGBColorSpace() && !texture->bytes.empty())
  {
    decodeBytes(*texture);
  }
  texture->wrap = wrapOf(source);
  texture->linear = source->GetInterpolate() != 0;
  const float* border = source->GetBorderColor();
  texture->border = glm::vec4(border[0], border[1], border[2], opaqueFormat ? 1.0f : border[3]);
  texture->alpha = alphaOf(*texture);
  return texture;
}

//------------------------------------------------------------------------------
bool sameContent(const Texture& a, const Texture& b)
{
  return a.width == b.width && a.height == b.height && a.wrap == b.wrap && a.linear == b.linear &&
    a.border == b.border && a.bytes == b.bytes && a.floats == b.floats;
}

//------------------------------------------------------------------------------
TextureBlend blendOf(vtkTexture* source)
{
  switch (source->GetBlendingMode())
  {
    case vtkTexture::VTK_TEXTURE_BLENDING_MODE_REPLACE:
      return TextureBlend::Replace;
    case vtkTexture::VTK_TEXTURE_BLENDING_MODE_MODULATE:
      return TextureBlend::Modulate;
    case vtkTexture::VTK_TEXTURE_BLENDING_MODE_ADD:
      return TextureBlend::Add;
    case vtkTexture::VTK_TEXTURE_BLENDING_MODE_ADD_SIGNED:
      return TextureBlend::AddSigned;
    case vtkTexture::VTK_TEXTURE_BLENDING_MODE_SUBTRACT:
      return TextureBlend::Subtract;
    default:
      return TextureBlend::None; // VTK leaves out the interpolating mode too
  }
}

//------------------------------------------------------------------------------
// What all textures of a surface make of its opacity. The sums that VTK's modes form are clamped to 1 when
// they are written; only the signed sum makes something between from holes and opaque texels.
Texture::Alpha combined(const std::vector<TextureLayer>& layers)
{
  Texture::Alpha all = Texture::Alpha::Opaque;
  for (const TextureLayer& layer : layers)
  {
    const Texture::Alpha alpha = layer.texture->alpha;
    const bool mixes =
      alpha == Texture::Alpha::Holes && layer.blend == TextureBlend::AddSigned;
    all = std::max(all, mixes ? Texture::Alpha::Mixed : alpha);
  }
  return all;
}

//------------------------------------------------------------------------------
std::vector<vtkTexture*> shownTextures(vtkActor* actor)
{
  std::vector<vtkTexture*> all;
  if (isPhysicallyBased(actor))
  {
    return all;
  }
  if (actor->GetTexture())
  {
    all.push_back(actor->GetTexture());
  }
  const std::map<std::string, vtkTexture*>& named = actor->GetProperty()->GetAllTextures();
  for (const auto& entry : named)
  {
    if (entry.second && !isPhysicalTexture(entry.first))
    {
      all.push_back(entry.second);
    }
  }
  all.erase(std::remove_if(all.begin(), all.end(), [](vtkTexture* t) { return t->GetCubeMap(); }),
    all.end());
  return all;
}

//------------------------------------------------------------------------------
// The actor's texture brings its own; the key alone moves the others too.
void readTransform(vtkActor* actor, Textures& textures)
{
  const double* m = nullptr; // row by row
  if (actor->GetTexture() && actor->GetTexture()->GetTransform())
  {
    m = &actor->GetTexture()->GetTransform()->GetMatrix()->Element[0][0];
  }
  else
  {
    vtkInformation* keys = actor->GetPropertyKeys();
    if (keys && keys->Has(vtkProp::GeneralTextureTransform()))
    {
      m = keys->Get(vtkProp::GeneralTextureTransform());
    }
  }
  if (m)
  {
    textures.transformed = true;
    textures.transformX = glm::vec3(m[0], m[1], m[3]);
    textures.transformY = glm::vec3(m[4], m[5], m[7]);
    textures.transformW = glm::vec3(m[12], m[13], m[15]);
  }
}

} // anonymous namespace

//------------------------------------------------------------------------------
std::shared_ptr<const Texture> TextureCache::get(vtkTexture* source)
{
  if (vtkAlgorithm* producer = source->GetInputAlgorithm())
  {
    producer->UpdateWholeExtent();
  }
  Record& record = this->Records[source];
  if (record.source != source)
  {
    record = Record();
    record.source = source;
  }
  record.used = true;
  vtkImageData* image = source->GetInput();
  const auto signature = [&]()
  {
    vtkScalarsToColors* table = source->GetLookupTable();
    return Signature(source->GetMTime(), image, image ? image->GetMTime() : 0,
      table ? table->GetMTime() : 0);
  };
  if (record.signature != signature())
  {
    std::shared_ptr<Texture> fresh = readTexture(source);
    if (!fresh || !record.texture || !sameContent(*record.texture, *fresh))
    {
      if (fresh)
      {
        fresh->version = nextVersion();
      }
      record.texture = fresh;
    }
    // Mapping may have made or touched the table; what counts is the state after it.
    record.signature = signature();
  }
  return record.texture;
}

//------------------------------------------------------------------------------
TextureReading TextureCache::read(vtkActor* actor)
{
  TextureReading reading;
  for (vtkTexture* source : shownTextures(actor))
  {
    TextureLayer layer;
    layer.texture = this->get(source);
    layer.blend = blendOf(source);
    if (!reading.textures.layers.empty() && layer.blend == TextureBlend::None)
    {
      continue;
    }
    if (!layer.texture)
    {
      reading.state = TextureReading::State::Unreadable;
      return reading;
    }
    const bool oneTexel = layer.texture->width <= 1 && layer.texture->height <= 1;
    if (source->GetInterpolate() && source->GetMipmap() && !oneTexel)
    {
      reading.state = TextureReading::State::MipMapped;
    }
    reading.textures.layers.push_back(std::move(layer));
  }
  reading.textures.alpha = combined(reading.textures.layers);
  reading.textures.onBack = actor->GetProperty()->GetShowTexturesOnBackface();
  readTransform(actor, reading.textures);
  return reading;
}

//------------------------------------------------------------------------------
void TextureCache::endFrame()
{
  for (auto it = this->Records.begin(); it != this->Records.end();)
  {
    const bool used = std::exchange(it->second.used, false);
    it = used ? std::next(it) : this->Records.erase(it);
  }
}

} // namespace scene
} // namespace hrt
