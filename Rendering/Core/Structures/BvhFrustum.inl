// The hull of a packet's rays, which goes down the tree in place of them. Included by
// BvhPackets.inl.

// The hull of a packet's rays: two lines in x and two in y over the depth z, the axis along which
// all their directions are 1 or all are -1. A line joins the least (or most) x of any ray where the
// first ray begins and where the outer box ends: no ray, being straight, leaves it in between.
//
// Everything is widened by 20 (R + H) e, with R, H and e as in TraversalBox::padding, which is a
// quarter of it. At both depths a ray's x is off by 3 R e + 8 H e: its origin's by R e, twice, for
// x and z; its direction, rounded, over 2 H, by 2 H e; the difference of depths and its product
// with the direction by 2 H e each; the sum, of at most R + 2 H, by R e + 2 H e. The line's slope
// is no steeper than a ray's, 1; by what the two ends' difference and the quotient are rounded by,
// it is off, over the depth, by 6 H e, and by nothing more where it is cut off at 1. Its offset
// costs 4 R e, its evaluation at a box 3 R e. Together 10 R e + 14 H e.
struct Frustum
{
  unsigned int rays = 0; // bits of those that are still searching
  PerRay<float> apart;   // zero; infinity for those that are not, or not any more
  int x = 0, y = 0, z = 0;
  float forward = 1.0f;
  int nearSide = 0;   // which of a box' bounds along z is met first
  float begin = 0.0f; // the first origin's forward * z
  float slack = 0.0f;
  float slope[2][2], offset[2][2]; // lower and upper; x and y
  float width = 0.0f;              // the largest, at either end

  // False when the rays do not go the same way.
  HRT_TARGET bool enclose(const PacketEntry& entry, const TraversalBox& box)
  {
    const int one = lowest(entry.active);
    const Axes axes(glm::vec3(
      entry.direction[0].of[one], entry.direction[1].of[one], entry.direction[2].of[one]));
    this->x = axes.x;
    this->y = axes.y;
    this->z = axes.z;
    this->forward = entry.direction[axes.z].of[one];
    this->nearSide = this->forward > 0.0f ? 0 : 1;
    this->keep(entry.active);
    RayFloats nearest = broadcastRays(std::numeric_limits<float>::infinity());
    unsigned int back = 0;
    for (unsigned int first = 0; first < kPacket; first += RayFloats::kLanes)
    {
      const RayFloats way = loadRays(entry.direction[axes.z].of + first) * broadcastRays(this->forward);
      back |= less(way, broadcastRays(1.0f)) << first;
      nearest = min(nearest,
        mulAdd(loadRays(entry.origin[axes.z].of + first), broadcastRays(this->forward),
          loadRays(this->apart.of + first)));
    }
    if ((back & entry.active) != 0)
    {
      return false;
    }
    this->slack = static_cast<float>(4.0 * box.padding());
    this->begin = minLane(nearest);
    const double last = this->forward > 0.0f ? box.upper[axes.z] : -box.lower[axes.z];
    const float depth = std::max(static_cast<float>(last) - this->begin, 0.0f);
    this->fit(entry, axes.x, 0, depth);
    this->fit(entry, axes.y, 1, depth);
    return true;
  }

  HRT_LANES void keep(unsigned int which)
  {
    this->rays = which;
    for (unsigned int i = 0; i < kPacket; ++i)
    {
      this->apart.of[i] = (which >> i & 1u) != 0 ? 0.0f : std::numeric_limits<float>::infinity();
    }
  }

  // Where the last of the rays ends, from the beginning.
  HRT_LANES float end(const PacketEntry& entry) const
  {
    RayFloats last = broadcastRays(-1.0f);
    for (unsigned int first = 0; first < kPacket; first += RayFloats::kLanes)
    {
      const RayFloats start = mulSub(
        loadRays(entry.origin[this->z].of + first), broadcastRays(this->forward), broadcastRays(this->begin));
      // An end may be infinite, and infinity less infinity no number.
      const RayFloats end =
        min(start + loadRays(entry.end.of + first), broadcastRays(std::numeric_limits<float>::max()));
      last = max(last, end - loadRays(this->apart.of + first));
    }
    return maxLane(last) + this->slack;
  }

