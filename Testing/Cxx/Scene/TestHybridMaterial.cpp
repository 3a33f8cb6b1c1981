// The door of vtkHybridMaterial: what it keeps, what it refuses, and that a refusal changes
// nothing.
#include "SceneTest.h"

#include "vtkHybridMaterial.h"
#include "vtkInformation.h"

#include <limits>

namespace
{

const double kNaN = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

// Messages without an object go to the output window only; these tests look at the values.
struct SilentWarnings
{
  SilentWarnings() { vtkObject::GlobalWarningDisplayOff(); }
  ~SilentWarnings() { vtkObject::GlobalWarningDisplayOn(); }
};

TEST(HybridMaterial, DefaultsAreNoMirrorAndNoGlass)
{
  vtkNew<vtkActor> actor;
  EXPECT_EQ(vtkHybridMaterial::GetReflectance(actor), 0.0);
  EXPECT_EQ(vtkHybridMaterial::GetIndexOfRefraction(actor), 0.0);
  EXPECT_EQ(actor->GetPropertyKeys(), nullptr) << "asking must not add keys";
}

TEST(HybridMaterial, KeepsValuesOfTheWholeRange)
{
  vtkNew<vtkActor> actor;
  for (double r : { 0.0, 0.6, 1.0 })
  {
    vtkHybridMaterial::SetReflectance(actor, r);
    EXPECT_EQ(vtkHybridMaterial::GetReflectance(actor), r);
  }
  for (double index : { 1.0, 1.5, 2.42 })
  {
    vtkHybridMaterial::SetGlass(actor, index);
    EXPECT_EQ(vtkHybridMaterial::GetIndexOfRefraction(actor), index);
  }
  EXPECT_EQ(vtkHybridMaterial::GetReflectance(actor), 1.0) << "the two are independent";
}

TEST(HybridMaterial, RefusesBadReflectancesNamingTheActor)
{
  vtkNew<vtkActor> actor;
  vtkHybridMaterial::SetReflectance(actor, 0.25);
  Messages messages(actor);
  std::size_t expected = 0;
  for (double bad : { -1e-9, 1.0 + 1e-9, kNaN, kInfinity })
  {
    vtkHybridMaterial::SetReflectance(actor, bad);
    ASSERT_EQ(messages.errors.size(), ++expected) << bad;
    EXPECT_NE(messages.errors.back().find(addressOf(actor.GetPointer())), std::string::npos);
    EXPECT_EQ(vtkHybridMaterial::GetReflectance(actor), 0.25);
  }
}

TEST(HybridMaterial, RefusesBadIndicesNamingTheActor)
{
  vtkNew<vtkActor> actor;
  Messages messages(actor);
  std::size_t expected = 0;
  for (double bad : { 0.0, 0.999, -1.5, kNaN, kInfinity })
  {
    vtkHybridMaterial::SetGlass(actor, bad);
    ASSERT_EQ(messages.errors.size(), ++expected) << bad;
    EXPECT_NE(messages.errors.back().find(addressOf(actor.GetPointer())), std::string::npos);
    EXPECT_EQ(vtkHybridMaterial::GetIndexOfRefraction(actor), 0.0);
  }
}

TEST(HybridMaterial, ClearForgetsBothAndLeavesOtherKeys)
{
  vtkNew<vtkActor> actor;
  vtkNew<vtkInformation> keys;
  keys->Set(vtkProp::GeneralTextureUnit(), 3);
  actor->SetPropertyKeys(keys);
  vtkHybridMaterial::SetReflectance(actor, 0.5);
  vtkHybridMaterial::SetGlass(actor, 1.5);
  vtkHybridMaterial::Clear(actor);
  EXPECT_EQ(vtkHybridMaterial::GetReflectance(actor), 0.0);
  EXPECT_EQ(vtkHybridMaterial::GetIndexOfRefraction(actor), 0.0);
  EXPECT_EQ(actor->GetPropertyKeys()->Get(vtkProp::GeneralTextureUnit()), 3);
}

TEST(HybridMaterial, ANullPropIsAnErrorAndNoCrash)
{
  SilentWarnings silent;
  vtkHybridMaterial::SetReflectance(nullptr, 0.5);
  vtkHybridMaterial::SetGlass(nullptr, 1.5);
  vtkHybridMaterial::Clear(nullptr);
  EXPECT_EQ(vtkHybridMaterial::GetReflectance(nullptr), 0.0);
  EXPECT_EQ(vtkHybridMaterial::GetIndexOfRefraction(nullptr), 0.0);
}

} // anonymous namespace
