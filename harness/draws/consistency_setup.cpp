#include "harness/draws/consistency_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "estimators/core/flush_denormals.h"
#include "harness/draws/sound_draw.h"

namespace assay::harness {
namespace {

double relative_difference(double a, double b) {
  if (a == b) return 0;
  return std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

double farther(double one, double other) { return std::isnan(one) || one > other ? one : other; }

/// The larger of two relative differences |a - b| / max(|a|, |b|), 0 if a = b. One compares the
/// draw's density with density(point), the other weight x density(point) with evaluate(point). It
/// is infinite for a draw without a point whose weight is not 0. Point masses have no density and
/// give 0. It is NaN if one of the numbers is NaN.
double difference_of(const AskedDraw& asked) {
  const SamplerDraw& draw = asked.draw;
  if (!asked.density) {
    return draw.valid || draw.weight == 0 ? 0 : std::numeric_limits<double>::infinity();
  }
  return farther(relative_difference(draw.density, *asked.density),
                 relative_difference(draw.weight * *asked.density, asked.evaluation));
}

/// The two numbers that are farthest from each other, in words.
std::string contradiction(const AskedDraw& asked) {
  const double weight = asked.draw.weight, density = asked.density.value_or(0);
  if (!asked.density) return fmt::format("the weight without a point is {}, not 0", weight);
  const double far = difference_of(asked);
  const double apart = relative_difference(asked.draw.density, density);
  const int digits = far > 1e-6 ? 9 : 17;
  if (std::isnan(apart) || apart == far)
    return fmt::format("the draw has density {:.{}g}, but density(point) is {:.{}g}",
                       asked.draw.density, digits, density, digits);
  return fmt::format("weight x density is {:.{}g}, but evaluate is {:.{}g}", weight * density,
                     digits, asked.evaluation, digits);
}

class ConsistencyEstimator final : public Estimator {
 public:
  explicit ConsistencyEstimator(const ConsistencySetup& setup)
      : setup_(setup), rounding_(setup.sampler().rounding()) {}

  void announce(const Announcement& next) override { draws_.announce(next); }
  double seconds_elsewhere() const override { return setup_.sampler().seconds_elsewhere(); }

  void secondary(Stream& random, std::uint64_t, std::span<double> out, Cost& cost) override {
    const NamedSampler& named = setup_.named();
    const AskedDraw& asked = draws_.of(random);
    if (asked.density.value_or(0) < 0) sound_density(named, asked.draw.point, *asked.density);
    out[1] = difference_of(asked);
    const bool consistent = out[1] <= rounding_;
    out[0] =
        consistent ? 0 : 1 + static_cast<double>(setup_.cells().index(sound(named, asked.draw)));
    cost.samples += 1;
  }

 private:
  const ConsistencySetup& setup_;
  double rounding_;
  AskedDraws draws_{setup_.named(), PointNumbers::densities_and_evaluations};
};

}  // namespace

ConsistencySetup::ConsistencySetup(const NamedSampler& named, const Location& where)
    : SamplerSetup(named, where), cells_(sampler()) {}

Channel ConsistencySetup::channel(std::size_t place) const {
  if (place == 0) return {.name = inconsistent_channel};
  return {.name = "difference", .diagnostic = true};
}

std::unique_ptr<Estimator> ConsistencySetup::make() const {
  return std::make_unique<ConsistencyEstimator>(*this);
}

std::optional<std::pair<std::uint64_t, std::string>> first_inconsistent(const Pool& pool,
                                                                        std::uint64_t count) {
  const FlushDenormals flush;
  const auto& setup = dynamic_cast<const ConsistencySetup&>(*pool.setup());
  AskedDraws draws(setup.named(), PointNumbers::densities_and_evaluations);
  draws.announce({.key = pool.key(), .first = 0, .last = count});
  for (std::uint64_t i = 0; i < count; ++i) {
    const AskedDraw& asked = draws.of(Stream(pool.key(), i));
    if (!(difference_of(asked) <= setup.sampler().rounding()))
      return std::pair(i, contradiction(asked));
  }
  return std::nullopt;
}

std::string consistency_purpose(const std::string& sampler) { return sampler + " consistency"; }

}  // namespace assay::harness
