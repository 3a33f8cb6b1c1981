// Implements the grouping policy, rule by rule in the order of the header.
#include "Rendering/Core/Structures/Grouping.h"

#include <algorithm>
#include <unordered_map>

namespace hrt
{

namespace
{

struct Box
{
  glm::dvec3 lower, upper;
  bool contains(const glm::dvec3& p) const
  {
    return glm::all(glm::lessThanEqual(this->lower, p)) &&
      glm::all(glm::lessThanEqual(p, this->upper));
  }
};

bool meetsRays(const Part& part)
{
  return part.triangleCount() > 0 && (part.visibleToRays || part.castsShadow);
}

// Numbers in the last snapshot by key. Parts mostly stay in their order: only where one does not is
// a table made. Each earlier part is found once, should a key occur twice.
class Earlier
{
public:
  explicit Earlier(const Grouping& before)
    : Before(before)
    , Taken(before.parts.size(), false)
  {
  }

  std::size_t find(std::uint64_t key, std::size_t expected)
  {
    if (expected < this->Taken.size() && !this->Taken[expected] &&
      this->Before.parts[expected].key == key)
    {
      this->Taken[expected] = true;
      return expected;
    }
    return this->look(key);
  }

private:
  std::size_t look(std::uint64_t key)
  {
    if (!this->TableMade)
    {
      this->TableMade = true;
      for (std::size_t i = 0; i < this->Before.parts.size(); ++i)
      {
        this->Table.emplace(this->Before.parts[i].key, i);
      }
    }
    const auto range = this->Table.equal_range(key);
    for (auto i = range.first; i != range.second; ++i)
    {
      if (!this->Taken[i->second])
      {
        this->Taken[i->second] = true;
        return i->second;
      }
    }
    return kNewPart;
  }

  const Grouping& Before;
  std::vector<bool> Taken;
  std::unordered_multimap<std::uint64_t, std::size_t> Table;
  bool TableMade = false;
};

// Frobenius norms bound the stretches: exact enough for a limit far from any usual matrix.
bool isIllConditioned(const glm::dmat4& m)
{
  const glm::dmat3 linear(m), inverse = glm::inverse(linear);
  double squares = 0.0, inverseSquares = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    squares += glm::dot(linear[i], linear[i]);
    inverseSquares += glm::dot(inverse[i], inverse[i]);
  }
  return !(squares * inverseSquares <= kLargestCondition * kLargestCondition);
}

class Policy
{
public:
  Policy(const Snapshot& snapshot, const Grouping& before)
    : Now(snapshot)
    , Before(before)
    , Parts(this->Result.parts)
    , Copied(snapshot.parts.size(), false)
  {
  }

  Grouping decide()
  {
    this->matchWithEarlier();
    this->findCopies();
    this->keepResting();
    this->letJoin();
    this->keepSingleAlone();
    this->placeMoving();
    this->findFlatChanges();
    return std::move(this->Result);
  }

private:
  const GroupedPart* earlier(const GroupedPart& part) const
  {
    return part.before == kNewPart ? nullptr : &this->Before.parts[part.before];
  }

  static bool unchanged(const GroupedPart& a, const GroupedPart& b)
  {
    return a.version == b.version && a.positionsToWorld == b.positionsToWorld;
  }

  void matchWithEarlier()
  {
    Earlier known(this->Before);
    this->Parts.resize(this->Now.parts.size());
    for (std::size_t i = 0; i < this->Parts.size(); ++i)
    {
      const Part& part = this->Now.parts[i];
      GroupedPart& grouped = this->Parts[i];
      grouped.key = part.key;
      grouped.version = part.geometry->version;
      grouped.triangles = part.geometry->triangleCount();
      grouped.positionsToWorld = part.positionsToWorld();
      grouped.updatesToRest = kUpdatesToRest;
      grouped.before = known.find(part.key, i);
      if (const GroupedPart* old = this->earlier(grouped))
      {
        grouped.updatesToRest = old->updatesToRest;
        grouped.stillUpdates = unchanged(*old, grouped) ? old->stillUpdates + 1 : 0;
        grouped.deformed = old->version != grouped.version && old->triangles == grouped.triangles;
      }
    }
  }

  // Rule 6.
  void findCopies()
  {
    std::unordered_map<std::uint64_t, std::size_t> copies;
    for (const GroupedPart& part : this->Parts)
    {
      ++copies[part.version];
    }
    for (std::size_t i = 0; i < this->Parts.size(); ++i)
    {
      const std::size_t count = copies[this->Parts[i].version];
      this->Copied[i] = this->Now.parts[i].copies ||
        (count > 1 && count * this->Parts[i].triangles > kMostCopiedTriangles);
    }
  }

  // Rules 1 and 2, for those that are merged already.
  void keepResting()
  {
    this->Result.mergedTriangles = this->Before.mergedTriangles;
    for (std::size_t i = 0; i < this->Parts.size(); ++i)
    {
      GroupedPart& part = this->Parts[i];
      const GroupedPart* old = this->earlier(part);
      if (!old || old->place != Place::Merged || !meetsRays(this->Now.parts[i]))
      {
        continue;
      }
      if (unchanged(*old, part))
      {
        part.place = Place::Merged;
        this->Resting += part.triangles;
      }
      else
      {
        part.updatesToRest = std::min(2 * part.updatesToRest, kMostUpdatesToRest);
      }
    }
  }

  bool mayJoin(std::size_t i) const
  {
    return this->Parts[i].place != Place::Merged && !this->Copied[i] &&
      meetsRays(this->Now.parts[i]);
  }

