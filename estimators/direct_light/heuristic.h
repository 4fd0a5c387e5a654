#pragma once

// Weights of two sampling techniques (Veach 1997, sections 9.2.2 and 9.2.3).

#include "estimators/parameters.h"

namespace assay::direct_light {

/// A number for each of the two techniques: sampling the light, sampling the BRDF.
struct Pair {
  double light = 0;
  double brdf = 0;
};

/// Weights that sum to 1, from q_i, the density of a technique times its number of samples. In the
/// one-sample model q_i is the density times the technique's probability.
///   balance      w_i = q_i / sum q_k  (eq. 9.8)
///   power        w_i = q_i^e / sum q_k^e
///   cutoff       0 where q_i < t max q_k, else q_i / sum of the q_k that are not
///   maximum      1 where q_i is the largest, else 0.
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

}  // namespace assay::direct_light
