#pragma once

// What is known of direct lighting without sampling it.

#include <optional>

#include "direct_light/combination.h"
#include "render/quadrature.h"

namespace assay::direct_light {

/// A number and a bound of its error.
struct Known {
  double value = 0;
  double error = 0;
};

/// Integrals over the directions in which the luminaire is seen, f standing for L f cos.
class Moments {
 public:
  /// The integrals of f, w_i^2 f^2 / p_i (light, brdf) and w_i f (light, brdf).
  explicit Moments(const render::Integrals<5>& integrals) : integrals_(integrals) {}

  Known radiance() const { return {integrals_.value[0], integrals_.error[0]}; }
  /// Of X = sum 1/n_i sum w_i f / p_i: sum (integral of w_i^2 f^2 / p_i - (that of w_i f)^2) / n_i.
  Known multi_sample_variance(const Counts&) const;
  /// Of X = w_i f / (c_i p_i): sum (integral of w_i^2 f^2 / p_i) / c_i - (that of f)^2. A technique
  /// of probability 0 has no weight.
  Known one_sample_variance(const Pair& probabilities) const;

 private:
  render::Integrals<5> integrals_;
};

/// By adaptive quadrature over a planar luminaire's luminaire::visible_parts(); none where there
/// are none. Where the combination's weights jump, so do the integrands, and the errors say so.
std::optional<Moments> moments(const Techniques&, const WeightedByHeuristic&);

/// The radiance alone: in closed form, f times Lambert's formula, of a constant BRDF.
std::optional<Known> radiance(const Techniques&);

}  // namespace assay::direct_light
