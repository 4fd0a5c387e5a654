#include "stats/cells/cell_quadrature.h"

#include <algorithm>
#include <span>
#include <vector>

namespace assay::stats {
namespace {

constexpr std::size_t probes_a_side = 256;
constexpr std::size_t probes_at_once = 32;
// Panels of a cell that shows only a corner of the support at its side.
constexpr std::size_t panels_of_a_corner = 32;

// The densities of this many lines stay in the cache.
constexpr std::size_t lines_at_once = 36;

}  // namespace

AdaptiveQuadrature::Function across(const PlaneDensity& density, Span y, AdaptiveQuadrature& rule) {
  const std::vector<Span> parts = cut(y, density.y, density.y_panels);
  return [&density, &rule, parts](const AdaptiveQuadrature::Places& places) {
    std::vector<AdaptiveQuadrature::Line> lines;
    for (const double x : places) {
      for (const Span& part : parts) lines.push_back({x, part});
    }
    AdaptiveQuadrature::Values values;
    for (std::size_t first = 0; first < lines.size(); first += lines_at_once) {
      const auto some = std::span(lines).subspan(first);
      const auto integrals =
          rule.along(density.values, some.first(std::min(some.size(), lines_at_once)));
      for (std::size_t i = 0; i < integrals.size(); ++i) {
        Integral& sum = values[(first + i) / parts.size()];
        sum = sum + integrals[i];
      }
    }
    return values;
  };
}

Integral CellQuadrature::over(const PlaneDensity& density, const PlaneCell& cell) {
  Integral sum;
  const auto strip = across(density, cell.y, rule_);
  for (const Span& part : cut(cell.x, density.x, density.x_panels)) {
    sum = sum + rule_.over(strip, part);
  }
  densest_ = std::max(densest_, rule_.largest());
  return sum;
}

Integral CellQuadrature::over(const PlaneCell& cell) {
  rule_.forget_largest();
  return over(density_, cell);
}

// True if the density shows at some of the points of each side from this one on.
bool CellQuadrature::shown_at(const PlaneCell& cell, std::size_t first) {
  constexpr double inside = 1e-9;
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t k = first; k < first + probes_at_once; ++k) {
    const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(probes_a_side);
    for (const double end : {inside, 1 - inside}) {
      x.insert(x.end(), {cell.x.low + share * cell.x.width(), cell.x.low + end * cell.x.width()});
      y.insert(y.end(), {cell.y.low + end * cell.y.width(), cell.y.low + share * cell.y.width()});
    }
  }
  std::vector<double> values(x.size());
  density_.values(x, y, values);
  return std::ranges::any_of(values, [](double value) { return value > 0; });
}

bool CellQuadrature::shown_at_a_side(const PlaneCell& cell) {
  for (std::size_t k = 0; k < probes_a_side; k += probes_at_once) {
    if (shown_at(cell, k)) return true;
  }
  return false;
}

Integral CellQuadrature::beside_support(const PlaneCell& cell) {
  rule_.forget_largest();
  if (!shown_at_a_side(cell)) return {};
  const PlaneDensity closer{.x = cell.x,
                            .y = cell.y,
                            .values = density_.values,
                            .x_panels = {panels_of_a_corner},
                            .y_panels = {panels_of_a_corner}};
  return over(closer, cell);
}

double hidden_beside_support(const PlaneCell& cell, double densest) {
  const double step = 1 / static_cast<double>(probes_a_side);
  return densest * cell.x.width() * cell.y.width() * step * step / 2;
}

}  // namespace assay::stats
