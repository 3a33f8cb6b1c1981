// The rays of a packet side by side, as they are given and where they enter a tree's outer box.
// Included by BvhPackets.inl.

// A number a ray.
template <class T>
struct alignas(64) PerRay
{
  T of[kPacket];
};

HRT_LANES int lowest(unsigned int mask)
{
  return __builtin_ctz(mask);
}

// The numbers of eight of the rays.
HRT_LANES void pick(const PerRay<double>& from, const std::uint32_t* rays, double* to)
{
#if HRT_AVX512
  const __m512i numbers =
    _mm512_maskz_cvtepu32_epi64(0xff, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(rays)));
  _mm512_store_pd(
    to, _mm512_permutex2var_pd(_mm512_load_pd(from.of), numbers, _mm512_load_pd(from.of + kLanes)));
#else
  for (unsigned int i = 0; i < kLanes; ++i)
  {
    to[i] = from.of[rays[i]];
  }
#endif
}

// Bits of a condition that holds where lanes are not zero.
HRT_LANES unsigned int bitsOf(const PerRay<std::int64_t>& holds)
{
  std::int64_t bits = 0;
  for (unsigned int i = 0; i < kPacket; ++i)
  {
    bits |= holds.of[i] != 0 ? std::int64_t(1) << i : 0;
  }
  return static_cast<unsigned int>(bits);
}

// The packet's rays in the coordinates of one tree.
struct PacketRays
{
  PerRay<double> origin[3], direction[3], end;
  unsigned int active = 0; // bits of those that take part; the others repeat one of them

  // Lets the others repeat one of those that take part.
  HRT_LANES void repeatActive()
  {
    const int first = lowest(this->active);
    for (unsigned int rest = this->active ^ ((1u << kPacket) - 1u); rest != 0; rest &= rest - 1)
    {
      const int i = lowest(rest);
      for (int axis = 0; axis < 3; ++axis)
      {
        this->origin[axis].of[i] = this->origin[axis].of[first];
        this->direction[axis].of[i] = this->direction[axis].of[first];
      }
      this->end.of[i] = this->end.of[first];
    }
  }
};

// The bits of a number's size: without arithmetic, which raises exceptions, they are in the order
// of the sizes, infinity and what is not a number after all others.
HRT_LANES std::int64_t bitsOfSize(double a)
{
  std::int64_t bits;
  std::memcpy(&bits, &a, sizeof(bits));
  return bits & std::numeric_limits<std::int64_t>::max();
}

HRT_LANES std::int64_t largestSize(const PerRay<double> (&v)[3], unsigned int i)
{
  const std::int64_t x = bitsOfSize(v[0].of[i]), y = bitsOfSize(v[1].of[i]),
                     z = bitsOfSize(v[2].of[i]);
  const std::int64_t xy = x > y ? x : y;
  return xy > z ? xy : z;
}

// The packet's rays as they are given, in the scene's coordinates.
struct SceneRays : PacketRays
{
  static constexpr int kNoAxis = 3;
  PerRay<double> last;       // Ray::tMaximum
  PerRay<TriangleId> from;   // Ray::originTriangle
  PerRay<float> twinEnd;     // Ray's
  PerRay<std::int64_t> away; // largestSize of the origin
  std::int64_t farthest = 0; // the largest of those
  unsigned int alone = 0;    // bits of those that must go singly, if they go at all
  bool leave = false;        // some of them do leave from a triangle
  bool twins = false;        // and may meet twins of it
  int longest = kNoAxis;     // axis of all their directions, or kNoAxis where it is not one

  // False when none of them may go with others.
  HRT_LANES bool take(const Ray* rays, unsigned int count)
  {
    for (unsigned int first = 0; first < kPacket; first += kLanes)
    {
      this->takeEight(rays, count, first);
    }
    this->end = this->last;
    const unsigned int given = (1u << count) - 1u;
    this->active = given & this->goTogether();
    this->alone = given & ~this->active;
    if (this->active == 0)
    {
      return false;
    }
    this->leave = this->leaving(kNoTriangle) != (1u << kPacket) - 1u;
    for (unsigned int i = 0; i < kPacket && this->leave; ++i)
    {
      this->twins = this->twins || this->twinEnd.of[i] > 0.0f;
    }
    this->repeatActive();
    this->findLongest();
    return true;
  }

  // The least of their directions' longest components.
  HRT_LANES double shortest() const
  {
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    for (unsigned int i = 0; i < kPacket; ++i)
    {
      const std::int64_t length = largestSize(this->direction, i);
      least = length < least ? length : least;
    }
    double shortest;
    std::memcpy(&shortest, &least, sizeof(shortest));
    return shortest;
  }


  // Bits of those that begin farther away than that.
  HRT_LANES unsigned int beyond(double distance) const
  {
    const std::int64_t bound = distance > 0.0 ? bitsOfSize(distance) : -1;
    unsigned int bits = 0;
    for (unsigned int i = 0; i<kPacket&& this->farthest> bound; ++i)
    {
      bits |= this->away.of[i] > bound ? 1u << i : 0u;
    }
    return bits;
  }

