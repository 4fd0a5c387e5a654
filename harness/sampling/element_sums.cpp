#include "harness/sampling/element_sums.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "harness/base/parallel.h"
#include "stats/images/image_moments.h"

namespace assay::harness {

void Extremes::add(std::span<const float> values) {
  // So many numbers have extremes of their own, so that none waits for the last.
  constexpr std::size_t apart = 32;
  std::array<float, apart> low;
  std::array<float, apart> high;
  std::array<std::uint32_t, apart> not_zero{};
  low.fill(std::numeric_limits<float>::infinity());
  high.fill(-std::numeric_limits<float>::infinity());
  const auto take = [&](float value, std::size_t k) {
    low[k] = value < low[k] ? value : low[k];
    high[k] = value > high[k] ? value : high[k];
    not_zero[k] += value != 0 ? 1 : 0;
  };
  const std::size_t whole = values.size() / apart * apart;
  for (std::size_t i = 0; i < whole; i += apart) {
    for (std::size_t k = 0; k < apart; ++k) take(values[i + k], k);
  }
  for (std::size_t i = whole; i < values.size(); ++i) take(values[i], i - whole);
  minimum = std::min(minimum, double{*std::ranges::min_element(low)});
  maximum = std::max(maximum, double{*std::ranges::max_element(high)});
  nonzero += std::accumulate(not_zero.begin(), not_zero.end(), std::uint64_t{0});
}

void Extremes::merge(const Extremes& other) {
  minimum = std::min(minimum, other.minimum);
  maximum = std::max(maximum, other.maximum);
  nonzero += other.nonzero;
}

stats::Moments ElementSums::moments(std::size_t channel) const {
  if (channel == 0) return first;
  if (channel == mean.size()) return average;
  return {.count = count, .mean = mean[channel], .m2 = m2[channel]};
}

stats::MomentArrays ElementSums::room_for(const stats::ImageStack& stack, stats::RowRange rows) {
  mean.resize(stack.extent.elements());
  m2.resize(stack.extent.elements());
  if (rows.first == 0) stats::element_moments(stack, 0, std::span(&first, 1));
  const stats::ElementRange range = rows.elements(stack.extent);
  return stats::MomentArrays{mean, m2}.part(range.first, range.size());
}

void ElementSums::take(const stats::ImageStack& stack, stats::RowRange rows) {
  const stats::MomentArrays moments = room_for(stack, rows);
  const std::size_t row = stack.extent.row();
  on_all_threads(rows.last - rows.first, [&](std::size_t y) {
    stats::moments_of_range(stack, (rows.first + y) * row, moments.part(y * row, row));
  });
}

}  // namespace assay::harness
