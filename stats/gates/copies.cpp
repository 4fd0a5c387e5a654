#include "stats/gates/copies.h"

#include <algorithm>
#include <bit>
#include <boost/container_hash/hash.hpp>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace assay::stats {
namespace {

constexpr double chance_of_run = 1e-5;

bool same(double x, double y) {
  return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
}

struct Stay {
  double value;
  std::size_t begin;
  std::size_t length;

  bool operator==(const Stay& other) const {
    return length == other.length && same(value, other.value);
  }
};

using Stays = std::vector<Stay>;

Stays stays_of(std::span<const double> values) {
  Stays stays;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (stays.empty() || !same(stays.back().value, values[i])) stays.push_back({values[i], i, 0});
    ++stays.back().length;
  }
  return stays;
}

// Number of stays, so that a run occurs twice with probability at most `chance_of_run` over all
// pairs of places.
std::size_t stays_needed(double pairs) {
  return 1 + static_cast<std::size_t>(std::ceil(std::max(2.0, std::log2(pairs / chance_of_run))));
}

// Hashes of all windows of so many stays, as differences of hashes from the first stay on (Karp &
// Rabin 1987).
class WindowHashes {
 public:
  WindowHashes(const Stays& stays, std::size_t size) : size_(size) {
    constexpr std::size_t factor = 0x9e3779b97f4a7c15;
    for (std::size_t i = 0; i < size; ++i) power_ *= factor;
    from_first_.reserve(stays.size() + 1);
    from_first_.push_back(0);
    for (const Stay& stay : stays) {
      std::size_t hash = stay.length;
      boost::hash_combine(hash, std::bit_cast<std::uint64_t>(stay.value));
      from_first_.push_back(from_first_.back() * factor + hash);
    }
  }
  bool has(std::size_t window) const { return window + size_ < from_first_.size(); }
  std::size_t operator[](std::size_t window) const {
    return from_first_[window + size_] - from_first_[window] * power_;
  }

 private:
  std::size_t size_;
  std::size_t power_ = 1;
  std::vector<std::size_t> from_first_;
};

// Neighbours differ. So a third value is not that two before it.
bool has_three_values(std::span<const Stay> window) {
  return !std::ranges::equal(window.first(window.size() - 2), window.subspan(2), same, &Stay::value,
                             &Stay::value);
}

// Number of equal stays around and in two windows.
std::size_t shared(const Stays& a, std::size_t i, const Stays& b, std::size_t j) {
  std::size_t count = 0;
  while (i + count < a.size() && j + count < b.size() && a[i + count] == b[j + count]) ++count;
  while (i > 0 && j > 0 && a[--i] == b[--j]) ++count;
  return count;
}

// The longest run of equal values through two places where they are equal.
RepeatedRun run_through(std::span<const double> a, std::size_t i, std::span<const double> b,
                        std::size_t j) {
  while (i > 0 && j > 0 && same(a[i - 1], b[j - 1])) {
    --i;
    --j;
  }
  std::size_t length = 0;
  while (i + length < a.size() && j + length < b.size() && same(a[i + length], b[j + length])) {
    ++length;
  }
  return {.first = i, .second = j, .length = length};
}

// A run of the second sample that the first one has, among so many pairs of places. If they are one
// sample, it has the run before.
std::optional<RepeatedRun> run_again(std::span<const double> first, std::span<const double> second,
                                     double pairs, bool of_one) {
  // Many windows of one hash are a short pattern over and over, and one of them will do.
  constexpr std::size_t most = 4;
  const std::size_t needed = stays_needed(pairs);
  const Stays one = stays_of(first);
  const Stays other = of_one ? Stays() : stays_of(second);
  const Stays& two = of_one ? one : other;
  // Windows that do not overlap, by their hashes. A run of twice their size less one has one.
  const std::size_t size = (needed + 1) / 2;
  std::unordered_multimap<std::size_t, std::size_t> anchors;
  const auto add = [&](std::size_t place, std::size_t hash) {
    if (!has_three_values(std::span(one).subspan(place, size))) return;
    if (anchors.count(hash) < most) anchors.emplace(hash, place);
  };
  if (!of_one) {
    const WindowHashes hashes(one, size);
    for (std::size_t i = 0; hashes.has(i); i += size) add(i, hashes[i]);
  }
  const WindowHashes hashes(two, size);
  for (std::size_t i = 0; hashes.has(i); ++i) {
    const auto [begin, end] = anchors.equal_range(hashes[i]);
    for (auto anchor = begin; anchor != end; ++anchor) {
      if (shared(one, anchor->second, two, i) < needed) continue;
      return run_through(first, one[anchor->second].begin, second, two[i].begin);
    }
    if (of_one && i % size == 0) add(i, hashes[i]);
  }
  return {};
}

}  // namespace

std::optional<RepeatedRun> repeated_run(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  return run_again(values, values, n * (n - 1) / 2, true);
}

std::optional<RepeatedRun> common_run(std::span<const double> first,
                                      std::span<const double> second) {
  return run_again(first, second,
                   static_cast<double>(first.size()) * static_cast<double>(second.size()), false);
}

}  // namespace assay::stats
