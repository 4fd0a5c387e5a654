#include "stats/basics/joint_moments.h"

#include <algorithm>
#include <cmath>

#include "stats/basics/vector_copies.h"

namespace assay::stats {
namespace {

constexpr std::size_t weight = JointMoments::weight;
constexpr std::size_t powers_of_cost = JointMoments::powers_of_cost;
constexpr auto at_powers = JointMoments::place;
static_assert(at_powers(0, powers_of_cost) + 1 == JointMoments::count_of_sums);

using Sums = std::array<double, JointMoments::count_of_sums>;

// Binomial coefficients up to the weight.
constexpr auto choose = [] {
  std::array<std::array<double, weight + 1>, weight + 1> c{};
  for (std::size_t n = 0; n <= weight; ++n) {
    c[n][0] = 1;
    for (std::size_t k = 1; k <= n; ++k) c[n][k] = c[n - 1][k - 1] + (k < n ? c[n - 1][k] : 0);
  }
  return c;
}();

// Denormal numbers have lost their digits.
constexpr double least_with_digits =
    std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();

// A quick test that settles nearly all of an image's millions of elements.
bool are_ordinary(const Moments& moments) {
  return moments.m2 > 1e-60 && moments.m2 < 1e60 && std::abs(moments.m3) < 1e90 &&
         moments.m4 > 1e-120 && moments.m4 < 1e120;
}

enum class Along { x, cost };

// Sums of (d + step)^i e^j from those of d^i e^j for each j, or of d^i (e + step)^j for each i.
void move_origin(Sums& sums, Along along, double step) {
  if (step == 0) return;
  std::array<double, weight + 1> power{1};
  for (std::size_t n = 1; n <= weight; ++n) power[n] = power[n - 1] * step;
  const bool of_x = along == Along::x;
  for (std::size_t other = 0; other <= (of_x ? powers_of_cost : weight); ++other) {
    const auto at = [&](std::size_t n) -> double& {
      return sums[of_x ? at_powers(n, other) : at_powers(other, n)];
    };
    // Higher powers first: each needs the lower ones as they were.
    for (std::size_t n = of_x ? weight - 2 * other : (weight - other) / 2; n > 0; --n) {
      double moved = at(n);
      for (std::size_t k = 0; k < n; ++k) moved += choose[n][k] * power[n - k] * at(k);
      at(n) = moved;
    }
  }
}

constexpr std::size_t most_at_once = 256;
// Pairs that are summed side by side, in a fixed order whatever the machine.
constexpr std::size_t lanes = 8;

struct Deviations {
  std::size_t count = 0;  // Zeros fill the last lanes.
  alignas(64) std::array<double, most_at_once> d;
  alignas(64) std::array<double, most_at_once> e;
};

template <std::size_t degree>
void add_powers(const Deviations& of, std::array<double, most_at_once>& factor, double* sums) {
  std::array<std::array<double, lanes>, degree + 1> parts{};
  for (std::size_t first = 0; first < of.count; first += lanes) {
    std::array<double, lanes> power;
    for (std::size_t l = 0; l < lanes; ++l) power[l] = factor[first + l];
    for (std::size_t l = 0; l < lanes; ++l) parts[0][l] += power[l];
#pragma GCC unroll 8
    for (std::size_t i = 1; i <= degree; ++i) {
      for (std::size_t l = 0; l < lanes; ++l) power[l] *= of.d[first + l];
      for (std::size_t l = 0; l < lanes; ++l) parts[i][l] += power[l];
    }
    for (std::size_t l = 0; l < lanes; ++l) factor[first + l] *= of.e[first + l];
  }
  for (std::size_t i = 0; i <= degree; ++i) {
    double sum = 0;
    for (const double part : parts[i]) sum += part;
    sums[i] = sum;
  }
}

ASSAY_VECTOR_COPIES void sum_powers(const Deviations& of, bool with_cost, Sums& sums) {
  alignas(64) std::array<double, most_at_once> factor{};
  std::fill_n(factor.begin(), of.count, 1.0);
  add_powers<weight>(of, factor, &sums[at_powers(0, 0)]);
  if (!with_cost) return;
  add_powers<weight - 2>(of, factor, &sums[at_powers(0, 1)]);
  add_powers<weight - 4>(of, factor, &sums[at_powers(0, 2)]);
  add_powers<weight - 6>(of, factor, &sums[at_powers(0, 3)]);
  add_powers<weight - 8>(of, factor, &sums[at_powers(0, 4)]);
}

Moments moments_of(const JointMoments& joint, const JointMoments::Coordinate& coordinate,
                   const std::array<double, 3>& sums) {
  return {.count = joint.count,
          .mean = coordinate.mean,
          .m2 = sums[0],
          .m3 = sums[1],
          .m4 = sums[2],
          .minimum = coordinate.minimum,
          .maximum = coordinate.maximum,
          .nonzero = 0,
          .rest = coordinate.rest};
}

}  // namespace

void JointMoments::merge(const JointMoments& other) {
  if (other.count == 0) return;
  if (count == 0) {
    *this = other;
    return;
  }
  const double here = static_cast<double>(count);
  const double there = static_cast<double>(other.count);
  const double share = there / (here + there);
  Sums theirs = other.sums;
  const auto merge_along = [&](Along along, Coordinate& ours, const Coordinate& coordinate) {
    const double step = (coordinate.mean - ours.mean) + (coordinate.rest - ours.rest);
    move_origin(sums, along, -step * share);
    move_origin(theirs, along, step * (1 - share));
    move_compensated(step * share, ours.mean, ours.rest);
    ours.minimum = std::min(ours.minimum, coordinate.minimum);
    ours.maximum = std::max(ours.maximum, coordinate.maximum);
  };
  merge_along(Along::x, of_x, other.of_x);
  merge_along(Along::cost, of_cost, other.of_cost);
  for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += theirs[k];
  // The deviations sum to zero by definition.
  sums[at_powers(1, 0)] = 0;
  sums[at_powers(0, 1)] = 0;
  count += other.count;
  known = std::min(known, other.known);
}

bool has_sound_powers(const JointMoments& powers) {
  return powers.sum(powers.known, 0) > least_with_digits &&
         std::ranges::all_of(powers.sums, [](double sum) { return std::isfinite(sum); });
}

bool has_sound_powers(const Moments& moments) {
  if (moments.count < 2 || are_ordinary(moments)) return true;
  return moments.m2 * moments.m2 > least_with_digits && std::isfinite(moments.m2) &&
         std::isfinite(moments.m4) && moments.m4 > least_with_digits &&
         std::isfinite(moments.skewness()) && std::isfinite(moments.kurtosis());
}

JointMoments joint_of_four(const Moments& x, double cost) {
  JointMoments joint{.count = x.count,
                     .known = 4,
                     .of_x = {x.mean, x.rest, x.minimum, x.maximum},
                     .of_cost = {cost, 0, cost, cost}};
  joint.sums[at_powers(0, 0)] = static_cast<double>(x.count);
  joint.sums[at_powers(2, 0)] = x.m2;
  joint.sums[at_powers(3, 0)] = x.m3;
  joint.sums[at_powers(4, 0)] = x.m4;
  return joint;
}

Moments JointMoments::x() const {
  return moments_of(*this, of_x, {sum(2, 0), sum(3, 0), sum(4, 0)});
}

Moments JointMoments::cost() const {
  return moments_of(*this, of_cost, {sum(0, 2), sum(0, 3), sum(0, 4)});
}

JointMoments JointSums::of_waiting() const {
  JointMoments part;
  part.count = waiting_.size();
  if (waiting_.empty()) return part;
  const double n = static_cast<double>(waiting_.size());
  const Pair first = waiting_[0];
  double sum_x = 0;
  double sum_cost = 0;
  for (const Pair& pair : waiting_) {
    sum_x += pair.x - first.x;
    sum_cost += pair.cost - first.cost;
    part.of_x.minimum = std::min(part.of_x.minimum, pair.x);
    part.of_x.maximum = std::max(part.of_x.maximum, pair.x);
    part.of_cost.minimum = std::min(part.of_cost.minimum, pair.cost);
    part.of_cost.maximum = std::max(part.of_cost.maximum, pair.cost);
  }
  part.of_x.mean = first.x;
  move_compensated(sum_x / n, part.of_x.mean, part.of_x.rest);
  part.of_cost.mean = first.cost;
  move_compensated(sum_cost / n, part.of_cost.mean, part.of_cost.rest);
  Deviations deviations;
  deviations.count = (waiting_.size() + lanes - 1) / lanes * lanes;
  for (std::size_t k = 0; k < waiting_.size(); ++k) {
    deviations.d[k] = (waiting_[k].x - first.x) - sum_x / n;
    deviations.e[k] = (waiting_[k].cost - first.cost) - sum_cost / n;
  }
  for (std::size_t k = waiting_.size(); k < deviations.count; ++k) {
    deviations.d[k] = 0;
    deviations.e[k] = 0;
  }
  sum_powers(deviations, part.of_cost.minimum < part.of_cost.maximum, part.sums);
  part.sums[at_powers(0, 0)] = n;
  part.sums[at_powers(1, 0)] = 0;
  part.sums[at_powers(0, 1)] = 0;
  return part;
}

void JointSums::sum_waiting() {
  summed_.merge(of_waiting());
  waiting_.clear();
}

void JointSums::merge(const JointSums& other) {
  sum_waiting();
  summed_.merge(other.moments());
}

JointMoments JointSums::moments() const {
  JointMoments all = summed_;
  all.merge(of_waiting());
  return all;
}

}  // namespace assay::stats
