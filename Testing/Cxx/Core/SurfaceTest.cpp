// Surface points: sides, normals and colours as VTK's mapper has them, and rays that leave them.
#include "Rendering/Core/Structures/BvhStructure.h"
#include "Rendering/Core/Tracing/Surface.h"
#include "Scenes.h"

#include <gtest/gtest.h>

namespace
{

using namespace hrt;

const glm::dvec3 kDown(0, 0, -1);

// Front towards +z, normals tilted towards +x.
std::shared_ptr<Geometry> floorQuad()
{
  auto g = scenes::quad({ -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 });
  g->normals.values.assign(g->vertexCount(), glm::vec3(3, 0, 4)); // five long: not normalised
  return g;
}

SurfacePoint seen(const Snapshot& s, const glm::dvec3& origin, const glm::dvec3& direction)
{
  scenes::BruteForce structure;
  structure.update(s);
  Ray ray;
  ray.origin = origin;
  ray.direction = direction;
  const Hit hit = structure.intersect(ray);
  EXPECT_TRUE(hit.valid());
  return Surfaces(s).at(hit, direction);
}

TEST(Surface, SidesFollowTheWinding)
{
  Snapshot s;
  scenes::addPart(s, floorQuad());
  const SurfacePoint above = seen(s, { 0.5, 0.25, 1 }, kDown);
  EXPECT_EQ(above.position, glm::dvec3(0.5, 0.25, 0));
  EXPECT_TRUE(above.frontSide && above.outside);
  EXPECT_EQ(above.geometricNormal, glm::dvec3(0, 0, 1));
  // A normalised vector is off by two or three roundings.
  EXPECT_LT(glm::length(above.normal - glm::dvec3(0.6, 0, 0.8)), 4 * scenes::kDoubleRounding);
  const SurfacePoint below = seen(s, { 0.5, 0.25, -1 }, -kDown);
  EXPECT_FALSE(below.frontSide || below.outside);
  EXPECT_EQ(below.geometricNormal, glm::dvec3(0, 0, -1));
  EXPECT_LT(glm::length(below.normal + glm::dvec3(0.6, 0, 0.8)), 4 * scenes::kDoubleRounding);
}

TEST(Surface, MirroringSwapsSidesButNotOutside)
{
  Snapshot s;
  scenes::addPart(s, floorQuad(), glm::scale(glm::dmat4(1.0), { -1, 1, 1 }));
  const SurfacePoint above = seen(s, { 0.5, 0.25, 1 }, kDown);
  EXPECT_FALSE(above.frontSide); // as gl_FrontFacing
  EXPECT_TRUE(above.outside);
  EXPECT_EQ(above.geometricNormal, glm::dvec3(0, 0, 1));
}

TEST(Surface, NormalsTakeTheInverseTranspose)
{
  // Stretched by two along x, the normal (3, 0, 4) becomes (1.5, 0, 4).
  Snapshot s;
  scenes::addPart(s, floorQuad(), glm::scale(glm::dmat4(1.0), { 2, 1, 1 }));
  const glm::dvec3 expected = glm::normalize(glm::dvec3(1.5, 0, 4));
  EXPECT_LT(glm::length(seen(s, { 0.5, 0.25, 1 }, kDown).normal - expected),
    8 * scenes::kDoubleRounding);
}

TEST(Surface, BackfacePropertyOnlyWithoutScalars)
{
  auto colored = std::make_shared<Geometry>(*floorQuad());
  colored->version = 1000001;
  colored->colorSource = ColorSource::Corner;
  colored->colors.values.assign(colored->vertexCount(), glm::u8vec4(255, 0, 51, 102));
  Material material;
  material.front.diffuseColor = { 0, 1, 0 };
  material.front.diffuse = 0.5f;
  material.front.ambient = 0.25f;
  material.front.opacity = 0.5f;
  material.back = material.front;
  material.back.diffuseColor = { 0, 0, 1 };

  Snapshot plain, scalars;
  scenes::addPart(plain, floorQuad()).material = material;
  scenes::addPart(scalars, colored).material = material;
  EXPECT_EQ(seen(plain, { 0.5, 0, 1 }, kDown).colors.diffuse, glm::vec3(0, 0.5f, 0));
  EXPECT_EQ(seen(plain, { 0.5, 0, -1 }, -kDown).colors.diffuse, glm::vec3(0, 0, 0.5f));
  for (const glm::dvec3& direction : { kDown, -kDown })
  {
    const SurfacePoint p = seen(scalars, glm::dvec3(0.5, 0, 0) - direction, direction);
    // Interpolating three equal bytes and two products: under 8 roundings of numbers up to 1.
    const float tolerance = 8 * static_cast<float>(scenes::kFloatRounding);
    EXPECT_LT(glm::length(p.colors.diffuse - 0.5f * glm::vec3(1, 0, 0.2f)), tolerance);
    EXPECT_LT(glm::length(p.colors.ambient - 0.25f * glm::vec3(1, 0, 0.2f)), tolerance);
    EXPECT_NEAR(p.opacity, 0.5f * 0.4f, tolerance);
  }
}

TEST(Surface, LookupTakesTheNearestTexel)
{
  auto mapped = std::make_shared<Geometry>(*floorQuad());
  mapped->version = 1000002;
  mapped->colorSource = ColorSource::Lookup;
  mapped->lookupWidth = 4;
  mapped->lookupHeight = 1;
  mapped->lookup = { { 255, 0, 0, 255 }, { 0, 255, 0, 255 }, { 0, 0, 255, 255 },
    { 255, 255, 255, 0 } };
  for (const glm::vec3& p : mapped->positions)
  {
    mapped->coordinates.values.push_back({ 0.5f * (p.x + 1.0f), 0.5f });
  }
  Snapshot s;
  scenes::addPart(s, mapped);
  EXPECT_EQ(seen(s, { -0.75, 0, 1 }, kDown).diffuseColor, glm::vec3(1, 0, 0));
  EXPECT_EQ(seen(s, { -0.25, 0, 1 }, kDown).diffuseColor, glm::vec3(0, 1, 0));
  EXPECT_EQ(seen(s, { 0.25, 0, 1 }, kDown).diffuseColor, glm::vec3(0, 0, 1));
  EXPECT_EQ(seen(s, { 0.75, 0, 1 }, kDown).opacity, 0.0f);
}

// A floor under a texture of four texels: red, green, blue, and white with no opacity.
Part& addTexturedFloor(Snapshot& s)
{
  auto mapped = std::make_shared<Geometry>(*floorQuad());
  mapped->version = 1000003;
  for (const glm::vec3& p : mapped->positions)
  {
    mapped->textureCoordinates.values.push_back({ 0.5f * (p.x + 1.0f), 0.5f });
  }
  auto texture = std::make_shared<Texture>();
  texture->version = 1;
  texture->width = 4;
  texture->height = 1;
  texture->bytes = { { 255, 0, 0, 255 }, { 0, 255, 0, 255 }, { 0, 0, 255, 255 },
    { 255, 255, 255, 0 } };
  Part& part = scenes::addPart(s, mapped);
  part.material.textures.layers = { { texture, TextureBlend::None } };
  part.material.textures.alpha = Texture::Alpha::Holes;
  return part;
}

TEST(Surface, TexturesMultiplyWhatIsShaded)
{
  Snapshot s;
  Part& part = addTexturedFloor(s);
  part.material.front.diffuseColor = { 0.5f, 0.25f, 1.0f };
  part.material.front.opacity = 0.5f;
  const SurfacePoint p = seen(s, { -0.25, 0, 1 }, kDown);
  EXPECT_EQ(p.colors.diffuse, glm::vec3(0.5f, 0.25f, 1.0f)) << "lit without the texture";
  EXPECT_EQ(p.textureColor, glm::vec3(0, 1, 0));
  EXPECT_EQ(p.diffuseColor, glm::vec3(0, 0.25f, 0)) << "what glass is tinted with";
  EXPECT_EQ(p.opacity, 0.5f);
  EXPECT_EQ(seen(s, { 0.75, 0, 1 }, kDown).opacity, 0.0f);
  part.material.textures.onBack = false;
  EXPECT_EQ(seen(s, { -0.25, 0, -1 }, -kDown).textureColor, glm::vec3(1.0f));
}

TEST(Surface, PerforatedSurfacesAreThereOrNot)
{
  Snapshot s;
  addTexturedFloor(s).perforated = true;
  EXPECT_EQ(seen(s, { 0.25, 0, 1 }, kDown).opacity, 1.0f);
  EXPECT_EQ(seen(s, { 0.75, 0, 1 }, kDown).opacity, 0.0f);
  scenes::BruteForce structure;
  structure.update(s);
  for (const double x : { -0.75, -0.25, 0.25, 0.75 })
  {
    Ray ray;
    ray.origin = { x, 0.1, 1 };
    ray.direction = kDown;
    EXPECT_EQ(Surfaces(s).isHole(structure.intersect(ray), kDown), x == 0.75);
  }
}

// Between texels of full opacity a filter rounds; the surface stays opaque.
TEST(Surface, OpaqueTexturesLeaveTheOpacityAlone)
{
  Snapshot s;
  Part& part = addTexturedFloor(s);
  auto texture = std::make_shared<Texture>(*part.material.textures.layers[0].texture);
  texture->bytes[3].a = 255;
  texture->linear = true;
  part.material.textures.layers[0].texture = texture;
  part.material.textures.alpha = Texture::Alpha::Opaque;
  scenes::Random random(3);
  for (int i = 0; i < 1000; ++i)
  {
    ASSERT_EQ(seen(s, { random(-1, 1), random(-1, 1), 1 }, kDown).opacity, 1.0f);
  }
}

TEST(Surface, PrimaryHitMovesOntoTheTriangle)
{
  Snapshot s;
  scenes::addPart(s, floorQuad());
  Ray ray;
  ray.origin = { 1.0 + 1.0 / 512.0, -0.5, 1 }; // a rasteriser's 1/256 pixel beyond the border
  Hit hit;
  ASSERT_TRUE(primaryHit(s, 0, ray, hit));
  EXPECT_EQ(hit.triangle, 0u);
  EXPECT_EQ(hit.t, 1.0);
  const SurfacePoint p = Surfaces(s).at(hit, ray.direction);
  EXPECT_LE(p.position.x, 1.0);
  EXPECT_NEAR(p.position.x, 1.0, 1.0 / 512.0);
  Hit again;
  ASSERT_TRUE(Surfaces(s).primaryHit(0, ray, again));
  EXPECT_TRUE(again.t == hit.t && again.u == hit.u && again.v == hit.v);
  ray.direction = { 1, 0, 0 };
  EXPECT_FALSE(primaryHit(s, 0, ray, hit)); // edge-on
  ray.direction = { 0, 0, 1 };
  EXPECT_FALSE(primaryHit(s, 0, ray, hit)); // behind
}

// Rays that leave a flat quad on its diagonal, where the other triangle begins, meet neither of its
// triangles, whichever way the quad is turned.
TEST(Surface, LeavingRaysDoNotMeetTheirOwnPlane)
{
  scenes::Random random(9);
  for (int i = 0; i < 200; ++i)
  {
    Snapshot s;
    scenes::addPart(s, floorQuad(),
      glm::translate(glm::dmat4(1.0), random.inBox(10)) *
        glm::rotate(glm::dmat4(1.0), random(0, 6), random.direction()));
    BvhStructure structure;
    structure.update(s);
    for (int j = 0; j < 200; ++j)
    {
      const TriangleId id = static_cast<TriangleId>(j % 2);
      const double along = random(0, 1);
      const Hit hit{ id, 1.0, id ? along : 0.0, id ? 0.0 : along }; // on the diagonal
      const glm::dvec3 direction = random.direction();
      const SurfacePoint p = Surfaces(s).at(hit, direction);
      // Away from it, back where the ray came from, and on through it.
      ASSERT_FALSE(structure.intersect(leave(p, -direction)).valid());
      ASSERT_FALSE(structure.intersect(leave(p, direction)).valid());
    }
  }
}

} // namespace
