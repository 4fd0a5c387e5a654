#pragma once

#include <cstddef>
#include <functional>

namespace assay::tests {

// A stats::ForEach in another order than one_by_one.
inline void last_first(std::size_t count, const std::function<void(std::size_t)>& work) {
  for (std::size_t i = count; i > 0; --i) work(i - 1);
}

}  // namespace assay::tests
