#pragma once

// What is known of direct lighting without sampling it.

#include <optional>

#include "direct_light/combination.h"
#include "render/quadrature.h"

namespace assay::direct_light {

/// A number and an estimate of its error.
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

/// By quadrature over a planar luminaire's luminaire::visible_parts(): triangles of which each is
/// seen within two widths of the BRDF's lobe, so that the lobe is not missed, then adapted until
/// the changes of the last refinements are below 1e-12 of the whole; their sum is the error. None
/// where there are no parts, or where a part takes more than 20000 triangles, as a lobe of width
/// 0.02 does below a ceiling without end. Where the combination's weights jump, so do the
/// integrands, and the errors say so. In units of the luminaire's radiance, variances in its square
/// (Veach 1997, equations 9.4 and 9.15).
std::optional<Moments> moments(const Techniques&, const WeightedByHeuristic&);

/// The radiance alone, by the same quadrature; of a constant BRDF in closed form, f times Lambert's
/// formula, whatever the sizes.
std::optional<Known> radiance(const Techniques&);

}  // namespace assay::direct_light
