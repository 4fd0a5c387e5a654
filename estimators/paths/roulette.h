#pragma once

// When paths end and what is counted then: the parts of a path tracer that its mutants replace.

#include <vector>

#include "paths/surface.h"

namespace assay::paths {

/// The probability to go on, from the throughput T and the albedo a of each colour. Each is a
/// weighted mean of the albedo, or its maximum, and so below 1.
enum class Rule {
  max_albedo,   ///< Value max a.
  mean_albedo,  ///< Value (sum a) / 3.
  luminance,    ///< Luminance of a.
  throughput,   ///< Value sum T a / sum T: keeps the sum of T as it is.
  radiance,     ///< Value sum T a L / sum T L, L the scene's mean radiance: keeps the sum of T L.
};

/// Probabilities to go on by a diffuse reflection and by the mirror.
struct Survival {
  double diffuse = 0;
  double mirror = 0;

  double total() const { return diffuse + mirror; }
};

/// Russian roulette with terminal values (Szecsi, Szirmay-Kalos and Kelemen 2003). T is a vertex's
/// throughput, a its albedo, s the probability to go on and e the terminal value. A path that ends
/// adds T e. One that goes on subtracts T e (1 - s) / s and multiplies T by a / s. The expectation
/// is the same for every e. With e = 0 it is the classical roulette.
class Roulette {
 public:
  /// `terminal` holds e of each patch, or nothing for e = 0.
  Roulette(Rule rule, const Spectrum& mean_radiance, std::vector<Spectrum> terminal)
      : rule_(rule), mean_radiance_(mean_radiance), terminal_(std::move(terminal)) {}

  double rule(const Spectrum& throughput, const Spectrum& albedo) const {
    switch (rule_) {
      case Rule::max_albedo:
        return largest(albedo);
      case Rule::mean_albedo:
        return mean(albedo);
      case Rule::luminance:
        return luminance(albedo);
      case Rule::throughput:
        return sum(throughput * albedo) / sum(throughput);
      case Rule::radiance:
        break;
    }
    const Spectrum weight = throughput * mean_radiance_;
    // Nothing is lost if no light can arrive in any channel that the path still carries.
    return sum(weight) > 0 ? sum(weight * albedo) / sum(weight) : 0;
  }

  /// The rule's value for the whole albedo, split between the lobes by the rule's value for each.
  Survival survival(const Spectrum& throughput, const Surface& surface) const {
    const double total = rule(throughput, surface.albedo());
    if (surface.mirror == Spectrum{} || total == 0) return {.diffuse = total};
    const double diffuse = rule(throughput, surface.diffuse);
    const double mirror = rule(throughput, surface.mirror);
    return {total * diffuse / (diffuse + mirror), total * mirror / (diffuse + mirror)};
  }

  Spectrum terminal(const Vertex& v) const {
    return terminal_.empty() ? Spectrum{} : terminal_[v.patch];
  }
  Spectrum on_end(const Spectrum& terminal) const { return terminal; }
  Spectrum on_going_on(const Spectrum& terminal, double survival) const {
    return (survival - 1) / survival * terminal;
  }
  /// The throughput after a reflection that was chosen with this probability.
  Spectrum continued(const Spectrum& throughput, const Spectrum& reflectance,
                     double probability) const {
    return 1 / probability * (throughput * reflectance);
  }

 private:
  Rule rule_;
  Spectrum mean_radiance_;
  std::vector<Spectrum> terminal_;
};

}  // namespace assay::paths
