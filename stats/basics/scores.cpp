#include "stats/basics/scores.h"

#include <algorithm>
#include <boost/sort/pdqsort/pdqsort.hpp>
#include <boost/sort/spreadsort/float_sort.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace assay::stats {
namespace {

// The values from the smallest on; equal ones in any order.
template <class Real>
void put_in_order(std::span<const Real> values, std::vector<Placed<Real>>& order) {
  order.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) order[i] = {values[i], i};
  boost::sort::pdqsort_branchless(
      order.begin(), order.end(),
      [](const Placed<Real>& a, const Placed<Real>& b) { return a.value < b.value; });
}

// The finaliser of Steele, Lea and Flood (2014): every bit of x flips each bit of the result with
// probability near 1/2.
constexpr std::uint64_t splitmix64_finalised(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

}  // namespace

std::vector<double> sorted(std::vector<double> values) {
  boost::sort::spreadsort::float_sort(values.begin(), values.end());
  return values;
}

std::size_t count_below(std::span<const double> ascending, double v) {
  return static_cast<std::size_t>(std::ranges::lower_bound(ascending, v) - ascending.begin());
}

std::size_t count_up_to(std::span<const double> ascending, double v) {
  return static_cast<std::size_t>(std::ranges::upper_bound(ascending, v) - ascending.begin());
}

template <class Real>
void midranks(std::span<const Real> values, std::vector<Placed<Real>>& order,
              std::vector<double>& ranks) {
  put_in_order(values, order);
  ranks.resize(values.size());
  for_each_tie(order, [&](std::size_t first, std::size_t end) {
    const double shared = static_cast<double>(first + end - 1) / 2;
    for (std::size_t i = first; i < end; ++i) ranks[order[i].place] = shared;
  });
}
template void midranks(std::span<const float>, std::vector<Placed<float>>&, std::vector<double>&);
template void midranks(std::span<const double>, std::vector<Placed<double>>&, std::vector<double>&);

std::vector<double> centred_ranks(std::span<const double> values) {
  std::vector<Placed<double>> order;
  put_in_order(values, order);
  struct Scattered {
    std::uint64_t turn;  // As good as random, and another for each place.
    std::size_t place;
  };
  const double middle = static_cast<double>(values.size() - 1) / 2;
  std::vector<double> ranks(values.size());
  std::vector<Scattered> tie;
  for_each_tie(order, [&](std::size_t first, std::size_t end) {
    tie.clear();
    for (std::size_t i = first; i < end; ++i) {
      const std::size_t place = order[i].place;
      tie.push_back({splitmix64_finalised(place + 0x9e3779b97f4a7c15), place});
    }
    boost::sort::pdqsort_branchless(
        tie.begin(), tie.end(),
        [](const Scattered& a, const Scattered& b) { return a.turn < b.turn; });
    for (std::size_t i = first; i < end; ++i) {
      ranks[tie[i - first].place] = static_cast<double>(i) - middle;
    }
  });
  return ranks;
}

bool standardise(std::span<double> values) {
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
