// From vtkTexture to texels: which images are colours and which go through a table, which textures an
// actor shows in which order, their coordinates, and what their opacity makes of the actor.
#include "SceneTest.h"

#include "vtkFloatArray.h"
#include "vtkHybridMaterial.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkLookupTable.h"
#include "vtkPointData.h"
#include "vtkProperty.h"
#include "vtkTexture.h"
#include "vtkTransform.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedShortArray.h"

#include <cmath>

namespace
{

using Values = std::vector<double>;

template <class Array>
vtkSmartPointer<vtkImageData> makeImage(int width, int height, int components, const Values& values)
{
  vtkNew<Array> array;
  array->SetName("colors");
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / components);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    array->SetComponent(static_cast<vtkIdType>(i) / components,
      static_cast<int>(i) % components, values[i]);
  }
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(width, height, 1);
  image->GetPointData()->SetScalars(array);
  return image;
}

vtkSmartPointer<vtkTexture> makeTexture(vtkImageData* image)
{
  auto texture = vtkSmartPointer<vtkTexture>::New();
  texture->SetInputData(image);
  return texture;
}

vtkSmartPointer<vtkTexture> oneColor(const Values& color)
{
  return makeTexture(
    makeImage<vtkUnsignedCharArray>(1, 1, static_cast<int>(color.size()), color));
}

class TexturesOf : public SceneTest
{
protected:
  TexturesOf()
    : mesh(makeSquare())
    , actor(this->addMesh(this->mesh))
    , property(this->actor->GetProperty())
  {
    this->setCoordinates(2, { 0, 0, 1, 0, 1, 1, 0, 1 });
  }

  void setCoordinates(int components, const Values& values)
  {
    vtkNew<vtkFloatArray> coordinates;
    coordinates->SetName("coordinates");
    coordinates->SetNumberOfComponents(components);
    for (const double v : values)
    {
      coordinates->InsertNextValue(static_cast<float>(v));
    }
    this->mesh->GetPointData()->SetTCoords(coordinates);
  }

  const hrt::Part& onlyPart()
  {
    this->update();
    if (this->snapshot->parts.size() != 1u)
    {
      throw std::runtime_error("the test expects exactly one part");
    }
    return this->snapshot->parts[0];
  }

  const std::vector<hrt::TextureLayer>& layers() { return this->onlyPart().material.textures.layers; }

  // The only texture.
  const hrt::Texture& onlyTexture()
  {
    const std::vector<hrt::TextureLayer>& all = this->layers();
    if (all.size() != 1u)
    {
      throw std::runtime_error("the test expects exactly one texture");
    }
    return *all[0].texture;
  }

  vtkSmartPointer<vtkPolyData> mesh;
  vtkSmartPointer<vtkActor> actor;
  vtkProperty* property;
};

using Bytes = std::vector<glm::u8vec4>;

TEST_F(TexturesOf, ComponentsAreGreyOpacityAndColours)
{
  this->actor->SetTexture(makeTexture(makeImage<vtkUnsignedCharArray>(2, 1, 1, { 10, 200 })));
  EXPECT_EQ(this->onlyTexture().bytes, (Bytes{ { 10, 10, 10, 255 }, { 200, 200, 200, 255 } }));
  this->actor->SetTexture(makeTexture(makeImage<vtkUnsignedCharArray>(1, 1, 2, { 10, 255 })));
  EXPECT_EQ(this->onlyTexture().bytes, (Bytes{ { 10, 10, 10, 255 } }));
  this->actor->SetTexture(oneColor({ 10, 20, 30 }));
  EXPECT_EQ(this->onlyTexture().bytes, (Bytes{ { 10, 20, 30, 255 } }));
  this->actor->SetTexture(oneColor({ 10, 20, 30, 255 }));
  EXPECT_EQ(this->onlyTexture().bytes, (Bytes{ { 10, 20, 30, 255 } }));
}

