// Pairs of a ray and a triangle that the sieve has let pass for the rays of a packet, gathered
// until there are enough of them for the exact kernel to decide eight at once. Included by
// BvhPackets.inl.

class Candidates
{
public:
  // Of a packet that looks for the nearest hits.
  HRT_LANES Candidates(const Hierarchy& hierarchy, const Member* members, const Packet& packet)
    : OfHierarchy(hierarchy)
    , Members(members)
    , Of(packet)
  {
  }

  // The pairs of a triangle, in a lane of a block, with some rays, as bits, each of which may see
  // it. Only when `enough` is false.
  HRT_LANES void add(std::uint32_t block, int lane, unsigned int rays)
  {
    // A loop over the bits would be guessed wrong once a triangle: as much is written for each as
    // for all rays.
    appendBits(rays, this->RayOf + this->Count);
    const Place place = Place(block) * kLanes + static_cast<Place>(lane);
    Place* const places = this->PlaceOf + this->Count;
    for (unsigned int i = 0; i < kPacket; ++i)
    {
      places[i] = place;
    }
    this->Count += static_cast<unsigned int>(__builtin_popcount(rays));
  }

  HRT_LANES bool enough() const { return this->Count >= kLanes; }

  // Decides the pairs eight by eight as long as there are at least so many. Bits of the rays that
  // have a new best hit.
  HRT_TARGET unsigned int decide(unsigned int least)
  {
    unsigned int nearer = 0, first = 0;
    for (; first < this->Count && this->Count - first >= least; first += kLanes)
    {
      const unsigned int count = std::min(kLanes, this->Count - first);
      if (this->alike(first, count))
      {
        nearer |= this->decideTogether(first, count);
        continue;
      }
      for (unsigned int i = 0; i < count; ++i)
      {
        nearer |= this->decideSingly(first + i);
      }
    }
    first = std::min(first, this->Count);
    std::copy(this->RayOf + first, this->RayOf + this->Count, this->RayOf);
    std::copy(this->PlaceOf + first, this->PlaceOf + this->Count, this->PlaceOf);
    this->Count -= first;
    return nearer;
  }

private:
  static_assert(ExactLanes::kLanes == kLanes, "a value's lanes are the exact kernel's");
  using Place = std::uint64_t; // of a triangle: its block times the lanes, and the lane

  static std::uint32_t blockOf(Place place) { return static_cast<std::uint32_t>(place / kLanes); }
  static int laneOf(Place place) { return static_cast<int>(place % kLanes); }
  const Member& memberOf(Place place) const
  {
    return this->OfHierarchy.memberOf(blockOf(place), laneOf(place), this->Members);
  }

  // Whether one matrix and one axis serve them all, and there are enough to be worth it.
  bool alike(unsigned int first, unsigned int count) const
  {
    const Member* const member = &this->memberOf(this->PlaceOf[first]);
    return this->Of.rays.longest != SceneRays::kNoAxis && count > 2 &&
      std::all_of(this->PlaceOf + first, this->PlaceOf + first + count,
        [&](Place place) { return &this->memberOf(place) == member; });
  }

  unsigned int decideSingly(unsigned int pair)
  {
    const std::uint32_t ray = this->RayOf[pair];
    const Place place = this->PlaceOf[pair];
    Search search(this->Of.given[ray], *this->Of.surfaces);
    search.best = this->Of.hits[ray];
    const bool nearer =
      this->OfHierarchy.nearest(blockOf(place), 1u << laneOf(place), this->Members, search);
    this->Of.hits[ray] = search.best; // which may be a shared one now
    return nearer ? 1u << ray : 0u;
  }

  HRT_LANES unsigned int decideTogether(unsigned int first, unsigned int count)
  {
    for (unsigned int i = count; i < kLanes; ++i) // what follows is not used any more
    {
      this->RayOf[first + i] = this->RayOf[first];
      this->PlaceOf[first + i] = this->PlaceOf[first];
    }
    const std::uint32_t* const rayOf = this->RayOf + first;
    const Place* const placeOf = this->PlaceOf + first;
    ExactLanes lanes;
    for (int axis = 0; axis < 3; ++axis)
    {
      pick(this->Of.rays.origin[axis], rayOf, lanes.origin[axis]);
      pick(this->Of.rays.direction[axis], rayOf, lanes.direction[axis]);
    }
    pick(this->Of.rays.last, rayOf, lanes.last);
    const float* corners[3][kLanes];
    ExactPositions positions{};
    for (unsigned int i = 0; i < kLanes; ++i)
    {
      positions = this->OfHierarchy.positionsOf(blockOf(placeOf[i]), laneOf(placeOf[i]));
      for (int corner = 0; corner < 3; ++corner)
      {
        corners[corner][i] = positions.corner[corner];
      }
    }
    for (int corner = 0; corner < 3; ++corner)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        store(
          lanes.position[corner][axis], gather(corners[corner], axis * positions.axisStep));
      }
    }
    const Member& member = this->memberOf(placeOf[0]);
    unsigned int nearer = 0;
    unsigned int hits = lanes.hit(member.toScene, this->Of.rays.longest, HRT_SET);
    for (hits &= (1u << count) - 1u; hits != 0; hits &= hits - 1)
    {
      const int i = lowest(hits);
      const TriangleId triangle = member.firstTriangle +
        this->OfHierarchy.block(blockOf(placeOf[i])).triangle[laneOf(placeOf[i])];
      const std::uint32_t ray = rayOf[i];
      if (this->Of.rays.twins &&
        this->Of.given[ray].passesOver(triangle, lanes.t[i], *this->Of.surfaces))
      {
        continue;
      }
      const bool best = this->Of.hits[ray].offer(
        triangle, lanes.t[i], lanes.u[i], lanes.v[i], Window{ this->Of, ray });
      nearer |= best ? 1u << ray : 0u;
    }
    return nearer;
  }

  // The ray's own, which takes a division, is asked where the widest does not answer.
  struct Window
  {
    const Packet& of;
    std::uint32_t ray;

    bool holds(double first, double second) const
    {
      return this->of.widest.holds(first, second) &&
        this->of.surfaces->windowOf(this->of.given[this->ray].direction).holds(first, second);
    }
  };

  const Hierarchy& OfHierarchy;
  const Member* Members;
  const Packet& Of;
  unsigned int Count = 0;
  std::uint32_t RayOf[kLanes + kPacket];
  Place PlaceOf[kLanes + kPacket];
};
