#include "harness/base/quantiles.h"

#include <algorithm>
#include <cmath>

#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

constexpr std::size_t most_points = 99;

}  // namespace

std::vector<reports::QuantilePoint> quantile_points(std::span<const double> values) {
  std::vector<double> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted),
               [](double value) { return std::isfinite(value); });
  std::sort(sorted.begin(), sorted.end());
  const std::size_t points = std::min(sorted.size(), most_points);
  std::vector<reports::QuantilePoint> plot;
  for (std::size_t i = 0; i < points; ++i) {
    const double probability = (static_cast<double>(i) + 0.5) / static_cast<double>(points);
    const auto rank = static_cast<std::size_t>(probability * static_cast<double>(sorted.size()));
    plot.push_back({.normal = stats::normal_quantile({stats::Tail::lower, std::log(probability)}),
                    .observed = sorted[rank]});
  }
  return plot;
}

}  // namespace assay::harness