TEST_F(TexturesOf, RowsAndSizeAreTheImages)
{
  this->actor->SetTexture(
    makeTexture(makeImage<vtkUnsignedCharArray>(2, 3, 1, { 1, 2, 3, 4, 5, 6 })));
  const hrt::Texture& texture = this->onlyTexture();
  EXPECT_EQ(texture.width, 2);
  EXPECT_EQ(texture.height, 3);
  ASSERT_EQ(texture.bytes.size(), 6u);
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_EQ(texture.bytes[i].r, i + 1);
  }
}

// The two dimensions of an image are any of its three; scalars may be the cells'.
TEST_F(TexturesOf, DimensionsAreVTKs)
{
  const auto image = makeImage<vtkUnsignedCharArray>(6, 1, 1, { 1, 2, 3, 4, 5, 6 });
  this->actor->SetTexture(makeTexture(image));
  const auto expectSize = [this](int width, int height)
  {
    const hrt::Texture& texture = this->onlyTexture();
    EXPECT_EQ(texture.width, width);
    EXPECT_EQ(texture.height, height);
  };
  expectSize(6, 1);
  image->SetDimensions(1, 2, 3);
  expectSize(2, 3);
  image->SetDimensions(2, 1, 3);
  expectSize(2, 3);
  image->SetDimensions(3, 4, 1); // six cells
  expectSize(2, 3);
}

TEST_F(TexturesOf, OtherValuesGoThroughTheTable)
{
  const auto texture = makeTexture(makeImage<vtkFloatArray>(2, 1, 1, { 3.0, 5.0 }));
  vtkNew<vtkLookupTable> table;
  table->SetNumberOfTableValues(2);
  table->SetRange(3.0, 5.0);
  table->SetTableValue(0, 1.0, 0.0, 0.0, 1.0);
  table->SetTableValue(1, 0.0, 0.0, 1.0, 1.0);
  texture->SetLookupTable(table);
  this->actor->SetTexture(texture);
  EXPECT_EQ(this->onlyTexture().bytes, (Bytes{ { 255, 0, 0, 255 }, { 0, 0, 255, 255 } }));
  table->SetTableValue(0, 0.0, 1.0, 0.0, 1.0);
  EXPECT_EQ(this->onlyTexture().bytes, (Bytes{ { 0, 255, 0, 255 }, { 0, 0, 255, 255 } }));
}

TEST_F(TexturesOf, BytesToo)
{
  const auto texture = makeTexture(makeImage<vtkUnsignedCharArray>(2, 1, 1, { 0, 255 }));
  vtkNew<vtkLookupTable> table;
  table->SetNumberOfTableValues(2);
  table->SetRange(0.0, 255.0);
  table->SetTableValue(0, 1.0, 0.0, 0.0, 1.0);
  table->SetTableValue(1, 0.0, 0.0, 1.0, 1.0);
  texture->SetLookupTable(table);
  texture->SetColorModeToMapScalars();
  this->actor->SetTexture(texture);
  EXPECT_EQ(this->onlyTexture().bytes, (Bytes{ { 255, 0, 0, 255 }, { 0, 0, 255, 255 } }));
}

TEST_F(TexturesOf, WideColoursAreKept)
{
  const auto wide = makeTexture(makeImage<vtkFloatArray>(1, 1, 3, { 0.25, 3.0, 1.0 }));
  wide->SetColorModeToDirectScalars();
  this->actor->SetTexture(wide);
  EXPECT_EQ(this->onlyTexture().floats, (std::vector<glm::vec4>{ { 0.25f, 3.0f, 1.0f, 1.0f } }));
  const auto shorts =
    makeTexture(makeImage<vtkUnsignedShortArray>(1, 1, 4, { 0, 65535, 13107, 65535 }));
  shorts->SetColorModeToDirectScalars();
  this->actor->SetTexture(shorts);
  EXPECT_EQ(this->onlyTexture().floats, (std::vector<glm::vec4>{ { 0.0f, 1.0f, 0.2f, 1.0f } }));
}

