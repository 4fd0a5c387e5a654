#include "harness/sampler_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "harness/domain_chart.h"
#include "harness/fetched_ahead.h"
#include "harness/sound_draw.h"

namespace assay::harness {
namespace {

// Fine enough to see a defect of one quadrant or a wrong exponent; cells that expect fewer than 20
// points are pooled by the test.
constexpr std::array<std::size_t, 2> plane_cells = {16, 32};
constexpr std::size_t interval_cells = 64;
// Where a density jumps the cells that it jumps in come out right to some 1e-6 together, a tenth of
// what corners of its support between the nodes may hide; more digits take two and a half times as
// long, and a million draws tell 1e-4 of a cell.
constexpr stats::QuadratureLimits cell_limits{.tolerance = 1e-8, .deepest_bisection = 24};
constexpr stats::QuadratureLimits table_limits{.tolerance = 1e-7, .deepest_bisection = 24};
// A table begins with no fewer parts.
constexpr std::size_t least_parts = 32;
// So many panels of both coordinates together cost about as much as the limits allow.
constexpr std::size_t most_panels = std::size_t{1} << 15;

bool on_interval(const Sampler& sampler) { return sampler.domain() == Domain::interval; }

stats::IntervalGrid interval_grid(const Sampler& sampler) {
  return {.low = sampler.bounds()[0], .high = sampler.bounds()[1], .cells = interval_cells};
}

/// Halved until they can be paid for: jumps then lie inside panels, and bisection finds them.
Panels affordable(Panels panels) {
  while (panels.first * panels.second > most_panels) {
    std::size_t& larger = panels.first > panels.second ? panels.first : panels.second;
    larger = (larger + 1) / 2;
  }
  return panels;
}

/// A density at many points, of a sampler that may write those of the first few only.
using Densities = std::function<std::size_t(std::span<const Point>, std::span<double>)>;

/// Throws as sound_density().
Densities sound_densities(const NamedSampler& named, Densities densities) {
  return [&named, densities](std::span<const Point> points, std::span<double> out) {
    const std::size_t written = densities(points, out);
    for (std::size_t i = 0; i < written; ++i) sound_density(named, points[i], out[i]);
    return written;
  };
}

void write_all(const Densities& densities, std::span<const Point> points, std::span<double> out) {
  for (std::size_t done = 0; done < points.size();) {
    done += densities(points.subspan(done), out.subspan(done));
  }
}

/// A density on a plane as stats integrates it.
class OnChart {
 public:
  OnChart(const DomainChart& chart, Densities densities)
      : chart_(chart),
        densities_(std::move(densities)),
        firsts_(chart.coordinate),
        seconds_(chart.coordinate) {}

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

stats::PlaneDensity plane_density(const Sampler& sampler, std::size_t marginal,
                                  Densities densities) {
  const DomainChart chart = chart_by(sampler.domain(), marginal);
  const Panels panels = affordable(sampler.panels());
  return {.x = chart.first,
          .y = chart.second,
          .values = OnChart(chart, std::move(densities)),
          .x_panels = marginal == 0 ? panels.first : panels.second,
          .y_panels = marginal == 0 ? panels.second : panels.first};
}

stats::CellProbabilities cells_of_lobe(const NamedSampler& named, const stats::PlaneGrid& grid,
                                       int lobe) {
  const Sampler& sampler = *named.sampler;
  if (on_interval(sampler)) {
    return stats::cell_probabilities(interval_grid(sampler), [&](double x) {
      const Point point{x, 0, 0};
      return sound_density(named, point, sampler.lobe_density(lobe, point));
    });
  }
  const Densities densities =
      sound_densities(named, [&](std::span<const Point> points, std::span<double> out) {
        return sampler.lobe_densities(lobe, points, out);
      });
  return stats::cell_probabilities(grid, plane_density(sampler, 0, densities), cell_limits);
}

void append(stats::CellProbabilities& all, const stats::CellProbabilities& more) {
  all.probability.insert(all.probability.end(), more.probability.begin(), more.probability.end());
  all.error.insert(all.error.end(), more.error.begin(), more.error.end());
  all.total += more.total;
  all.total_error += more.total_error;
}

DensityCells cells_of(const NamedSampler& named, const stats::PlaneGrid& grid) {
  const Sampler& sampler = *named.sampler;
  DensityCells cells;
  for (int lobe = 0; lobe < sampler.lobes(); ++lobe) {
    append(cells.grid, cells_of_lobe(named, grid, lobe));
  }
  for (int lobe = 0; lobe < sampler.lobes(); ++lobe) {
    const double mass = sampler.point_mass(lobe);
    if (mass == 0) continue;
    append(cells.grid, {.probability = {mass}, .error = {0}, .total = mass});
    cells.point_masses += mass;
  }
  return cells;
}

/// That of all lobes together.
Densities densities_of(const NamedSampler& named) {
  return sound_densities(named, [&named](std::span<const Point> points, std::span<double> out) {
    return named.sampler->densities(points, out);
  });
}

stats::TabulatedLaw law_on_interval(const NamedSampler& named) {
  const Sampler& sampler = *named.sampler;
  stats::AdaptiveQuadrature rule(table_limits);
  const stats::Span range{sampler.bounds()[0], sampler.bounds()[1]};
  const auto parts = stats::cut(range, range, std::max(sampler.panels().first, least_parts));
  const auto density = [&](std::span<const double> x, std::span<double> values) {
    std::vector<Point> points;
    for (const double each : x) points.push_back({each, 0, 0});
    write_all(densities_of(named), points, values);
  };
  return stats::tabulate(rule.of(density), parts, rule);
}

stats::TabulatedLaw law_of(const NamedSampler& named, std::size_t marginal) {
  if (on_interval(*named.sampler)) return law_on_interval(named);
  const stats::PlaneDensity density = plane_density(*named.sampler, marginal, densities_of(named));
  stats::AdaptiveQuadrature rule(table_limits);
  // A multiple of the panels, so that their borders stay borders.
  const std::size_t each = (least_parts + density.x_panels - 1) / density.x_panels;
  const auto parts = stats::cut(density.x, density.x, each * density.x_panels);
  return stats::tabulate(stats::marginal_density(density, rule), parts, rule);
}

bool has_density(const Sampler& sampler, const SamplerDraw& draw) {
  return draw.valid && sampler.point_mass(draw.lobe) == 0;
}

/// Draws of a sampler as an estimator yields observations.
class SamplerEstimator final : public Estimator {
 public:
  explicit SamplerEstimator(const SamplerSetup& setup)
      : setup_(setup), marginals_(setup.marginals()) {}

