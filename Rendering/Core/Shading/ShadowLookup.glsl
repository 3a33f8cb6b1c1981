// The look-up in shadow maps, written once for both ray casters (paper, section 3): compiled into the GPU's
// fragment shader and, through ShadowLookup.h, into the tracer, which looks maps up that were read
// back. All positions are in the frame of ShadingFrame.h.
//
// Whoever includes it provides HRT_SHADOW_FACE(i), texel i of the table of faces (kFaceTexels a face),
// HRT_SHADOW_DEPTH(place), the depth stored at a texel of the atlas, and HRT_SHADOW_CLEAR, the depth
// where nothing was drawn.

#define HRT_FAR_AWAY real(1e30) // farther than any distance, its square within float

HRT_FUNCTION mat4 hrtShadowMatrix(int at)
{
  return mat4(HRT_SHADOW_FACE(at), HRT_SHADOW_FACE(at + 1), HRT_SHADOW_FACE(at + 2),
    HRT_SHADOW_FACE(at + 3));
}

// The distance from the light, or along it, of a stored depth.
HRT_FUNCTION real hrtShadowDistance(vec4 toDistance, real depth)
{
  return (toDistance.x + toDistance.y * depth) / (toDistance.z + toDistance.w * depth);
}

// Share of a light that reaches a point, from one face of its shadow map. The map's depth at a
// texel's centre is compared with the depth, on the same line of sight, of the plane of the
// receiving triangle: a plane never shadows itself, whatever its slope, and the bias only has to
// cover rounding and the bend between neighbouring facets (see ShadowLookup.h).
HRT_FUNCTION real hrtFaceVisibility(
  int at, vec4 clip, vec4 planeVC, real cosine, real eyeDistance, real folds)
{
  mat4 planeToClip = hrtShadowMatrix(at + 4);
  vec4 depthToDistance = HRT_SHADOW_FACE(at + 8);
  vec4 tile = HRT_SHADOW_FACE(at + 9);   // origin, size in texels, snapping in texels
  vec4 scale = HRT_SHADOW_FACE(at + 10); // texel: x + y * d; near plane; rounding: w * d^2
  vec4 plane = planeToClip * planeVC;

  vec2 ndc = vec2(clip.x, clip.y) / clip.w;
  vec2 texel = (ndc * real(0.5) + real(0.5)) * tile.z - real(0.5);
  vec2 corner = floor(texel);
  vec2 weight = texel - corner;
  real cosine2 = max(cosine * cosine, real(MINIMUM_COSINE2));
  // By so much the rasteriser may have drawn the plane's depth elsewhere.
  real snapping = (abs(plane.x) + abs(plane.y)) / abs(plane.z) * real(2.0) * tile.w / tile.z;
  real share[4];
  for (int k = 0; k < 4; ++k)
  {
    vec2 place = clamp(
      corner + vec2(real(k % 2), real(k / 2)), vec2(real(0.0)), vec2(tile.z - real(1.0)));
    real stored = HRT_SHADOW_DEPTH(ivec2(vec2(tile.x, tile.y) + place));
    share[k] = real(1.0);
    if (stored != HRT_SHADOW_CLEAR)
    {
      vec2 centre = (place + real(0.5)) / tile.z * real(2.0) - real(1.0);
      real depth = -(plane.x * centre.x + plane.y * centre.y + plane.w) / plane.z;
      real receiver = min(hrtShadowDistance(depthToDistance, depth - snapping),
        hrtShadowDistance(depthToDistance, depth + snapping));
      real occluder = hrtShadowDistance(depthToDistance, stored);
      // Beyond the horizon of the receiver's plane the line of sight never meets it.
      receiver =
        receiver < scale.z && depthToDistance.w != real(0.0) ? HRT_FAR_AWAY : receiver;
      real bias = folds * real(BEND) * (scale.x + scale.y * occluder) / cosine2 +
        real(ROUNDING) * (eyeDistance + abs(occluder)) + scale.w * occluder * occluder;
      share[k] = occluder < receiver - bias ? real(0.0) : real(1.0);
    }
  }
  // Written so that four equal shares give exactly that share.
  real low = share[0] + (share[1] - share[0]) * weight.x;
  real high = share[2] + (share[3] - share[2]) * weight.x;
  return low + (high - low) * weight.y;
}

// Share of a light, whose map has `faceCount` faces from `firstFace` on, that reaches point p of a
// triangle with unit normal ng on the viewer's side; folds: 0 where the whole part lies in one
// plane, else 1.
HRT_FUNCTION real hrtLightVisibility(
  int firstFace, int faceCount, HrtLight light, vec3 p, vec3 ng, real folds)
{
  if (faceCount == 0)
  {
    return real(1.0);
  }
  real cosine = -dot(ng, hrtLightDirectionAt(light, p));
  if (cosine <= real(0.0))
  {
    return real(0.0); // the surface turns its back to the light
  }
  vec4 planeVC = vec4(ng, -dot(ng, p));
  for (int face = 0; face < faceCount; ++face)
  {
    int at = (firstFace + face) * FACE_TEXELS;
    vec4 clip = hrtShadowMatrix(at) * vec4(p, real(1.0));
    // A point on the seam of two cube faces belongs to either; rounding must not lose it to both.
    real limit = clip.w * real(FACE_SEAM);
    if (clip.w > real(0.0) && abs(clip.x) <= limit && abs(clip.y) <= limit)
    {
      return hrtFaceVisibility(at, clip, planeVC, cosine, length(p), folds);
    }
  }
  return real(1.0); // outside of the map no caster stands between
}
