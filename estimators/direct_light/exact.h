#pragma once

// The exact moments of direct lighting, without sampling.

#include <optional>

#include "direct_light/combination.h"
#include "render/quadrature.h"

namespace assay::direct_light {

/// A number and an estimate of its error.
struct Known {
  double value = 0;
  double error = 0;
};

/// The channel `radiance` with its mean, where that is known, and nothing else.
Channel mean_channel(const std::optional<Known>& radiance);

/// Integrals over the directions in which the luminaire is seen, f standing for L f cos.
class Moments {
 public:
  /// The integrals of f, w_i^2 f^2 / p_i (light, brdf) and w_i f (light, brdf).
  explicit Moments(const render::Integrals<5>& integrals) : integrals_(integrals) {}

  Known radiance() const { return {integrals_.value[0], integrals_.error[0]}; }
  /// X = sum 1/n_i sum w_i f / p_i has sum (integral of w_i^2 f^2 / p_i - (that of w_i f)^2) / n_i.
  Known multi_sample_variance(const Counts&) const;
  /// X = w_i f / (c_i p_i) has sum (integral of w_i^2 f^2 / p_i) / c_i - (that of f)^2. A technique
  /// of probability 0 has no weight.
  Known one_sample_variance(const Pair& probabilities) const;

 private:
  render::Integrals<5> integrals_;
};

/// Moments by quadrature over a planar luminaire's luminaire::visible_parts() (Veach 1997,
/// equations 9.4 and 9.15), in units of the luminaire's radiance. Each triangle is seen within two
/// widths of the BRDF's lobe, so that the lobe is not missed. Triangles are refined until the last
/// changes are below 1e-12 of the whole; the sum of the changes is the error. Weights that jump
/// have larger errors. nullopt if there are no parts, or if a part takes more than 20000 triangles.
std::optional<Moments> moments(const Techniques&, const WeightedByHeuristic&);

/// The radiance alone, by the same quadrature; of a constant BRDF in closed form, f times Lambert's
/// formula, whatever the sizes.
std::optional<Known> radiance(const Techniques&);

}  // namespace assay::direct_light
