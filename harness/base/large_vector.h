#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

namespace assay::harness {

/// Allocates large arrays in large pages, if the system has them: a first touch costs less than
/// that of many small ones.
template <class T>
struct LargePages {
  using value_type = T;
  LargePages() = default;
  template <class Other>
  LargePages(const LargePages<Other>&) {}

  T* allocate(std::size_t count) {
    constexpr std::size_t page = std::size_t{1} << 21;
    const std::size_t bytes = count * sizeof(T);
    const bool large = bytes >= page;
    void* const room =
        large ? std::aligned_alloc(page, (bytes + page - 1) / page * page) : std::malloc(bytes);
    if (room == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    if (large) madvise(room, bytes, MADV_HUGEPAGE);
#endif
    return static_cast<T*>(room);
  }
  void deallocate(T* room, std::size_t) { std::free(room); }
  friend bool operator==(const LargePages&, const LargePages&) = default;
};

template <class T>
using LargeVector = std::vector<T, LargePages<T>>;

}  // namespace assay::harness