TEST_F(TexturesOf, StandardColoursAreDecoded)
{
  const auto texture = oneColor({ 0, 128, 255 });
  texture->UseSRGBColorSpaceOn();
  this->actor->SetTexture(texture);
  const hrt::Texture& decoded = this->onlyTexture();
  ASSERT_EQ(decoded.floats.size(), 1u);
  EXPECT_TRUE(decoded.bytes.empty());
  EXPECT_EQ(decoded.floats[0].r, 0.0f);
  EXPECT_NEAR(decoded.floats[0].g, std::pow((128 / 255.0 + 0.055) / 1.055, 2.4), 1e-7);
  EXPECT_EQ(decoded.floats[0].b, 1.0f);
}

TEST_F(TexturesOf, RulesOfLookingUp)
{
  const auto texture = oneColor({ 1, 2, 3 });
  this->actor->SetTexture(texture);
  EXPECT_EQ(this->onlyTexture().wrap, hrt::Texture::Wrap::Repeat);
  EXPECT_FALSE(this->onlyTexture().linear);
  texture->InterpolateOn();
  texture->SetWrap(vtkTexture::MirroredRepeat);
  EXPECT_TRUE(this->onlyTexture().linear);
  EXPECT_EQ(this->onlyTexture().wrap, hrt::Texture::Wrap::MirroredRepeat);
  texture->SetWrap(vtkTexture::ClampToEdge);
  EXPECT_EQ(this->onlyTexture().wrap, hrt::Texture::Wrap::ClampToEdge);
  texture->SetWrap(vtkTexture::ClampToBorder);
  texture->SetBorderColor(0.25f, 0.5f, 0.75f, 0.5f);
  EXPECT_EQ(this->onlyTexture().wrap, hrt::Texture::Wrap::ClampToBorder);
  EXPECT_EQ(this->onlyTexture().border, glm::vec4(0.25f, 0.5f, 0.75f, 1.0f)) << "no opacity in RGB";
}

TEST_F(TexturesOf, TheActorsComesFirstThenThoseOfThePropertyByName)
{
  this->property->SetTexture("b", oneColor({ 2, 0, 0 }));
  const auto a = oneColor({ 1, 0, 0 });
  a->SetBlendingMode(vtkTexture::VTK_TEXTURE_BLENDING_MODE_ADD);
  this->property->SetTexture("a", a);
  this->property->SetTexture("normalTex", oneColor({ 3, 0, 0 })); // of physically based shading
  ASSERT_EQ(this->layers().size(), 1u) << "b has no blending mode";
  EXPECT_EQ(this->onlyTexture().bytes[0].r, 1);
  this->actor->SetTexture(oneColor({ 9, 0, 0 }));
  const std::vector<hrt::TextureLayer> all = this->layers();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].texture->bytes[0].r, 9);
  EXPECT_EQ(all[1].texture->bytes[0].r, 1);
  EXPECT_EQ(all[1].blend, hrt::TextureBlend::Add);
}

TEST_F(TexturesOf, CoordinatesFollowTheCorners)
{
  this->actor->SetTexture(oneColor({ 1, 2, 3 }));
  const hrt::Geometry& geometry = this->onlyGeometry();
  for (std::size_t triangle = 0; triangle < 2; ++triangle)
  {
    const auto corners = geometry.cornerPositions(triangle);
    const auto coordinates = geometry.cornersOf(geometry.textureCoordinates, triangle);
    for (std::size_t k = 0; k < 3; ++k)
    {
      EXPECT_EQ(coordinates[k], glm::vec2(corners[k])) << "the unit square's are its points";
    }
  }
  this->actor->SetTexture(nullptr);
  EXPECT_TRUE(this->onlyGeometry().textureCoordinates.empty()) << "nobody asks for them";
}

TEST_F(TexturesOf, CoordinatesOfOneComponentAreOfTheLowestRow)
{
  this->actor->SetTexture(oneColor({ 1, 2, 3 }));
  this->setCoordinates(1, { 0, 0.5, 1, 0.25 });
  const hrt::Part& part = this->onlyPart();
  for (std::size_t v = 0; v < 4; ++v)
  {
    const glm::vec3 p = part.geometry->positions[v];
    const float s = p.x == 0.0f ? 0.25f * p.y : 0.5f + 0.5f * p.y;
    EXPECT_EQ(part.geometry->textureCoordinates.values[v], glm::vec2(s, 0.0f));
  }
  EXPECT_EQ(part.material.textures.transformY, glm::vec3(0.0f));
}

