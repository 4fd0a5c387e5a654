#include "stats/cells.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

#include "stats/adaptive_quadrature.h"
#include "stats/check.h"

namespace assay::stats {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

struct Rectangle {
  Span cos_theta;
  Span phi;
};

double checked(double density) {
  check::non_negative({"cell_probabilities", "density"}, density);
  return density;
}

using PlaneRule = boost::math::quadrature::gauss<double, 7>;

double integrate(const std::function<double(Direction)>& density, Rectangle cell) {
  const auto over_phi = [&](double cos_theta) {
    return PlaneRule::integrate(
        [&](double phi) {
          return checked(density({cos_theta, phi}));
        },
        cell.phi.low, cell.phi.high);
  };
  return PlaneRule::integrate(over_phi, cell.cos_theta.low, cell.cos_theta.high);
}

std::array<Rectangle, 4> parts(Rectangle cell) {
  const auto mu = cell.cos_theta.halves();
  const auto phi = cell.phi.halves();
  return {{{mu[0], phi[0]}, {mu[0], phi[1]}, {mu[1], phi[0]}, {mu[1], phi[1]}}};
}

// The tolerance is shared among the parts, so that a cell as a whole keeps it.
Integral adaptive(const std::function<double(Direction)>& density, Rectangle cell, double whole,
                  QuadratureOptions options) {
  const auto pieces = parts(cell);
  std::array<double, 4> values{};
  double sum = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    values[i] = integrate(density, pieces[i]);
    sum += values[i];
  }
  const double error = std::abs(sum - whole);
  if (error <= options.tolerance || options.deepest_bisection <= 0) return {sum, error};
  const QuadratureOptions finer{options.tolerance / static_cast<double>(pieces.size()),
                                options.deepest_bisection - 1};
  Integral total;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    total = total + adaptive(density, pieces[i], values[i], finer);
  }
  return total;
}

void append(CellProbabilities& result, Integral estimate) {
  result.probability.push_back(estimate.value);
  result.error.push_back(estimate.error);
  result.total += estimate.value;
  result.total_error += estimate.error;
}

Span slice(Span whole, std::size_t index, std::size_t cells) {
  const double width = (whole.high - whole.low) / static_cast<double>(cells);
  const auto edge = [&](std::size_t k) {
    return k == cells ? whole.high : whole.low + width * static_cast<double>(k);
  };
  return {edge(index), edge(index + 1)};
}

std::size_t cell_of(double fraction, std::size_t cells) {
  const auto index = static_cast<std::size_t>(fraction * static_cast<double>(cells));
  return std::min(index, cells - 1);
}

void check_grid(const IntervalGrid& grid) {
  check::at_least({"IntervalGrid", "cells"}, grid.cells, 1);
  check::finite({"IntervalGrid", "low"}, grid.low);
  check::finite({"IntervalGrid", "high"}, grid.high);
  if (!(grid.low < grid.high)) check::fail({"IntervalGrid", "high"}, grid.high, "above low");
}

void check_grid(const HemisphereGrid& grid) {
  check::at_least({"HemisphereGrid", "cos_theta_cells"}, grid.cos_theta_cells, 1);
  check::at_least({"HemisphereGrid", "phi_cells"}, grid.phi_cells, 1);
}

}  // namespace

std::size_t IntervalGrid::index(double x) const {
  check_grid(*this);
  if (!(x >= low && x <= high)) check::fail({"IntervalGrid::index", "x"}, x, "inside the interval");
  return cell_of((x - low) / (high - low), cells);
}

std::size_t HemisphereGrid::index(Direction direction) const {
  check_grid(*this);
  check::unit({"HemisphereGrid::index", "cos_theta"}, direction.cos_theta);
  check::finite({"HemisphereGrid::index", "phi"}, direction.phi);
  const double turns = direction.phi / two_pi;
  const std::size_t row = cell_of(direction.cos_theta, cos_theta_cells);
  return row * phi_cells + cell_of(turns - std::floor(turns), phi_cells);
}

CellProbabilities cell_probabilities(const IntervalGrid& grid,
                                     const std::function<double(double)>& density,
                                     QuadratureOptions options) {
  check_grid(grid);
  check::positive({"cell_probabilities", "tolerance"}, options.tolerance);
  AdaptiveQuadrature rule(
      {.tolerance = options.tolerance, .deepest_bisection = options.deepest_bisection});
  std::vector<AdaptiveQuadrature::Line> lines;
  for (std::size_t i = 0; i < grid.cells; ++i) {
    lines.push_back({.x = 0, .y = slice({grid.low, grid.high}, i, grid.cells)});
  }
  const auto values = [&](std::span<const double>, std::span<const double> x,
                          std::span<double> out) {
    std::ranges::transform(x, out.begin(), density);
  };
  CellProbabilities result;
  for (const Integral& each : rule.along(values, lines)) append(result, each);
  return result;
}

CellProbabilities cell_probabilities(const HemisphereGrid& grid,
                                     const std::function<double(Direction)>& density,
                                     QuadratureOptions options) {
  check_grid(grid);
  check::positive({"cell_probabilities", "tolerance"}, options.tolerance);
  CellProbabilities result;
  for (std::size_t row = 0; row < grid.cos_theta_cells; ++row) {
    for (std::size_t column = 0; column < grid.phi_cells; ++column) {
      const Rectangle cell{slice({0, 1}, row, grid.cos_theta_cells),
                           slice({0, two_pi}, column, grid.phi_cells)};
      append(result, adaptive(density, cell, integrate(density, cell), options));
    }
  }
  return result;
}

}  // namespace assay::stats
