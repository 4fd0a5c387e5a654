#pragma once

// From parameters to a roulette, for the estimators and their mutants.

#include "paths/family.h"

namespace assay::paths {

/// Everything that a path with roulette needs besides its world.
struct RoulettePlan {
  Rule rule = Rule::max_albedo;
  Direct direct = Direct::hit;
  /// e of each patch; empty for the classical roulette.
  std::vector<Spectrum> terminal = {};
  /// The global estimate and the factor that e was made with; nothing for local estimates.
  std::optional<Incoming> incoming = {};
  double scale = 0;
  Cost cost = {};

  Roulette roulette(const Scene& scene) const { return {rule, scene.global.all, terminal}; }
};

RoulettePlan read_classical(Parameters& parameters, const Scene& scene);
RoulettePlan read_improved(Parameters& parameters, const Scene& scene);
std::vector<ParameterInformation> improved_parameters();

/// The terminal value e of a surface: scale x albedo x arriving radiance. If direct light is found
/// separately, its part of the diffuse reflection is left out.
Spectrum terminal_value(const Surface& surface, const Incoming& incoming, Direct direct,
                        double scale);
/// e of every patch of a scene from its global estimate.
std::vector<Spectrum> global_terminal(const Scene& scene, const Incoming& incoming, Direct direct,
                                      double scale);

/// The steps of zones where the probability to go on depends on the zone alone.
std::optional<Steps> exact_steps(const Scene& scene, const RoulettePlan& plan);

std::vector<NamedSampler> samplers_of(const Scene& scene, const RoulettePlan& plan,
                                      const Knowledge& known);

}  // namespace assay::paths
