#include "stats/cells/adaptive_cells.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <queue>

#include "stats/basics/check.h"
#include "stats/basics/moments.h"
#include "stats/basics/scores.h"

namespace assay::stats {
namespace {

constexpr std::size_t probes_a_side = 256;
constexpr std::size_t probes_at_once = 32;
// Panels of a cell that shows only a corner of the support at its side.
constexpr std::size_t panels_of_a_corner = 32;

// The densities of this many lines stay in the cache.
constexpr std::size_t lines_at_once = 36;

// The density at x, integrated over part of the other coordinate. `density` must outlive the
// result.
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

// The mass that a support may hide from beside_support() in a cell. The hidden corner is half the
// squared step between the points, as dense as what was met next to it.
double hidden_beside_support(const PlaneCell& cell, double densest) {
  const double step = 1 / static_cast<double>(probes_a_side);
  return densest * cell.x.width() * cell.y.width() * step * step / 2;
}

// Integrates a density over one rectangle after another, all within the limits together. It
// integrates adaptively along y within x. So a jump along any curve is a border in y, which
// bisection finds. In x it is at most a kink. The tolerance applies to each inner and each outer
// part. Throws std::domain_error where the density is negative or not finite.
class CellQuadrature {
 public:
  // Keeps a reference to the density.
  CellQuadrature(const PlaneDensity& density, QuadratureLimits limits)
      : density_(density), rule_(limits) {}

  Integral over(const PlaneCell& cell) {
    rule_.forget_largest();
    return over(density_, cell);
  }

  // For a cell in which over() met no density, next to one in which it did. It looks for density
  // along the sides, at 256 points each. The error does not cover what may still hide there.
  Integral beside_support(const PlaneCell& cell) {
    rule_.forget_largest();
    std::size_t k = 0;
    while (k < probes_a_side && !shown_at(cell, k)) k += probes_at_once;
    if (k == probes_a_side) return {};
    const PlaneDensity closer{.x = cell.x,
                              .y = cell.y,
                              .values = density_.values,
                              .x_panels = {panels_of_a_corner},
                              .y_panels = {panels_of_a_corner}};
    return over(closer, cell);
  }

  double densest() const { return densest_; }                 // Largest density so far.
  double densest_of_last() const { return rule_.largest(); }  // Largest in the last cell.
  bool exhausted() const { return rule_.exhausted(); }

 private:
  Integral over(const PlaneDensity& density, const PlaneCell& cell) {
    Integral sum;
    const auto strip = across(density, cell.y, rule_);
    for (const Span& part : cut(cell.x, density.x, density.x_panels)) {
      sum = sum + rule_.over(strip, part);
    }
    densest_ = std::max(densest_, rule_.largest());
    return sum;
  }

