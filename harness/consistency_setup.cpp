#include "harness/consistency_setup.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimators/flush_denormals.h"

namespace assay::harness {
namespace {

double relative_difference(double a, double b) {
  if (a == b) return 0;
  return std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

/// The larger, and NaN where one is.
double farther(double one, double other) { return std::isnan(one) || one > other ? one : other; }

class ConsistencyEstimator final : public Estimator {
 public:
  explicit ConsistencyEstimator(const ConsistencySetup& setup)
      : setup_(setup), rounding_(setup.sampler().rounding()) {}

  void secondary(Stream& random, std::uint64_t, std::span<double> out, Cost& cost) override {
    const SamplerDraw draw = setup_.sampler().sample(random);
    const double difference = inconsistency(setup_.sampler(), draw);
    // NaN is not consistent either.
    const bool consistent = difference <= rounding_;
    out[0] = consistent ? 0 : 1 + static_cast<double>(setup_.cell(draw));
    out[1] = difference;
    cost.samples += 1;
  }

 private:
  const ConsistencySetup& setup_;
  double rounding_;
};

}  // namespace

double inconsistency(const Sampler& sampler, const SamplerDraw& draw) {
  if (!draw.valid) return draw.weight == 0 ? 0 : std::numeric_limits<double>::infinity();
  if (sampler.point_mass(draw.lobe) > 0) return 0;
  const double density = sampler.density(draw.point);
  return farther(relative_difference(draw.density, density),
                 relative_difference(draw.weight * density, sampler.evaluate(draw.point)));
}

std::vector<Channel> ConsistencySetup::channels() const {
  return {{.name = inconsistent_channel}, {.name = "difference", .diagnostic = true}};
}

std::unique_ptr<Estimator> ConsistencySetup::make() const {
  return std::make_unique<ConsistencyEstimator>(*this);
}

std::optional<std::uint64_t> first_inconsistent(const Pool& pool, std::uint64_t count) {
  const FlushDenormals flush;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (draw_observation(*pool.setup(), pool.key(), pool.primaries(), i)[0] != 0) return i;
  }
  return std::nullopt;
}

std::string consistency_purpose(const std::string& sampler) { return sampler + " consistency"; }

std::shared_ptr<const SamplerSetup> consistency_setup(const NamedSampler& named,
                                                      const Location& where) {
  require_sound(named, where);
  return std::make_shared<const ConsistencySetup>(named);
}

}  // namespace assay::harness
