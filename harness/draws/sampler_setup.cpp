#include "harness/draws/sampler_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "harness/draws/declared_density.h"
#include "harness/draws/sound_draw.h"
#include "harness/sampling/fetched_ahead.h"
#include "harness/sampling/sample.h"

namespace assay::harness {
namespace {

constexpr stats::QuadratureLimits table_limits{.tolerance = 1e-7, .deepest_bisection = 24};
constexpr std::size_t least_parts = 32;

bool on_interval(const Sampler& sampler) { return sampler.domain() == Domain::interval; }

stats::TabulatedLaw law_on_interval(const NamedSampler& named) {
  const Sampler& sampler = *named.sampler;
  stats::AdaptiveQuadrature rule(table_limits);
  const stats::Span range{sampler.bounds()[0], sampler.bounds()[1]};
  const stats::LineDensity density = line_density(sampler, densities_of(named));
  const auto parts = stats::cut(range, range, std::max(density.panels, least_parts));
  return stats::tabulate(rule.of(density.values), parts, rule);
}

stats::TabulatedLaw law_of(const NamedSampler& named, std::size_t marginal) {
  if (on_interval(*named.sampler)) return law_on_interval(named);
  const stats::PlaneDensity density = plane_density(*named.sampler, marginal, densities_of(named));
  stats::AdaptiveQuadrature rule(table_limits);
  // A multiple of the panels keeps their borders.
  const std::size_t each = (least_parts + density.x_panels - 1) / density.x_panels;
  const auto parts = stats::cut(density.x, density.x, each * density.x_panels);
  return stats::tabulate(stats::marginal_density(density, rule), parts, rule);
}

bool has_density(const Sampler& sampler, const SamplerDraw& draw) {
  return draw.valid && sampler.point_mass(draw.lobe) == 0;
}

/// A sampler whose draws are the observations of an estimator.
class SamplerEstimator final : public Estimator {
 public:
  explicit SamplerEstimator(const SamplerSetup& setup)
      : setup_(setup), marginals_(setup.marginals()), density_cells_(setup.cells_asked_for()) {}

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
    out[marginals_.size()] =
        density_cells_ ? static_cast<double>(density_cells_->cells.index(draw)) : no_cell;
    cost.samples += 1;
  }

 private:
  const SamplerSetup& setup_;
  std::vector<Marginal> marginals_;
  std::shared_ptr<const DensityCells> density_cells_;
  FetchedAhead<SamplerDraw> ahead_;
};

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

double no_point(const Marginal& marginal) { return marginal.low - 1; }

SamplerSetup::SamplerSetup(NamedSampler named) : named_(std::move(named)) {}

std::vector<Marginal> SamplerSetup::marginals() const { return marginals_of(sampler()); }

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

/// A density that failed is not asked for again: each time may take a time-out.
auto SamplerSetup::integrated(auto table) const {
  if (!no_density_.empty()) throw NoDensity(no_density_);
  try {
    return table();
  } catch (const std::domain_error&) {
    throw;  // the density exists but allows no cells
  } catch (...) {
    no_density_ = words_of(std::current_exception());
    throw NoDensity(no_density_);
  }
}

const DensityCells& SamplerSetup::density_cells() const {
  const std::scoped_lock lock(once_);
  if (!cells_) {
    cells_ = integrated(
        [&] { return std::make_shared<const DensityCells>(harness::density_cells(named_)); });
  }
  return *cells_;
}

std::shared_ptr<const DensityCells> SamplerSetup::cells_asked_for() const {
  const std::scoped_lock lock(once_);
  return cells_;
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
