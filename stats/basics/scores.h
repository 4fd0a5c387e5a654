#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace assay::stats {

// Midranks from 0 on: equal values share the mean of their places. `order` is room for the order.
template <class Real>
void midranks(std::span<const Real> values, std::vector<std::uint32_t>& order,
              std::vector<double>& ranks) {
  order.resize(values.size());
  ranks.resize(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](std::uint32_t i) { return values[i]; });
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i + 1;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (std::size_t j = i; j < end; ++j) ranks[order[j]] = static_cast<double>(i + end - 1) / 2;
    i = end;
  }
}

// Shifts and scales values to mean 0 and mean square 1. Values that are all equal become 0, and the
// result is false.
inline bool standardise(std::span<double> values) {
  const auto [least, most] = std::ranges::minmax(values);
  if (least == most) {
    std::ranges::fill(values, 0);
    return false;
  }
  const auto count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (double& value : values) {
    value -= mean;
    squares += value * value;
  }
  const double scale = 1 / std::sqrt(squares / count);
  for (double& value : values) value *= scale;
  return true;
}

}  // namespace assay::stats
