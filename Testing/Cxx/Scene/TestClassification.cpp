// Who draws an actor: the tracer or VTK, with the reason, and what rays and lights see of it.
#include "SceneTest.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkHybridMaterial.h"
#include "vtkImageData.h"
#include "vtkLookupTable.h"
#include "vtkMatrix4x4.h"
#include "vtkPlane.h"
#include "vtkPointData.h"
#include "vtkPointGaussianMapper.h"
#include "vtkProperty.h"
#include "vtkShaderProperty.h"
#include "vtkTexture.h"
#include "vtkVolume.h"

namespace
{

class Classification : public SceneTest
{
protected:
  Classification()
    : mesh(makeSquare())
    , actor(this->addMesh(this->mesh))
    , mapper(vtkPolyDataMapper::SafeDownCast(this->actor->GetMapper()))
    , property(this->actor->GetProperty())
  {
  }

  void expectTraced()
  {
    const hrt::Snapshot& s = this->update();
    ASSERT_EQ(s.parts.size(), 1u);
    EXPECT_TRUE(s.parts[0].visibleToCamera);
    EXPECT_TRUE(s.parts[0].visibleToRays);
    EXPECT_TRUE(s.parts[0].castsShadow);
    EXPECT_TRUE(this->scene->IsDrawnByTracer(this->actor));
    EXPECT_STREQ(this->scene->GetReasonLeftToVTK(this->actor), "");
  }

  void expectLeft(const std::string& reason)
  {
    EXPECT_FALSE(this->scene->IsDrawnByTracer(this->actor));
    EXPECT_NE(
      std::string(this->scene->GetReasonLeftToVTK(this->actor)).find(reason), std::string::npos)
      << this->scene->GetReasonLeftToVTK(this->actor);
  }

  // VTK draws it, rays see its triangles.
  void expectLeftButSeen(const std::string& reason, bool castsShadow)
  {
    const hrt::Snapshot& s = this->update();
    this->expectLeft(reason);
    ASSERT_EQ(s.parts.size(), 1u);
    EXPECT_EQ(s.parts[0].geometry->triangleCount(), 2u);
    EXPECT_FALSE(s.parts[0].visibleToCamera);
    EXPECT_TRUE(s.parts[0].visibleToRays);
    EXPECT_EQ(s.parts[0].castsShadow, castsShadow);
  }

  // VTK draws it and rays pass through.
  void expectLeftAndUnseen(const std::string& reason)
  {
    EXPECT_TRUE(this->update().parts.empty());
    this->expectLeft(reason);
    EXPECT_EQ(this->snapshot->refusals.total(), 0u);
  }