  // Bits of those that leave from the triangle.
  HRT_LANES unsigned int leaving(TriangleId triangle) const
  {
    unsigned int bits = 0;
    for (unsigned int first = 0; first < kPacket; first += Floats::kLanes)
    {
      bits |= equal(this->from.of + first, triangle) << first;
    }
    return bits;
  }

private:
  // Those from the first-th on; beyond `count` the first of all.
  HRT_LANES void takeEight(const Ray* rays, unsigned int count, unsigned int first)
  {
#if HRT_AVX512
    // The rays' numbers lie as registers do, and are turned by three rounds of exchanges.
    static_assert(sizeof(Ray) == 64 && offsetof(Ray, origin) == 0 &&
        offsetof(Ray, direction) == 24 && offsetof(Ray, tMaximum) == 48 &&
        offsetof(Ray, originTriangle) == 56 && offsetof(Ray, twinEnd) == 60,
      "a ray is eight numbers");
    __m512d a[kLanes], b[kLanes];
    for (unsigned int i = 0; i < kLanes; ++i)
    {
      a[i] = _mm512_loadu_pd(rays + (first + i < count ? first + i : 0));
    }
    for (unsigned int i = 0; i < kLanes; i += 2)
    {
      b[i] = _mm512_maskz_unpacklo_pd(0xff, a[i], a[i + 1]);
      b[i + 1] = _mm512_maskz_unpackhi_pd(0xff, a[i], a[i + 1]);
    }
    for (unsigned int i = 0; i < kLanes; i += 4)
    {
      for (unsigned int k = 0; k < 2; ++k)
      {
        a[i + k] = _mm512_maskz_shuffle_f64x2(0xff, b[i + k], b[i + k + 2], 0x88);
        a[i + k + 2] = _mm512_maskz_shuffle_f64x2(0xff, b[i + k], b[i + k + 2], 0xdd);
      }
    }
    for (unsigned int k = 0; k < kLanes / 2; ++k)
    {
      b[k] = _mm512_maskz_shuffle_f64x2(0xff, a[k], a[k + 4], 0x88);
      b[k + 4] = _mm512_maskz_shuffle_f64x2(0xff, a[k], a[k + 4], 0xdd);
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      _mm512_store_pd(this->origin[axis].of + first, b[axis]);
      _mm512_store_pd(this->direction[axis].of + first, b[axis + 3]);
    }
    _mm512_store_pd(this->last.of + first, b[6]);
    const __m512i from = _mm512_castpd_si512(b[7]);
    _mm256_store_si256(reinterpret_cast<__m256i*>(this->from.of + first),
      _mm512_maskz_cvtepi64_epi32(0xff, from));
    _mm256_store_si256(reinterpret_cast<__m256i*>(this->twinEnd.of + first),
      _mm512_maskz_cvtepi64_epi32(0xff, _mm512_maskz_srli_epi64(0xff, from, 32)));
#else
    for (unsigned int i = first; i < first + kLanes; ++i)
    {
      const Ray& ray = rays[i < count ? i : 0];
      for (int axis = 0; axis < 3; ++axis)
      {
        this->origin[axis].of[i] = ray.origin[axis];
        this->direction[axis].of[i] = ray.direction[axis];
      }
      this->last.of[i] = ray.tMaximum;
      this->from.of[i] = ray.originTriangle;
      this->twinEnd.of[i] = ray.twinEnd;
    }
#endif
  }

  // Bits of those that are usable and ordinary, and have a length.
  HRT_LANES unsigned int goTogether()
  {
    const std::int64_t infinity = bitsOfSize(std::numeric_limits<double>::infinity());
    const std::int64_t shortest = bitsOfSize(kShortest), most = bitsOfSize(kLongest);
    PerRay<std::int64_t> together;
    for (unsigned int i = 0; i < kPacket; ++i)
    {
      const std::int64_t length = largestSize(this->direction, i);
      const std::int64_t distance = largestSize(this->origin, i);
      std::int64_t end; // with its sign
      std::memcpy(&end, &this->last.of[i], sizeof(end));
      together.of[i] = (length >= shortest) & (length <= most) & (distance < infinity) & (end > 0) &
        (end <= infinity);
      this->away.of[i] = distance;
    }
    std::int64_t largest = 0;
    for (unsigned int i = 0; i < kPacket; ++i)
    {
      largest = this->away.of[i] > largest ? this->away.of[i] : largest;
    }
    this->farthest = largest;
    return bitsOf(together);
  }

  // By ExactShear::longestAxis.
  HRT_LANES void findLongest()
  {
    PerRay<std::int64_t> axis;
    for (unsigned int i = 0; i < kPacket; ++i)
    {
      const double x = std::fabs(this->direction[0].of[i]), y = std::fabs(this->direction[1].of[i]),
                   z = std::fabs(this->direction[2].of[i]);
      axis.of[i] = ((x >= y) & (x >= z)) ? 0 : (y >= z ? 1 : 2);
    }
    std::int64_t differ = 0;
    for (unsigned int i = 0; i < kPacket; ++i)
    {
      differ |= axis.of[i] ^ axis.of[0];
    }
    this->longest = differ == 0 ? static_cast<int>(axis.of[0]) : kNoAxis;
  }
};

