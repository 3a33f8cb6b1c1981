// From vtkProperty, backface property and vtkHybridMaterial to hrt::Material.
#include "SceneTest.h"

#include "vtkDoubleArray.h"
#include "vtkHybridMaterial.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleKey.h"
#include "vtkPointData.h"
#include "vtkProperty.h"

#include <limits>

namespace
{

class Materials : public SceneTest
{
protected:
  Materials()
    : mesh(makeSquare())
    , actor(this->addMesh(this->mesh))
  {
  }

  const hrt::Material& material()
  {
    this->onlyGeometry();
    return this->snapshot->parts[0].material;
  }

  vtkSmartPointer<vtkPolyData> mesh;
  vtkSmartPointer<vtkActor> actor;
};

void setAll(vtkProperty* property, double base)
{
  property->SetAmbientColor(base, 0.25, 0.5);
  property->SetAmbient(0.125);
  property->SetDiffuseColor(0.5, base, 0.75);
  property->SetDiffuse(0.875);
  property->SetSpecularColor(1.0, 0.5, base);
  property->SetSpecular(0.375);
  property->SetSpecularPower(17.5);
}

// Every number below is a float, so that nothing is rounded.
void expectAll(const hrt::PhongTerms& terms, float base)
{
  EXPECT_EQ(terms.ambientColor, glm::vec3(base, 0.25f, 0.5f));
  EXPECT_EQ(terms.ambient, 0.125f);
  EXPECT_EQ(terms.diffuseColor, glm::vec3(0.5f, base, 0.75f));
  EXPECT_EQ(terms.diffuse, 0.875f);
  EXPECT_EQ(terms.specularColor, glm::vec3(1.0f, 0.5f, base));
  EXPECT_EQ(terms.specular, 0.375f);
  EXPECT_EQ(terms.specularPower, 17.5f);
  EXPECT_EQ(terms.opacity, 1.0f);
}

TEST_F(Materials, CopyTheProperty)
{
  setAll(this->actor->GetProperty(), 0.0625);
  const hrt::Material& m = this->material();
  expectAll(m.front, 0.0625f);
  expectAll(m.back, 0.0625f);
  EXPECT_TRUE(m.lit);
  EXPECT_FALSE(m.cullFront);
  EXPECT_FALSE(m.cullBack);
  EXPECT_FALSE(m.needsSecondaryRays());
}

TEST_F(Materials, CopyTheSwitches)
{
  vtkProperty* property = this->actor->GetProperty();
  property->LightingOff();
  property->FrontfaceCullingOn();
  EXPECT_FALSE(this->material().lit);
  EXPECT_TRUE(this->material().cullFront);
  EXPECT_FALSE(this->material().cullBack);
  property->FrontfaceCullingOff();
  property->BackfaceCullingOn();
  EXPECT_FALSE(this->material().cullFront);
  EXPECT_TRUE(this->material().cullBack);
}

TEST_F(Materials, HaveABackOfTheirOwn)
{
  vtkNew<vtkProperty> back;
  setAll(this->actor->GetProperty(), 0.0625);
  setAll(back, 0.9375);
  this->actor->SetBackfaceProperty(back);
  expectAll(this->material().front, 0.0625f);
  expectAll(this->material().back, 0.9375f);
}

// VTK's shader drops the backface property when colours come from scalars.
TEST_F(Materials, LoseTheirBackToScalarColors)
{
  vtkNew<vtkProperty> back;
  setAll(this->actor->GetProperty(), 0.0625);
  setAll(back, 0.9375);
  this->actor->SetBackfaceProperty(back);
  vtkNew<vtkDoubleArray> scalars;
  for (double v : { 0.0, 0.25, 0.5, 1.0 })
  {
    scalars->InsertNextValue(v);
  }
  this->mesh->GetPointData()->SetScalars(scalars);
  expectAll(this->material().back, 0.0625f);
}

TEST_F(Materials, ReadMirrorAndGlass)
{
  vtkHybridMaterial::SetReflectance(this->actor, 0.5);
  EXPECT_EQ(this->material().reflectance, 0.5f);
  EXPECT_FALSE(this->material().isGlass());
  EXPECT_TRUE(this->snapshot->parts[0].castsShadow);

  vtkHybridMaterial::SetGlass(this->actor, 1.5);
  EXPECT_EQ(this->material().indexOfRefraction, 1.5f);
  EXPECT_FALSE(this->snapshot->parts[0].castsShadow) << "glass lets light through";
  EXPECT_TRUE(this->snapshot->parts[0].visibleToCamera);

  vtkHybridMaterial::Clear(this->actor);
  EXPECT_FALSE(this->material().needsSecondaryRays());
  EXPECT_TRUE(this->snapshot->parts[0].castsShadow);
}

TEST_F(Materials, IgnoreKeysThatWereSetPastTheDoor)
{
  vtkNew<vtkInformation> keys;
  keys->Set(vtkHybridMaterial::REFLECTANCE(), 7.0);
  keys->Set(vtkHybridMaterial::INDEX_OF_REFRACTION(), std::numeric_limits<double>::quiet_NaN());
  this->actor->SetPropertyKeys(keys);
  EXPECT_FALSE(this->material().needsSecondaryRays());
}

TEST_F(Materials, OfGlassIgnoreOpacity)
{
  this->actor->GetProperty()->SetOpacity(0.25);
  EXPECT_FALSE(this->material().isGlass());
  EXPECT_FALSE(this->snapshot->parts[0].visibleToCamera) << "plain opacity is VTK's";
  vtkHybridMaterial::SetGlass(this->actor, 1.5);
  EXPECT_TRUE(this->material().isGlass());
  EXPECT_EQ(this->material().front.opacity, 0.25f);
  EXPECT_TRUE(this->snapshot->parts[0].visibleToCamera);
}

} // anonymous namespace
