// The curves between an AFF scene's keys: Kochanek-Bartels splines for translations, scales and
// rotations, steps for visibility.
//
// D. Kochanek, R. Bartels: "Interpolating Splines with Local Tension, Continuity, and Bias
// Control", SIGGRAPH 1984. Key i with value P_i, time t_i, tension T, continuity C, bias B has the
// tangents
//
//   incoming  a_i ((1-T)(1-C)(1+B)/2 (P_i - P_{i-1}) + (1-T)(1+C)(1-B)/2 (P_{i+1} - P_i))
//   outgoing  b_i ((1-T)(1+C)(1+B)/2 (P_i - P_{i-1}) + (1-T)(1-C)(1-B)/2 (P_{i+1} - P_i))
//
// and each segment is the cubic with the values and tangents of its two ends (Hermite). With
// segments of unequal length, d_i = t_{i+1} - t_i, the factors a_i = 2 d_{i-1} / (d_{i-1} + d_i)
// and b_i = 2 d_i / (d_{i-1} + d_i) keep the speed in time the same on both sides of a key.
//
// Rotations follow the same formula with unit quaternions: the difference Q_{i+1} - Q_i becomes
// log(Q_i^-1 Q_{i+1}), the cubic becomes Shoemake's squad (D. Eberly: "Key Frame Interpolation via
// Splines and Quaternions"). Neighbouring quaternions are taken on the same half of the sphere, so
// that a segment turns by 180 degrees at most, whatever whole turns the angles of its keys hold.
//
// The first and the last key give tangents only: the curve runs from the second key to the last but
// one and stays there outside.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace hrt
{
namespace bart
{

// A curve needs both ends of one segment and a neighbour on either side.
constexpr std::size_t kFewestKeys = 4;

struct KeyShape
{
  double tension = 0.0;
  double continuity = 0.0;
  double bias = 0.0;
};

struct VectorKey
{
  double time = 0.0;
  glm::dvec3 value{ 0.0 };
  KeyShape shape;
};

struct RotationKey
{
  double time = 0.0;
  glm::dquat value{ 1.0, 0.0, 0.0, 0.0 };
  KeyShape shape;
};

struct VisibilityKey
{
  double time = 0.0;
  bool visible = true;
};

// Which segment a time falls into. Times should ascend; real files hold tables in which they once
// jump back (two tables written one after the other). The segment is then the first that ends later
// than the time, as in a search from the front, but found by bisection.
class Timeline
{
public:
  // The times of all keys, the first and last included.
  explicit Timeline(std::vector<double> times);

  struct Place
  {
    std::size_t segment = 0; // segment i runs from key i + 1 to key i + 2
    double u = 0.0;          // in [0, 1]
  };
  Place find(double time) const;

private:
  std::vector<double> Times;
  std::vector<double> LatestEnd; // of the segments up to and including this one
};

class VectorSpline
{
public:
  // At least kFewestKeys keys.
  explicit VectorSpline(const std::vector<VectorKey>& keys);
  glm::dvec3 at(double time) const;

private:
  struct Segment
  {
    glm::dvec3 start, startTangent, end, endTangent;
  };
  Timeline Line;
  std::vector<Segment> Segments;
};

class RotationSpline
{
public:
  // At least kFewestKeys keys; the values are of unit length.
  explicit RotationSpline(const std::vector<RotationKey>& keys);
  glm::dquat at(double time) const;

private:
  struct Segment
  {
    glm::dquat start, startControl, endControl, end;
  };
  Timeline Line;
  std::vector<Segment> Segments;
};

// Visible before the first key, then what the latest key says.
class VisibilityTrack
{
public:
  explicit VisibilityTrack(std::vector<VisibilityKey> keys);
  bool at(double time) const;

private:
  std::vector<VisibilityKey> Keys; // by ascending time
};

// The unit quaternion of a turn around an axis that need not be of unit length but must not be zero
// unless the angle is.
glm::dquat rotationAbout(const glm::dvec3& axis, double degrees);

} // namespace bart
} // namespace hrt
