// Actors met on paths through assemblies: composed matrices, visibility, keys and materials.
#include "SceneTest.h"

#include "vtkAssembly.h"
#include "vtkFollower.h"
#include "vtkProperty.h"
#include "vtkHybridMaterial.h"
#include "vtkInformation.h"
#include "vtkLODProp3D.h"
#include "vtkMatrix4x4.h"
#include "vtkPropAssembly.h"
#include "vtkTransform.h"

#include <cmath>

namespace
{

using Assemblies = SceneTest;

void expectMatrix(const glm::dmat4& a, vtkMatrix4x4* b, double tolerance)
{
  for (int i = 0; i < 4; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      EXPECT_NEAR(a[j][i], b->GetElement(i, j), tolerance) << i << " " << j;
    }
  }
}

TEST_F(Assemblies, AnActorsMatrixIsTaken)
{
  auto actor = this->addMesh(makeSquare());
  actor->SetPosition(1, 2, 3);
  actor->RotateX(30);
  actor->SetScale(2, 3, -4);
  expectMatrix(this->update().parts.at(0).localToWorld, actor->GetMatrix(), 0.0);
  EXPECT_LT(glm::determinant(glm::dmat3(this->snapshot->parts[0].localToWorld)), 0.0) << "mirrored";
}

TEST_F(Assemblies, UserTransformsAreTaken)
{
  auto actor = this->addMesh(makeSquare());
  vtkNew<vtkTransform> transform;
  actor->SetUserTransform(transform);
  this->update();
  transform->Translate(5, 6, 7); // the actor itself is not told
  EXPECT_EQ(this->update().parts.at(0).localToWorld[3], glm::dvec4(5, 6, 7, 1));
}

TEST_F(Assemblies, NestedMatricesAreComposed)
{
  auto leaf = makeActor(makeSquare());
  leaf->SetPosition(1, 0, 0);
  leaf->RotateZ(25);
  vtkNew<vtkAssembly> inner;
  inner->SetScale(-2, 1, 1);
  inner->RotateY(40);
  inner->AddPart(leaf);
  vtkNew<vtkAssembly> outer;
  outer->SetPosition(10, 20, 30);
  outer->RotateX(50);
  outer->AddPart(inner);
  this->renderer->AddActor(outer);

  vtkNew<vtkMatrix4x4> expected;
  vtkMatrix4x4::Multiply4x4(outer->GetMatrix(), inner->GetMatrix(), expected);
  vtkMatrix4x4::Multiply4x4(expected, leaf->GetMatrix(), expected);
  // Two products of four terms below 32, each rounded.
  const double tolerance = 8 * std::ldexp(32.0, -53);
  expectMatrix(this->update().parts.at(0).localToWorld, expected, tolerance);
  EXPECT_TRUE(this->scene->IsDrawnByTracer(outer));
  EXPECT_TRUE(this->scene->IsDrawnByTracer(leaf));

  leaf->SetPosition(2, 0, 0);
  vtkMatrix4x4::Multiply4x4(outer->GetMatrix(), inner->GetMatrix(), expected);
  vtkMatrix4x4::Multiply4x4(expected, leaf->GetMatrix(), expected);
  expectMatrix(this->update().parts.at(0).localToWorld, expected, tolerance);
}

TEST_F(Assemblies, OneActorOnTwoPathsIsTwoPartsWithOneGeometry)
{
  auto leaf = makeActor(makeSquare());
  vtkNew<vtkAssembly> assembly;
  assembly->SetPosition(5, 0, 0);
  assembly->AddPart(leaf);
  this->renderer->AddActor(leaf);
  this->renderer->AddActor(assembly);
  const hrt::Snapshot& s = this->update();
  ASSERT_EQ(s.parts.size(), 2u);
  EXPECT_NE(s.parts[0].key, s.parts[1].key);
  EXPECT_EQ(s.parts[0].geometry, s.parts[1].geometry);
  EXPECT_EQ(s.parts[1].localToWorld[3], glm::dvec4(5, 0, 0, 1));
  EXPECT_EQ(s.triangleCount, 4u);
  EXPECT_EQ(this->scene->GetProp(1), leaf.Get());
}

TEST_F(Assemblies, VisibilityHoldsAlongThePath)
{
  auto leaf = makeActor(makeSquare());
  vtkNew<vtkAssembly> inner;
  inner->AddPart(leaf);
  vtkNew<vtkAssembly> outer;
  outer->AddPart(inner);
  this->renderer->AddActor(outer);
  ASSERT_EQ(this->update().parts.size(), 1u);
  for (vtkProp* prop :
    { static_cast<vtkProp*>(outer), static_cast<vtkProp*>(inner), static_cast<vtkProp*>(leaf) })
  {
    prop->VisibilityOff();
    EXPECT_TRUE(this->update().parts.empty());
    EXPECT_FALSE(this->scene->IsDrawnByTracer(leaf));
    prop->VisibilityOn();
    EXPECT_EQ(this->update().parts.size(), 1u);
  }
}

