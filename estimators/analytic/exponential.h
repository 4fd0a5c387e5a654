#pragma once

// The integrand of the teaching estimators, f(x) = e^(3x) on [0, 1], and what is known of it.

#include <cmath>
#include <span>
#include <vector>

#include "estimators/estimator.h"

namespace assay::analytic {

inline double integrand(double x) { return std::exp(3 * x); }
/// (e^3 - 1) / 3 = 6.361845641
inline double integral() { return std::expm1(3) / 3; }
/// The integral of f^2, (e^6 - 1) / 6.
inline double integral_of_square() { return std::expm1(6) / 6; }

/// A density near f: q(x) = 5 (1 + x)^4 / 31 on [0, 1].
inline double near_density(double x) {
  const double square = (1 + x) * (1 + x);
  return 5 * square * square / 31;
}

/// f(x) = e^(3x) and g(x) = 5 (1 + x)^4 / 31, of integral 1, at one point.
struct RatioPair {
  double full = 0;
  double target = 0;
};

/// At x uniform in [0, 1).
inline RatioPair same_point(Stream& random) {
  const double x = random.uniform();
  return {integrand(x), near_density(x)};
}

inline RatioPair sum(std::span<const RatioPair> pairs) {
  RatioPair all;
  for (const RatioPair& pair : pairs) {
    all.full += pair.full;
    all.target += pair.target;
  }
  return all;
}

inline double ratio_of_sums(std::span<const RatioPair> pairs) {
  const RatioPair all = sum(pairs);
  return all.full / all.target;
}

/// The jackknife (Quenouille 1956) removes the term 1/M of the bias. It subtracts (M - 1) times the
/// mean change of R when one pair is left out. The function `replicate` gives a ratio from the
/// means with a pair left out and the means of all. One pair gives R as it is.
auto jackknife(const auto& replicate) {
  return [replicate](std::span<const RatioPair> pairs) {
    const RatioPair all = sum(pairs);
    const auto count = static_cast<double>(pairs.size());
    const double ratio = all.full / all.target;
    if (pairs.size() < 2) return ratio;
    const RatioPair mean{all.full / count, all.target / count};
    double replicates = 0;
    for (const RatioPair& pair : pairs) {
      replicates += replicate(
          RatioPair{(all.full - pair.full) / (count - 1), (all.target - pair.target) / (count - 1)},
          mean);
    }
    return count * ratio - (count - 1) * replicates / count;
  };
}

/// `draw` makes a pair, `combine` the estimate of all.
std::shared_ptr<const Setup> ratio_setup(Channel channel, auto draw, auto combine) {
  const auto estimate = [draw, combine, pairs = std::vector<RatioPair>()](
                            Stream& random, std::uint64_t primaries, std::span<double> out,
                            Cost& cost) mutable {
    pairs.resize(primaries);
    for (RatioPair& pair : pairs) pair = draw(random);
    out[0] = combine(pairs);
    cost.samples += primaries;
  };
  return setup_of({.channels = {std::move(channel)}, .make = estimating(estimate)});
}

}  // namespace assay::analytic
