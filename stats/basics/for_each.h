#pragma once

#include <cstddef>
#include <functional>

namespace assay::stats {

// Calls work(i) for every i below a count. The calls may come in any order and at the same time.
// Results are the same to the last bit.
using ForEach =
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& work)>;

inline void one_by_one(std::size_t count, const std::function<void(std::size_t)>& work) {
  for (std::size_t i = 0; i < count; ++i) work(i);
}

}  // namespace assay::stats