TEST_F(Assemblies, OfPropsAreWalkedToo)
{
  auto leaf = makeActor(makeSquare());
  leaf->SetPosition(1, 2, 3);
  vtkNew<vtkPropAssembly> assembly;
  assembly->AddPart(leaf);
  this->renderer->AddViewProp(assembly);
  EXPECT_EQ(this->update().parts.at(0).localToWorld[3], glm::dvec4(1, 2, 3, 1));
  EXPECT_TRUE(this->scene->IsDrawnByTracer(assembly));
}

TEST_F(Assemblies, OtherPropsAreLeftToVTK)
{
  vtkNew<vtkLODProp3D> prop;
  this->renderer->AddViewProp(prop);
  EXPECT_TRUE(this->update().parts.empty());
  EXPECT_FALSE(this->scene->IsDrawnByTracer(prop));
}

TEST_F(Assemblies, FollowersFaceTheCameraAlsoInsideAssemblies)
{
  vtkNew<vtkFollower> follower;
  follower->SetMapper(makeActor(makeSquare())->GetMapper());
  follower->SetCamera(this->renderer->GetActiveCamera());
  vtkNew<vtkAssembly> assembly;
  assembly->SetPosition(0, 3, 0);
  assembly->AddPart(follower);
  this->renderer->AddActor(follower);
  this->renderer->AddActor(assembly);
  for (const glm::dvec3& eye : { glm::dvec3(0, 0, 9), glm::dvec3(9, 0, 0), glm::dvec3(-3, 5, -8) })
  {
    this->renderer->GetActiveCamera()->SetPosition(eye.x, eye.y, eye.z);
    const hrt::Snapshot& s = this->update();
    ASSERT_EQ(s.parts.size(), 2u);
    const glm::dvec3 facing(s.parts[0].localToWorld[2]);
    // A dozen roundings of numbers up to 1.
    EXPECT_LE(glm::length(facing - glm::normalize(eye)), 12 * std::ldexp(1.0, -53));
    EXPECT_EQ(glm::dmat3(s.parts[1].localToWorld), glm::dmat3(s.parts[0].localToWorld));
    EXPECT_EQ(s.parts[1].localToWorld[3], glm::dvec4(0, 3, 0, 1));
  }
}

TEST_F(Assemblies, HandTheirMaterialToPartsWithoutOne)
{
  auto plain = makeActor(makeSquare());
  auto own = makeActor(makeSquare());
  vtkNew<vtkAssembly> assembly;
  assembly->AddPart(plain);
  assembly->AddPart(own);
  this->renderer->AddActor(assembly);
  vtkHybridMaterial::SetReflectance(assembly, 0.5);
  vtkHybridMaterial::SetReflectance(own, 0.25);
  const hrt::Snapshot& s = this->update();
  ASSERT_EQ(s.parts.size(), 2u);
  EXPECT_EQ(s.parts[0].material.reflectance, 0.5f);
  EXPECT_EQ(s.parts[1].material.reflectance, 0.25f);
}

// VTK draws an assembly as a whole: where it has to draw one part, it draws all, and the tracer none.
TEST_F(Assemblies, WithOnePartLeftToVTKAreLeftWhole)
{
  auto plain = makeActor(makeSquare());
  auto pane = makeActor(makeSquare());
  pane->GetProperty()->SetOpacity(0.5);
  auto alone = makeActor(makeSquare());
  vtkNew<vtkAssembly> assembly;
  assembly->AddPart(plain);
  assembly->AddPart(pane);
  this->renderer->AddActor(assembly);
  this->renderer->AddActor(alone);
  const hrt::Snapshot& s = this->update();
  ASSERT_EQ(s.parts.size(), 3u);
  EXPECT_FALSE(s.parts[0].visibleToCamera);
  EXPECT_FALSE(s.parts[1].visibleToCamera);
  EXPECT_TRUE(s.parts[2].visibleToCamera);
  EXPECT_TRUE(s.parts[0].visibleToRays) << "mirrors show it all the same";
  EXPECT_FALSE(this->scene->IsDrawnByTracer(assembly));
  EXPECT_TRUE(this->scene->IsDrawnByTracer(alone));
}

// vtkAssembly replaces the keys of its parts by its own whenever it is drawn or asked.
TEST_F(Assemblies, MayNotTakeTheMirrorsOfTheirParts)
{
  auto mirror = makeActor(makeSquare());
  auto plain = makeActor(makeSquare());
  vtkNew<vtkAssembly> assembly;
  assembly->AddPart(mirror);
  assembly->AddPart(plain);
  this->renderer->AddActor(assembly);
  vtkHybridMaterial::SetReflectance(mirror, 0.75);
  for (int frame = 0; frame < 3; ++frame)
  {
    const hrt::Snapshot& s = this->update();
    EXPECT_EQ(s.parts.at(0).material.reflectance, 0.75f) << frame;
    EXPECT_EQ(s.parts.at(1).material.reflectance, 0.0f) << frame;
    assembly->HasTranslucentPolygonalGeometry();
    ASSERT_EQ(mirror->GetPropertyKeys(), nullptr) << "VTK no longer does this: the memory can go";
  }
  vtkHybridMaterial::Clear(mirror);
  EXPECT_EQ(this->update().parts.at(0).material.reflectance, 0.0f) << "cleared all the same";
}

} // anonymous namespace
