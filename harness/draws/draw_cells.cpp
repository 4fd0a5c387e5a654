#include "harness/draws/draw_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "estimators/core/mapped.h"
#include "reports/words/number.h"

namespace assay::harness {
namespace {

constexpr double pi = std::numbers::pi;

// v / (1 - u); 1 if rounding led to u + v > 1.
double share_of_rest(double v, double u) {
  const double rest = 1 - u;
  if (v > rest) return 1;
  return rest > 0 ? v / rest : 0;
}

/// A coordinate's value; for an angle also sine and cosine.
struct Coordinate {
  double value;
  double cosine = 0;
  double sine = 0;
};

/// Maps a domain to a rectangle, so that cells and marginals of all domains are those of a
/// rectangle. Hemisphere and sphere: theta and phi, density per solid angle times sin theta.
/// Square: u and v. Triangle: u and v / (1 - u), times 1 - u. Its second marginal has v and
/// u / (1 - v). An interval has one coordinate; the second is 0.
struct DomainChart {
  Domain domain;
  bool turned;  ///< True if its first coordinate is the second marginal.
  stats::Span first;
  stats::Span second;

  Coordinate coordinate(double value) const {
    if (!has_directions(domain)) return {.value = value};
    return {.value = value, .cosine = std::cos(value), .sine = std::sin(value)};
  }
  Point point(const Coordinate& a, const Coordinate& b) const {
    if (has_directions(domain)) {
      const Coordinate& theta = turned ? b : a;
      const Coordinate& phi = turned ? a : b;
      return {theta.sine * phi.cosine, theta.sine * phi.sine, theta.cosine};
    }
    if (domain == Domain::interval) return {a.value, 0, 0};
    const double other = domain == Domain::triangle ? b.value * (1 - a.value) : b.value;
    return turned ? Point{other, a.value, 0} : Point{a.value, other, 0};
  }
  double jacobian(const Coordinate& a, const Coordinate& b) const {
    if (has_directions(domain)) return turned ? b.sine : a.sine;
    return domain == Domain::triangle ? 1 - a.value : 1;
  }
  std::array<double, 2> coordinates(const Point& p) const {
    static const std::vector<Marginal> angles = marginals(Domain::sphere);
    const bool directions = has_directions(domain);
    std::array<double, 2> both{directions ? angles[0].coordinate(p) : p[0],
                               directions ? angles[1].coordinate(p) : p[1]};
    if (domain == Domain::interval) both[1] = 0;
    if (turned) std::swap(both[0], both[1]);
    if (domain == Domain::triangle) both[1] = share_of_rest(both[1], both[0]);
    return both;
  }
};

/// A cache of coordinates: quadrature meets the same values in every row of cells, and sine and
/// cosine cost more than most densities. Each slot remembers the latest value.
class RememberedCoordinates {
 public:
  explicit RememberedCoordinates(const DomainChart& chart) : chart_(chart) {}

  const Coordinate& operator()(double value) {
    // Knuth's multiplicative hashing by the golden ratio.
    const auto hash = std::bit_cast<std::uint64_t>(value) * 0x9E3779B97F4A7C15;
    Coordinate& known = table_[hash >> (64 - bits)];
    if (known.value != value) known = chart_.coordinate(value);
    return known;
  }

 private:
  static constexpr int bits = 12;