TEST_F(TexturesOf, WithoutCoordinatesNoneIsShown)
{
  this->actor->SetTexture(oneColor({ 1, 2, 3 }));
  this->setCoordinates(3, { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0 }); // VTK knows no volumes of texels
  EXPECT_TRUE(this->layers().empty());
  this->mesh->GetPointData()->SetTCoords(nullptr);
  EXPECT_TRUE(this->layers().empty());
  EXPECT_TRUE(this->scene->IsDrawnByTracer(this->actor));
}

TEST_F(TexturesOf, CoordinatesThatAreNoNumbersAreZero)
{
  this->actor->SetTexture(oneColor({ 1, 2, 3 }));
  this->setCoordinates(2, { NAN, 0.5, INFINITY, 0, 1, 1, 0, 1 });
  const hrt::Geometry& geometry = this->onlyGeometry();
  for (std::size_t v = 0; v < 4; ++v)
  {
    const glm::vec3 p = geometry.positions[v];
    if (p.y == 0.0f)
    {
      EXPECT_EQ(geometry.textureCoordinates.values[v], glm::vec2(0.0f, p.x == 0.0f ? 0.5f : 0.0f));
    }
  }
}

TEST_F(TexturesOf, TransformsAreTheTexturesOrTheKeys)
{
  const auto texture = oneColor({ 1, 2, 3 });
  this->actor->SetTexture(texture);
  EXPECT_FALSE(this->onlyPart().material.textures.transformed);
  double key[16] = { 2, 0, 0, 0.5, 0, 3, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
  vtkNew<vtkInformation> keys;
  this->actor->SetPropertyKeys(keys);
  keys->Set(vtkProp::GeneralTextureTransform(), key, 16);
  EXPECT_TRUE(this->onlyPart().material.textures.transformed);
  EXPECT_EQ(this->onlyPart().material.textures.transformX, glm::vec3(2, 0, 0.5f));
  EXPECT_EQ(this->onlyPart().material.textures.transformY, glm::vec3(0, 3, 0));
  EXPECT_EQ(this->onlyPart().material.textures.transformW, glm::vec3(0, 0, 1));
  vtkNew<vtkTransform> own;
  own->Scale(5, 1, 1);
  texture->SetTransform(own);
  EXPECT_EQ(this->onlyPart().material.textures.transformX, glm::vec3(5, 0, 0));
}

TEST_F(TexturesOf, TheBackShowsThemUnlessToldNotTo)
{
  this->actor->SetTexture(oneColor({ 1, 2, 3 }));
  EXPECT_TRUE(this->onlyPart().material.textures.onBack);
  this->property->ShowTexturesOnBackfaceOff();
  EXPECT_FALSE(this->onlyPart().material.textures.onBack);
}

TEST_F(TexturesOf, TexelsAreReplacedOnlyWhenTheyDiffer)
{
  const auto image = makeImage<vtkUnsignedCharArray>(1, 1, 3, { 1, 2, 3 });
  const auto texture = makeTexture(image);
  this->actor->SetTexture(texture);
  const auto second = this->addMesh(this->mesh);
  second->SetTexture(texture);
  this->update();
  const auto version = [this](std::size_t part)
  { return this->snapshot->parts[part].material.textures.layers[0].texture->version; };
  const std::uint64_t first = version(0);
  EXPECT_EQ(version(1), first) << "one texture, two actors";
  this->update();
  EXPECT_EQ(version(0), first);
  texture->Modified();
  image->Modified();
  this->update();
  EXPECT_EQ(version(0), first) << "touched, but the same";
  image->GetPointData()->GetScalars()->SetComponent(0, 1, 77);
  image->GetPointData()->GetScalars()->Modified();
  image->Modified();
  this->update();
  EXPECT_NE(version(0), first);
  EXPECT_EQ(version(1), version(0));
}

TEST_F(TexturesOf, OpacityDecidesWhoDraws)
{
  const struct
  {
    Values alphas; // of two texels
    bool linear;
    bool traced, perforated, castsShadow, tintsShadow;
  } table[] = {
    { { 255, 255 }, true, true, false, true, false },
    { { 0, 255 }, false, true, true, false, true },
    { { 0, 0 }, false, true, true, false, true },
    { { 0, 255 }, true, false, false, false, true }, // the filter mixes them
    { { 128, 255 }, false, false, false, false, true },
  };
  for (const auto& row : table)
  {
    Values texels;
    for (const double alpha : row.alphas)
    {
      texels.insert(texels.end(), { 1, 2, 3, alpha });
    }
    const auto texture = makeTexture(makeImage<vtkUnsignedCharArray>(2, 1, 4, texels));
    texture->SetInterpolate(row.linear);
    this->actor->SetTexture(texture);
    const hrt::Part& part = this->onlyPart();
    EXPECT_EQ(this->scene->IsDrawnByTracer(this->actor), row.traced);
    EXPECT_EQ(part.visibleToCamera, row.traced);
    EXPECT_EQ(part.perforated, row.perforated);
    EXPECT_EQ(part.castsShadow, row.castsShadow);
    EXPECT_EQ(part.tintsShadow, row.tintsShadow);
    if (!row.traced)
    {
      EXPECT_STREQ(this->scene->GetReasonLeftToVTK(this->actor), "translucent");
    }
  }
}

// VTK asks only the actor's own texture whether it is translucent; the others blend all the same.
TEST_F(TexturesOf, OpacityOfThePropertysTexturesCountsToo)
{
  this->property->SetTexture("a", oneColor({ 1, 2, 3, 100 }));
  this->update();
  EXPECT_STREQ(this->scene->GetReasonLeftToVTK(this->actor), "translucent");
  vtkHybridMaterial::SetGlass(this->actor, 1.5);
  this->update();
  EXPECT_TRUE(this->scene->IsDrawnByTracer(this->actor)) << "glass does not ask for opacity";
}

TEST_F(TexturesOf, WhatCastsNoShadowCastsNoneThroughItsHolesEither)
{
  this->actor->SetTexture(makeTexture(
    makeImage<vtkUnsignedCharArray>(2, 1, 4, { 1, 2, 3, 0, 1, 2, 3, 255 })));
  vtkHybridMaterial::SetCastsShadow(this->actor, false);
  const hrt::Part& part = this->onlyPart();
  EXPECT_TRUE(part.perforated);
  EXPECT_FALSE(part.castsShadow || part.tintsShadow || part.castsShadowInMaps());
}

TEST_F(TexturesOf, NothingCrashesOnBrokenOnes)
{
  vtkNew<vtkTexture> empty;
  this->actor->SetTexture(empty);
  this->update();
  EXPECT_FALSE(this->scene->IsDrawnByTracer(this->actor));
  vtkNew<vtkImageData> bare;
  bare->SetDimensions(2, 2, 1);
  empty->SetInputData(bare);
  this->update();
  EXPECT_FALSE(this->scene->IsDrawnByTracer(this->actor));
  empty->SetInputData(makeImage<vtkUnsignedCharArray>(3, 3, 3, { 1, 2, 3 })); // one texel of nine
  this->update();
  EXPECT_FALSE(this->scene->IsDrawnByTracer(this->actor));
  empty->SetInputData(makeImage<vtkUnsignedCharArray>(1, 1, 5, { 1, 2, 3, 4, 5 }));
  this->update();
  EXPECT_FALSE(this->scene->IsDrawnByTracer(this->actor));
  empty->SetInputData(makeImage<vtkUnsignedCharArray>(1, 1, 3, { 1, 2, 3 }));
  this->update();
  EXPECT_TRUE(this->scene->IsDrawnByTracer(this->actor));
}

} // namespace
