#include "harness/draws/density_cells.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "harness/draws/declared_density.h"

namespace assay::harness {
namespace {

// Cells at a jump of the density are right to 1e-6 together. A million draws tell 1e-4 of a cell,
// so more digits would cost time for nothing.
constexpr stats::QuadratureLimits limits{.tolerance = 1e-8, .deepest_bisection = 24};

// More cells of a peak find finer defects, but need more points for those that are everywhere
// (tests/cells_study.sh). A share of 1/32 would be one column of azimuths of a lobe about
// the pole.
constexpr double largest_share = 1.0 / 40;

stats::AdaptiveCells cells_of_lobe(const NamedSampler& named, const stats::PlaneGrid& grid,
                                   std::span<const Point> drawn, int lobe) {
  const Sampler& sampler = *named.sampler;
  const Densities densities = densities_of_lobe(named, lobe);
  // A grid's own cells must not all be halved if they are slightly above the mean.
  const double share = std::max(largest_share, 2 / static_cast<double>(grid.size()));
  if (sampler.domain() == Domain::interval) {
    return stats::adaptive_cells(grid.x_borders, line_density(sampler, drawn, densities), share,
                                 limits);
  }
  return stats::adaptive_cells(grid, plane_density(sampler, 0, drawn, densities), share, limits);
}

void append(stats::CellProbabilities& all, const stats::CellProbabilities& more) {
  all.probability.insert(all.probability.end(), more.probability.begin(), more.probability.end());
  all.error.insert(all.error.end(), more.error.begin(), more.error.end());
  all.total += more.total;
  all.total_error += more.total_error;
}

}  // namespace

double DensityCells::tolerance() const {
  const double parts = static_cast<double>(cells.size()) + 10;
  return 8 * mass.total_error + parts * std::numeric_limits<double>::epsilon() * mass.total;
}

std::vector<std::uint64_t> DensityCells::in_cells(std::span<const std::uint64_t> counts) const {
  std::vector<std::uint64_t> all(counts.begin(), counts.begin() + std::ssize(impossible(counts)));
  std::ranges::transform(all, impossible(counts), all.begin(), std::plus());
  return all;
}

double DensityCells::missing() const {
  const double rest = 1 - mass.total;
  return rest <= tolerance() ? 0 : rest;
}

DensityCells density_cells(const NamedSampler& named, StreamKey key, std::span<const Point> drawn) {
  const Sampler& sampler = *named.sampler;
  const stats::PlaneGrid grid = shifted_grid(sampler, key);
  std::vector<stats::HalvedCells> of_lobes;
  stats::CellProbabilities mass;
  for (int lobe = 0; lobe < sampler.lobes(); ++lobe) {
    stats::AdaptiveCells found = cells_of_lobe(named, grid, drawn, lobe);
    append(mass, found.mass);
    of_lobes.push_back(std::move(found.cells));
  }
  double point_masses = 0;
  for (int lobe = 0; lobe < sampler.lobes(); ++lobe) {
    const double point_mass = sampler.point_mass(lobe);
    if (point_mass == 0) continue;
    append(mass, {.probability = {point_mass}, .error = {0}, .total = point_mass});
    point_masses += point_mass;
  }
  return {.cells = DrawCells(sampler, std::move(of_lobes)),
          .mass = std::move(mass),
          .point_masses = point_masses};
}

}  // namespace assay::harness
