#include "stats/plane_cells.h"

#include <algorithm>
#include <array>

#include "stats/check.h"

namespace assay::stats {
namespace {

constexpr std::size_t probes_a_side = 256;
// Points of each side that are looked at together.
constexpr std::size_t probes_at_once = 32;
// Panels of a cell that shows a corner of the support at its side only.
constexpr std::size_t panels_of_a_corner = 32;

// The densities of so many lines stay in the cache.
constexpr std::size_t lines_at_once = 36;

void check_borders(const std::vector<double>& borders) {
  check::at_least({"PlaneGrid", "number of borders"}, borders.size(), 2);
  for (std::size_t i = 1; i < borders.size(); ++i) {
    if (!(borders[i - 1] < borders[i]))
      check::fail({"PlaneGrid", "border"}, borders[i], "ascending");
  }
}

std::size_t slot(const std::vector<double>& borders, double x) {
  if (!(x >= borders.front() && x <= borders.back())) {
    check::fail({"PlaneGrid::index", "coordinate"}, x, "inside the grid");
  }
  const auto above = std::upper_bound(borders.begin(), borders.end(), x);
  const auto slot = static_cast<std::size_t>(above - borders.begin()) - 1;
  return std::min(slot, borders.size() - 2);
}

struct Cell {
  Span x;
  Span y;
};

Cell cell_of(const PlaneGrid& grid, std::size_t index) {
  const std::size_t columns = grid.y_borders.size() - 1;
  const std::size_t row = index / columns;
  const std::size_t column = index % columns;
  return {{grid.x_borders[row], grid.x_borders[row + 1]},
          {grid.y_borders[column], grid.y_borders[column + 1]}};
}

class Cells {
 public:
  Cells(const PlaneGrid& grid, const PlaneDensity& density, QuadratureLimits limits)
      : grid_(grid), density_(density), rule_(limits), found_(grid.size()) {
    for (std::size_t i = 0; i < found_.size(); ++i) found_[i] = integral(cell_of(grid, i));
    for (std::size_t i = 0; i < found_.size(); ++i) {
      if (found_[i].value == 0 && beside_support(i)) found_[i] = searched(cell_of(grid, i));
    }
  }

  CellProbabilities result() const {
    CellProbabilities all;
    for (const Integral& each : found_) {
      all.probability.push_back(each.value);
      all.error.push_back(each.error);
      all.total += each.value;
      all.total_error += each.error;
    }
    return all;
  }

 private:
  Integral integral(const Cell& cell) {
    Integral sum;
    const auto strip = across(density_, cell.y, rule_);
    for (const Span& part : cut(cell.x, density_.x, density_.x_panels)) {
      sum = sum + rule_.over(strip, part);
    }
    return sum;
  }

  bool beside_support(std::size_t index) const {
    const std::size_t columns = grid_.y_borders.size() - 1;
    const std::size_t rows = grid_.x_borders.size() - 1;
    const std::size_t row = index / columns;
    const std::size_t column = index % columns;
    for (std::size_t r = row == 0 ? 0 : row - 1; r <= std::min(row + 1, rows - 1); ++r) {
      // An azimuth goes round: the last column is beside the first.
      for (const std::size_t c :
           {(column + columns - 1) % columns, column, (column + 1) % columns}) {
        if (found_[r * columns + c].value > 0) return true;
      }
    }
    return false;
  }

  /// Whether the density shows at some of the points of each side from this one on.
  bool shown_at(const Cell& cell, std::size_t first) {
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

  bool shown_at_a_side(const Cell& cell) {
    for (std::size_t k = 0; k < probes_a_side; k += probes_at_once) {
      if (shown_at(cell, k)) return true;
    }
    return false;
  }

  Integral searched(const Cell& cell) {
    const double step = 1 / static_cast<double>(probes_a_side);
    const double unseen = rule_.largest() * cell.x.width() * cell.y.width() * step * step / 2;
    if (!shown_at_a_side(cell)) return {0, unseen};
    const PlaneDensity closer{.x = cell.x,
                              .y = cell.y,
                              .values = density_.values,
                              .x_panels = panels_of_a_corner,
                              .y_panels = panels_of_a_corner};
    Integral sum{0, unseen};
    const auto strip = marginal_density(closer, rule_);
    for (const Span& part : cut(cell.x, cell.x, panels_of_a_corner)) {
      sum = sum + rule_.over(strip, part);
    }
    return sum;
  }

  const PlaneGrid& grid_;
  const PlaneDensity& density_;
  AdaptiveQuadrature rule_;
  std::vector<Integral> found_;
};

}  // namespace

std::size_t PlaneGrid::index(double x, double y) const {
  return slot(x_borders, x) * (y_borders.size() - 1) + slot(y_borders, y);
}

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

CellProbabilities cell_probabilities(const PlaneGrid& grid, const PlaneDensity& density,
                                     QuadratureLimits limits) {
  check_borders(grid.x_borders);
  check_borders(grid.y_borders);
  check::positive({"cell_probabilities", "tolerance"}, limits.tolerance);
  return Cells(grid, density, limits).result();
}

}  // namespace assay::stats
