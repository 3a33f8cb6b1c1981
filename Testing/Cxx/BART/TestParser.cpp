// Every command of AFF, from files as a user writes them and from short texts.
#include "BARTTest.h"

using namespace hrt::bart;

namespace
{

Scene everything()
{
  DiskFiles files;
  return readScene(HRT_TEST_DATA "/everything.aff", files);
}

} // anonymous namespace

TEST(Parser, ReadsViewBackgroundAmbientAndTimes)
{
  const Scene scene = everything();
  ASSERT_TRUE(scene.viewpoint.has_value());
  const Viewpoint& view = *scene.viewpoint;
  EXPECT_EQ(view.from, glm::dvec3(0, 1, 10));
  EXPECT_EQ(view.at, glm::dvec3(0));
  EXPECT_EQ(view.up, glm::dvec3(0, 1, 0));
  EXPECT_EQ(view.angle, 40.0);
  EXPECT_EQ(view.hither, 0.5);
  EXPECT_EQ(view.width, 320);
  EXPECT_EQ(view.height, 240);
  EXPECT_EQ(scene.background, glm::dvec3(0.1, 0.2, 0.3));
  EXPECT_EQ(scene.ambient, glm::dvec3(0.5));
  EXPECT_EQ(scene.startTime, 0.0);
  EXPECT_EQ(scene.endTime, 10.0);
  EXPECT_EQ(scene.frames, 101);
}

TEST(Parser, ReadsLightsWithAndWithoutColourAndName)
{
  const Scene scene = everything();
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].position, glm::dvec3(10, 20, 30));
  EXPECT_EQ(scene.lights[0].color, glm::dvec3(1));
  EXPECT_EQ(scene.lights[1].color, glm::dvec3(0.5, 0.25, 0.125));
  EXPECT_EQ(scene.lights[2].name, "lamp");
  expectNear(lightPositionAt(scene, poseAt(scene, 5.0), scene.lights[2], 5.0), { 5, 5, 0 });
}

TEST(Parser, ReadsBothKindsOfMaterial)
{
  const Scene scene = everything();
  ASSERT_EQ(scene.materials.size(), 2u);
  const Material &full = scene.materials[0], &simple = scene.materials[1];
  EXPECT_EQ(full.ambient, glm::dvec3(0.2, 0.4, 0.6));
  EXPECT_EQ(full.diffuse, glm::dvec3(0.1, 0.2, 0.3));
  EXPECT_EQ(full.specular, glm::dvec3(0.3, 0.6, 0.9));
  EXPECT_EQ(full.shininess, 25.0);
  EXPECT_EQ(simple.ambient, glm::dvec3(0));
  expectNear(simple.diffuse, { 0.8, 0.4, 0.2 });
  EXPECT_EQ(simple.specular, glm::dvec3(0.2));
  EXPECT_EQ(simple.transmittance, 0.9);
  EXPECT_EQ(simple.indexOfRefraction, 1.5);
}

TEST(Parser, AMaterialHoldsUntilTheNextAcrossBracesAndFiles)
{
  MemoryFiles files;
  files.files["main.aff"] = "s 0 0 0 1 x a { i 0 color.aff s 0 0 0 1 } s 0 0 0 1\n"
                            "fm 0 0 0 1 1 1 0 0 0 1 0 1 s 0 0 0 1 i 0 color.aff s 0 0 0 1";
  files.files["color.aff"] = "f 1 0 0 1 0 1 0 1";
  const Scene scene = readScene("main.aff", files);
  ASSERT_EQ(scene.instances.size(), 5u);
  EXPECT_EQ(scene.materials.size(), 2u) << "equal ones are one: the default is the fm";
  std::vector<int> used;
  for (const Instance& instance : scene.instances)
  {
    used.push_back(instance.material);
  }
  EXPECT_EQ(used, (std::vector<int>{ 0, 1, 1, 0, 1 }));
}

TEST(Parser, ReadsSpheresAndCones)
{
  const Scene scene = everything();
  ASSERT_EQ(scene.spheres.size(), 2u);
  EXPECT_EQ(scene.spheres[1].center, glm::dvec3(3, 0, 0));
  EXPECT_EQ(scene.spheres[1].radius, -1.0);
  ASSERT_EQ(scene.cones.size(), 1u);
  EXPECT_EQ(scene.cones[0].apex, glm::dvec3(0, 2, 0));
  EXPECT_EQ(scene.cones[0].baseRadius, 1.0);
  EXPECT_EQ(scene.cones[0].apexRadius, 0.5);
}