  vtkSmartPointer<vtkPolyData> mesh;
  vtkSmartPointer<vtkActor> actor;
  vtkPolyDataMapper* mapper;
  vtkProperty* property;
};

TEST_F(Classification, PlainSurfacesAreTraced)
{
  this->expectTraced();
  this->property->SetInterpolationToFlat();
  this->expectTraced();
  this->property->LightingOff();
  this->expectTraced();
}

TEST_F(Classification, HiddenAndUnknownPropsAreNot)
{
  this->actor->VisibilityOff();
  this->update();
  EXPECT_FALSE(this->scene->IsDrawnByTracer(this->actor));
  EXPECT_FALSE(this->scene->IsDrawnByTracer(nullptr));
  EXPECT_STREQ(this->scene->GetReasonLeftToVTK(nullptr), "");
}

TEST_F(Classification, WireframeAndPoints)
{
  this->property->SetRepresentationToWireframe();
  this->expectLeftAndUnseen("wireframe");
  this->property->SetRepresentationToPoints();
  this->expectLeftAndUnseen("points");
  this->property->SetRepresentationToSurface();
  this->expectTraced();
}

// What is cut away is not there for anybody; planes are in the world.
TEST_F(Classification, ClippingPlanesCutTheSurface)
{
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(0.25, 0, 0);
  plane->SetNormal(1, 0, 0);
  this->mapper->AddClippingPlane(plane);
  this->expectTraced();
  EXPECT_EQ(this->snapshot->boundsMin.x, 0.25);
  const std::uint64_t version = this->snapshot->parts[0].geometry->version;
  EXPECT_EQ(this->update().parts.at(0).geometry->version, version);
  this->actor->SetPosition(0.5, 0, 0);
  EXPECT_EQ(this->update().boundsMin.x, 0.5) << "the whole square";
  this->actor->SetPosition(0, 0, 0);
  plane->SetOrigin(2, 0, 0);
  EXPECT_TRUE(this->update().parts.empty());
  EXPECT_EQ(this->snapshot->refusals.total(), 0u);
  EXPECT_TRUE(this->scene->IsDrawnByTracer(this->actor));
  this->mapper->RemoveAllClippingPlanes();
  this->expectTraced();
  EXPECT_EQ(this->snapshot->boundsMin.x, 0.0);
}

TEST_F(Classification, TexturesThatAreNotTraced)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(2, 2, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  vtkNew<vtkTexture> texture;
  texture->SetInputData(image);
  this->actor->SetTexture(texture);
  this->expectTraced();
  texture->MipmapOn();
  this->expectTraced(); // without interpolation VTK uses none
  texture->InterpolateOn();
  this->expectLeftButSeen("mip maps", true);
  texture->MipmapOff();
  this->expectTraced();
  image->SetDimensions(2, 2, 2);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  this->expectLeftButSeen("not an image", true);
  this->actor->SetTexture(nullptr);
  this->expectTraced();
}

TEST_F(Classification, EdgesAreTraced)
{
  this->property->EdgeVisibilityOn();
  this->expectTraced();
  this->property->RenderLinesAsTubesOn();
  this->expectTraced();
}

TEST_F(Classification, PhysicallyBased)
{
  this->property->SetInterpolationToPBR();
  this->property->SetMetallic(0.25);
  this->property->SetRoughness(0.75);
  this->property->SetCoatStrength(0.5);
  this->property->SetEdgeTint(1.0, 0.5, 0.25);
  this->expectTraced();
  const hrt::PhysicalTerms& terms = this->snapshot->parts[0].material.physical;
  EXPECT_TRUE(terms.used);
  EXPECT_EQ(terms.metallic, 0.25f);
  EXPECT_EQ(terms.roughness, 0.75f);
  EXPECT_EQ(terms.coat, 0.5f);
  EXPECT_EQ(terms.edgeTint, glm::vec3(1.0f, 0.5f, 0.25f));
  // Of 1.5 in air, where the coat's half is not; below the coat, of 2.
  EXPECT_NEAR(terms.f0, 0.5 * 0.2 * 0.2 + 0.5 / 49.0, 1e-6);
  EXPECT_NEAR(terms.coatF0, 1.0 / 9.0, 1e-6);
  this->property->LightingOff(); // then VTK takes Phong's colours
  this->expectTraced();
  EXPECT_FALSE(this->snapshot->parts[0].material.physical.used);
}

TEST_F(Classification, PhysicallyBasedBeyondDirectLight)
{
  this->property->SetInterpolationToPBR();
  this->expectTraced();
  this->property->SetAnisotropy(0.5);
  this->expectLeftButSeen("anisotropy", true);
  this->property->SetAnisotropy(0.0);
  vtkNew<vtkImageData> image;
  image->SetDimensions(2, 2, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  vtkNew<vtkTexture> texture;
  texture->SetInputData(image);
  this->property->SetORMTexture(texture);
  this->expectLeftButSeen("textures", true);
  this->property->RemoveTexture("materialTex");
  this->expectTraced();
  // The actor's own texture VTK does not show then.
  this->actor->SetTexture(texture);
  this->expectTraced();
  EXPECT_TRUE(this->snapshot->parts[0].material.textures.layers.empty());
  this->renderer->UseImageBasedLightingOn();
  this->expectTraced(); // there is no image
  this->renderer->SetEnvironmentTexture(texture);
  this->expectLeftButSeen("environment image", true);
}

TEST_F(Classification, ShaderReplacements)
{
  this->actor->GetShaderProperty()->AddFragmentShaderReplacement(
    "//VTK::Light::Impl", true, "//VTK::Light::Impl\n", false);
  this->expectLeftButSeen("shader", true);
  this->actor->GetShaderProperty()->ClearAllShaderReplacements();
  this->expectTraced();
}

// The surface is traced, and VTK draws the rest over it.
TEST_F(Classification, VertsLinesAndVerticesAreHosted)
{
  this->expectTraced();
  EXPECT_TRUE(this->scene->GetHostedActors().empty());
  this->mesh->SetVerts(makeCells({ { 0 } }));
  this->expectTraced();
  EXPECT_EQ(this->scene->GetHostedActors().size(), 1u);
  this->mesh->SetVerts(nullptr);
  this->mesh->SetLines(makeCells({ { 0, 1 } }));
  this->property->VertexVisibilityOn();
  this->expectTraced();
  EXPECT_EQ(this->scene->GetHostedActors().size(), 2u);
  // Where VTK draws the actor itself nothing is drawn twice.
  this->property->SetOpacity(0.5);
  this->update();
  EXPECT_TRUE(this->scene->GetHostedActors().empty());
}

TEST_F(Classification, HostedCellsAreThoseOfTheData)
{
  vtkNew<vtkDoubleArray> scalars;
  scalars->SetName("cells");
  for (double v : { 7.0, 1.0, 2.0 })
  {
    scalars->InsertNextValue(v);
  }
  this->mesh->GetCellData()->SetScalars(scalars);
  this->mesh->SetLines(makeCells({ { 0, 2, 3 } }));
  this->actor->SetPosition(1, 2, 3);
  this->expectTraced();
  const std::vector<vtkActor*> hosted = this->scene->GetHostedActors();
  ASSERT_EQ(hosted.size(), 1u);
  auto* shown = vtkPolyData::SafeDownCast(hosted[0]->GetMapper()->GetInput());
  EXPECT_EQ(shown->GetNumberOfCells(), 1);
  EXPECT_EQ(shown->GetNumberOfPolys(), 0);
  EXPECT_EQ(shown->GetCellData()->GetScalars()->GetComponent(0, 0), 7.0);
  EXPECT_EQ(hosted[0]->GetMatrix()->GetElement(2, 3), 3.0);
  this->update();
  EXPECT_EQ(this->scene->GetHostedActors(), hosted) << "nothing has changed";
}

TEST_F(Classification, LinesAloneAreNoEmptyPart)
{
  this->mesh->SetPolys(nullptr);
  this->mesh->SetLines(makeCells({ { 0, 1 } }));
  this->expectLeftAndUnseen("vertex or line");
  EXPECT_TRUE(this->scene->IsHosted(this->actor));
}

TEST_F(Classification, WhatIsVTKsByNatureIsHosted)
{
  for (int representation : { VTK_POINTS, VTK_WIREFRAME })
  {
    this->property->SetRepresentation(representation);
    this->update();
    EXPECT_TRUE(this->scene->IsHosted(this->actor));
  }
  this->property->SetRepresentationToSurface();
  this->property->SetOpacity(0.5);
  this->update();
  EXPECT_TRUE(this->scene->IsHosted(this->actor));
  this->property->SetOpacity(1.0);
  this->mapper->SetNumberOfSubPieces(2);
  this->update();
  EXPECT_FALSE(this->scene->IsHosted(this->actor)) << "a surface";
  vtkNew<vtkVolume> volume;
  this->renderer->AddVolume(volume);
  this->update();
  EXPECT_TRUE(this->scene->IsHosted(volume));
  EXPECT_STREQ(this->scene->GetReasonLeftToVTK(volume), "a volume");
}

TEST_F(Classification, AMirrorThatVTKDrawsIsSpokenOfOnce)
{
  vtkHybridMaterial::SetReflectance(this->actor, 0.5);
  this->expectTraced();
  this->property->SetRepresentationToWireframe();
  for (int frame = 0; frame < 3; ++frame)
  {
    this->update();
  }
  ASSERT_EQ(this->messages.warnings.size(), 1u);
  EXPECT_NE(this->messages.warnings[0].find(addressOf(this->actor)), std::string::npos);
  EXPECT_NE(this->messages.warnings[0].find("a mirror"), std::string::npos);
  EXPECT_NE(this->messages.warnings[0].find("wireframe"), std::string::npos);
}

TEST_F(Classification, CastingShadowsCanBeSwitchedOff)
{
  vtkHybridMaterial::SetCastsShadow(this->actor, false);
  const hrt::Snapshot& s = this->update();
  EXPECT_FALSE(s.parts.at(0).castsShadow);
  EXPECT_FALSE(s.parts[0].tintsShadow);
  EXPECT_TRUE(s.parts[0].visibleToRays);
  this->property->SetOpacity(0.5);
  EXPECT_FALSE(this->update().parts.at(0).tintsShadow);
  vtkHybridMaterial::Clear(this->actor);
  EXPECT_TRUE(this->update().parts.at(0).tintsShadow);
}

TEST_F(Classification, TranslucencyOfEveryOrigin)
{
  this->property->SetOpacity(0.5);
  this->expectLeftButSeen("translucent", false);
  this->actor->ForceOpaqueOn();
  this->expectLeftButSeen("translucent", false);
  this->actor->ForceOpaqueOff();
  this->property->SetOpacity(1.0);
  this->actor->ForceTranslucentOn();
  this->expectLeftButSeen("translucent", false);
  this->actor->ForceTranslucentOff();
  vtkNew<vtkProperty> back;
  back->SetOpacity(0.5);
  this->actor->SetBackfaceProperty(back);
  this->expectLeftButSeen("translucent", false);
  this->actor->SetBackfaceProperty(nullptr);
  this->expectTraced();
}

TEST_F(Classification, TranslucentScalars)
{
  vtkNew<vtkDoubleArray> scalars;
  for (double v : { 0.0, 0.25, 0.5, 1.0 })
  {
    scalars->InsertNextValue(v);
  }
  this->mesh->GetPointData()->SetScalars(scalars);
  vtkNew<vtkLookupTable> table;
  table->Build();
  this->mapper->SetLookupTable(table);
  this->expectTraced();
  table->SetTableValue(7, 1, 0, 0, 0.5);
  this->expectLeftButSeen("translucent", false);
}

TEST_F(Classification, Glass)
{
  vtkHybridMaterial::SetGlass(this->actor, 1.5);
  this->property->SetOpacity(0.5);
  const hrt::Snapshot& s = this->update();
  EXPECT_TRUE(s.parts.at(0).visibleToCamera);
  EXPECT_FALSE(s.parts[0].castsShadow);
  EXPECT_TRUE(this->scene->IsDrawnByTracer(this->actor));
}

TEST_F(Classification, ActorsWithoutMapperDrawThemselves)
{
  this->actor->SetMapper(nullptr);
  this->expectLeftAndUnseen("no mapper");
}

TEST_F(Classification, OtherMappers)
{
  vtkNew<vtkPointGaussianMapper> gaussians;
  gaussians->SetInputData(this->mesh);
  this->actor->SetMapper(gaussians);
  this->expectLeftAndUnseen("something other");
}

TEST_F(Classification, StreamedPieces)
{
  this->mapper->SetNumberOfSubPieces(2);
  this->expectLeftAndUnseen("pieces");
}

TEST_F(Classification, ProjectiveMatrices)
{
  vtkNew<vtkMatrix4x4> matrix;
  matrix->SetElement(3, 0, 0.125);
  this->actor->SetUserMatrix(matrix);
  this->expectLeftAndUnseen("projective");
}

TEST_F(Classification, TheMapperIsTakenAnewEachFrame)
{
  this->expectTraced();
  vtkNew<vtkPolyDataMapper> coarse; // as level-of-detail actors do
  coarse->SetInputData(makeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { { 0, 1, 2 } }));
  this->actor->SetMapper(coarse);
  EXPECT_EQ(this->update().triangleCount, 1u);
}

TEST_F(Classification, ActorsOutsideTheViewAreInTheSnapshot)
{
  this->actor->SetPosition(0, 0, 1e6); // behind the camera
  this->expectTraced();
}

} // anonymous namespace
