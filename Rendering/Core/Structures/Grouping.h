// Which parts of a snapshot share a ray structure. One structure over everything is the fastest to
// trace but must be built anew for every movement; one structure a part makes a movement cheap but
// lets a ray pay for every part whose box it meets. This is the policy between the two, a pure
// function of the snapshot and of what was decided before, for any kind of structure:
//
//   1. What rests is merged: all parts of the first snapshot, and later ones when they pay for it.
//   2. A merged part that moves or changes leaves. The merged structure is kept - whoever traces it
//      skips the part - until a quarter of it is gone.
//   3. A moving part stands alone, in coordinates of its own: a movement is a new matrix only.
//   4. A part that rests again joins after so many still updates, twice as many after each
//   departure,
//      and only when the merged structure is cheap to build or the joining parts are a fair share
//      of it.
//   5. Moving parts that share their space with many others (each ray would enter all of them) and
//      those too small to be worth a structure are put in one flat structure, built for each
//      movement.
//   6. A geometry of many copies is never multiplied: its parts stand alone and share one
//   structure. A part with copies of its own (Copies.h) stands alone, whatever its size and matrices.
//   7. A matrix that cannot be inverted to full precision has no place on its own: merged or flat.
//   8. A single resting part stands alone: that is as fast, and it may begin to move for free.
#pragma once

#include "Rendering/Core/Snapshot.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hrt
{

enum class Place : std::uint8_t
{
  None,   // no triangles, or neither seen by rays nor casting shadows
  Merged, // in scene coordinates, built rarely
  Flat,   // in scene coordinates, built whenever one of these parts moves
  Alone   // in its own coordinates, shared with other parts of the same geometry
};

inline constexpr std::size_t kNewPart = static_cast<std::size_t>(-1);

struct GroupedPart
{
  Place place = Place::None;
  // The part's number in the last snapshot, or kNewPart.
  std::size_t before = kNewPart;
  // The triangles are other ones than in the last update, but as many: a hierarchy may be refitted.
  bool deformed = false;

  // What the next decision is made from.
  std::uint64_t key = 0;
  std::uint64_t version = 0;
  std::size_t triangles = 0;
  glm::dmat4 positionsToWorld{ 1.0 };
  unsigned int stillUpdates = 0;
  unsigned int updatesToRest = 0;
};

struct Grouping
{
  std::vector<GroupedPart> parts; // one a part of the snapshot
  // The structures of these groups must be built from the parts now placed in them; otherwise the
  // earlier structure holds all of them (and, if Merged, perhaps some that have left).
  bool mergedAnew = false;
  bool flatAnew = false;
  std::size_t mergedTriangles = 0; // in the merged structure, those that have left included
};

// A part rests after so many updates without a change: at 30 frames a second half a second.
inline constexpr unsigned int kUpdatesToRest = 16;
// The number doubles with every departure up to this.
inline constexpr unsigned int kMostUpdatesToRest = 1024;
// A merged structure of so many triangles is built in about a hundredth of a second: any part may
// join.
inline constexpr std::size_t kCheapTriangles = 65536;
// A larger one is built anew when one in so many triangles would join or has left, so that the
// building of each triangle is paid for by a fixed number of changes.
inline constexpr std::size_t kFairShare = 4;
// More boxes than this around one point are a crowd: entering a structure costs about as much as
// going down it, and pieces cut out of a mesh, which touch but do not mix, stay well below.
inline constexpr std::size_t kCrowd = 8;
// Points that are looked at for a crowd, so that the search stays linear in the number of parts.
inline constexpr std::size_t kCrowdSamples = 256;
// Parts of no more triangles are a leaf, not a structure.
inline constexpr std::size_t kTinyPart = 8;
// Copies of a geometry may be merged up to so many triangles in all.
inline constexpr std::size_t kMostCopiedTriangles = 1u << 20;
// The ratio of a matrix' strongest to its weakest stretch up to which inverting it in double keeps
// errors 2^-10 below half an ulp of single precision, which is what hierarchies work in:
// 2^(53-24-10), and a few bits for the sums.
inline constexpr double kLargestCondition = 0x1p16;
// A refitted hierarchy whose expected cost has grown by more than this is better built anew.
inline constexpr double kWorstDecay = 1.3;

// `before` is the result for the last snapshot; empty at first.
Grouping groupParts(const Snapshot& snapshot, const Grouping& before);

} // namespace hrt
