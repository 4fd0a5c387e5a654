#include "stats/gates/lagged_correlation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "stats/basics/splitmix64.h"

namespace assay::stats {
namespace {

constexpr std::size_t most_lags = 1000;
constexpr std::size_t most_products = 200'000'000;

// A fixed number that is as good as random.
std::uint64_t scattered(std::uint64_t number) {
  return splitmix64_finalised(number + 0x9e3779b97f4a7c15);
}

}  // namespace

std::vector<double> centred_ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t i, std::size_t j) {
    return values[i] != values[j] ? values[i] < values[j] : scattered(i) < scattered(j);
  });
  const double middle = static_cast<double>(values.size() - 1) / 2;
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) ranks[order[i]] = static_cast<double>(i) - middle;
  return ranks;
}

std::vector<LaggedCorrelation> lagged_correlations(std::span<const double> values,
                                                   std::size_t first) {
  const std::size_t n = values.size();
  const bool constant =
      std::ranges::adjacent_find(values, std::ranges::not_equal_to{}) == values.end();
  if (n < 8 || constant) return {};
  const std::vector<double> ranks = centred_ranks(values);
  const double squares = std::inner_product(ranks.begin(), ranks.end(), ranks.begin(), 0.0);
  const std::size_t farthest = std::min({n / 4, most_lags, most_products / n});
  const double count = static_cast<double>(n);
  std::vector<LaggedCorrelation> all;
  for (std::size_t lag = first; lag <= farthest; ++lag) {
    const auto later = ranks.begin() + static_cast<std::ptrdiff_t>(lag);
    const double r = std::inner_product(later, ranks.end(), ranks.begin(), 0.0) / squares;
    const double z = (r + 1 / count) * count / std::sqrt(count - static_cast<double>(lag));
    all.push_back({.lag = lag, .correlation = r, .z = z});
  }
  return all;
}

LaggedCorrelation worst_of(std::span<const LaggedCorrelation> all) {
  LaggedCorrelation worst;
  for (const LaggedCorrelation& each : all) {
    if (std::abs(each.z) > std::abs(worst.z)) worst = each;
  }
  return worst;
}

}  // namespace assay::stats
