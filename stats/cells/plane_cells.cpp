#include "stats/cells/plane_cells.h"

#include <algorithm>

#include "stats/basics/check.h"
#include "stats/basics/scores.h"

namespace assay::stats {
namespace {

void check_ascending(const std::vector<double>& borders) {
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
  return std::min(count_up_to(borders, x), borders.size() - 1) - 1;
}

// The greatest density met in a cell's neighbours, 0 if none showed any.
double densest_beside(const PlaneGrid& grid, const std::vector<double>& densest,
                      std::size_t index) {
  const std::size_t columns = grid.columns();
  const std::size_t row = index / columns;
  const std::size_t column = index % columns;
  double most = 0;
  for (std::size_t r = row == 0 ? 0 : row - 1; r <= std::min(row + 1, grid.rows() - 1); ++r) {
    // An azimuth goes round: the last column is beside the first.
    for (const std::size_t c : {(column + columns - 1) % columns, column, (column + 1) % columns}) {
      most = std::max(most, densest[r * columns + c]);
    }
  }
  return most;
}

}  // namespace

std::size_t PlaneGrid::index(double x, double y) const {
  return slot(x_borders, x) * columns() + slot(y_borders, y);
}

PlaneCell PlaneGrid::cell(std::size_t index) const {
  const std::size_t row = index / columns();
  const std::size_t column = index % columns();
  return {{x_borders[row], x_borders[row + 1]}, {y_borders[column], y_borders[column + 1]}};
}

void check_borders(const PlaneGrid& grid) {
  check_ascending(grid.x_borders);
  check_ascending(grid.y_borders);
}

std::vector<Integral> integrals_over(const PlaneGrid& grid, CellQuadrature& quadrature) {
  check_borders(grid);
  std::vector<Integral> found;
  std::vector<double> densest;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    found.push_back(quadrature.over(grid.cell(i)));
    densest.push_back(quadrature.densest_of_last());
  }
  // A cell found beside the support is support too, with cells beside it.
  std::vector<bool> searched(grid.size());
  for (bool more = true; more;) {
    more = false;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i].value > 0 || searched[i] || densest_beside(grid, densest, i) == 0) continue;
      searched[i] = true;
      found[i] = quadrature.beside_support(grid.cell(i));
      densest[i] = quadrature.densest_of_last();
      more = more || found[i].value > 0;
    }
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!searched[i]) continue;
    const double beside = std::max(densest[i], densest_beside(grid, densest, i));
    found[i].error += hidden_beside_support(grid.cell(i), beside);
  }
  return found;
}

std::size_t HalvedCells::index(double x, double y) const {
  const Node* node = &nodes[grid.index(x, y)];
  while (node->halves > 0) {
    node = &nodes[node->halves + ((node->along_x ? x : y) < node->border ? 0 : 1)];
  }
  return node->number;
}

HalvedCells whole_cells(const PlaneGrid& grid) {
  check_borders(grid);
  HalvedCells all{.grid = grid};
  for (std::size_t i = 0; i < grid.size(); ++i) {
    all.nodes.push_back({.number = i});
    all.cells.push_back(grid.cell(i));
    all.grid_cells.push_back(i);
  }
  return all;
}

}  // namespace assay::stats