  // Rules 1 and 4, for those that are not merged yet.
  void letJoin()
  {
    std::size_t rested = 0, added = 0;
    for (std::size_t i = 0; i < this->Parts.size(); ++i)
    {
      const GroupedPart& part = this->Parts[i];
      if (this->mayJoin(i))
      {
        rested += part.stillUpdates >= part.updatesToRest ? part.triangles : 0;
        added += part.before == kNewPart ? part.triangles : 0;
      }
    }
    // New parts as heavy as all that rests are to be built in any case.
    const bool addedJoin = added > 0 && added >= this->Resting;
    const std::size_t gone = this->Result.mergedTriangles - this->Resting;
    const std::size_t fair = this->Result.mergedTriangles / kFairShare;
    const bool cheap = this->Resting + rested <= kCheapTriangles;
    const bool restedJoin = rested > 0 && (cheap || rested + gone > fair);
    if (addedJoin || restedJoin || gone > fair)
    {
      this->mergeAnew(addedJoin);
    }
  }

  void mergeAnew(bool addedJoin)
  {
    for (std::size_t i = 0; i < this->Parts.size(); ++i)
    {
      GroupedPart& part = this->Parts[i];
      const bool joins =
        part.stillUpdates >= part.updatesToRest || (addedJoin && part.before == kNewPart);
      if (this->mayJoin(i) && joins)
      {
        part.place = Place::Merged;
        this->Resting += part.triangles;
      }
    }
    this->Result.mergedAnew = true;
    this->Result.mergedTriangles = this->Resting;
  }

  // Rule 8.
  void keepSingleAlone()
  {
    if (!this->Result.mergedAnew)
    {
      return;
    }
    const auto merged = [](const GroupedPart& part) { return part.place == Place::Merged; };
    const auto first = std::find_if(this->Parts.begin(), this->Parts.end(), merged);
    if (first == this->Parts.end() || isIllConditioned(first->positionsToWorld) ||
      std::any_of(first + 1, this->Parts.end(), merged))
    {
      return;
    }
    first->place = Place::Alone;
    // There is something to build only if a merged structure was there to be taken down.
    this->Result.mergedAnew = this->Before.mergedTriangles > 0;
    this->Result.mergedTriangles = 0;
  }

  // Rules 3, 5 and 7.
  void placeMoving()
  {
    std::vector<std::size_t> moving;
    for (std::size_t i = 0; i < this->Parts.size(); ++i)
    {
      GroupedPart& part = this->Parts[i];
      if (part.place != Place::None || !meetsRays(this->Now.parts[i]))
      {
        continue;
      }
      const bool hasCopies = this->Now.parts[i].copies != nullptr;
      const bool tiny = part.triangles <= kTinyPart && !this->Copied[i];
      part.place = !hasCopies && (tiny || isIllConditioned(part.positionsToWorld)) ? Place::Flat
                                                                                  : Place::Alone;
      if (part.place == Place::Alone && !hasCopies)
      {
        moving.push_back(i);
      }
    }
    this->flattenCrowds(moving);
  }

  // A box counts as crowded when it holds the centre of a sampled box together with many others.
  void flattenCrowds(const std::vector<std::size_t>& moving)
  {
    if (moving.size() <= kCrowd)
    {
      return;
    }
    std::vector<Box> boxes(moving.size());
    for (std::size_t i = 0; i < moving.size(); ++i)
    {
      worldBounds(this->Now.parts[moving[i]], boxes[i].lower, boxes[i].upper);
    }
    const std::size_t step = (moving.size() + kCrowdSamples - 1) / kCrowdSamples;
    std::vector<std::size_t> around;
    for (std::size_t sample = 0; sample < moving.size(); sample += step)
    {
      const glm::dvec3 centre = 0.5 * boxes[sample].lower + 0.5 * boxes[sample].upper;
      around.clear();
      for (std::size_t i = 0; i < boxes.size(); ++i)
      {
        if (boxes[i].contains(centre))
        {
          around.push_back(moving[i]);
        }
      }
      if (around.size() > kCrowd)
      {
        this->flatten(around);
      }
    }
  }

  void flatten(const std::vector<std::size_t>& crowd)
  {
    for (const std::size_t i : crowd)
    {
      if (!this->Copied[i])
      {
        this->Parts[i].place = Place::Flat;
      }
    }
  }

  // The flat structure stands as long as the same parts are in it, unmoved.
  void findFlatChanges()
  {
    const auto isFlat = [](const GroupedPart& part) { return part.place == Place::Flat; };
    const auto earlierCount =
      std::count_if(this->Before.parts.begin(), this->Before.parts.end(), isFlat);
    std::ptrdiff_t same = 0, count = 0;
    for (const GroupedPart& part : this->Parts)
    {
      if (isFlat(part))
      {
        const GroupedPart* old = this->earlier(part);
        ++count;
        same += old && isFlat(*old) && unchanged(*old, part);
      }
    }
    this->Result.flatAnew = count != earlierCount || same != count;
  }

  const Snapshot& Now;
  const Grouping& Before;
  Grouping Result;
  std::vector<GroupedPart>& Parts; // of the result
  std::vector<bool> Copied;        // rule 6 holds
  std::size_t Resting = 0;         // triangles of the parts placed in the merged structure so far
};

} // namespace

Grouping groupParts(const Snapshot& snapshot, const Grouping& before)
{
  return Policy(snapshot, before).decide();
}

} // namespace hrt
