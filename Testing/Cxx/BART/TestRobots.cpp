// BART's robots, the paper's third scene: what its authors say of it, and the same from our reader.
// Skipped, not passed, where the data are absent.
#include "BARTTest.h"

#include "vtkHybridBARTImporter.h"

#include "vtkActorCollection.h"
#include "vtkCamera.h"
#include "vtkNew.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

namespace
{

std::string robots()
{
  const char* chosen = std::getenv("HRT_DATA_ROOT");
  const std::string root = chosen && *chosen ? chosen : HRT_DEFAULT_DATA_ROOT;
  const std::string path = root + "/bart/robots/aff/Robot.aff";
  return std::filesystem::exists(path) ? path : std::string();
}

} // anonymous namespace

#define HRT_SKIP_WITHOUT_ROBOTS(path)                                                              \
  const std::string path = robots();                                                               \
  if (path.empty())                                                                                \
  {                                                                                                \
    GTEST_SKIP() << "scene data bart/robots/aff/Robot.aff is absent (see Data/README.md)";         \
  }

TEST(Robots, HaveTheFiguresOfTheBenchmark)
{
  HRT_SKIP_WITHOUT_ROBOTS(path);
  hrt::bart::DiskFiles files;
  const hrt::bart::Scene scene = hrt::bart::readScene(path, files);
  const hrt::bart::TriangleCount count = hrt::bart::countTriangles(scene);
  EXPECT_EQ(count.all, 71708u);
  EXPECT_EQ(count.textured, 65786u);
  EXPECT_EQ(scene.instances.size(), 1849u);
  EXPECT_EQ(scene.meshes.size(), 580u) << "stored once, whichever robot uses them";
  std::set<std::string> still;
  std::set<int> keys;
  int animated = 0;
  for (const hrt::bart::Node& node : scene.nodes)
  {
    animated += node.animated ? 1 : 0;
    if (node.animation != hrt::bart::kNone)
    {
      keys.insert(node.animation);
    }
    else if (node.animated)
    {
      still.insert(node.name);
    }
  }
  EXPECT_EQ(animated, 190);
  EXPECT_EQ(keys.size(), 185u);
  EXPECT_EQ(still,
    (std::set<std::string>{ "grip_lift1", "grip_rot1", "gun_lift2", "gun_rot2", "head_rot2" }));
  EXPECT_EQ(scene.animations.size(), 187u) << "also the camera and an old one";
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.frames, 800);
}

TEST(Robots, AreRightAtEveryFrame)
{
  HRT_SKIP_WITHOUT_ROBOTS(path);
  hrt::bart::DiskFiles files;
  const hrt::bart::Scene scene = hrt::bart::readScene(path, files);
  for (int frame = 0; frame < scene.frames; frame += 7)
  {
    const double time = scene.endTime * frame / (scene.frames - 1);
    const hrt::bart::Pose pose = hrt::bart::poseAt(scene, time);
    for (std::size_t i = 0; i < pose.toWorld.size(); ++i)
    {
      // No key scales: all that is scaled is each robot, by 2. Rigid motions keep the volume.
      const double volume = glm::determinant(glm::dmat3(pose.toWorld[i]));
      EXPECT_TRUE(std::abs(volume - 1.0) < 1e-9 || std::abs(volume - 8.0) < 1e-9) << volume;
      // The city's walls.
      EXPECT_LT(glm::length(glm::dvec3(pose.toWorld[i][3])), 1000.0);
    }
    const hrt::bart::Viewpoint view = hrt::bart::viewpointAt(scene, time);
    EXPECT_LT(std::abs(view.from.x), 164.0);
    EXPECT_GT(view.from.y, 0.0) << "above the street";
  }
}

TEST(Robots, BecomeActors)
{
  HRT_SKIP_WITHOUT_ROBOTS(path);
  for (bool textures : { true, false })
  {
    vtkNew<vtkHybridBARTImporter> importer;
    importer->SetFileName(path.c_str());
    importer->SetTextures(textures);
    ASSERT_TRUE(importer->Read());
    EXPECT_EQ(importer->GetActors()->GetNumberOfItems(), 1849);
    EXPECT_EQ(importer->GetNumberOfTriangles(), 71708);
    EXPECT_EQ(importer->GetNumberOfTexturedTriangles(), 65786);
    EXPECT_EQ(importer->GetNumberOfAnimatedTransforms(), 190);
    EXPECT_EQ(importer->GetNumberOfKeyedTransforms(), 185);
    EXPECT_EQ(importer->GetNumberOfFrames(), 800);
    EXPECT_EQ(importer->GetTimeRange()[0], 0.0);
    EXPECT_EQ(importer->GetTimeRange()[1], 50.0);
    EXPECT_EQ(importer->GetResolution()[0], 800);
    // The camera's keys at the first frame.
    EXPECT_EQ(importer->GetCamera()->GetPosition()[2], -203.0);
  }
}
