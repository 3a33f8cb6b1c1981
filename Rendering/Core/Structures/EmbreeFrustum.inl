// The rays of a packet where they enter a tree's outer box, and their hull. Included by
// EmbreePackets.inl.

// A number a ray.
template <class T>
struct alignas(32) PerRay
{
  T of[kPacket];
};

HRT_LANES int lowest(unsigned int mask)
{
  return __builtin_ctz(mask);
}

// The packet's rays in the coordinates of one tree.
struct PacketRays
{
  PerRay<double> origin[3], direction[3], end;
  unsigned int active = 0; // bits of those that take part; the others repeat one of them
};

// Where they enter its outer box: TraversalRay for each of them.
struct PacketEntry
{
  PerRay<float> origin[3], direction[3], end;
  PerRay<double> start, scale;
  unsigned int active = 0; // the others repeat one of these

  // enterBox for all rays, one operation after the other.
  HRT_TARGET PacketEntry(const EntryBox& box, const PacketRays& rays)
  {
    PerRay<double> leave;
    for (unsigned int i = 0; i < kPacket; ++i)
    {
      const double x = std::fabs(rays.direction[0].of[i]), y = std::fabs(rays.direction[1].of[i]),
                   z = std::fabs(rays.direction[2].of[i]);
      const double xy = x > y ? x : y, longest = xy > z ? xy : z;
      this->scale.of[i] = longest;
      this->start.of[i] = 0.0;
      leave.of[i] = rays.end.of[i] * longest;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      const double lower = box.lower[axis], upper = box.upper[axis];
      for (unsigned int i = 0; i < kPacket; ++i)
      {
        const double inverse = this->scale.of[i] / rays.direction[axis].of[i];
        const double t0 = (lower - rays.origin[axis].of[i]) * inverse;
        const double t1 = (upper - rays.origin[axis].of[i]) * inverse;
        const double nearer = t0 < t1 ? t0 : t1, farther = t0 < t1 ? t1 : t0;
        this->start.of[i] = nearer > this->start.of[i] ? nearer : this->start.of[i];
        leave.of[i] = farther < leave.of[i] ? farther : leave.of[i];
      }
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      for (unsigned int i = 0; i < kPacket; ++i)
      {
        const double along = rays.direction[axis].of[i] / this->scale.of[i];
        this->origin[axis].of[i] =
          static_cast<float>(rays.origin[axis].of[i] + this->start.of[i] * along);
        this->direction[axis].of[i] = static_cast<float>(along);
      }
    }
    PerRay<float> within;
    for (unsigned int i = 0; i < kPacket; ++i)
    {
      this->end.of[i] = this->endOf(i, rays.end.of[i]);
      within.of[i] = static_cast<float>(leave.of[i] - this->start.of[i]);
    }
    for (unsigned int half = 0; half < kPacket; half += kLanes)
    {
      this->active |= lessEqual(all(0.0f), load(within.of + half)) << half;
    }
    this->active &= rays.active;
    this->repeatActive();
  }

  // TraversalRay::end of one ray.
  HRT_LANES float endOf(unsigned int i, double t) const
  {
    const double parameter = t * this->scale.of[i] - this->start.of[i];
    return static_cast<float>(parameter > 0.0 ? parameter : 0.0) * (1.0f + 0x1p-22f) +
      std::numeric_limits<float>::min();
  }

private:
  // A ray that has missed the box may have entered it at infinity.
  HRT_LANES void repeatActive()
  {
    const unsigned int rest = this->active ^ ((1u << kPacket) - 1u);
    for (unsigned int others = this->active == 0 ? 0 : rest; others != 0; others &= others - 1)
    {
      const int i = lowest(others), first = lowest(this->active);
      for (int axis = 0; axis < 3; ++axis)
      {
        this->origin[axis].of[i] = this->origin[axis].of[first];
        this->direction[axis].of[i] = this->direction[axis].of[first];
      }
      this->end.of[i] = this->end.of[first];
    }
  }
};

// The hull of a packet's rays: two lines in x and two in y over the depth z, the axis along which
// all their directions are 1 or all are -1. A line joins the least (or most) x of any ray where the
// first ray begins and where the outer box ends: no ray, being straight, leaves it in between.
//
// Everything is widened by 20 (R + H) e, with R, H and e as in TraversalBox::padding, which is a
// quarter of it. At both depths a ray's x is off by 3 R e + 8 H e: its origin's by R e, twice, for x
// and z; its direction, rounded, over 2 H, by 2 H e; the difference of depths and its product with
// the direction by 2 H e each; the sum, of at most R + 2 H, by R e + 2 H e. The line's slope is no
// steeper than a ray's, 1; by what the two ends' difference and the quotient are rounded by, it is
// off, over the depth, by 6 H e, and by nothing more where it is cut off at 1. Its offset costs 4 R e,
// its evaluation at a box 3 R e. Together 10 R e + 14 H e.
struct Frustum
{
  unsigned int rays = 0; // bits of those that are still searching
  PerRay<float> apart;   // zero; infinity for those that are not, or not any more
  int x = 0, y = 0, z = 0;
  float forward = 1.0f;
  float begin = 0.0f; // the first origin's forward * z
  float slack = 0.0f;
  float slope[2][2], offset[2][2]; // lower and upper; x and y
  float width = 0.0f;              // the largest, at either end

