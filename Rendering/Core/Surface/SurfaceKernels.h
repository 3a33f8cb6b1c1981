// Surfaces and their light for eight points at once: what Tracing/Surface.h and Tracing/Lighting.h say of one
// point, for each instruction set that it is compiled for. The same operations in the same order, hence
// the same bits as there; the tests compare the two.
//
// Only what all points need is done here. Whatever depends on a point - colours by scalars, textures, edges,
// shadows - the caller does for each lane, and those lanes that are special it does alone.
#pragma once

#include "Rendering/Core/Structures/InstructionSet.h"

#include <cstdint>

namespace hrt
{

inline constexpr unsigned int kSurfaceLanes = 8;

// Lanes that are not wanted repeat one that is: nothing is computed that no point asks for.
struct alignas(64) SurfaceLanes
{
  template <class T>
  using Vectors = T[3][kSurfaceLanes];

  // Pixels' rays. In: the pixels' numbers; out: origin and direction.
  std::uint32_t pixel[kSurfaceLanes];

  // A ray and a triangle that it meets; the corners as they stand in the mesh, zero normals where there
  // are none. Matrices are column by column, of 4 x 4 and 3 x 3 numbers.
  alignas(64) Vectors<double> origin;
  alignas(64) Vectors<double> direction;
  alignas(64) Vectors<float> corner[3];
  alignas(64) Vectors<float> normal[3];
  const double* toScene[kSurfaceLanes];
  const double* normalsToScene[kSurfaceLanes];
  alignas(64) double t[kSurfaceLanes];
  alignas(64) double u[kSurfaceLanes];
  alignas(64) double v[kSurfaceLanes];

  // The surface: see SurfacePoint.
  alignas(64) Vectors<double> position;
  alignas(64) Vectors<double> geometricNormal;
  alignas(64) Vectors<double> shadingNormal;
  alignas(64) double positionError[kSurfaceLanes];
  unsigned int front;  // bits
  unsigned int smooth; // likewise: where corners' normals say more than the triangle
  unsigned int border; // likewise: the point is next to an edge

  alignas(64) Vectors<double> start;    // where rays leave from, but for the error
  alignas(64) Vectors<double> toViewer; // unit
  // In: whether all are seen from there, in the scene's coordinates, or else along their directions.
  bool seenFromEye;
  double eye[3];

  // Its light. In: all but the last.
  alignas(64) Vectors<float> diffuse;
  alignas(64) Vectors<float> specular;
  alignas(64) float power[kSurfaceLanes];
  alignas(64) Vectors<float> weight; // of the result in the pixel
  alignas(64) double twinReach[kSurfaceLanes];
  alignas(64) Vectors<float> portion;

  // Rays towards the light.
  alignas(64) Vectors<double> shadowOrigin;
  alignas(64) Vectors<double> shadowDirection;
  alignas(64) double shadowEnd[kSurfaceLanes]; // no length: nothing is between
  alignas(64) float twinEnd[kSurfaceLanes];
};

// The rays of a camera's pixels: CameraRays.
struct PixelRays
{
  double origin[3][3];    // of the middle, and what x and y add
  double direction[3][3]; // likewise
  double width, height;
};

// The rows of z and w of the matrix to clip space, from the scene's coordinates.
struct ClipRows
{
  double z[4], w[4];
};

// A light as shading and shadow rays take it, the same for all points.
struct LaneLight
{
  double position[3]; // relative to the scene's origin
  double directionOf[3];
  float direction[3];
  float color[3];
  float attenuation[3];
  float cosCone;
  float exponent;
  int kind;           // HRT_LIGHT_...
  bool positional;
  bool fromEye;       // shines from the camera's plane on
  double eye[3];
};

struct SurfaceKernels
{
  // Rays from pixels.
  void (*pixelRays)(const PixelRays& camera, SurfaceLanes& lanes);
  // Cuts rays from the camera by the near and the far plane: ClipPlanes::between. Moves their origins; `t`
  // becomes what is left of them. Bits of those of which something is.
  unsigned int (*clip)(const ClipRows& planes, SurfaceLanes& lanes);
  // ClipPlanes::depth at `t` of the rays, in `t`.
  void (*depths)(const ClipRows& planes, SurfaceLanes& lanes);
  // Where the rays meet their triangles: in their planes, moved into them, as primaryHit says it, or by the
  // exact test. Bits of those that do.
  unsigned int (*meet)(SurfaceLanes& lanes);
  unsigned int (*meetExactly)(SurfaceLanes& lanes);
  // The surfaces there, all but `start`, which is the position unless that is on the border.
  void (*surface)(SurfaceLanes& lanes);
  // What a light adds without shadow. Bits: where that is not zero.
  unsigned int (*shade)(const LaneLight& light, SurfaceLanes& lanes);
  // The rays to the light. Bits: where the point's side faces it; elsewhere there is no ray.
  unsigned int (*shadowRays)(const LaneLight& light, SurfaceLanes& lanes);
};

// One that the processor has.
const SurfaceKernels& surfaceKernelsFor(InstructionSet set);

// The best that it has.
InstructionSet bestInstructionSet();

} // namespace hrt
