// The edges of cells on a surface: neighbours of triangles, and what a pixel sees near an edge.
#include "Rendering/Core/Geometry/Clipping.h"
#include "Rendering/Core/Surface/EdgeLookup.h"
#include "Rendering/Core/Tracing/Surface.h"
#include "Scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace hrt;

constexpr std::uint32_t kNone = kNoNeighbour;
using Three = std::array<std::uint32_t, 3>;

std::shared_ptr<Geometry> withSides(const std::vector<glm::vec3>& corners)
{
  auto mesh = std::make_shared<Geometry>(*scenes::makeGeometry(corners));
  mesh->sides.assign(mesh->triangleCount(), TriangleSides());
  connectSides(*mesh);
  return mesh;
}

TEST(Sides, NeighboursShareTheEndsOfASide)
{
  const auto mesh = withSides({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, //
    { 0, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, //
    { 5, 0, 0 }, { 6, 0, 0 }, { 5, 1, 0 } });
  EXPECT_EQ(mesh->sides[0].neighbours, (Three{ kNone, kNone, 1 }));
  EXPECT_EQ(mesh->sides[1].neighbours, (Three{ 0, kNone, kNone }));
  EXPECT_EQ(mesh->sides[2].neighbours, (Three{ kNone, kNone, kNone }));
}

// Meshes with creases repeat points; the sides are the same all the same.
TEST(Sides, PlacesCountNotVertices)
{
  Geometry mesh;
  mesh.positions = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { -0.0f, 0, 0 }, { 1, 1, -0.0f },
    { 0, 1, 0 } };
  mesh.triangles = { { 0, 1, 2 }, { 3, 4, 5 } };
  mesh.sides.assign(2, TriangleSides());
  connectSides(mesh);
  EXPECT_EQ(mesh.sides[0].neighbours, (Three{ kNone, kNone, 1 }));
  EXPECT_EQ(mesh.sides[1].neighbours, (Three{ 0, kNone, kNone }));
}

TEST(Sides, ThreeAtOneSidePairOffAsTheyCome)
{
  const auto mesh = withSides({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, //
    { 0, 0, 0 }, { 1, 0, 0 }, { 0, 0, 1 }, //
    { 0, 0, 0 }, { 1, 0, 0 }, { 0, -1, 0 } });
  EXPECT_EQ(mesh->sides[0].neighbours[0], 1u);
  EXPECT_EQ(mesh->sides[1].neighbours[0], 0u);
  EXPECT_EQ(mesh->sides[2].neighbours[0], kNone);
}

TEST(Sides, AClosedMeshHasNoOpenSide)
{
  Geometry mesh = *scenes::torus(24, 12, 2.0, 0.5);
  mesh.sides.assign(mesh.triangleCount(), TriangleSides());
  connectSides(mesh);
  for (std::uint32_t i = 0; i < mesh.triangleCount(); ++i)
  {
    for (const std::uint32_t other : mesh.sides[i].neighbours)
    {
      ASSERT_LT(other, mesh.triangleCount());
      const Three& back = mesh.sides[other].neighbours;
      ASSERT_TRUE(std::find(back.begin(), back.end(), i) != back.end());
    }
  }
}

// A cell of two triangles, 20 x 20 pixels, whose depth grows with y, and beyond its upper side another
// one that lies as the first but for a fold.
struct Window
{
  Geometry mesh;
  double fold = 1e-3; // the depth's gradient in the upper cell

  explicit Window(double lower = 1e-3, double upper = 1e-3)
    : fold(upper)
  {
    const auto point = [&](float x, float y) {
      return glm::vec3(x, y, y <= 20.0f ? lower * y : lower * 20.0 + upper * (y - 20.0));
    };
    this->mesh = *scenes::makeGeometry({ point(0, 0), point(20, 0), point(20, 20), //
      point(0, 0), point(20, 20), point(0, 20), //
      point(0, 20), point(20, 20), point(20, 40), //
      point(0, 20), point(20, 40), point(0, 40) });
    this->mesh.sides.assign(4, TriangleSides());
    connectSides(this->mesh);
    this->mesh.sides[0].edges = this->mesh.sides[2].edges = 1u | 2u; // not the diagonal
    this->mesh.sides[1].edges = this->mesh.sides[3].edges = 2u | 4u;
  }

