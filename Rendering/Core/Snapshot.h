// The snapshot is the one description of a scene that every engine reads: the OpenGL passes, the
// ray structures, the tracer and the tests. It is made from a vtkRenderer by Rendering/Scene and
// holds neither VTK nor GL types, so that everything below it can be tested and fuzzed alone.
//
// Coordinates. A Geometry keeps its vertices as floats relative to a double-precision origin of its
// own; a Part places it in the world by a double matrix. No engine ever sees a large coordinate in
// single precision: matrices are composed in double and only the product is rounded.
#pragma once

#include "Rendering/Core/Copies.h"
#include "Rendering/Core/Geometry/Geometry.h"
#include "Rendering/Core/Scene/Texture.h"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace hrt
{

// A triangle's number within the whole snapshot. Numbers follow the order of the parts and, within
// a part, the order of its geometry; the same order is used by the vertex buffer, the texture
// buffers, the ray structures and the buffers handed to the user.
using TriangleId = std::uint32_t;

// "No triangle" in every id buffer of the C++ side. On the GPU the id is stored plus one, so that
// a cleared buffer (zero) means no hit; hence at most 2^32 - 1 triangles.
inline constexpr TriangleId kNoTriangle = std::numeric_limits<TriangleId>::max();
inline constexpr std::uint64_t kMaximumTriangles = kNoTriangle;

// One side's reflection terms of vtkProperty. Ambient and diffuse coefficients are kept apart from
// the colours because scalar colours replace both colours but neither coefficient.
struct PhongTerms
{
  glm::vec3 ambientColor{ 1.0f };
  float ambient = 0.0f;
  glm::vec3 diffuseColor{ 1.0f };
  float diffuse = 1.0f;
  glm::vec3 specularColor{ 1.0f };
  float specular = 0.0f;
  float specularPower = 1.0f;
  float opacity = 1.0f;

  bool operator==(const PhongTerms& o) const
  {
    return ambientColor == o.ambientColor && ambient == o.ambient &&
      diffuseColor == o.diffuseColor && diffuse == o.diffuse && specularColor == o.specularColor &&
      specular == o.specular && specularPower == o.specularPower && opacity == o.opacity;
  }
  bool operator!=(const PhongTerms& o) const { return !(*this == o); }
};

// How the edges of cells are shown on a surface; see Surface/Edges.glsl.
struct EdgeStyle
{
  bool visible = false; // on a part whose geometry knows its sides
  glm::vec3 color{ 0.0f };
  float opacity = 1.0f; // of the edges over the surface
  float width = 1.0f;   // pixels
  bool tubes = false;   // lit as if they were tubes

  bool operator==(const EdgeStyle& o) const
  {
    return visible == o.visible && color == o.color && opacity == o.opacity &&
      width == o.width && tubes == o.tubes;
  }
};

// What physically based shading asks for beside the diffuse colour; see Surface/Pbr.glsl.
struct PhysicalTerms
{
  bool used = false; // else the surface is Phong's
  float metallic = 0.0f;
  float roughness = 0.5f;
  float f0 = 0.04f; // reflectance along the normal of what is no metal
  glm::vec3 edgeTint{ 1.0f };
  float coat = 0.0f; // strength
  float coatRoughness = 0.0f;
  float coatF0 = 0.0f;
  glm::vec3 coatColor{ 1.0f };

  bool operator==(const PhysicalTerms& o) const
  {
    return used == o.used && metallic == o.metallic && roughness == o.roughness && f0 == o.f0 &&
      edgeTint == o.edgeTint && coat == o.coat && coatRoughness == o.coatRoughness &&
      coatF0 == o.coatF0 && coatColor == o.coatColor;
  }
};

// By how much the camera is shown a surface farther away than it is: vtkMapper's polygon offset, in
// OpenGL's window depth, from 0 to 1. Camera rays alone ask.
struct DepthOffset
{
  float slope = 0.0f;    // of the depth's change from pixel to pixel
  float constant = 0.0f;

  bool any() const { return slope != 0.0f || constant != 0.0f; }
  bool operator==(const DepthOffset& o) const
  {
    return slope == o.slope && constant == o.constant;
  }
};

struct Material
{
  PhongTerms front;
  PhongTerms back;             // equal to front unless the actor has a backface property
  bool lit = true;             // vtkProperty::Lighting
  bool cullFront = false;      // hides sides from the camera only; rays see both sides
  bool cullBack = false;
  DepthOffset depthOffset;
  float reflectance = 0.0f;    // [0, 1]: share of the mirror image in the colour
  float indexOfRefraction = 0; // 0: not glass; else the ratio inside : outside, >= 1
  Textures textures;           // of a part whose geometry has texture coordinates
  EdgeStyle edges;
  PhysicalTerms physical;      // where the surface is lit

  bool isMirror() const { return reflectance > 0.0f; }
  bool isGlass() const { return indexOfRefraction > 0.0f; }
  bool needsSecondaryRays() const { return isMirror() || isGlass(); }

  bool operator==(const Material& o) const
  {
    return front == o.front && back == o.back && lit == o.lit && cullFront == o.cullFront &&
      cullBack == o.cullBack && depthOffset == o.depthOffset && reflectance == o.reflectance &&
      indexOfRefraction == o.indexOfRefraction && textures == o.textures &&
      edges == o.edges && physical == o.physical;
  }
  bool operator!=(const Material& o) const { return !(*this == o); }
};

// What a part comes from, for the user's buffers.
struct Source
{
  std::uint32_t prop = 0;  // number of the actor's path among those that have parts
  std::int64_t block = -1; // flat index in composite data; -1: none
};

// One placed geometry: in VTK's words, what one path to a vtkActor shows, or one block of it.
struct Part
{
  std::uint64_t key = 0;                    // the same for the same path and block in later frames
  Source source;
  std::shared_ptr<const Geometry> geometry; // never null
  std::shared_ptr<const Copies> copies;     // null: the geometry is there once
  glm::dmat4 localToWorld{ 1.0 };
  Material material;
  TriangleId firstTriangle = 0;             // id of its first triangle in the snapshot

  bool visibleToCamera = true; // in the object intersection buffer; else VTK draws the actor itself
  bool visibleToRays = true;   // seen by reflection and refraction rays
  bool castsShadow = true;     // and lets no light through
  // Casts one, but light may pass: where it is translucent or perforated it takes its share.
  bool tintsShadow = false;
  // Its textures have holes: there it does not exist, for camera, rays and light alike.
  bool perforated = false;

  // Whether it may look different from point to point for other reasons than light.
  bool hasDetail() const { return !material.textures.layers.empty() || showsEdges(); }
  bool showsEdges() const { return material.edges.visible && !geometry->sides.empty(); }

  // A shadow map knows depths, and holes in them, but no shares.
  bool castsShadowInMaps() const { return castsShadow || (perforated && tintsShadow); }

  // Nothing of it can shadow the rest of it.
  bool isFlat() const { return geometry->flat && !copies; }

  std::size_t copyCount() const { return copies ? copies->count() : 1; }
  // Of all copies together.
  std::uint64_t triangleCount() const
  {
    return std::uint64_t(geometry->triangleCount()) * this->copyCount();
  }
  // Of a triangle's number in the snapshot, which must be one of the part's: the copy, and the number
  // in the geometry.
  std::size_t copyOf(TriangleId id) const
  {
    return copies ? (id - firstTriangle) / geometry->triangleCount() : 0;
  }
  std::size_t indexOf(TriangleId id) const
  {
    const std::size_t index = id - firstTriangle;
    return copies ? index % geometry->triangleCount() : index;
  }

  // Maps Geometry::positions to the world: localToWorld, after the copy's matrix where there are
  // copies, with the geometry's origin folded in.
  glm::dmat4 positionsToWorld(std::size_t copy = 0) const
  {
    const glm::dmat4 place = copies ? localToWorld * copies->matrix(copy) : localToWorld;
    glm::dmat4 m = place;
    m[3] = place * glm::dvec4(geometry->origin, 1.0);
    return m;
  }
};

struct Light
{
  enum class Kind : std::uint8_t
  {
    Directional,
    Positional // point light, or spot light when coneAngle < 90
  };
  std::uint64_t key = 0;           // the same for the same vtkLight in later frames
  Kind kind = Kind::Directional;
  bool isHeadlight = false;        // moves with the camera and shines along its axis
  bool castsShadows = true;
  glm::dvec3 position{ 0.0 };      // world; for a directional light only a point on its axis
  glm::dvec3 direction{ 0, 0, -1 };// world, unit length, the way the light travels
  glm::vec3 color{ 1.0f };         // diffuse colour times intensity
  glm::vec3 attenuation{ 1, 0, 0 };// constant, linear, quadratic
  float coneAngle = 90.0f;         // half angle in degrees; >= 90: no cone
  float exponent = 0.0f;           // of the cosine to the axis within the cone

  bool isSpot() const { return kind == Kind::Positional && coneAngle < 90.0f; }
};

// The primary rays, from the composed matrices and never from a view angle, so that off-centre,
// tiled, stereo and explicit projections need no case of their own. For normalised device
// coordinates (x, y) in [-1, 1]:
//   origin = origin0 + x * originX + y * originY,  direction = direction0 + x * directionX + ...
// Directions are not normalised and point away from the viewer.
struct CameraRays
{
  glm::dvec3 origin0{ 0.0 }, originX{ 0.0 }, originY{ 0.0 };
  glm::dvec3 direction0{ 0, 0, -1 }, directionX{ 0.0 }, directionY{ 0.0 };

  glm::dvec3 origin(double x, double y) const { return origin0 + x * originX + y * originY; }
  glm::dvec3 direction(double x, double y) const
  {
    return direction0 + x * directionX + y * directionY;
  }
};

struct Camera
{
  glm::dmat4 worldToView{ 1.0 };
  glm::dmat4 viewToClip{ 1.0 }; // OpenGL clip space, z from -w to w
  bool parallel = false;
  int width = 0;                // pixels of the renderer's viewport
  int height = 0;

  // To pixels from the lower left corner of the viewport; depth stays.
  glm::dmat4 clipToWindow() const;
  // In view coordinates. See CameraRays.
  CameraRays viewRays() const;
  // In world coordinates relative to a point near the scene.
  CameraRays worldRays(const glm::dvec3& sceneOrigin) const;

  bool operator==(const Camera& o) const
  {
    return worldToView == o.worldToView && viewToClip == o.viewToClip && parallel == o.parallel &&
      width == o.width && height == o.height;
  }
};

// What a ray that leaves the scene sees. A gradient runs, in VTK, from the bottom to the top of the
// viewport; a ray sees it by its elevation over the camera's horizon (up: unit, world).
struct Background
{
  glm::vec3 bottom{ 0.0f };
  glm::vec3 top{ 0.0f };
  glm::vec3 up{ 0, 1, 0 };

  bool operator==(const Background& o) const
  {
    return bottom == o.bottom && top == o.top && up == o.up;
  }
};

// Cells refused at the scene's door, summed over the parts of one snapshot.
struct Refusals
{
  std::uint64_t nonFinitePoints = 0;    // triangles with a NaN, infinite or too large coordinate
  std::uint64_t invalidIndices = 0;     // triangles that name a point out of range
  std::uint64_t degenerateTriangles = 0;// zero area: two equal corners or three in a line
  std::uint64_t emptyParts = 0;         // no input, no points or no triangle left
  std::uint64_t singularMatrices = 0;   // parts whose matrix cannot be inverted or is not finite
  std::uint64_t outOfRangeParts = 0;    // parts whose points, or bounds in the world, exceed kLargestCoordinate

  std::uint64_t total() const
  {
    return nonFinitePoints + invalidIndices + degenerateTriangles + emptyParts +
      singularMatrices + outOfRangeParts;
  }
};

struct Snapshot
{
  std::vector<Part> parts;      // in the order of the renderer's props
  std::vector<Light> lights;    // only those that are switched on
  // VTK shades by a simpler formula when the only light is one headlight: see Shading.glsl.
  bool singleHeadlight = false;
  Camera camera;
  Background background;
  glm::dvec3 origin{ 0.0 };     // near the scene's centre; rays are traced relative to it
  glm::dvec3 boundsMin{ 0.0 };  // world box of all parts; min > max when empty
  glm::dvec3 boundsMax{ -1.0 };
  TriangleId triangleCount = 0;
  Refusals refusals;

  bool empty() const { return triangleCount == 0; }
  // The part that holds a triangle; the id must be below triangleCount.
  std::size_t partOf(TriangleId id) const;
  // Whether VTK draws the one after the other: the actors come in the order of the renderer's props.
  bool drawnAfter(TriangleId one, TriangleId other) const;
};

// What differs between two successive snapshots of one renderer.
struct Changes
{
  bool first = true;         // nothing earlier to compare with: everything counts as changed
  bool camera = true;        // matrices or the viewport's size
  bool geometry = true;      // parts added, removed, shown, hidden, or with a new Geometry
  bool transforms = true;    // some part's matrix, its Geometry unchanged
  bool materials = true;     // some part's material
  bool culling = true;       // some material shows other sides to the camera, or at another offset
  bool lightColors = true;   // colour, attenuation, exponent: no shadow map is touched
  bool background = true;
  // Per light of the new snapshot: its position, direction, cone or kind is new.
  std::vector<bool> lightMoved;
  bool lightCount = true;

  bool any() const
  {
    bool moved = false;
    for (bool m : lightMoved)
    {
      moved = moved || m;
    }
    return first || camera || geometry || transforms || materials || lightColors || background ||
      lightCount || moved;
  }
};

// Compares two snapshots; `before` may be null.
Changes compareSnapshots(const Snapshot* before, const Snapshot& now);

// World box of one part, from its local box; conservative (outward by nothing but rounding).
void worldBounds(const Part& part, glm::dvec3& lower, glm::dvec3& upper);

// Sets the bounds of the copies of a geometry, and of their matrices' numbers.
void boundCopies(const Geometry& geometry, Copies& copies);

} // namespace hrt
