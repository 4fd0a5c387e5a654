#include "harness/draws/draw_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace assay::harness {
namespace {

constexpr double pi = std::numbers::pi;

Coordinate number(double value) { return {.value = value}; }

Coordinate angle(double value) {
  return {.value = value, .cosine = std::cos(value), .sine = std::sin(value)};
}

Point direction(const Coordinate& theta, const Coordinate& phi) {
  return {theta.sine * phi.cosine, theta.sine * phi.sine, theta.cosine};
}

template <Domain D>
std::array<double, 2> angles(const Point& p) {
  static const std::vector<Marginal> both = marginals(D);
  return {both[0].coordinate(p), both[1].coordinate(p)};
}

template <Domain D>
DomainChart of_directions(double highest_theta) {
  return {.first = {0, highest_theta},
          .second = {0, 2 * pi},
          .coordinate = angle,
          .point = direction,
          .jacobian = [](const Coordinate& theta, const Coordinate&) { return theta.sine; },
          .coordinates = angles<D>};
}

DomainChart of_square() {
  return {.first = {0, 1},
          .second = {0, 1},
          .coordinate = number,
          .point =
              [](const Coordinate& u, const Coordinate& v) {
                return Point{u.value, v.value, 0};
              },
          .jacobian = [](const Coordinate&, const Coordinate&) { return 1.0; },
          .coordinates =
              [](const Point& p) {
                return std::array{p[0], p[1]};
              }};
}

// v / (1 - u); 1 if rounding led to u + v > 1.
double share_of_rest(double v, double u) {
  const double rest = 1 - u;
  if (v > rest) return 1;
  return rest > 0 ? v / rest : 0;
}

DomainChart of_triangle() {
  return {.first = {0, 1},
          .second = {0, 1},
          .coordinate = number,
          .point =
              [](const Coordinate& u, const Coordinate& share) {
                return Point{u.value, share.value * (1 - u.value), 0};
              },
          .jacobian = [](const Coordinate& u, const Coordinate&) { return 1 - u.value; },
          .coordinates =
              [](const Point& p) {
                return std::array{p[0], share_of_rest(p[1], p[0])};
              }};
}

DomainChart turned(DomainChart chart, Domain domain) {
  std::swap(chart.first, chart.second);
  if (domain == Domain::triangle) {
    chart.point = [](const Coordinate& v, const Coordinate& share) {
      return Point{share.value * (1 - v.value), v.value, 0};
    };
    chart.coordinates = [](const Point& p) { return std::array{p[1], share_of_rest(p[0], p[1])}; };
    return chart;  // area element as for the first: 1 - v
  }
  if (domain == Domain::square) {
    chart.point = [](const Coordinate& v, const Coordinate& u) {
      return Point{u.value, v.value, 0};
    };
    chart.coordinates = [](const Point& p) { return std::array{p[1], p[0]}; };
    return chart;
  }
  chart.point = [](const Coordinate& phi, const Coordinate& theta) {
    return direction(theta, phi);
  };
  chart.jacobian = [](const Coordinate&, const Coordinate& theta) { return theta.sine; };
  chart.coordinates = [](const Point& p) {
    const auto [theta, phi] = angles<Domain::sphere>(p);
    return std::array{phi, theta};
  };
  return chart;
}

// The first coordinate below which this share of the domain's measure lies.
double quantile(Domain domain, double share) {
  switch (domain) {
    case Domain::hemisphere:
      return std::acos(1 - share);
    case Domain::sphere:
      return std::acos(1 - 2 * share);
    case Domain::triangle:
      return 1 - std::sqrt(1 - share);
    case Domain::square:
    case Domain::interval:
      break;
  }
  return share;
}

std::vector<double> borders(stats::Span span, std::span<const double> shares, auto quantile) {
  std::vector<double> all{span.low};
  for (const double share : shares) all.push_back(quantile(share));
  all.push_back(span.high);
  return all;
}

/// "theta 0.1 to 0.2", with enough digits to tell the ends apart.
std::string range_text(const std::string& name, stats::Span span) {
  const double largest = std::max(std::abs(span.low), std::abs(span.high));
  // 17 digits tell any two doubles apart.
  const int digits = std::clamp(2 + static_cast<int>(std::log10(largest / span.width())), 3, 17);
  return fmt::format("{} {:.{}g} to {:.{}g}", name, span.low, digits, span.high, digits);
}

}  // namespace

DomainChart chart_by(Domain domain, std::size_t marginal) {
  const auto straight = [&] {
    switch (domain) {
      case Domain::hemisphere:
        return of_directions<Domain::hemisphere>(pi / 2);
      case Domain::sphere:
        return of_directions<Domain::sphere>(pi);
      case Domain::square:
        return of_square();
      case Domain::triangle:
        return of_triangle();
      case Domain::interval:
        break;
    }
    throw std::logic_error("an interval has one coordinate");
  };
  return marginal == 0 ? straight() : turned(straight(), domain);
}

