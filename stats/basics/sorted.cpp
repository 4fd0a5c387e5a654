#include "stats/basics/sorted.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace assay::stats {
namespace {

constexpr std::size_t few = 512;
constexpr int digit_bits = 8;
constexpr std::size_t base = std::size_t{1} << digit_bits;
constexpr std::size_t digits = 64 / digit_bits;
constexpr std::uint64_t sign = std::uint64_t{1} << 63;

// Whole numbers in the order of the doubles: the bits of negative ones run downwards.
std::uint64_t key_of(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return bits & sign ? ~bits : bits | sign;
}

double value_of(std::uint64_t key) {
  return std::bit_cast<double>(key & sign ? key & ~sign : ~key);
}

std::size_t digit_of(std::uint64_t key, std::size_t place) {
  return (key >> (digit_bits * place)) % base;
}

using Counts = std::array<std::array<std::size_t, base>, digits>;

Counts counts_of(const std::vector<std::uint64_t>& keys) {
  Counts counts{};
  for (const std::uint64_t key : keys) {
    for (std::size_t place = 0; place < digits; ++place) ++counts[place][digit_of(key, place)];
  }
  return counts;
}

void sort_by_digit(const std::vector<std::uint64_t>& from, std::vector<std::uint64_t>& to,
                   std::size_t place, std::array<std::size_t, base> count) {
  std::size_t first = 0;
  for (std::size_t& each : count) first += std::exchange(each, first);
  for (const std::uint64_t key : from) to[count[digit_of(key, place)]++] = key;
}

}  // namespace

std::vector<double> sorted(std::vector<double> values) {
  if (values.size() < few) {
    std::sort(values.begin(), values.end());
    return values;
  }
  std::vector<std::uint64_t> keys(values.size());
  std::transform(values.begin(), values.end(), keys.begin(), key_of);
  std::vector<std::uint64_t> other(keys.size());
  const Counts counts = counts_of(keys);
  for (std::size_t place = 0; place < digits; ++place) {
    // A digit that all share, as most of the exponent is, orders nothing.
    if (counts[place][digit_of(keys[0], place)] == keys.size()) continue;
    sort_by_digit(keys, other, place, counts[place]);
    keys.swap(other);
  }
  std::transform(keys.begin(), keys.end(), values.begin(), value_of);
  return values;
}

}  // namespace assay::stats
