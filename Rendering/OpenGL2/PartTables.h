// The small tables that change from frame to frame: each part's matrices and material and each
// light, in the frame of ShadingFrame.h, composed in double precision and only then rounded to float.
#pragma once

#include "Rendering/OpenGL2/ObjectPool.h"
#include "Rendering/OpenGL2/TextureBuffers.h"

#include "Rendering/Core/Shading/ShadowLookup.h"
#include "Rendering/Core/Snapshot.h"

#include <vector>

namespace hrt
{
namespace gl
{

// Layout of the tables; the same names are handed to the shaders as #defines.
//   part:   0-2 rows of the matrix from positions to the frame, 3-5 normals to the frame,
//           6-8 front: (ambient colour, ambient) (diffuse colour, diffuse) (specular, power),
//           9-11 back: the same, 12 (lit, folds, textures on the back, textures transformed),
//           13-15 rows x, y, w of the texture transform with (place of the textures' descriptions in
//           this table, their number, 0); the descriptions follow all parts: see TextureBuffers.h
//           16-17 edges: (colour, opacity) (width, one side is culled, tubes, 0)
//           18-20 physically based: (edge tint, roughness) (coat colour, coat)
//           (metallic, f0, coat roughness, coat f0), metallic -1 where it is not
//   layout: (first triangle, normals, colours, coordinates)
//           (lookup start, width, height, first vertex)
//           (normals of triangles, colours of triangles, texture coordinates, sides)
//           (place of the first triangle, triangles of a copy or 0: no copies, first texel of the
//           copies among the positions, texels a copy)
//   light:  (position, kind) (direction, cosine of the cone) (colour, exponent)
//           (attenuation, 0) (first shadow face, number of faces, 0, 0)
inline constexpr int kPartTexels = 21;
inline constexpr int kLayoutTexels = 4;
inline constexpr int kLightTexels = 5;

class PartTables
{
public:
  explicit PartTables(ObjectPool& pool);

  // The texture buffers must be up to date.
  void updateParts(const Snapshot& snapshot, const TextureBuffers& textures);
  void updateLights(const Snapshot& snapshot, const std::vector<ShadowSlot>& shadows);

  // part table, light table
  static constexpr int kUnits = 2;
  void bindTables(int firstUnit) const;

private:
  TextureBuffer Parts, Lights;
};

} // namespace gl
} // namespace hrt