  struct Seen
  {
    int triangle;
    glm::dvec2 uv;
    double mix;
  };
  Seen at(double x, double y, double width, int triangle, bool culled = false) const
  {
    const glm::dmat4 toWindow = glm::translate(glm::dmat4(1.0), { -x, -y, 0.0 });
    shading64::EdgeLookup lookup(this->mesh, toWindow);
    const auto hit = lookup.hrtEdgeHit(triangle, { 0.25, 0.25 }, width, culled);
    return { hit.triangle, hit.uv, lookup.hrtEdgeMix(hit.nearest.z, width) };
  }
};

TEST(Edges, AreHalfTheirWidthOnEitherSideAndFadeOverAPixel)
{
  const Window window;
  const struct
  {
    double y, width, mix;
  } table[] = { { 0.0, 3.0, 1.0 }, { 1.0, 3.0, 1.0 }, { 1.25, 3.0, 0.75 }, { 1.5, 3.0, 0.5 },
    { 2.0, 3.0, 0.0 }, { 0.05, 1.1, 1.0 }, { 0.55, 1.1, 0.5 }, { 1.1, 1.1, 0.0 } };
  for (const auto& row : table)
  {
    EXPECT_NEAR(window.at(10, row.y, row.width, 0).mix, row.mix, 1e-12) << row.y;
  }
}

TEST(Edges, DiagonalsOfCellsAreNone)
{
  const Window window;
  EXPECT_EQ(window.at(10.001, 10, 3.0, 0).mix, 0.0);
  EXPECT_EQ(window.at(9.999, 10, 3.0, 1).mix, 0.0);
  EXPECT_EQ(window.at(1.0, 10, 3.0, 1).mix, 1.0) << "the cell's border";
}

// The nearer of two triangles reaches over their common side by less than a quarter of the width.
TEST(Edges, TheNearerTriangleShowsBeyondItsSide)
{
  const Window window; // the lower cell is nearer
  EXPECT_EQ(window.at(10, 20.1, 1.1, 2).triangle, 1);
  EXPECT_EQ(window.at(10, 20.1, 1.1, 2).mix, 1.0);
  EXPECT_EQ(window.at(10, 20.4, 1.1, 2).triangle, 2);
  EXPECT_NEAR(window.at(10, 20.4, 1.1, 2).mix, 0.65, 1e-12);
  EXPECT_EQ(window.at(10, 19.9, 1.1, 1).triangle, 1) << "its own side of it";
  const Window turned(-1e-3, -1e-3);
  EXPECT_EQ(turned.at(10, 20.1, 1.1, 2).triangle, 2);
  EXPECT_NEAR(turned.at(10, 20.1, 1.1, 2).mix, 0.95, 1e-12);
  EXPECT_EQ(turned.at(10, 19.9, 1.1, 1).triangle, 2);
}

TEST(Edges, OfEqualDepthsTheLastOneIsSeen)
{
  const Window facing(0.0, 0.0);
  EXPECT_EQ(facing.at(10, 20.1, 1.1, 2).triangle, 2);
  EXPECT_EQ(facing.at(10, 19.9, 1.1, 1).triangle, 2);
}

TEST(Edges, CulledSidesReachNowhere)
{
  Window folded(1e-3, -1e-3);
  for (glm::vec3& p : folded.mesh.positions)
  {
    p.y = p.y > 20.0f ? 40.0f - p.y : p.y; // the upper cell folded down: its back is seen
  }
  EXPECT_EQ(folded.at(10, 19.9, 1.1, 1, false).triangle, 2) << "nearer, and drawn last";
  EXPECT_EQ(folded.at(10, 19.9, 1.1, 1, true).triangle, 1);
}

// What is interpolated is stretched with the widened triangle: at its own corners are those of the
// triangle, and nothing is lost where the line has no width.
TEST(Edges, BarycentricsAreThoseOfTheWidenedTriangle)
{
  const Window window;
  const Window::Seen thin = window.at(15, 5, 1e-9, 0);
  EXPECT_NEAR(thin.uv.x, 0.5, 1e-9); // (15, 5) = 1/4 a + 1/2 b + 1/4 c
  EXPECT_NEAR(thin.uv.y, 0.25, 1e-9);
  const Window::Seen wide = window.at(20, 0, 4.0, 0); // the corner b; widened, it lies 1 pixel further
  EXPECT_LT(wide.uv.x, 1.0);
  EXPECT_GT(wide.uv.x, 0.9);
}