  // True if the density shows at some of the points of each side from this one on.
  bool shown_at(const PlaneCell& cell, std::size_t first) {
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

  const PlaneDensity& density_;
  AdaptiveQuadrature rule_;
  double densest_ = 0;
};

void check_borders(const PlaneGrid& grid) {
  for (const std::vector<double>* borders : {&grid.x_borders, &grid.y_borders}) {
    check::at_least({"PlaneGrid", "number of borders"}, borders->size(), 2);
    const auto falling = std::ranges::adjacent_find(*borders, std::not_fn(std::less()));
    if (falling != borders->end()) check::fail({"PlaneGrid", "border"}, falling[1], "ascending");
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

// Integral of the density over every cell. If a cell shows no density at its nodes but a neighbour
// does, its sides are searched.
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

constexpr int most_halvings = 48;
// A cell is looked at at these places to find the side to halve.
constexpr std::size_t looks_a_side = 16;

enum class Along { x, y };

struct Questions {
  std::function<Integral(const PlaneCell&)> integral;
  std::function<std::optional<Along>(const PlaneCell&, int halvings)> side;
  std::function<bool()> exhausted;
  /// Share of the drawn values in a cell.
  std::function<double(const PlaneCell&)> drawn_share = [](const PlaneCell&) { return 0.0; };
};

bool can_be_halved(const Span& span) {
  return span.low < span.middle() && span.middle() < span.high;
}

std::array<PlaneCell, 2> halves_of(const PlaneCell& cell, Along along) {
  if (along == Along::x) return {{{cell.x.halves()[0], cell.y}, {cell.x.halves()[1], cell.y}}};
  return {{{cell.x, cell.y.halves()[0]}, {cell.x, cell.y.halves()[1]}}};
}

// Halves the heaviest cell, then the heaviest of the result, and so on.
class Halving {
 public:
  Halving(const PlaneGrid& grid, std::span<const Integral> masses, const Questions& ask)
      : grid_(grid), ask_(ask) {
    for (std::size_t i = 0; i < masses.size(); ++i) {
      add({.cell = grid.cell(i), .mass = masses[i], .grid_cell = i});
    }
  }

  void halve_until(double most) {
    most_ = most;
    while (!heaviest_.empty() && heaviest_.top().mass > most) {
      const std::size_t number = heaviest_.top().number;
      heaviest_.pop();
      if (known_[number].halvings < most_halvings && !halve(number)) return;
    }
  }

  AdaptiveCells numbered() const {
    AdaptiveCells found{.cells = {.grid = grid_, .nodes = nodes_}};
    for (std::size_t i = 0; i < grid_.size(); ++i) number(i, found);
    return found;
  }

 private:
  struct Known {
    PlaneCell cell;
    Integral mass;
    std::size_t grid_cell = 0;
    int halvings = 0;
    bool guessed = false;  // The mass is the share of draws.
  };
  struct Candidate {
    double mass;
    std::size_t number;
    // Among equal weights the first counts as heavier.
    bool operator<(const Candidate& other) const {
      return mass != other.mass ? mass < other.mass : number > other.number;
    }
  };

  void add(const Known& known) {
    heaviest_.push({.mass = known.mass.value, .number = known_.size()});
    known_.push_back(known);
    nodes_.emplace_back();
  }

  // A cell with no number between its ends stays whole. False if halving takes more evaluations
  // than are left: the halves would be worse than the whole.
  bool halve(std::size_t number) {
    const Known whole = known_[number];
    const std::optional<Along> along = ask_.side(whole.cell, whole.halvings);
    if (!along) return true;
    const auto [lower, upper] = halves_of(whole.cell, *along);
    const Known one = half_of(whole, lower);
    const Known two = half_of(whole, upper);
    if (ask_.exhausted()) return false;
    const bool along_x = *along == Along::x;
    nodes_[number] = {
        .halves = nodes_.size(), .along_x = along_x, .border = along_x ? upper.x.low : upper.y.low};
    add(one);
    add(two);
    return true;
  }

  // Draws tell which halves will be halved again. Those need no integral.
  Known half_of(const Known& whole, const PlaneCell& cell) const {
    const double share = ask_.drawn_share(cell);
    const bool guessed = share > 2 * most_;
    return {.cell = cell,
            .mass = guessed ? Integral{.value = share} : ask_.integral(cell),
            .grid_cell = whole.grid_cell,
            .halvings = whole.halvings + 1,
            .guessed = guessed};
  }

  void number(std::size_t cell, AdaptiveCells& found) const {
    if (const std::size_t halves = nodes_[cell].halves; halves > 0) {
      number(halves, found);
      number(halves + 1, found);
      return;
    }
    found.cells.nodes[cell].number = found.cells.size();
    const Known& known = known_[cell];
    const Integral mass = known.guessed ? ask_.integral(known.cell) : known.mass;
    found.cells.cells.push_back(known.cell);
    found.cells.grid_cells.push_back(known.grid_cell);
    found.mass.probability.push_back(mass.value);
    found.mass.error.push_back(mass.error);
    found.mass.total += mass.value;
    found.mass.total_error += mass.error;
  }

  const PlaneGrid& grid_;
  const Questions& ask_;
  std::vector<Known> known_;
  std::vector<HalvedCells::Node> nodes_;
  std::priority_queue<Candidate> heaviest_;
  double most_ = 1;
};

AdaptiveCells halved(const PlaneGrid& grid, std::span<const Integral> masses, double largest_share,
                     const Questions& ask) {
  double total = 0;
  for (const Integral& mass : masses) total += mass.value;
  Halving halving(grid, masses, ask);
  halving.halve_until(largest_share * std::max(total, 1.0));
  return halving.numbered();
}

// Standard deviation of the mass's place along one side, in units of the side.
double spread(std::span<const double, looks_a_side> masses) {
  double total = 0;
  double mean = 0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    total += masses[i];
    mean += masses[i] * (static_cast<double>(i) + .5);
  }
  mean /= total;
  double sum = 0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double distance = static_cast<double>(i) + .5 - mean;
    sum += masses[i] * distance * distance;
  }
  return std::sqrt(sum / total) / static_cast<double>(masses.size());
}

using Drawn = std::vector<std::array<double, 2>>;

Drawn drawn_in(const PlaneDensity& density, const PlaneCell& cell) {
  Drawn inside;
  std::ranges::copy_if(density.drawn, std::back_inserter(inside), [&](const auto& at) {
    return at[0] >= cell.x.low && at[0] < cell.x.high && at[1] >= cell.y.low && at[1] < cell.y.high;
  });
  return inside;
}

std::optional<Along> narrower(double of_x, double of_y) {
  if (of_x < .9 * of_y) return Along::x;
  if (of_y < .9 * of_x) return Along::y;
  return std::nullopt;
}

// The side along which the mass of a cell lies closer together, as a share of the side. Nothing if
// the two are nearly equal. Draws tell it, if there are enough, or the density at some places.
std::optional<Along> narrower_along(const PlaneDensity& density, const PlaneCell& cell) {
  constexpr std::size_t enough_draws = 64;
  if (const Drawn inside = drawn_in(density, cell); inside.size() >= enough_draws) {
    std::array<Moments, 2> places;
    for (const auto& at : inside) {
      for (std::size_t i = 0; i < 2; ++i) places[i].add(at[i]);
    }
    return narrower(std::sqrt(places[0].variance()) / cell.x.width(),
                    std::sqrt(places[1].variance()) / cell.y.width());
  }
  constexpr std::size_t n = looks_a_side;
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t i = 0; i < n * n; ++i) {
    const auto share = [](std::size_t k) {
      return (static_cast<double>(k) + .5) / static_cast<double>(n);
    };
    x.push_back(cell.x.low + share(i / n) * cell.x.width());
    y.push_back(cell.y.low + share(i % n) * cell.y.width());
  }
  std::vector<double> values(n * n);
  density.values(x, y, values);
  std::array<double, n> along_x{};
  std::array<double, n> along_y{};
  for (std::size_t i = 0; i < n * n; ++i) {
    along_x[i / n] += values[i];
    along_y[i % n] += values[i];
  }
  return narrower(spread(along_x), spread(along_y));
}

void check_limits(double largest_share, const QuadratureLimits& limits) {
  check::unit({"adaptive_cells", "largest_share"}, largest_share);
  check::positive({"adaptive_cells", "largest_share"}, largest_share);
  check::positive({"adaptive_cells", "tolerance"}, limits.tolerance);
}

}  // namespace

AdaptiveQuadrature::Function marginal_density(const PlaneDensity& density,
                                              AdaptiveQuadrature& rule) {
  return across(density, density.y, rule);
}

std::size_t PlaneGrid::index(double x, double y) const {
  return slot(x_borders, x) * columns() + slot(y_borders, y);
}

PlaneCell PlaneGrid::cell(std::size_t index) const {
  const std::size_t row = index / columns();
  const std::size_t column = index % columns();
  return {{x_borders[row], x_borders[row + 1]}, {y_borders[column], y_borders[column + 1]}};
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

AdaptiveCells adaptive_cells(const PlaneGrid& grid, const PlaneDensity& density,
                             double largest_share, QuadratureLimits limits) {
  check_limits(largest_share, limits);
  CellQuadrature rule(density, limits);
  const std::vector<Integral> masses = integrals_over(grid, rule);
  // A cell that shows no density lies beside one that shows some.
  const auto integral = [&](const PlaneCell& cell) {
    const Integral mass = rule.over(cell);
    if (mass.value > 0) return mass;
    Integral beside = rule.beside_support(cell);
    beside.error += hidden_beside_support(cell, rule.densest());
    return beside;
  };
  const auto side = [&](const PlaneCell& cell, int halvings) -> std::optional<Along> {
    const bool x = can_be_halved(cell.x);
    const bool y = can_be_halved(cell.y);
    if (x && y) {
      return narrower_along(density, cell).value_or(halvings % 2 == 0 ? Along::x : Along::y);
    }
    if (x || y) return x ? Along::x : Along::y;
    return std::nullopt;
  };
  const auto share = [&](const PlaneCell& cell) {
    return density.drawn.empty() ? 0
                                 : static_cast<double>(drawn_in(density, cell).size()) /
                                       static_cast<double>(density.drawn.size());
  };
  return halved(grid, masses, largest_share,
                {.integral = integral,
                 .side = side,
                 .exhausted = [&] { return rule.exhausted(); },
                 .drawn_share = share});
}

AdaptiveCells adaptive_cells(const std::vector<double>& borders, const LineDensity& density,
                             double largest_share, QuadratureLimits limits) {
  check_limits(largest_share, limits);
  const PlaneGrid grid{.x_borders = borders, .y_borders = {0, 1}};
  check_borders(grid);
  const Span whole{borders.front(), borders.back()};
  AdaptiveQuadrature rule(limits);
  const AdaptiveQuadrature::Function along = rule.of(density.values);
  const auto integral = [&](const PlaneCell& cell) {
    Integral sum;
    for (const Span& part : cut(cell.x, whole, density.panels)) sum = sum + rule.over(along, part);
    return sum;
  };
  std::vector<Integral> masses;
  for (std::size_t i = 0; i < grid.size(); ++i) masses.push_back(integral(grid.cell(i)));
  return halved(
      grid, masses, largest_share,
      {.integral = integral,
       .side = [](const PlaneCell& cell,
                  int) { return can_be_halved(cell.x) ? std::optional(Along::x) : std::nullopt; },
       .exhausted = [&] { return rule.exhausted(); }});
}

}  // namespace assay::stats