  DomainChart chart_;
  std::vector<Coordinate> table_ = std::vector<Coordinate>(
      std::size_t{1} << bits, {.value = std::numeric_limits<double>::quiet_NaN()});
};

/// The chart whose first coordinate is this marginal, 0 or 1.
DomainChart chart_by(const Sampler& sampler, std::size_t marginal = 0) {
  const Domain domain = sampler.domain();
  DomainChart chart{.domain = domain, .turned = marginal == 1, .first = {0, 1}, .second = {0, 1}};
  if (has_directions(domain)) {
    chart.first = {0, domain == Domain::hemisphere ? pi / 2 : pi};
    chart.second = {0, 2 * pi};
  }
  if (domain == Domain::interval) chart.first = {sampler.bounds()[0], sampler.bounds()[1]};
  if (chart.turned) std::swap(chart.first, chart.second);
  return chart;
}

// The first coordinate below which this share of the domain's measure lies.
double quantile(Domain domain, double share) {
  if (domain == Domain::hemisphere) return std::acos(1 - share);
  if (domain == Domain::sphere) return std::acos(1 - 2 * share);
  return domain == Domain::triangle ? 1 - std::sqrt(1 - share) : share;
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

// Fine enough to see a defect of one quadrant or a wrong exponent. The test pools cells that expect
// fewer than 20 points.
constexpr std::array<std::size_t, 2> plane_cells = {16, 32};
constexpr std::size_t interval_cells = 64;

stats::PlaneGrid grid_of(const Sampler& sampler, const auto& shares) {
  if (sampler.domain() != Domain::interval) {
    const DomainChart chart = chart_by(sampler);
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

/// Shares of the measure below the borders between equal cells. There is one cell at least.
std::vector<double> equal_shares(std::size_t cells) {
  return mapped_indices(cells - 1, [&](std::size_t k) {
    return static_cast<double>(k + 1) / static_cast<double>(cells);
  });
}

// Ample for single precision and fast reciprocal roots; a direction that was never normalised is
// off by more.
constexpr double least_length_slack = 1e-4;
// About ten roundings of single precision.
constexpr double least_slack = 1e-6;
constexpr double single_rounding = std::numeric_limits<float>::epsilon();

std::string in_words(const Sampler& sampler, const Point& p) {
  if (sampler.domain() == Domain::interval) return fmt::format("{}", p[0]);
  return fmt::format("({})", fmt::join(std::span(p).first(coordinates(sampler.domain())), ", "));
}

std::string domain_in_words(const Sampler& sampler) {
  const auto [low, high] = sampler.bounds();
  if (sampler.domain() == Domain::interval) return fmt::format("interval [{}, {}]", low, high);
  constexpr const char* others[] = {"square (u and v from 0 to 1)",
                                    "triangle (u >= 0, v >= 0, u + v <= 1)", "hemisphere (z >= 0)",
                                    "sphere"};
  return others[static_cast<int>(sampler.domain()) - 1];
}

/// Moves a coordinate that is at most `slack` outside the range to its border. False if it is
/// farther out.
bool settle(double& x, stats::Span range, double slack) {
  if (!(x >= range.low - slack && x <= range.high + slack)) return false;
  x = std::clamp(x, range.low, range.high);
  return true;
}

/// Settles all coordinates of a point. u + v may exceed 1 by rounding: cells allow for it.
bool settle(Point& p, const Sampler& sampler) {
  const double slack = std::max(least_slack, sampler.rounding());
  const Domain domain = sampler.domain();
  if (domain == Domain::interval) {
    const auto [low, high] = sampler.bounds();
    // Single precision rounds the bounds themselves.
    const double rounding = single_rounding * std::max(std::abs(low), std::abs(high));
    return settle(p[0], {low, high}, slack * (high - low) + rounding);
  }
  if (domain == Domain::sphere) return true;
  if (domain == Domain::hemisphere) return settle(p[2], {0, 2}, slack);
  if (domain == Domain::triangle && !(p[0] + p[1] <= 1 + slack)) return false;
  return settle(p[0], {0, 1}, slack) && settle(p[1], {0, 1}, slack);
}

[[noreturn]] void refuse_draw(const NamedSampler& named, const std::string& words) {
  throw std::runtime_error(fmt::format("sampler `{}` drew {}", named.name, words));
}

// More panels of both coordinates together would exceed the limits of the quadrature.
constexpr std::size_t most_panels = std::size_t{1} << 15;

Densities checked(const NamedSampler& named, Densities densities) {
  return [&named, densities](std::span<const Point> points, std::span<double> out) {
    const std::size_t written = densities(points, out);
    for (std::size_t i = 0; i < written; ++i) sound_density(named, points[i], out[i]);
    return written;
  };
}

class OnChart {
 public:
  OnChart(const DomainChart& chart, Densities densities)
      : chart_(chart), densities_(std::move(densities)), firsts_(chart), seconds_(chart) {}

  void operator()(std::span<const double> x, std::span<const double> y, std::span<double> values) {
    points_.clear();
    jacobians_.clear();
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Coordinate& first = firsts_(x[i]);
      const Coordinate& second = seconds_(y[i]);
      points_.push_back(chart_.point(first, second));
      jacobians_.push_back(chart_.jacobian(first, second));
    }
    write_all(densities_, points_, values);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] *= jacobians_[i];
  }

 private:
  DomainChart chart_;
  Densities densities_;
  RememberedCoordinates firsts_;
  RememberedCoordinates seconds_;
  std::vector<Point> points_;
  std::vector<double> jacobians_;
};

std::vector<Point> densest_first(std::span<const Point> drawn, const Densities& densities) {
  std::vector<double> values(drawn.size());
  write_all(densities, drawn, values);
  std::vector<std::size_t> order(drawn.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return values[i]; });
  return mapped(order, [&](std::size_t i) { return drawn[i]; });
}

/// Points that a sampler draws show the quadrature where its density has peaks.
stats::LineDensity line_density(const Sampler& sampler, std::span<const Point> drawn,
                                Densities densities) {
  const std::vector<double> places =
      mapped(densest_first(drawn, densities), [](const Point& point) { return point[0]; });
  const auto values = [densities = std::move(densities)](std::span<const double> x,
                                                         std::span<double> out) {
    write_all(densities, mapped(x, [](double each) { return Point{each, 0, 0}; }), out);
  };
  const stats::Span whole{sampler.bounds()[0], sampler.bounds()[1]};
  return {.values = values,
          .panels = {.equal = sampler.panels().first,
                     .borders = stats::borders_of_peaks(places, whole)}};
}

/// The density on a domain of two coordinates, in its chart by this marginal, 0 or 1. It asks for
/// the sampler's panels, halved as often as they cost too much. Bisection then finds jumps inside
/// panels.
stats::PlaneDensity plane_density(const Sampler& sampler, std::size_t marginal,
                                  std::span<const Point> drawn, Densities densities) {
  const DomainChart chart = chart_by(sampler, marginal);
  Panels panels = sampler.panels();
  while (panels.first * panels.second > most_panels) {
    std::size_t& larger = panels.first > panels.second ? panels.first : panels.second;
    larger = (larger + 1) / 2;
  }
  const auto on_chart = [&](const Point& point) { return chart.coordinates(point); };
  std::array<std::vector<double>, 2> places;
  for (const Point& point : densest_first(drawn, densities))
    for (std::size_t i = 0; i < 2; ++i) places[i].push_back(on_chart(point)[i]);
  return {.x = chart.first,
          .y = chart.second,
          .values = OnChart(chart, std::move(densities)),
          .x_panels = {.equal = marginal == 0 ? panels.first : panels.second,
                       .borders = stats::borders_of_peaks(places[0], chart.first)},
          .y_panels = {.equal = marginal == 0 ? panels.second : panels.first,
                       .borders = stats::borders_of_peaks(places[1], chart.second)},
          .drawn = mapped(drawn, on_chart)};
}

constexpr stats::QuadratureLimits table_limits{.tolerance = 1e-7};
constexpr std::size_t least_parts = 32;

// Cells at a jump of the density are right to 1e-6 together. A million draws tell 1e-4 of a cell,
// so more digits would cost time for nothing.
constexpr stats::QuadratureLimits limits{.tolerance = 1e-8};

// More cells of a peak find finer defects, but need more points for those that are everywhere
// (tests/cells_study.sh). A share of 1/32 would be one column of azimuths of a lobe about
// the pole.
constexpr double largest_share = 1.0 / 40;

stats::AdaptiveCells cells_of_lobe(const NamedSampler& named, const stats::PlaneGrid& grid,
                                   std::span<const Point> drawn, int lobe) {
  const Sampler& sampler = *named.sampler;
  const auto of_lobe = [&named, lobe](std::span<const Point> points, std::span<double> out) {
    return named.sampler->lobe_densities(lobe, points, out);
  };
  const Densities densities = checked(named, of_lobe);
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
  for (int lobe = 0; lobe < sampler.lobes(); ++lobe)
    if (sampler.point_mass(lobe) != 0) point_masses_.push_back(lobe);
}

std::size_t DrawCells::index(const SamplerDraw& draw) const {
  if (!draw.valid) return size() - 1;
  const auto point_mass = std::ranges::find(point_masses_, draw.lobe);
  if (point_mass != point_masses_.end())
    return lobes_end_ + static_cast<std::size_t>(point_mass - point_masses_.begin());
  const auto lobe = static_cast<std::size_t>(draw.lobe);
  const auto [first, second] = chart_by(sampler_).coordinates(draw.point);
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
  if (cell >= lobes_end_)
    return fmt::format("the points of lobe {}", point_masses_[cell - lobes_end_]);
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

SamplerDraw sound(const NamedSampler& named, SamplerDraw draw) {
  const Sampler& sampler = *named.sampler;
  const int lobes = sampler.lobes();
  if (draw.lobe < 0 || draw.lobe >= lobes)
    refuse_draw(named, fmt::format("from lobe {}, and declares {}", draw.lobe, lobes));
  if (!draw.valid) return draw;
  const Point drawn = draw.point;
  const auto& [x, y, z] = drawn;
  const double length = has_directions(sampler.domain()) ? std::sqrt(x * x + y * y + z * z) : 1;
  if (!(std::abs(length - 1) <= std::max(least_length_slack, sampler.rounding()))) {
    refuse_draw(named, fmt::format("{}, whose length is {:.6g}: a direction must have length 1",
                                   in_words(sampler, drawn), length));
  }
  if (!settle(draw.point, sampler)) {
    refuse_draw(named, fmt::format("{}, outside its {}", in_words(sampler, drawn),
                                   domain_in_words(sampler)));
  }
  if (draw.density < 0 && !(sampler.point_mass(draw.lobe) > 0)) {
    refuse_draw(named, fmt::format("{} with density {}: a density must be >= 0",
                                   in_words(sampler, draw.point), reports::human(draw.density, 3)));
  }
  return draw;
}

double sound_density(const NamedSampler& named, const Point& point, double density) {
  if (density >= 0 && std::isfinite(density)) return density;
  throw std::domain_error(fmt::format(
      "sampler `{}` declares the density {} at {}: a density must be non-negative and finite",
      named.name, reports::human(density, 3), in_words(*named.sampler, point)));
}

void write_all(const Densities& densities, std::span<const Point> points, std::span<double> out) {
  for (std::size_t done = 0; done < points.size();) {
    done += densities(points.subspan(done), out.subspan(done));
  }
}

bool is_impossible(const Sampler& sampler, const Point& point, double density) {
  if (density != 0) return false;
  constexpr double least_reach = 1e-6;
  const double reach = std::max(least_reach, sampler.rounding());
  const auto moved = [&](double place, const stats::Span& span, int steps) {
    return std::clamp(place + steps * reach * span.width(), span.low, span.high);
  };
  const DomainChart chart = chart_by(sampler);
  const auto [first, second] = chart.coordinates(point);
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      const Point beside = chart.point(chart.coordinate(moved(first, chart.first, i)),
                                       chart.coordinate(moved(second, chart.second, j)));
      if (sampler.density(beside) != 0) return false;
    }
  }
  return true;
}

stats::TabulatedLaw law_of(const NamedSampler& named, std::size_t marginal,
                           std::span<const Point> drawn) {
  const Sampler& sampler = *named.sampler;
  stats::AdaptiveQuadrature rule(table_limits);
  const Densities densities =
      checked(named, [&named](std::span<const Point> points, std::span<double> out) {
        return named.sampler->densities(points, out);
      });
  if (sampler.domain() == Domain::interval) {
    stats::LineDensity density = line_density(sampler, drawn, densities);
    density.panels.equal = std::max(density.panels.equal, least_parts);
    const stats::Span range{sampler.bounds()[0], sampler.bounds()[1]};
    return stats::tabulate(rule.of(density.values), stats::cut(range, range, density.panels), rule);
  }
  const stats::PlaneDensity density = plane_density(sampler, marginal, drawn, densities);
  // A multiple of the panels keeps their borders.
  stats::Panelling panels = density.x_panels;
  panels.equal *= (least_parts + panels.equal - 1) / panels.equal;
  const auto parts = stats::cut(density.x, density.x, panels);
  return stats::tabulate(stats::marginal_density(density, rule), parts, rule);
}

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