  // False when the rays do not go the same way.
  HRT_TARGET bool enclose(const PacketEntry& entry, const TraversalBox& box)
  {
    const int first = lowest(entry.active);
    const Axes axes(glm::vec3(
      entry.direction[0].of[first], entry.direction[1].of[first], entry.direction[2].of[first]));
    this->x = axes.x;
    this->y = axes.y;
    this->z = axes.z;
    this->forward = entry.direction[axes.z].of[first];
    this->keep(entry.active);
    Floats first0 = all(std::numeric_limits<float>::infinity());
    unsigned int back = 0;
    for (unsigned int half = 0; half < kPacket; half += kLanes)
    {
      const Floats way = load(entry.direction[axes.z].of + half) * all(this->forward);
      back |= less(way, all(1.0f)) << half;
      first0 = least(first0,
        mulAdd(
          load(entry.origin[axes.z].of + half), all(this->forward), load(this->apart.of + half)));
    }
    if ((back & entry.active) != 0)
    {
      return false;
    }
    this->slack = static_cast<float>(4.0 * box.padding());
    this->begin = smallest(first0);
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
    Floats last = all(-1.0f);
    for (unsigned int half = 0; half < kPacket; half += kLanes)
    {
      const Floats start =
        mulSub(load(entry.origin[this->z].of + half), all(this->forward), all(this->begin));
      // An end may be infinite, and infinity less infinity no number.
      const Floats end =
        least(start + load(entry.end.of + half), all(std::numeric_limits<float>::max()));
      last = most(last, end - load(this->apart.of + half));
    }
    return largest(last) + this->slack;
  }

  // Of eight boxes those that the frustum meets, and their depths from its beginning.
  HRT_LANES unsigned int meet(
    const Floats (&lower)[3], const Floats (&upper)[3], Floats end, Floats& start) const
  {
    const int axes[2] = { this->x, this->y };
    Floats gap[2];
    for (int i = 0; i < 2; ++i)
    {
      const Floats below = mulAdd(all(this->slope[0][i]),
        this->slope[0][i] < 0.0f ? upper[this->z] : lower[this->z], all(this->offset[0][i]));
      const Floats above = mulAdd(all(this->slope[1][i]),
        this->slope[1][i] < 0.0f ? lower[this->z] : upper[this->z], all(this->offset[1][i]));
      gap[i] = least(upper[axes[i]] - below, above - lower[axes[i]]);
    }
    const bool ahead = this->forward > 0.0f;
    const Floats forwards = all(this->forward), from = all(this->begin);
    const Floats nearer = mulSub(ahead ? lower[this->z] : upper[this->z], forwards, from);
    const Floats farther = mulSub(ahead ? upper[this->z] : lower[this->z], forwards, from);
    start = most(nearer, all(0.0f));
    // The depths decide last: they are numbers even for an unused child.
    const Floats along = least(end - nearer, farther + all(this->slack));
    return lessEqual(all(0.0f), least(least(gap[0], gap[1]), along));
  }

  HRT_LANES unsigned int meet(const WideNode& node, Floats end, Floats& start) const
  {
    const Floats lower[3] = { load(node.bound[0][0]), load(node.bound[0][1]),
      load(node.bound[0][2]) };
    const Floats upper[3] = { load(node.bound[1][0]), load(node.bound[1][1]),
      load(node.bound[1][2]) };
    return this->meet(lower, upper, end, start);
  }

private:
  HRT_LANES static float smallest(Floats a)
  {
    alignas(32) float lanes[kLanes];
    store(lanes, a);
    const float a0 = std::min(lanes[0], lanes[1]), a1 = std::min(lanes[2], lanes[3]);
    const float a2 = std::min(lanes[4], lanes[5]), a3 = std::min(lanes[6], lanes[7]);
    return std::min(std::min(a0, a1), std::min(a2, a3));
  }
  HRT_LANES static float largest(Floats a) { return -smallest(all(0.0f) - a); }

  HRT_LANES void fit(const PacketEntry& entry, int axis, int which, float depth)
  {
    Floats lower[2], upper[2];
    lower[0] = lower[1] = all(std::numeric_limits<float>::infinity());
    upper[0] = upper[1] = all(-std::numeric_limits<float>::infinity());
    for (unsigned int half = 0; half < kPacket; half += kLanes)
    {
      const Floats shear = load(entry.direction[axis].of + half);
      const Floats out = load(this->apart.of + half);
      const Floats after =
        mulSub(load(entry.origin[this->z].of + half), all(this->forward), all(this->begin));
      const Floats at0 = subMul(load(entry.origin[axis].of + half), shear, after);
      const Floats at1 = mulAdd(shear, all(depth), at0);
      lower[0] = least(lower[0], at0 + out);
      lower[1] = least(lower[1], at1 + out);
      upper[0] = most(upper[0], at0 - out);
      upper[1] = most(upper[1], at1 - out);
    }
    const float l0 = smallest(lower[0]), l1 = smallest(lower[1]);
    const float u0 = largest(upper[0]), u1 = largest(upper[1]);
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
