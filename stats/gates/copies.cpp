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
  std::uint64_t hash() const {
    std::size_t hash = length;
    boost::hash_combine(hash, std::bit_cast<std::uint64_t>(value));
    return hash;
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

// Hashes of all windows of so many stays in turn. It also says if a window has three values.
class Windows {
 public:
  Windows(const Stays& stays, std::size_t size) : stays_(stays), size_(size) {
    for (std::size_t i = 1; i < size_; ++i) highest_ *= factor;
    for (std::size_t i = 0; i < size_ && i < stays_.size(); ++i) take(i);
  }

  bool done() const { return at_ + size_ > stays_.size(); }
  std::size_t at() const { return at_; }
  std::uint64_t hash() const { return hash_; }
  // Neighbours differ. So the third value of a window is the first that is not that two before it.
  bool has_three_values() const { return third_ >= at_ + 2; }
  void advance() {
    hash_ -= highest_ * stays_[at_].hash();
    ++at_;
    if (!done()) take(at_ + size_ - 1);
  }

 private:
  static constexpr std::uint64_t factor = 0x9e3779b97f4a7c15;

  void take(std::size_t i) {
    hash_ = hash_ * factor + stays_[i].hash();
    if (i >= 2 && !same(stays_[i].value, stays_[i - 2].value)) third_ = i;
  }

  const Stays& stays_;
  std::size_t size_;
  std::size_t at_ = 0;
  // The last stay that is not that two before it.
  std::size_t third_ = 0;
  std::uint64_t highest_ = 1;
  std::uint64_t hash_ = 0;
};

// Windows that do not overlap, by their hashes. A run of twice their size less one has one of
// them.
class Anchors {
 public:
  explicit Anchors(std::size_t size) : size_(size) {}

  void add(const Windows& window) {
    // Many windows of one hash are a short pattern over and over, and one of them will do.
    constexpr std::size_t most = 4;
    if (window.at() % size_ != 0 || !window.has_three_values()) return;
    if (places_.count(window.hash()) < most) places_.emplace(window.hash(), window.at());
  }
  std::size_t size() const { return size_; }
  std::vector<std::size_t> at(const Windows& window) const {
    std::vector<std::size_t> places;
    const auto [begin, end] = places_.equal_range(window.hash());
    for (auto place = begin; place != end; ++place) places.push_back(place->second);
    return places;
  }

 private:
  std::size_t size_;
  std::unordered_multimap<std::uint64_t, std::size_t> places_;
};

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

}  // namespace

std::optional<RepeatedRun> repeated_run(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  const std::size_t needed = stays_needed(n * (n - 1) / 2);
  const Stays stays = stays_of(values);
  Anchors anchors((needed + 1) / 2);
  for (Windows window(stays, anchors.size()); !window.done(); window.advance()) {
    for (const std::size_t earlier : anchors.at(window)) {
      if (shared(stays, earlier, stays, window.at()) < needed) continue;
      return run_through(values, stays[earlier].begin, values, stays[window.at()].begin);
    }
    anchors.add(window);
  }
  return {};
}

std::optional<RepeatedRun> common_run(std::span<const double> first,
                                      std::span<const double> second) {
  const std::size_t needed =
      stays_needed(static_cast<double>(first.size()) * static_cast<double>(second.size()));
  const Stays one = stays_of(first);
  const Stays two = stays_of(second);
  Anchors anchors((needed + 1) / 2);
  for (Windows window(one, anchors.size()); !window.done(); window.advance()) anchors.add(window);
  for (Windows window(two, anchors.size()); !window.done(); window.advance()) {
    for (const std::size_t place : anchors.at(window)) {
      if (shared(one, place, two, window.at()) < needed) continue;
      return run_through(first, one[place].begin, second, two[window.at()].begin);
    }
  }
  return {};
}

}  // namespace assay::stats
