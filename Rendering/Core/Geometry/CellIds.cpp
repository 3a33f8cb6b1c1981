// Implements the list of numbers that is as wide as it has to be.
#include "Rendering/Core/Geometry/CellIds.h"

#include <algorithm>
#include <limits>

namespace hrt
{

namespace
{

bool isNarrow(std::int64_t id)
{
  return id >= 0 && id <= std::int64_t(std::numeric_limits<std::uint32_t>::max());
}

} // namespace

CellIds::CellIds(std::initializer_list<std::int64_t> ids)
{
  for (const std::int64_t id : ids)
  {
    this->push_back(id);
  }
}

template <class T>
std::vector<T> CellIds::copied() const
{
  std::vector<T> list;
  list.reserve(std::max(this->Expected, this->Count + 1));
  for (std::size_t i = 0; i < this->Count; ++i)
  {
    list.push_back(static_cast<T>((*this)[i]));
  }
  return list;
}

void CellIds::push_back(std::int64_t id)
{
  if (this->Count == 0)
  {
    this->First = id;
  }
  const bool inRun = this->Narrow.empty() && this->Wide.empty();
  if (inRun && id != this->First + static_cast<std::int64_t>(this->Count))
  {
    const std::int64_t last = (*this)[this->Count - 1];
    if (isNarrow(this->First) && isNarrow(last))
    {
      this->Narrow = this->copied<std::uint32_t>();
    }
    else
    {
      this->Wide = this->copied<std::int64_t>();
    }
  }
  if (!this->Narrow.empty() && !isNarrow(id))
  {
    this->Wide = this->copied<std::int64_t>();
    this->Narrow = {};
  }
  if (!this->Narrow.empty())
  {
    this->Narrow.push_back(static_cast<std::uint32_t>(id));
  }
  else if (!this->Wide.empty())
  {
    this->Wide.push_back(id);
  }
  ++this->Count;
}

} // namespace hrt