TEST(Parser, LooseFacesThatBelongTogetherBecomeOneMesh)
{
  // Two polygons; one with a normal; tt; ttp; twice (instances of) the two meshes of part.aff.
  const Scene scene = everything();
  ASSERT_EQ(scene.meshes.size(), 4u + 2u);
  const Mesh& polygons = scene.meshes[0];
  EXPECT_EQ(polygons.faceEnds, (std::vector<std::size_t>{ 4, 7 }));
  EXPECT_EQ(polygons.vertices.size(), 7u);
  EXPECT_EQ(polygons.corners[4].vertex, 4);
  EXPECT_EQ(polygons.corners[4].normal, kNone);
  EXPECT_EQ(countTriangles(polygons), 3u);
  EXPECT_EQ(scene.meshes[1].normals.size(), 3u);
  EXPECT_EQ(scene.meshes[2].texture, 0);
  EXPECT_EQ(scene.meshes[2].coordinates[2], glm::vec2(0, 1));
  EXPECT_EQ(scene.meshes[3].normals[0], glm::vec3(0, 0, 1));
}

TEST(Parser, ReadsMeshesWithTheIndicesInTheirOrder)
{
  const Scene scene = everything();
  const Mesh& square = scene.meshes[4];
  EXPECT_EQ(square.vertices.size(), 4u);
  EXPECT_EQ(square.texture, 0);
  ASSERT_EQ(square.corners.size(), 6u);
  EXPECT_TRUE(square.faceEnds.empty());
  EXPECT_EQ(square.corners[5].vertex, 3);
  EXPECT_EQ(square.corners[5].normal, 0);
  EXPECT_EQ(square.corners[5].coordinate, 3);
  EXPECT_EQ(scene.meshes[5].texture, kNone);
  EXPECT_EQ(scene.meshes[5].corners[1].normal, kNone);
}

TEST(Parser, AnIncludedMeshIsStoredOnceAndPlacedThreeTimes)
{
  const Scene scene = everything();
  std::vector<int> nodes;
  for (const Instance& instance : scene.instances)
  {
    if (instance.shape == Instance::Shape::Mesh && instance.index == 4)
    {
      nodes.push_back(instance.node);
    }
  }
  EXPECT_EQ(nodes, (std::vector<int>{ kNone, 1, 2 }));
  const TriangleCount count = countTriangles(scene);
  EXPECT_EQ(count.textured, 1u + 1u + 3u * 2u);
  EXPECT_EQ(count.all, count.textured + 3u + 1u + 1u + 3u) << "polygons, tpa, plain triangles";
}

TEST(Parser, FindsAnAnimatedTriangleAtAnyTime)
{
  const Scene scene = everything();
  ASSERT_EQ(scene.animatedTriangles.size(), 1u);
  const AnimatedTriangle& triangle = scene.animatedTriangles[0][0];
  EXPECT_EQ(cornersAt(triangle, -1.0).positions[1], glm::vec3(1, 0, 5));
  EXPECT_EQ(cornersAt(triangle, 2.5).positions[1], glm::vec3(1, 0, 5.5));
  EXPECT_EQ(cornersAt(triangle, 5.0).normals[0], glm::vec3(0, 0.5, 0.5));
  EXPECT_EQ(cornersAt(triangle, 99.0).positions[1], glm::vec3(1, 0, 7));
}

TEST(Parser, AnimatedTrianglesInARowAreOneSurface)
{
  const std::string triangle = "tpa 1 0  0 0 0 0 0 1  1 0 0 0 0 1  0 1 0 0 0 1\n";
  const Scene scene = parse(triangle + triangle + "x a {" + triangle + "}");
  ASSERT_EQ(scene.animatedTriangles.size(), 2u);
  EXPECT_EQ(scene.animatedTriangles[0].size(), 2u);
  EXPECT_EQ(countTriangles(scene).all, 3u);
}

TEST(Parser, ATriangleAtTwoPlacesAtOneTimeTakesTheLaterOne)
{
  const Scene scene = parse("tpa 3 0  0 0 0 0 0 1  1 0 0 0 0 1  0 1 0 0 0 1"
                            " 0  0 0 5 0 0 1  1 0 5 0 0 1  0 1 5 0 0 1"
                            " 1  0 0 9 0 0 1  1 0 9 0 0 1  0 1 9 0 0 1");
  EXPECT_EQ(cornersAt(scene.animatedTriangles[0][0], 0.0).positions[0].z, 5.0f);
}

TEST(Parser, BindsKeysByNameBeforeAndAfterTheirUse)
{
  const Scene scene = everything();
  ASSERT_EQ(scene.nodes.size(), 3u);
  EXPECT_TRUE(scene.nodes[0].animated);
  EXPECT_EQ(scene.animations[static_cast<std::size_t>(scene.nodes[0].animation)].name, "mover");
  EXPECT_FALSE(scene.nodes[1].animated);
  EXPECT_EQ(scene.nodes[1].parent, 0);
  EXPECT_TRUE(scene.nodes[2].animated);
  EXPECT_EQ(scene.nodes[2].animation, kNone);
  ASSERT_NE(scene.camera, kNone);
}