TEST(Edges, PerspectiveIsTakenIntoAccount)
{
  Geometry mesh = *scenes::makeGeometry({ { -1, -1, 2 }, { 1, -1, 2 }, { 0, 1, 6 } });
  mesh.sides.assign(1, TriangleSides());
  connectSides(mesh);
  // x and y are divided by z; 100 pixels a unit. The point (0, 0, 4), half way up, is seen at (0, 0).
  glm::dmat4 toWindow(0.0);
  toWindow[0][0] = toWindow[1][1] = 100.0;
  toWindow[2][2] = 0.1;
  toWindow[2][3] = 1.0;
  shading64::EdgeLookup lookup(mesh, toWindow);
  const auto hit = lookup.hrtEdgeHit(0, { 0.0, 0.0 }, 1e-9, false);
  EXPECT_NEAR(hit.uv.x, 0.25, 1e-9);
  EXPECT_NEAR(hit.uv.y, 0.5, 1e-9);
}

// Lines behind the viewer have no place in the window; the triangle is taken as it is.
TEST(Edges, CornersBehindTheViewerDoNoHarm)
{
  Geometry mesh = *scenes::makeGeometry({ { -1, -1, 2 }, { 1, -1, 2 }, { 0, 1, -6 } });
  mesh.sides.assign(1, TriangleSides());
  mesh.sides[0].edges = 7;
  connectSides(mesh);
  glm::dmat4 toWindow(0.0);
  toWindow[0][0] = toWindow[1][1] = 100.0;
  toWindow[2][2] = 0.1;
  toWindow[2][3] = 1.0;
  toWindow[3][1] = 40.0; // the lower side is seen 5 pixels below the centre: (-100 + 40) / 2 + 25
  shading64::EdgeLookup lookup(mesh, glm::translate(glm::dmat4(1.0), { 0, 25, 0 }) * toWindow);
  const auto hit = lookup.hrtEdgeHit(0, { 0.3, 0.2 }, 3.0, false);
  EXPECT_EQ(hit.triangle, 0);
  EXPECT_EQ(hit.uv, glm::dvec2(0.3, 0.2));
  EXPECT_TRUE(std::isfinite(hit.nearest.z));
  EXPECT_NEAR(std::abs(hit.nearest.z), 5.0, 1e-9);
}

// A unit square 10 before a camera with 90 degrees over 200 pixels: a pixel is 0.1 there.
struct Scene
{
  Snapshot snapshot;
  Scene()
  {
    auto square = std::make_shared<Geometry>(
      *scenes::quad({ -5, -5, 0 }, { 5, -5, 0 }, { 5, 5, 0 }, { -5, 5, 0 }));
    square->version = 1000010;
    square->sides.assign(2, TriangleSides());
    connectSides(*square);
    square->sides[0].edges = 1u | 2u;
    square->sides[1].edges = 2u | 4u;
    Part& part = scenes::addPart(this->snapshot, square);
    part.material.front.ambient = 0.0f;
    part.material.front.diffuse = 0.5f;
    part.material.back = part.material.front;
    part.material.edges.visible = true;
    part.material.edges.color = { 1.0f, 0.0f, 0.0f };
    part.material.edges.width = 2.0f;
    this->snapshot.camera = scenes::perspective({ 0, 0, 10 }, { 0, 0, 0 }, 200, 200, 90.0);
  }

  SurfacePoint seenFrom(double x, double way) const
  {
    Hit hit;
    Ray ray;
    ray.origin = { x, -1, 10 };
    EXPECT_TRUE(primaryHit(this->snapshot, x > -1 ? 0 : 1, ray, hit));
    return Surfaces(this->snapshot).seenFrom(hit, ray.direction, { way, 1.0 });
  }
};

TEST(Edges, OnTheWayOverMirrorsAreAsWideAsInTheWindow)
{
  const Scene scene;
  for (const double way : { 10.0, 40.0 })
  {
    const double pixel = 0.01 * way;
    EXPECT_NEAR(scene.seenFrom(5 - 0.25 * pixel, way).edgeShare, 1.0, 1e-6);
    EXPECT_NEAR(scene.seenFrom(5 - 1.0 * pixel, way).edgeShare, 0.5, 1e-6);
    EXPECT_NEAR(scene.seenFrom(5 - 1.25 * pixel, way).edgeShare, 0.25, 1e-6);
    EXPECT_EQ(scene.seenFrom(5 - 1.75 * pixel, way).edgeShare, 0.0f);
  }
}

