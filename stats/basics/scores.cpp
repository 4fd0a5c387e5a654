#include "stats/basics/scores.h"

#include <algorithm>
#include <bit>
#include <boost/sort/pdqsort/pdqsort.hpp>
#include <boost/sort/spreadsort/float_sort.hpp>
#include <cmath>
#include <cstdint>
#include <map>
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

// The places below n in a fixed order that is as good as random, among others up to twice n.
std::span<const std::size_t> scattered_places(std::size_t n) {
  thread_local std::map<std::size_t, std::vector<std::size_t>> orders;
  const auto [found, added] = orders.try_emplace(std::bit_ceil(n));
  std::vector<std::size_t>& places = found->second;
  if (added) {
    places.resize(found->first);
    std::iota(places.begin(), places.end(), 0);
    std::ranges::sort(places, {}, [](std::size_t place) {
      return splitmix64_finalised(place + 0x9e3779b97f4a7c15);
    });
  }
  return places;
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
  const double middle = static_cast<double>(values.size() - 1) / 2;
  std::vector<double> ranks(values.size());
  std::vector<std::size_t> tie_of(values.size());
  std::vector<double> next(values.size());
  for_each_tie(order, [&](std::size_t first, std::size_t end) {
    next[first] = static_cast<double>(first) - middle;
    for (std::size_t i = first; i < end; ++i) tie_of[order[i].place] = first;
  });
  for (const std::size_t place : scattered_places(values.size())) {
    if (place < values.size()) ranks[place] = next[tie_of[place]]++;
  }
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