  struct Met
  {
    unsigned int boxes; // as bits
    Floats start;       // their depths from the beginning
    // At least |x| + |y|, along the axes of the shear, of any point in the box relative to any ray
    // at the point's depth. In front of where the first ray begins a ray, inclined by no more than
    // 1, leaves the hull, whose lines are neither, by twice the way to there.
    Floats spread;
  };

  // Which of eight boxes the frustum meets. `bound(side, axis)`: their lower (0) or upper (1)
  // bounds.
  template <class Bound>
  HRT_LANES Met meet(Bound bound, Floats end) const
  {
    const int axes[2] = { this->x, this->y };
    const Floats nearZ = bound(this->nearSide, this->z), farZ = bound(this->nearSide ^ 1, this->z);
    Floats gap[2], spread[2];
    for (int i = 0; i < 2; ++i)
    {
      const Floats slope0 = broadcast(this->slope[0][i]), offset0 = broadcast(this->offset[0][i]);
      const Floats slope1 = broadcast(this->slope[1][i]), offset1 = broadcast(this->offset[1][i]);
      const Floats below = min(mulAdd(slope0, nearZ, offset0), mulAdd(slope0, farZ, offset0));
      const Floats above = max(mulAdd(slope1, nearZ, offset1), mulAdd(slope1, farZ, offset1));
      const Floats over = bound(1, axes[i]) - below, under = above - bound(0, axes[i]);
      gap[i] = min(over, under);
      spread[i] = max(over, under);
    }
    const Floats forwards = broadcast(this->forward), from = broadcast(this->begin);
    const Floats nearer = mulSub(nearZ, forwards, from), farther = mulSub(farZ, forwards, from);
    Met met;
    met.start = max(nearer, broadcast(0.0f));
    met.spread = mulAdd(broadcast(4.0f), met.start - nearer, spread[0] + spread[1]);
    // The depths decide last: they are numbers even for an unused child.
    const Floats along = min(end - nearer, farther + broadcast(this->slack));
    met.boxes = lessEqual(broadcast(0.0f), min(min(gap[0], gap[1]), along));
    return met;
  }

  HRT_LANES unsigned int meet(const WideNode& node, Floats end, Floats& start) const
  {
    const Met met = this->meet(
      [&node](int side, int axis) HRT_TARGET { return load(node.bound[side][axis]); }, end);
    start = met.start;
    return met.boxes;
  }

private:
  HRT_LANES void fit(const PacketEntry& entry, int axis, int which, float depth)
  {
    RayFloats lower[2], upper[2];
    lower[0] = lower[1] = broadcastRays(std::numeric_limits<float>::infinity());
    upper[0] = upper[1] = broadcastRays(-std::numeric_limits<float>::infinity());
    for (unsigned int first = 0; first < kPacket; first += RayFloats::kLanes)
    {
      const RayFloats shear = loadRays(entry.direction[axis].of + first);
      const RayFloats out = loadRays(this->apart.of + first);
      const RayFloats after = mulSub(
        loadRays(entry.origin[this->z].of + first), broadcastRays(this->forward), broadcastRays(this->begin));
      const RayFloats at0 = subMul(loadRays(entry.origin[axis].of + first), shear, after);
      const RayFloats at1 = mulAdd(shear, broadcastRays(depth), at0);
      lower[0] = min(lower[0], at0 + out);
      lower[1] = min(lower[1], at1 + out);
      upper[0] = max(upper[0], at0 - out);
      upper[1] = max(upper[1], at1 - out);
    }
    const float l0 = minLane(lower[0]), l1 = minLane(lower[1]);
    const float u0 = maxLane(upper[0]), u1 = maxLane(upper[1]);
    this->width = std::max(this->width, std::max(u0 - l0, u1 - l1));
    this->line(0, which, l0 - this->slack, l1 - this->slack, depth);
    this->line(1, which, u0 + this->slack, u1 + this->slack, depth);
  }

  HRT_LANES void line(int side, int which, float at0, float at1, float depth)
  {
    const float rise = depth > 0.0f ? (at1 - at0) / depth : 0.0f;
    const float inclined = std::min(std::max(rise, -1.0f), 1.0f) * this->forward;
    const float offset0 = at0 - inclined * (this->begin * this->forward);
    const float offset1 = at1 - inclined * ((this->begin + depth) * this->forward);
    this->slope[side][which] = inclined;
    this->offset[side][which] = side == 0 ? std::min(offset0, offset1) : std::max(offset0, offset1);
  }
};
