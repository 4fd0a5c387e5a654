#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "stats/basics/check.h"
#include "stats/basics/for_each.h"
#include "stats/images/image.h"

// Internal to image_equivalence: sums over an image's elements, and without each replicate in turn.
namespace assay::stats::jackknifed {

inline constexpr std::size_t block_size = 512;
// Elements that a thread takes at a time.
inline constexpr std::size_t range_size = 64 * block_size;
using Block = std::array<double, block_size>;

// Means and squared errors of the elements of a block.
struct Estimates {
  Block mean{};
  Block squared_error{};
};

// Sums over elements of one or more terms.
template <std::size_t count>
using Sums = std::array<double, count>;

// The terms of a block: the first kind for all its elements, then the second.
template <std::size_t count>
using Terms = std::array<Block, count>;

// Covariance of two jackknifed sums: (n - 1) / n times the sum of products about the means.
template <std::size_t count>
double jackknife_covariance(const std::vector<Sums<count>>& values, std::size_t i, std::size_t j) {
  if (values.empty()) return 0;
  const double n = static_cast<double>(values.size());
  Sums<count> mean{};
  for (const Sums<count>& value : values) {
    for (std::size_t k = 0; k < count; ++k) mean[k] += value[k] / n;
  }
  double products = 0;
  for (const Sums<count>& value : values) products += (value[i] - mean[i]) * (value[j] - mean[j]);
  return products * (n - 1) / n;
}

// Sums over elements of the terms of (estimate of a, estimate of b), whole and without each
// replicate.
template <std::size_t count>
struct Jackknife {
  Sums<count> whole{};
  std::vector<Sums<count>> without_a;
  std::vector<Sums<count>> without_b;

  double covariance(std::size_t i, std::size_t j) const {
    return jackknife_covariance(without_a, i, j) + jackknife_covariance(without_b, i, j);
  }
  double degrees() const {
    const std::size_t fewest =
        without_b.empty() ? without_a.size() : std::min(without_a.size(), without_b.size());
    return static_cast<double>(fewest - 1);
  }
};

// Sums of several replicates take their terms in step. Each keeps the order of the elements, but
// none waits for the other's addition.
inline constexpr std::size_t in_step = 8;

template <std::size_t count>
using Step = std::array<Terms<count>, in_step>;

template <std::size_t count>
void add_in_step(std::span<Sums<count>> sums, const Step<count>& terms, std::size_t kind,
                 std::size_t size) {
  std::array<double, in_step> sum{};
  for (std::size_t k = 0; k < sums.size(); ++k) sum[k] = sums[k][kind];
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t k = 0; k < in_step; ++k) sum[k] += terms[k][kind][i];
  }
  for (std::size_t k = 0; k < sums.size(); ++k) sums[k][kind] = sum[k];
}

// Sums without each replicate in turn, of `kinds` kinds of terms. `terms_without` fills in the
// terms without replicate r.
template <std::size_t count, class TermsWithout>
void add_without(std::vector<Sums<count>>& sums, std::size_t kinds, std::size_t size,
                 Step<count>& step, const TermsWithout& terms_without) {
  for (std::size_t r = 0; r < sums.size(); r += in_step) {
    const auto some = std::span(sums).subspan(r, std::min(in_step, sums.size() - r));
    for (std::size_t k = 0; k < some.size(); ++k) terms_without(r + k, step[k]);
    for (std::size_t kind = 0; kind < kinds; ++kind) add_in_step(some, step, kind, size);
  }
}

// Adds up a range of elements that follows on those before.
template <std::size_t count, class First, class Second, class Term>
void add_range(Jackknife<count>& sums, ElementRange range, First a, Second b, const Term& term) {
  sums.without_a.resize(a.left_out());
  sums.without_b.resize(b.left_out());
  const auto step = std::make_unique<Step<count>>();
  const auto one = std::make_unique<Estimates>();
  for (std::size_t first = range.first; first < range.last; first += block_size) {
    const std::size_t size = std::min(block_size, range.last - first);
    a.load(first, size);
    b.load(first, size);
    term(a.all(), b.all(), (*step)[0], size);
    for (std::size_t kind = 0; kind < count; ++kind) {
      add_in_step(std::span(&sums.whole, 1), *step, kind, size);
    }
    add_without(sums.without_a, Term::kinds_of_a, size, *step,
                [&](std::size_t r, Terms<count>& terms) {
                  a.without(r, *one);
                  term(*one, b.all(), terms, size);
                });
    add_without(sums.without_b, count, size, *step, [&](std::size_t r, Terms<count>& terms) {
      b.without(r, *one);
      term(a.all(), *one, terms, size);
    });
  }
}

template <std::size_t count>
void add(Sums<count>& to, const Sums<count>& other) {
  for (std::size_t kind = 0; kind < count; ++kind) to[kind] += other[kind];
}

template <std::size_t count>
void add(std::vector<Sums<count>>& to, const std::vector<Sums<count>>& others) {
  for (std::size_t i = 0; i < to.size(); ++i) add(to[i], others[i]);
}

// Takes elements in their order. Sums over equal ranges are added up in order.
template <std::size_t count>
class RunningJackknife {
 public:
  // Elements that follow on those before, wherever these end.
  template <class First, class Second, class Term>
  void add(ElementRange elements, const First& a, const Second& b, const Term& term,
           const ForEach& for_each) {
    const std::size_t begin = elements.first / range_size;
    std::vector<Jackknife<count>> parts((elements.last - 1) / range_size + 1 - begin);
    if (elements.first % range_size != 0) parts[0] = std::move(open_);
    for_each(parts.size(), [&](std::size_t i) {
      const std::size_t first = (begin + i) * range_size;
      add_range(parts[i],
                {std::max(first, elements.first), std::min(first + range_size, elements.last)}, a,
                b, term);
    });
    open_ = {};
    if (elements.last % range_size != 0) {
      open_ = std::move(parts.back());
      parts.pop_back();
    }
    for (const Jackknife<count>& part : parts) take(part);
  }

  // To be called after the last elements. The first `kinds_of_a` terms depend on a.
  Jackknife<count> finish(std::size_t kinds_of_a) {
    if (!open_.without_a.empty()) take(open_);
    for (Sums<count>& without : sums_.without_a) {
      std::copy(sums_.whole.begin() + kinds_of_a, sums_.whole.end(), without.begin() + kinds_of_a);
    }
    for (const double sum : sums_.whole) {
      if (!std::isfinite(sum)) check::fail({"image_distance", "sum over the image"}, sum, "finite");
    }
    return sums_;
  }

 private:
  void take(const Jackknife<count>& part) {
    sums_.without_a.resize(part.without_a.size());
    sums_.without_b.resize(part.without_b.size());
    jackknifed::add(sums_.whole, part.whole);
    jackknifed::add(sums_.without_a, part.without_a);
    jackknifed::add(sums_.without_b, part.without_b);
  }

  Jackknife<count> sums_;
  Jackknife<count> open_;  // A range that is not complete.
};

}  // namespace assay::stats::jackknifed
