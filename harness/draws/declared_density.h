#pragma once

// The density that a sampler declares, as stats integrates it.

#include <functional>
#include <span>

#include "estimators/estimator.h"
#include "stats/cells/adaptive_cells.h"
#include "stats/cells/cell_quadrature.h"

namespace assay::harness {

/// A density at many points. A sampler may write only the first few, and returns how many. Throws
/// as sound_density().
using Densities = std::function<std::size_t(std::span<const Point>, std::span<double>)>;

/// The density of all lobes together, and of one lobe. Both keep a reference to the sampler's name.
Densities densities_of(const NamedSampler& named);
Densities densities_of_lobe(const NamedSampler& named, int lobe);

/// Points that a sampler draws show the quadrature where its density has peaks.
stats::LineDensity line_density(const Sampler& sampler, std::span<const Point> drawn,
                                Densities densities);

/// True if the density is 0 at this point and around it, as no draw has it. Around is within 1e-6
/// of the domain's size, or the sampler's rounding() if that is more. Rounding may move a point so
/// far across an edge.
bool is_impossible(const Sampler& sampler, const Point& point, double density);

/// The density on a domain of two coordinates, in its chart by this marginal, 0 or 1. It asks for
/// the sampler's panels, halved as often as they cost too much. Bisection then finds jumps inside
/// panels.
stats::PlaneDensity plane_density(const Sampler& sampler, std::size_t marginal,
                                  std::span<const Point> drawn, Densities densities);

}  // namespace assay::harness
