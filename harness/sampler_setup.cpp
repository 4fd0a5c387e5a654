#include "harness/sampler_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace assay::harness {
namespace {

// Fine enough to see a defect of one quadrant or a wrong exponent; cells that expect fewer than 20
// points are pooled by the test.
constexpr stats::HemisphereGrid hemisphere_grid{.cos_theta_cells = 16, .phi_cells = 32};
constexpr std::size_t interval_cells = 64;
// Tables of a marginal: so fine that the chord between two points is within 1e-4 of the law, and
// cut across into strips, because quadrature of a long thin cell halves it along its short side as
// well.
constexpr std::size_t marginal_cells = 1024;
constexpr std::size_t marginal_strips = 16;
constexpr double marginal_tolerance = 1e-7;

stats::IntervalGrid interval_grid(const Sampler& sampler, std::size_t cells) {
  return {.low = sampler.bounds()[0], .high = sampler.bounds()[1], .cells = cells};
}

std::function<double(double)> density_on_interval(const Sampler& sampler) {
  return [&sampler](double x) { return sampler.density({x, 0, 0}); };
}

std::function<double(stats::Direction)> density_on_hemisphere(const Sampler& sampler) {
  return [&sampler](stats::Direction direction) {
    const double sine = std::sqrt(std::max(0.0, 1 - direction.cos_theta * direction.cos_theta));
    return sampler.density(
        {sine * std::cos(direction.phi), sine * std::sin(direction.phi), direction.cos_theta});
  };
}

stats::CellProbabilities cells_of(const Sampler& sampler) {
  if (sampler.domain() == Domain::interval) {
    return stats::cell_probabilities(interval_grid(sampler, interval_cells),
                                     density_on_interval(sampler));
  }
  return stats::cell_probabilities(hemisphere_grid, density_on_hemisphere(sampler));
}

/// Draws of a sampler as an estimator yields observations.
class SamplerEstimator final : public Estimator {
 public:
  explicit SamplerEstimator(const SamplerSetup& setup)
      : setup_(setup), marginals_(setup.marginals()) {}

  void secondary(Stream& random, std::uint64_t, std::span<double> out, Cost& cost) override {
    const SamplerDraw draw = setup_.sampler().sample(random);
    for (std::size_t i = 0; i < marginals_.size(); ++i) {
      out[i] = draw.valid ? marginals_[i].coordinate(draw.point) : no_point(marginals_[i]);
    }
    out[marginals_.size()] = static_cast<double>(setup_.cell(draw));
    cost.samples += 1;
  }

 private:
  const SamplerSetup& setup_;
  std::vector<Marginal> marginals_;
};

/// Distribution function through the cumulated probabilities of equal cells.
std::function<double(double)> table(const std::vector<double>& probability, double low,
                                    double high) {
  std::vector<double> cumulated{0};
  for (const double p : probability) cumulated.push_back(cumulated.back() + p);
  for (double& value : cumulated) value /= cumulated.back();
  return [cumulated, low, high](double x) {
    const double cells = static_cast<double>(cumulated.size() - 1);
    const double place = std::clamp((x - low) / (high - low), 0.0, 1.0) * cells;
    const auto cell = std::min(static_cast<std::size_t>(place), cumulated.size() - 2);
    return std::lerp(cumulated[cell], cumulated[cell + 1], place - static_cast<double>(cell));
  };
}

}  // namespace

double no_point(const Marginal& marginal) { return marginal.low - 1; }

SamplerSetup::SamplerSetup(NamedSampler named) : named_(std::move(named)) {}

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

const DensityCells& SamplerSetup::cells() const {
  if (!cells_) cells_ = std::make_shared<const DensityCells>(cells_of(*named_.sampler));
  return *cells_;
}

std::size_t SamplerSetup::cell(const SamplerDraw& draw) const {
  const Sampler& sampler = *named_.sampler;
  if (sampler.domain() == Domain::interval) {
    const stats::IntervalGrid grid = interval_grid(sampler, interval_cells);
    return draw.valid ? grid.index(draw.point[0]) : grid.size();
  }
  if (!draw.valid) return hemisphere_grid.size();
  return hemisphere_grid.index(
      {.cos_theta = draw.point[2], .phi = std::atan2(draw.point[1], draw.point[0])});
}

std::function<double(double)> SamplerSetup::marginal_cdf(const std::string& marginal) const {
  const Sampler& sampler = *named_.sampler;
  if (sampler.domain() == Domain::interval) {
    return table(stats::cell_probabilities(interval_grid(sampler, marginal_cells),
                                           density_on_interval(sampler))
                     .probability,
                 sampler.bounds()[0], sampler.bounds()[1]);
  }
  const bool azimuth = marginal == "phi";
  const stats::HemisphereGrid grid{.cos_theta_cells = azimuth ? marginal_strips : marginal_cells,
                                   .phi_cells = azimuth ? marginal_cells : marginal_strips};
  const stats::CellProbabilities cells = stats::cell_probabilities(
      grid, density_on_hemisphere(sampler), {.tolerance = marginal_tolerance});
  std::vector<double> sums(marginal_cells);
  for (std::size_t cell = 0; cell < cells.probability.size(); ++cell) {
    sums[azimuth ? cell % marginal_cells : cell / marginal_strips] += cells.probability[cell];
  }
  if (azimuth) return table(sums, 0, 2 * std::numbers::pi);
  const auto of_cosine = table(sums, 0, 1);
  return [of_cosine](double theta) { return 1 - of_cosine(std::cos(theta)); };
}

std::shared_ptr<const SamplerSetup> sampler_setup(const NamedSampler& named,
                                                  const Location& where) {
  const Domain domain = named.sampler->domain();
  if (domain != Domain::interval && domain != Domain::hemisphere) {
    throw InputError(where, fmt::format("sampler `{}` draws on a square, triangle or sphere; only "
                                        "intervals and hemispheres can be divided into cells here",
                                        named.name));
  }
  return std::make_shared<const SamplerSetup>(named);
}

}  // namespace assay::harness