TEST(Edges, AreAmbientLightOverTheSurface)
{
  Scene scene;
  scene.snapshot.parts[0].material.edges.opacity = 0.5f;
  const SurfacePoint p = scene.seenFrom(5 - 0.01, 10.0);
  EXPECT_EQ(p.edgeShare, 0.5f);
  EXPECT_EQ(p.colors.diffuse, glm::vec3(0.25f));
  EXPECT_EQ(p.colors.ambient, glm::vec3(0.5f, 0.0f, 0.0f));
  EXPECT_EQ(p.normal, p.geometricNormal);
}

TEST(Edges, TubesAreLitAsTubes)
{
  Scene scene;
  scene.snapshot.parts[0].material.edges.tubes = true;
  scene.snapshot.parts[0].material.front.ambient = 0.25f;
  // On the edge itself the tube's normal is the surface's; beside it it leans away from the edge ...
  const SurfacePoint middle = scene.seenFrom(5.0, 10.0);
  EXPECT_EQ(middle.colors.diffuse, glm::vec3(0.5f, 0.0f, 0.0f));
  EXPECT_EQ(middle.colors.ambient, glm::vec3(0.25f, 0.0f, 0.0f));
  EXPECT_LT(glm::length(middle.normal - glm::dvec3(0, 0, 1)), 1e-9);
  const SurfacePoint beside = scene.seenFrom(5.0 - 0.05, 10.0); // half a pixel, of a radius of one
  EXPECT_NEAR(beside.normal.x, -0.5, 1e-9);
  EXPECT_NEAR(beside.normal.z, std::sqrt(0.75), 1e-9);
}

TEST(Edges, AreSeenAtAPixelAsByRaysAlongIt)
{
  const Scene scene;
  const Surfaces surfaces(scene.snapshot);
  for (int column = 140; column < 152; ++column)
  {
    const glm::dvec2 centre(column + 0.5, 90.5);
    const glm::dvec3 direction((centre.x - 100) / 100, (centre.y - 100) / 100, -1);
    Ray ray;
    ray.origin = { 0, 0, 10 };
    ray.direction = direction;
    Hit hit;
    ASSERT_TRUE(primaryHit(scene.snapshot, 0, ray, hit));
    Surfaces::Located where;
    const auto pixel = static_cast<std::uint32_t>(90 * scene.snapshot.camera.width + column);
    const SurfacePoint p = surfaces.seenAtPixel(hit, direction, pixel, where);
    EXPECT_NEAR(p.edgeShare, std::clamp(1.5 - (150.0 - centre.x), 0.0, 1.0), 1e-6) << column;
  }
}

// Cut by a plane, the pieces keep what was an edge; the cut is none.
TEST(Edges, ClippingKeepsThem)
{
  const Scene scene;
  const Geometry& whole = *scene.snapshot.parts[0].geometry;
  const Geometry left = clipped(whole, { glm::dvec4(-1, 0, 0, 2) }); // x <= 2
  ASSERT_EQ(left.sides.size(), left.triangleCount());
  int edges = 0, open = 0;
  for (std::size_t i = 0; i < left.triangleCount(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      const glm::vec3 a = left.cornerPositions(i)[static_cast<std::size_t>(k)];
      const glm::vec3 b = left.cornerPositions(i)[static_cast<std::size_t>((k + 1) % 3)];
      const bool onBorder = (a.x == -5 && b.x == -5) || (a.y == b.y && std::abs(a.y) == 5);
      EXPECT_EQ(left.sides[i].isEdge(k), onBorder);
      edges += left.sides[i].isEdge(k) ? 1 : 0;
      open += left.sides[i].neighbours[static_cast<std::size_t>(k)] == kNone ? 1 : 0;
    }
  }
  EXPECT_EQ(edges, 3) << "the left side and what is left of the lower and the upper one";
  EXPECT_GE(open, 4) << "these and the cut";
  // Through the diagonal's ends nothing is cut, and nothing may be marked that was not.
  const Geometry half = clipped(whole, { glm::dvec4(1, -1, 0, 0) }); // below the diagonal
  ASSERT_EQ(half.triangleCount(), 1u);
  EXPECT_EQ(half.sides[0].edges, 3u);
}

} // namespace