namespace {

// Fine enough to see a defect of one quadrant or a wrong exponent. The test pools cells that expect
// fewer than 20 points.
constexpr std::array<std::size_t, 2> plane_cells = {16, 32};
constexpr std::size_t interval_cells = 64;

stats::PlaneGrid grid_of(const Sampler& sampler, const auto& shares) {
  if (sampler.domain() != Domain::interval) {
    const DomainChart chart = chart_by(sampler.domain(), 0);
    const auto below = [&](double share) { return quantile(sampler.domain(), share); };
    const auto beside = [&](double share) { return share * chart.second.width(); };
    std::vector<double> first = borders(chart.first, shares(plane_cells[0]), below);
    return {std::move(first), borders(chart.second, shares(plane_cells[1]), beside)};
  }
  const auto [low, high] = sampler.bounds();
  stats::PlaneGrid grid{.x_borders = {low}, .y_borders = {0, 1}};
  for (const double share : shares(interval_cells)) {
    const double border = low + (high - low) * share;
    if (border > grid.x_borders.back()) grid.x_borders.push_back(border);
  }
  if (grid.x_borders.back() == high) grid.x_borders.pop_back();
  grid.x_borders.push_back(high);
  return grid;
}

/// Shares of the measure below the borders between equal cells.
std::vector<double> equal_shares(std::size_t cells) {
  std::vector<double> shares;
  for (std::size_t k = 1; k < cells; ++k) {
    shares.push_back(static_cast<double>(k) / static_cast<double>(cells));
  }
  return shares;
}

}  // namespace

stats::PlaneGrid shifted_grid(const Sampler& sampler, StreamKey key) {
  Stream random(key, 0);
  return grid_of(sampler, [&](std::size_t cells) {
    std::vector<double> shares = equal_shares(cells);
    for (double& share : shares) {
      const double moved = share + (2 * random.uniform_open() - 1) / static_cast<double>(cells);
      share = moved > 1 ? 2 - moved : std::abs(moved);
    }
    std::ranges::sort(shares);
    return shares;
  });
}

DrawCells::DrawCells(const Sampler& sampler)
    : DrawCells(sampler, std::vector(static_cast<std::size_t>(sampler.lobes()),
                                     stats::whole_cells(grid_of(sampler, equal_shares)))) {}

DrawCells::DrawCells(const Sampler& sampler, std::vector<stats::HalvedCells> of_lobes)
    : sampler_(sampler), of_lobes_(std::move(of_lobes)) {
  for (const stats::HalvedCells& cells : of_lobes_) {
    begin_.push_back(lobes_end_);
    lobes_end_ += cells.size();
  }
  for (int lobe = 0; lobe < sampler.lobes(); ++lobe) {
    if (sampler.point_mass(lobe) != 0) point_masses_.push_back(lobe);
  }
}

std::size_t DrawCells::index(const SamplerDraw& draw) const {
  if (!draw.valid) return size() - 1;
  const auto point_mass = std::ranges::find(point_masses_, draw.lobe);
  if (point_mass != point_masses_.end()) {
    return lobes_end_ + static_cast<std::size_t>(point_mass - point_masses_.begin());
  }
  const auto lobe = static_cast<std::size_t>(draw.lobe);
  if (sampler_.domain() == Domain::interval) {
    return begin_[lobe] + of_lobes_[lobe].index(draw.point[0], 0);
  }
  const auto [first, second] = chart_by(sampler_.domain(), 0).coordinates(draw.point);
  return begin_[lobe] + of_lobes_[lobe].index(first, second);
}

DrawCells::Found DrawCells::found(std::size_t cell) const {
  const auto after = std::ranges::upper_bound(begin_, cell);
  const auto lobe = static_cast<std::size_t>(after - begin_.begin()) - 1;
  return {.lobe = lobe, .cell = cell - begin_[lobe]};
}

std::size_t DrawCells::grid_cell(std::size_t cell) const {
  const auto [lobe, number] = found(cell);
  return of_lobes_[lobe].grid_cells[number];
}

stats::PlaneCell DrawCells::sides(std::size_t cell) const {
  const auto [lobe, number] = found(cell);
  return of_lobes_[lobe].cells[number];
}

std::string DrawCells::describe(std::size_t cell) const {
  if (cell == size() - 1) return "the draws without a point";
  if (cell >= lobes_end_) {
    return fmt::format("the points of lobe {}", point_masses_[cell - lobes_end_]);
  }
  const std::vector<Marginal> coordinates = cell_coordinates(sampler_);
  const stats::PlaneCell where = sides(cell);
  std::string text = range_text(coordinates[0].name, where.x);
  if (coordinates.size() > 1) text += ", " + range_text(coordinates[1].name, where.y);
  return of_lobes_.size() > 1 ? fmt::format("{} of lobe {}", text, found(cell).lobe) : text;
}

std::vector<Marginal> marginals_of(const Sampler& sampler) {
  std::vector<Marginal> all = marginals(sampler.domain());
  if (sampler.domain() == Domain::interval) {
    all[0].low = sampler.bounds()[0];
    all[0].high = sampler.bounds()[1];
  }
  return all;
}

std::vector<Marginal> cell_coordinates(const Sampler& sampler) {
  std::vector<Marginal> all = marginals_of(sampler);
  if (sampler.domain() == Domain::triangle) all[1].name = "v / (1 - u)";
  return all;
}

}  // namespace assay::harness
