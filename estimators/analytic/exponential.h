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
struct SamePoint {
  RatioPair operator()(Stream& random) const {
    const double x = random.uniform();
    return {integrand(x), near_density(x)};
  }
};

inline RatioPair sum(std::span<const RatioPair> pairs) {
  RatioPair all;
  for (const RatioPair& pair : pairs) {
    all.full += pair.full;
    all.target += pair.target;
  }
  return all;
}

struct RatioOfSums {
  double operator()(std::span<const RatioPair> pairs) const {
    const RatioPair all = sum(pairs);
    return all.full / all.target;
  }
};

/// The means of all pairs but one.
struct LeftOut {
  RatioPair all;
  double count;

  RatioPair mean() const { return {all.full / count, all.target / count}; }
  RatioPair without(const RatioPair& pair) const {
    return {(all.full - pair.full) / (count - 1), (all.target - pair.target) / (count - 1)};
  }
};

/// The jackknife (Quenouille 1956) removes the term 1/M of the bias. It subtracts (M - 1) times the
/// mean change of R when one pair is left out. The function `Replicate` gives a ratio from the
/// means with a pair left out and the means of all. One pair gives R as it is.
template <class Replicate>
struct Jackknife {
  double operator()(std::span<const RatioPair> pairs) const {
    const LeftOut left{sum(pairs), static_cast<double>(pairs.size())};
    const double ratio = left.all.full / left.all.target;
    if (pairs.size() < 2) return ratio;
    double replicates = 0;
    for (const RatioPair& pair : pairs) {
      replicates += Replicate{}(left.without(pair), left.mean());
    }
    return left.count * ratio - (left.count - 1) * replicates / left.count;
  }
};

struct BothLeftOut {
  double operator()(const RatioPair& without, const RatioPair& /*all*/) const {
    return without.full / without.target;
  }
};

/// `Draw` makes a pair, `Combine` the estimate of all.
template <class Draw, class Combine>
class RatioEstimator final : public Estimator {
 public:
  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    pairs_.resize(primaries);
    for (RatioPair& pair : pairs_) pair = Draw{}(random);
    out[0] = Combine{}(pairs_);
    cost.samples += primaries;
  }

 private:
  std::vector<RatioPair> pairs_;  // scratch
};

template <class Draw, class Combine>
std::shared_ptr<const Setup> ratio_setup(Channel channel) {
  return setup_of({.channels = {std::move(channel)},
                   .make = [] { return std::make_unique<RatioEstimator<Draw, Combine>>(); }});
}

}  // namespace assay::analytic
