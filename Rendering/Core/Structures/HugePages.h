// Memory for large arrays that rays read in no order. In pages of 4 KiB a ray that goes where none was
// before waits for the page's address first and for its data then; Linux gives pages of 2 MiB to whom asks
// for them. A wish only: without such pages the memory is ordinary.
#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace hrt
{

template <class T>
struct HugePageAllocator
{
  using value_type = T;
  static constexpr std::size_t kPage = std::size_t(2) << 20;

  HugePageAllocator() = default;
  template <class U>
  HugePageAllocator(const HugePageAllocator<U>&)
  {
  }

  T* allocate(std::size_t count)
  {
    const std::size_t bytes = count * sizeof(T);
    void* const memory = ::operator new(bytes, alignment(bytes));
#if defined(__linux__)
    if (bytes >= kPage)
    {
      // Whole pages only: the rest would take one more for itself.
      madvise(memory, bytes / kPage * kPage, MADV_HUGEPAGE);
    }
#endif
    return static_cast<T*>(memory);
  }

  void deallocate(T* memory, std::size_t count)
  {
    ::operator delete(memory, alignment(count * sizeof(T)));
  }

  // A vector made with a size is left to whom fills it, by all threads.
  template <class U>
  void construct(U* place)
  {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments)
  {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }

  bool operator==(const HugePageAllocator&) const { return true; }
  bool operator!=(const HugePageAllocator&) const { return false; }

private:
  static std::align_val_t alignment(std::size_t bytes)
  {
    return std::align_val_t(bytes >= kPage ? kPage : alignof(T));
  }
};

template <class T>
using HugePageVector = std::vector<T, HugePageAllocator<T>>;

} // namespace hrt