  void announce(const Announcement& next) override { ahead_.announce(next); }
  double seconds_elsewhere() const override { return setup_.sampler().seconds_elsewhere(); }

  void secondary(Stream& random, std::uint64_t, std::span<double> out, Cost& cost) override {
    const Sampler& sampler = setup_.sampler();
    const SamplerDraw draw =
        sound(setup_.named(),
              sampler.is_elsewhere()
                  ? ahead_.of(random, [&](auto streams) { return draws_of(sampler, streams); })
                  : sampler.sample(random));
    const bool point = has_density(setup_.sampler(), draw);
    for (std::size_t i = 0; i < marginals_.size(); ++i) {
      out[i] = point ? marginals_[i].coordinate(draw.point) : no_point(marginals_[i]);
    }
    out[marginals_.size()] = static_cast<double>(setup_.cell(draw));
    cost.samples += 1;
  }

 private:
  const SamplerSetup& setup_;
  std::vector<Marginal> marginals_;
  FetchedAhead<SamplerDraw> ahead_;
};

std::string range_text(const std::string& name, double low, double high) {
  return fmt::format("{} {:.3g} to {:.3g}", name, low, high);
}

}  // namespace

std::vector<SamplerDraw> draws_of(const Sampler& sampler, std::span<Stream> streams) {
  std::vector<SamplerDraw> draws(streams.size());
  draws.resize(sampler.samples(streams, draws));
  return draws;
}

void require_sound(const NamedSampler& named, const Location& where) {
  const Sampler& sampler = *named.sampler;
  const auto [low, high] = sampler.bounds();
  if (on_interval(sampler) && !(std::isfinite(low) && std::isfinite(high) && low < high)) {
    throw InputError(where,
                     fmt::format("sampler `{}` draws on [{}, {}]: no interval to divide into "
                                 "cells",
                                 named.name, low, high));
  }
  if (sampler.lobes() < 1) {
    throw InputError(where, fmt::format("sampler `{}` has no lobe to draw from", named.name));
  }
}

double DensityCells::tolerance() const {
  const double parts = static_cast<double>(size()) + 10;
  return 2 * grid.total_error + parts * std::numeric_limits<double>::epsilon() * grid.total;
}

double DensityCells::missing() const {
  const double rest = 1 - grid.total;
  return rest <= tolerance() ? 0 : rest;
}

double no_point(const Marginal& marginal) { return marginal.low - 1; }

SamplerSetup::SamplerSetup(NamedSampler named) : named_(std::move(named)) {
  if (!on_interval(sampler())) grid_ = equal_measure_grid(sampler().domain(), plane_cells);
}

std::vector<Marginal> SamplerSetup::marginals() const {
  std::vector<Marginal> all = assay::marginals(named_.sampler->domain());
  if (named_.sampler->domain() == Domain::interval) {
    all[0].low = named_.sampler->bounds()[0];
    all[0].high = named_.sampler->bounds()[1];
  }
  return all;
}

std::vector<Channel> SamplerSetup::channels() const {
  std::vector<Channel> all;
  for (const Marginal& marginal : marginals()) {
    all.push_back({.name = marginal.name, .low = no_point(marginal), .high = marginal.high});
  }
  all.push_back({.name = cell_channel, .diagnostic = true});
  return all;
}

std::unique_ptr<Estimator> SamplerSetup::make() const {
  return std::make_unique<SamplerEstimator>(*this);
}

/// A density that could not be had is not asked for again: that may have taken a time-out.
auto SamplerSetup::integrated(auto table) const {
  if (!no_density_.empty()) throw NoDensity(no_density_);
  try {
    return table();
  } catch (const std::runtime_error& error) {
    no_density_ = error.what();
    throw NoDensity(no_density_);
  }
}

const DensityCells& SamplerSetup::cells() const {
  const std::scoped_lock lock(once_);
  if (!cells_) {
    cells_ =
        integrated([&] { return std::make_shared<const DensityCells>(cells_of(named_, grid_)); });
  }
  return *cells_;
}

std::size_t SamplerSetup::cell_count() const {
  const int lobes = sampler().lobes();
  std::size_t count =
      static_cast<std::size_t>(lobes) * (on_interval(sampler()) ? interval_cells : grid_.size());
  for (int lobe = 0; lobe < lobes; ++lobe)
    if (sampler().point_mass(lobe) != 0) ++count;
  return count + 1;
}

std::size_t SamplerSetup::cell(const SamplerDraw& draw) const {
  const std::size_t each = on_interval(sampler()) ? interval_cells : grid_.size();
  const int lobes = sampler().lobes();
  const auto lobe = static_cast<std::size_t>(draw.lobe);
  std::size_t next = static_cast<std::size_t>(lobes) * each;
  for (int other = 0; other < lobes; ++other) {
    if (sampler().point_mass(other) == 0) continue;
    if (draw.valid && other == draw.lobe) return next;
    ++next;
  }
  if (!draw.valid) return next;
  if (on_interval(sampler())) return lobe * each + interval_grid(sampler()).index(draw.point[0]);
  const auto [first, second] = chart_by(sampler().domain(), 0).coordinates(draw.point);
  return lobe * each + grid_.index(first, second);
}

std::string SamplerSetup::describe_cell(std::size_t cell) const {
  const bool interval = on_interval(sampler());
  const std::size_t each = interval ? interval_cells : grid_.size();
  const auto lobes = static_cast<std::size_t>(sampler().lobes());
  const std::vector<Marginal> coordinates = marginals();
  if (cell < lobes * each) {
    const std::string lobe = lobes > 1 ? fmt::format(" of lobe {}", cell / each) : "";
    const std::size_t place = cell % each;
    if (interval) {
      const auto [low, high] = sampler().bounds();
      const double width = (high - low) / static_cast<double>(interval_cells);
      const double from = low + static_cast<double>(place) * width;
      return range_text(coordinates[0].name, from, from + width) + lobe;
    }
    const std::size_t row = grid_.y_borders.size() - 1;
    const auto range = [&](std::size_t which, const std::vector<double>& borders, std::size_t i) {
      return range_text(coordinates[which].name, borders[i], borders[i + 1]);
    };
    // Of a triangle the second coordinate of a cell is a share of what the first leaves.
    const bool triangle = sampler().domain() == Domain::triangle;
    const std::string second = triangle ? range_text("v / (1 - u)", grid_.y_borders[place % row],
                                                     grid_.y_borders[place % row + 1])
                                        : range(1, grid_.y_borders, place % row);
    return range(0, grid_.x_borders, place / row) + ", " + second + lobe;
  }
  std::size_t next = lobes * each;
  for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
    if (sampler().point_mass(static_cast<int>(lobe)) == 0) continue;
    if (cell == next++) return fmt::format("the points of lobe {}", lobe);
  }
  return "the draws without a point";
}

const stats::TabulatedLaw& SamplerSetup::marginal_law(const std::string& marginal) const {
  const std::scoped_lock lock(once_);
  const auto found = laws_.find(marginal);
  if (found != laws_.end()) return found->second;
  const std::vector<Marginal> all = marginals();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name != marginal) continue;
    auto law = integrated([&] { return law_of(named_, i); });
    return laws_.emplace(marginal, std::move(law)).first->second;
  }
  throw std::logic_error("no marginal " + marginal);
}

std::shared_ptr<const SamplerSetup> sampler_setup(const NamedSampler& named,
                                                  const Location& where) {
  require_sound(named, where);
  static std::mutex once;
  static std::map<const Sampler*, std::weak_ptr<const SamplerSetup>> known;
  const std::scoped_lock lock(once);
  std::weak_ptr<const SamplerSetup>& place = known[named.sampler.get()];
  if (const auto setup = place.lock()) return setup;
  const auto setup = std::make_shared<const SamplerSetup>(named);
  place = setup;
  return setup;
}

}  // namespace assay::harness