TEST(Parser, LaterKeysOfOneNameReplaceEarlierOnes)
{
  const std::string keys =
    "k a { transl 4 0 1 0 0 0 0 0  0 1 0 0 0 0 0  1 1 0 0 0 0 0  1 1 0 0 0 0 0 }";
  const Scene scene = parse(keys + " x a { s 0 0 0 1 } k a { visibility 1 0 0 }");
  expectNear(glm::dvec3(poseAt(scene, 0.5).toWorld[0][3]), glm::dvec3(0.0));
  EXPECT_FALSE(poseAt(scene, 0.5).visible[0]);
}

TEST(Parser, TransformsScaleThenTurnThenMove)
{
  const Scene scene = everything();
  // (1, 0, 0) -> scaled (2, 0, 0) -> turned (0, 2, 0) -> moved (1, 4, 3); then mover at time 0.
  const Pose pose = poseAt(scene, 0.0);
  expectNear(glm::dvec3(pose.toWorld[1] * glm::dvec4(1, 0, 0, 1)), { 1, 4, 3 });
}

TEST(Parser, InvisibilityCoversAllThatIsInside)
{
  const Scene scene = everything();
  EXPECT_TRUE(poseAt(scene, 7.9).visible[1]);
  EXPECT_FALSE(poseAt(scene, 8.5).visible[0]);
  EXPECT_FALSE(poseAt(scene, 8.5).visible[1]);
  EXPECT_TRUE(poseAt(scene, 8.5).visible[2]);
}

TEST(Parser, CameraKeysMoveTheViewpoint)
{
  const Scene scene = everything();
  Viewpoint view = viewpointAt(scene, 0.0);
  expectNear(view.from, { 0, 1, 10 });
  // Along -z, as far as the viewpoint looked.
  expectNear(view.at, { 0, 1, 10.0 - std::sqrt(101.0) });
  view = viewpointAt(scene, 10.0);
  expectNear(view.from, { 10, 1, 10 });
  expectNear(view.at, { 10.0 - std::sqrt(101.0), 1, 10 }, 1e-9);
  expectNear(view.up, { 0, 1, 0 });
}

TEST(Parser, WithoutCameraKeysTheViewpointStays)
{
  const Scene scene =
    parse("v from 1 2 3 at 0 0 0 up 0 1 0 angle 30 hither 0 resolution 10 20 x a { s 0 0 0 1 }");
  const Viewpoint view = viewpointAt(scene, 5.0);
  EXPECT_EQ(view.from, glm::dvec3(1, 2, 3));
  EXPECT_EQ(view.hither, 1.0) << "0 stands for a missing one";
}

TEST(Parser, TakesAnEmptyFileAndCommentsWithoutAnEndOfLine)
{
  EXPECT_TRUE(parse("").instances.empty());
  EXPECT_TRUE(parse("# s 0 0 0 1").instances.empty());
  EXPECT_EQ(parse("s 0 0 0 1%not 2\r\n# nor this\r\ns 0 0 0 1").spheres.size(), 2u);
}

TEST(Parser, TakesNumbersInAllTheirSpellings)
{
  const Scene scene = parse("s +1.5 -.25 1.e1 1E-2 s 1. 0 -0 2e+0");
  EXPECT_EQ(scene.spheres[0].center, glm::dvec3(1.5, -0.25, 10.0));
  EXPECT_EQ(scene.spheres[0].radius, 0.01);
  EXPECT_EQ(scene.spheres[1].radius, 2.0);
}

TEST(Parser, BracesNeedNoBlanks)
{
  EXPECT_EQ(parse("x a{s 0 0 0 1}x b{}").nodes.size(), 2u);
}

TEST(Parser, AFileMayBeIncludedAgainWhenItIsNotOpen)
{
  MemoryFiles files;
  files.files["main.aff"] = "i 0 a.aff i 0 b.aff i 0 a.aff";
  files.files["a.aff"] = "i 0 b.aff";
  files.files["b.aff"] = "s 0 0 0 1";
  EXPECT_EQ(readScene("main.aff", files).spheres.size(), 3u);
}

TEST(Parser, IncludesAreFoundBesideTheFileThatNamesThem)
{
  MemoryFiles files;
  files.files["scenes/main.aff"] = "i 0 parts/a.aff";
  files.files["scenes/parts/a.aff"] = "i 0 b.aff i 0 ../c.aff";
  files.files["scenes/parts/b.aff"] = "s 0 0 0 1";
  files.files["scenes/c.aff"] = "s 0 0 0 1";
  EXPECT_EQ(readScene("scenes/main.aff", files).spheres.size(), 2u);
}

TEST(Parser, DeepTransformsAreEvaluatedWithoutRecursion)
{
  std::string text;
  for (int i = 0; i < 1000; ++i)
  {
    text += "xs 1 1 1 0 0 1 0 1 0 0 {";
  }
  text += "s 0 0 0 1" + std::string(1000, '}');
  const Scene scene = parse(text);
  expectNear(glm::dvec3(poseAt(scene, 0.0).toWorld.back()[3]), { 1000, 0, 0 });
}
