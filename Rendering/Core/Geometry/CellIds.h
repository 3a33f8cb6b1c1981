// The numbers of the cells that a mesh's triangles came from. A large mesh has many of them, so
// they are kept as small as they are: numbers that follow one another, as where every cell is a
// triangle, take no memory; others take 32 bits each; only where one does not fit do all take 64.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace hrt
{

class CellIds
{
public:
  CellIds() = default;
  CellIds(std::initializer_list<std::int64_t> ids);

  // Announces how many there will be.
  void reserve(std::size_t count) { this->Expected = count; }
  void push_back(std::int64_t id);

  std::size_t size() const { return this->Count; }
  std::int64_t operator[](std::size_t i) const
  {
    return !this->Narrow.empty() ? std::int64_t(this->Narrow[i])
      : !this->Wide.empty()      ? this->Wide[i]
                                 : this->First + static_cast<std::int64_t>(i);
  }
  // Memory beyond the object itself.
  std::size_t bytes() const
  {
    return this->Narrow.capacity() * sizeof(std::uint32_t) +
      this->Wide.capacity() * sizeof(std::int64_t);
  }

  // Equal numbers are kept in the same way.
  bool operator==(const CellIds& o) const
  {
    return this->Count == o.Count && this->First == o.First && this->Narrow == o.Narrow &&
      this->Wide == o.Wide;
  }
  bool operator!=(const CellIds& o) const { return !(*this == o); }

private:
  template <class T>
  std::vector<T> copied() const;

  std::size_t Count = 0;
  std::size_t Expected = 0;
  std::int64_t First = 0; // where both lists are empty, the others follow it one by one
  std::vector<std::uint32_t> Narrow;
  std::vector<std::int64_t> Wide;
};

} // namespace hrt
