// Implements the key curves. All tangents are computed once, so that evaluating is a bisection and
// a cubic.
#include "IO/BART/AFF/Spline.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace hrt
{
namespace bart
{
namespace
{

// Below this sine of an angle x, x / sin(x) differs from 1 by x^2 / 6, less than half a unit in the
// last place of a double (x^2 / 6 < 2^-53 for x < 2.5e-8).
constexpr double kTinySine = 2e-8;

//------------------------------------------------------------------------------
// A quaternion's logarithm is a vector: half the angle times the axis.
glm::dvec3 logarithm(const glm::dquat& q)
{
  const glm::dvec3 v(q.x, q.y, q.z);
  const double sine = glm::length(v);
  return sine < kTinySine ? v : v * (std::atan2(sine, q.w) / sine);
}

//------------------------------------------------------------------------------
glm::dquat exponential(const glm::dvec3& v)
{
  const double angle = glm::length(v);
  const glm::dvec3 xyz = angle < kTinySine ? v : v * (std::sin(angle) / angle);
  return glm::normalize(glm::dquat(std::cos(angle), xyz.x, xyz.y, xyz.z));
}

//------------------------------------------------------------------------------
// From a (u = 0) to b (u = 1), along the way that their signs say: squad needs it without the turn
// to the shorter way that glm::slerp makes.
glm::dquat turn(const glm::dquat& a, const glm::dquat& b, double u)
{
  return a * exponential(u * logarithm(glm::conjugate(a) * b));
}

//------------------------------------------------------------------------------
// Where the table's times jump back, the length of the jump stands in for the missing segment.
double span(double from, double to)
{
  return std::abs(to - from);
}

//------------------------------------------------------------------------------
// The factor of the tangent that belongs to the segment of length own, when the one on the other
// side of the key has the length other.
double speedFactor(double own, double other)
{
  return own + other > 0.0 ? 2.0 * own / (own + other) : 1.0;
}

//------------------------------------------------------------------------------
// The formulas at the head of Spline.h; before and after are the differences to the neighbours.
glm::dvec3 incoming(const KeyShape& k, const glm::dvec3& before, const glm::dvec3& after)
{
  const double loose = 0.5 * (1.0 - k.tension);
  return loose * (1.0 - k.continuity) * (1.0 + k.bias) * before +
    loose * (1.0 + k.continuity) * (1.0 - k.bias) * after;
}

//------------------------------------------------------------------------------
glm::dvec3 outgoing(const KeyShape& k, const glm::dvec3& before, const glm::dvec3& after)
{
  const double loose = 0.5 * (1.0 - k.tension);
  return loose * (1.0 + k.continuity) * (1.0 + k.bias) * before +
    loose * (1.0 - k.continuity) * (1.0 - k.bias) * after;
}

//------------------------------------------------------------------------------
template <typename Key>
std::vector<double> timesOf(const std::vector<Key>& keys)
{
  std::vector<double> times;
  times.reserve(keys.size());
  for (const Key& key : keys)
  {
    times.push_back(key.time);
  }
  return times;
}

//------------------------------------------------------------------------------
struct Tangents
{
  glm::dvec3 start, end;
};

// The tangents of the segment from key i to key i + 1; differences[i] leads from key i to key i
// + 1.
template <typename Key>
Tangents tangentsOf(
  const std::vector<Key>& keys, const std::vector<glm::dvec3>& differences, std::size_t i)
{
  const double before = span(keys[i - 1].time, keys[i].time);
  const double own = span(keys[i].time, keys[i + 1].time);
  const double after = span(keys[i + 1].time, keys[i + 2].time);
  return { speedFactor(own, before) * outgoing(keys[i].shape, differences[i - 1], differences[i]),
    speedFactor(own, after) * incoming(keys[i + 1].shape, differences[i], differences[i + 1]) };
}

} // anonymous namespace

//------------------------------------------------------------------------------
Timeline::Timeline(std::vector<double> times)
  : Times(std::move(times))
{
  for (std::size_t key = 2; key + 1 < this->Times.size(); ++key)
  {
    const double latest = this->LatestEnd.empty() ? this->Times[key] : this->LatestEnd.back();
    this->LatestEnd.push_back(std::max(latest, this->Times[key]));
  }
}

//------------------------------------------------------------------------------
Timeline::Place Timeline::find(double time) const
{
  if (!(time > this->Times[1]))
  {
    return { 0, 0.0 };
  }
  const auto end = std::upper_bound(this->LatestEnd.begin(), this->LatestEnd.end(), time);
  if (end == this->LatestEnd.end())
  {
    return { this->LatestEnd.size() - 1, 1.0 };
  }
  // No segment before this one ends later than the time: this one has begun.
  const std::size_t segment = static_cast<std::size_t>(end - this->LatestEnd.begin());
  const double begin = this->Times[segment + 1];
  return { segment, (time - begin) / (this->Times[segment + 2] - begin) };
}

//------------------------------------------------------------------------------
VectorSpline::VectorSpline(const std::vector<VectorKey>& keys)
  : Line(timesOf(keys))
{
  std::vector<glm::dvec3> differences;
  for (std::size_t i = 0; i + 1 < keys.size(); ++i)
  {
    differences.push_back(keys[i + 1].value - keys[i].value);
  }
  for (std::size_t i = 1; i + 2 < keys.size(); ++i)
  {
    const Tangents tangents = tangentsOf(keys, differences, i);
    this->Segments.push_back({ keys[i].value, tangents.start, keys[i + 1].value, tangents.end });
  }
}

//------------------------------------------------------------------------------
glm::dvec3 VectorSpline::at(double time) const
{
  const Timeline::Place place = this->Line.find(time);
  const Segment& s = this->Segments[place.segment];
  const double u = place.u, v = 1.0 - u;
  // Hermite's basis. At u = 0 and 1 it gives the keys' values exactly.
  return v * v * (1.0 + 2.0 * u) * s.start + u * u * (1.0 + 2.0 * v) * s.end +
    u * v * v * s.startTangent - u * u * v * s.endTangent;
}

//------------------------------------------------------------------------------
RotationSpline::RotationSpline(const std::vector<RotationKey>& keys)
  : Line(timesOf(keys))
{
  std::vector<glm::dquat> turns;
  std::vector<glm::dvec3> differences;
  for (const RotationKey& key : keys)
  {
    const bool sameHalf = turns.empty() || glm::dot(turns.back(), key.value) >= 0.0;
    turns.push_back(sameHalf ? key.value : -key.value);
    if (turns.size() > 1)
    {
      differences.push_back(logarithm(glm::conjugate(*(turns.end() - 2)) * turns.back()));
    }
  }
  for (std::size_t i = 1; i + 2 < keys.size(); ++i)
  {
    // Squad's derivatives at its ends are the tangents when the controls stand half of what they
    // differ from the straight way beside the ends.
    const Tangents tangents = tangentsOf(keys, differences, i);
    this->Segments.push_back(
      { turns[i], turns[i] * exponential(0.5 * (tangents.start - differences[i])),
        turns[i + 1] * exponential(0.5 * (differences[i] - tangents.end)), turns[i + 1] });
  }
}

//------------------------------------------------------------------------------
glm::dquat RotationSpline::at(double time) const
{
  const Timeline::Place place = this->Line.find(time);
  const Segment& s = this->Segments[place.segment];
  const double u = place.u;
  return glm::normalize(
    turn(turn(s.start, s.end, u), turn(s.startControl, s.endControl, u), 2.0 * u * (1.0 - u)));
}

//------------------------------------------------------------------------------
VisibilityTrack::VisibilityTrack(std::vector<VisibilityKey> keys)
  : Keys(std::move(keys))
{
  std::stable_sort(this->Keys.begin(), this->Keys.end(),
    [](const VisibilityKey& a, const VisibilityKey& b) { return a.time < b.time; });
}

//------------------------------------------------------------------------------
bool VisibilityTrack::at(double time) const
{
  const auto later = std::upper_bound(this->Keys.begin(), this->Keys.end(), time,
    [](double t, const VisibilityKey& key) { return t < key.time; });
  return later == this->Keys.begin() || std::prev(later)->visible;
}

//------------------------------------------------------------------------------
glm::dquat rotationAbout(const glm::dvec3& axis, double degrees)
{
  const double length = glm::length(axis);
  if (!(length > 0.0))
  {
    return { 1.0, 0.0, 0.0, 0.0 };
  }
  const double half = glm::radians(0.5 * std::remainder(degrees, 720.0));
  const glm::dvec3 xyz = axis * (std::sin(half) / length);
  return { std::cos(half), xyz.x, xyz.y, xyz.z };
}

} // namespace bart
} // namespace hrt
