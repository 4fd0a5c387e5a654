#include "stats/cells/adaptive_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <queue>
#include <span>

#include "stats/basics/check.h"
#include "stats/basics/moments.h"

namespace assay::stats {
namespace {

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
