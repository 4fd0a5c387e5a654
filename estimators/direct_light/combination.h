#pragma once

// Weights of two sampling techniques (Veach 1997, sections 9.2.2 and 9.2.3).

#include <cstdint>

#include "direct_light/techniques.h"
#include "estimators/parameters.h"

namespace assay::direct_light {

/// Weights that sum to 1, from q_i, the density of a technique times its number of samples. In the
/// one-sample model q_i is the density times the technique's probability.
///  `balance      w_i = q_i / sum q_k  (eq. 9.8)
///   power        w_i = q_i^e / sum q_k^e
///   cutoff       0 where q_i < t max q_k, else q_i / sum of the q_k that are not
///   maximum      1 where q_i is the largest, else 0`.
/// All are functions of the ratio r of the smaller q to the larger. The technique of the larger has
/// the weight 1 / (1 + g(r)), with g = r, r^e, r [r >= t], 0.
class Heuristic {
 public:
  static Heuristic balance() { return Heuristic(1, 0); }
  static Heuristic power(double exponent) { return Heuristic(exponent, 0); }
  static Heuristic cutoff(double threshold) { return Heuristic(1, threshold); }
  static Heuristic maximum() { return Heuristic(1, 2); }

  /// One of q is above 0. Equal ones are as if the light's were the larger.
  Pair operator()(const Pair& q) const;
  /// True if weights are smooth functions of q.
  bool smooth() const { return threshold_ == 0; }

 private:
  Heuristic(double exponent, double threshold) : exponent_(exponent), threshold_(threshold) {}

  double of_smaller(double ratio) const;

  double exponent_;
  double threshold_;
};

/// `heuristic`: balance, power (of exponent 2), maximum, {power: exponent}, {cutoff: threshold}.
ParameterInformation heuristic_parameter();
/// InputError at the parameter for anything else, an exponent below 1 or a threshold outside [0,
/// 1].
Heuristic read_heuristic(Parameters&);

// Multiple importance sampling of the two techniques: the multi-sample and the one-sample model
// (Veach 1997, sections 9.2.1 and 9.2.4).

/// A Combination weighs a draw of either technique by light(p) and brdf(p), p the densities of both
/// there. This one is a heuristic on the densities times numbers of samples or probabilities.
class WeightedByHeuristic {
 public:
  WeightedByHeuristic(Heuristic heuristic, Pair shares) : heuristic_(heuristic), shares_(shares) {}

  double light(const Pair& p) const { return weights(p).light; }
  double brdf(const Pair& p) const { return weights(p).brdf; }
  Pair weights(const Pair& p) const {
    return heuristic_({shares_.light * p.light, shares_.brdf * p.brdf});
  }
  bool smooth() const { return heuristic_.smooth(); }

 private:
  Heuristic heuristic_;
  Pair shares_;
};

/// The term of one draw: its weight times integrand / density.
template <class Combination>
double from_light(const Combination& combination, const Draw& draw) {
  if (draw.integrand == 0) return 0;
  return combination.light(draw.density) * draw.integrand / draw.density.light;
}
template <class Combination>
double from_brdf(const Combination& combination, const Draw& draw) {
  if (draw.integrand == 0) return 0;
  return combination.brdf(draw.density) * draw.integrand / draw.density.brdf;
}

/// Numbers of samples in one primary.
struct Counts {
  std::uint64_t light = 1;
  std::uint64_t brdf = 1;

  Pair shares() const { return {static_cast<double>(light), static_cast<double>(brdf)}; }
};

/// Reads light_samples and brdf_samples, one or more of each.
Counts read_counts(Parameters&);
/// Reads light_probability, in (0, 1).
Pair read_probabilities(Parameters&);

/// X = sum over techniques of 1 / n_i times the sum over its n_i draws of w_i f / p_i (eq. 9.4).
template <class Combination = WeightedByHeuristic>
struct MultiSamplePrimary {
  SharedTechniques techniques;
  Counts counts;
  Combination combination;

  double operator()(Stream& random, Cost& cost) const {
    double light = 0;
    double brdf = 0;
    for (std::uint64_t i = 0; i < counts.light; ++i) {
      light += from_light(combination, techniques->light(random, cost));
    }
    for (std::uint64_t i = 0; i < counts.brdf; ++i) {
      brdf += from_brdf(combination, techniques->brdf(random, cost));
    }
    return light / static_cast<double>(counts.light) + brdf / static_cast<double>(counts.brdf);
  }
};

/// X = w_i f / (c_i p_i) with the technique i drawn with the probability c_i (eq. 9.15).
template <class Combination = WeightedByHeuristic>
struct OneSamplePrimary {
  SharedTechniques techniques;
  Pair probabilities;
  Combination combination;

  double operator()(Stream& random, Cost& cost) const {
    if (random.uniform() < probabilities.light) {
      return from_light(combination, techniques->light(random, cost)) / probabilities.light;
    }
    return from_brdf(combination, techniques->brdf(random, cost)) / probabilities.brdf;
  }
};

}  // namespace assay::direct_light
