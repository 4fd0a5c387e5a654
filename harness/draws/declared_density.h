#pragma once

// The density that a sampler declares, as stats integrates it.

#include <functional>
#include <span>

#include "estimators/estimator.h"
#include "stats/cells/adaptive_cells.h"
#include "stats/cells/cell_quadrature.h"

namespace assay::harness {

/// A density at many points, of a sampler that may write those of the first few only. Throws as
/// sound_density().
using Densities = std::function<std::size_t(std::span<const Point>, std::span<double>)>;

/// That of all lobes together, and of one. They keep a reference to the sampler's name.
Densities densities_of(const NamedSampler& named);
Densities densities_of_lobe(const NamedSampler& named, int lobe);

/// Of an interval.
stats::LineDensity line_density(const Sampler& sampler, Densities densities);

/// Of a domain of two coordinates, in its chart by the marginal of this number, 0 or 1; with so
/// many panels as the sampler asks for, or half as many as often as they cost too much: jumps then
/// lie inside panels, and bisection finds them.
stats::PlaneDensity plane_density(const Sampler& sampler, std::size_t marginal,
                                  Densities densities);

}  // namespace assay::harness