// Where they enter its outer box: TraversalRay for each of them.
struct PacketEntry
{
  PerRay<float> origin[3], direction[3], end;
  PerRay<float> begin;  // TraversalRay's
  PerRay<float> behind; // the widest window, as far as it does not grow with the parameter
  PerRay<double> start, scale, toUnits; // toUnits: the scale's reciprocal
  unsigned int active = 0;              // the others repeat one of these

  // enterBox for near rays, one operation after the other. `rays`: `scene`'s in other coordinates, or
  // themselves. `window`: the widest of theirs, where they look for the nearest hits.
  HRT_TARGET PacketEntry(
    const EntryBox& box, const PacketRays& rays, const SceneRays& scene, const HitWindow& window)
  {
    PerRay<std::int64_t> within;
    for (unsigned int i = 0; i < kPacket; ++i)
    {
      const double x = std::fabs(rays.direction[0].of[i]), y = std::fabs(rays.direction[1].of[i]),
                   z = std::fabs(rays.direction[2].of[i]);
      const double xy = x > y ? x : y;
      this->scale.of[i] = xy > z ? xy : z;
      this->toUnits.of[i] = 1.0 / this->scale.of[i];
      this->start.of[i] = 0.0;
      within.of[i] = (rays.origin[0].of[i] >= box.lower.x) & (rays.origin[0].of[i] <= box.upper.x) &
        (rays.origin[1].of[i] >= box.lower.y) & (rays.origin[1].of[i] <= box.upper.y) &
        (rays.origin[2].of[i] >= box.lower.z) & (rays.origin[2].of[i] <= box.upper.z);
    }
    this->active = rays.active;
    if (bitsOf(within) != (1u << kPacket) - 1u)
    {
      this->active &= this->clip(box, rays);
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      for (unsigned int i = 0; i < kPacket; ++i)
      {
        const double along = rays.direction[axis].of[i] * this->toUnits.of[i];
        this->origin[axis].of[i] =
          static_cast<float>(rays.origin[axis].of[i] + this->start.of[i] * along);
        this->direction[axis].of[i] = static_cast<float>(along);
      }
    }
    for (unsigned int i = 0; i < kPacket; ++i)
    {
      this->end.of[i] = this->endOf(i, rays.end.of[i]);
      this->begin.of[i] = 0.0f;
    }
    for (unsigned int i = 0; i < kPacket && scene.twins; ++i)
    {
      this->begin.of[i] = this->endOf(i, static_cast<double>(scene.twinEnd.of[i]));
    }
    for (unsigned int i = 0; i < kPacket; ++i)
    {
      this->behind.of[i] = static_cast<float>(
        window.fixed * this->scale.of[i] + this->start.of[i] * kComputedRounding);
    }
    this->repeatActive();
  }

  // One of them, of those that it was made of.
  HRT_LANES TraversalRay ray(const PacketRays& rays, unsigned int i) const
  {
    TraversalRay one;
    for (int axis = 0; axis < 3; ++axis)
    {
      one.origin[axis] = this->origin[axis].of[i];
      one.direction[axis] = this->direction[axis].of[i];
      const double inverse = slope(this->scale.of[i], rays.direction[axis].of[i]);
      one.inverse[axis] = static_cast<float>(std::clamp(inverse, -kSteepest, kSteepest));
    }
    one.start = this->start.of[i];
    one.scale = this->scale.of[i];
    return one;
  }

  // TraversalRay::end of one ray.
  HRT_LANES float endOf(unsigned int i, double t) const
  {
    const double parameter = t * this->scale.of[i] - this->start.of[i];
    return static_cast<float>(parameter > 0.0 ? parameter : 0.0) * (1.0f + 0x1p-22f) +
      std::numeric_limits<float>::min();
  }

private:
  // Sets where the rays enter the box. Bits of those that do.
  HRT_LANES unsigned int clip(const EntryBox& box, const PacketRays& rays)
  {
    const glm::dvec3 lower = box.lower, upper = box.upper;
    PerRay<std::int64_t> meets;
    for (unsigned int i = 0; i < kPacket; ++i)
    {
      double enter = 0.0, leave = rays.end.of[i] * this->scale.of[i];
      for (int axis = 0; axis < 3; ++axis)
      {
        const double inverse = slope(this->scale.of[i], rays.direction[axis].of[i]);
        const double t0 = (lower[axis] - rays.origin[axis].of[i]) * inverse;
        const double t1 = (upper[axis] - rays.origin[axis].of[i]) * inverse;
        const double nearer = t0 < t1 ? t0 : t1, farther = t0 < t1 ? t1 : t0;
        enter = nearer > enter ? nearer : enter;
        leave = farther < leave ? farther : leave;
      }
      // Of one that does not it may be no float.
      this->start.of[i] = enter <= leave ? enter : 0.0;
      meets.of[i] = enter <= leave;
    }
    return bitsOf(meets);
  }

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
      this->begin.of[i] = this->begin.of[first];
      this->behind.of[i] = this->behind.of[first];
    }
  }
};
