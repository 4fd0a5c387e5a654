#include "harness/draws/consistency_setup.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "estimators/core/flush_denormals.h"
#include "harness/draws/sound_draw.h"
#include "harness/sampling/fetched_ahead.h"

namespace assay::harness {
namespace {

double relative_difference(double a, double b) {
  if (a == b) return 0;
  return std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

double farther(double one, double other) { return std::isnan(one) || one > other ? one : other; }

double without_density(const SamplerDraw& draw) {
  return draw.valid || draw.weight == 0 ? 0 : std::numeric_limits<double>::infinity();
}

struct JudgedDraw {
  SamplerDraw draw;
  double difference = 0;
  double density = 0;  ///< declared at its point, if asked for
};

/// The difference of a draw is the larger of two relative differences |a - b| / max(|a|, |b|), 0 if
/// a = b. One compares the draw's density with density(point), the other weight x density(point)
/// with evaluate(point). It is infinite for a draw without a point whose weight is not 0. Point
/// masses have no density and give 0. It is NaN if one of the numbers is NaN.
std::vector<JudgedDraw> judged(const NamedSampler& named, std::span<const Stream> streams) {
  const Sampler& sampler = *named.sampler;
  const JudgedDraws judged =
      judged_draws(named, streams,
                   {[&](auto some, auto out) { return sampler.densities(some, out); },
                    [&](auto some, auto out) { return sampler.evaluations(some, out); }});
  std::vector<JudgedDraw> all;
  for (const SamplerDraw& draw : judged.draws) all.push_back({draw, without_density(draw)});
  for (std::size_t i = 0; i < judged.places.size(); ++i) {
    JudgedDraw& mine = all[judged.places[i]];
    mine.density = judged.numbers[0][i];
    mine.difference =
        farther(relative_difference(mine.draw.density, mine.density),
                relative_difference(mine.draw.weight * mine.density, judged.numbers[1][i]));
  }
  return all;
}

class ConsistencyEstimator final : public Estimator {
 public:
  explicit ConsistencyEstimator(const ConsistencySetup& setup)
      : setup_(setup), rounding_(setup.sampler().rounding()) {}

  void announce(const Announcement& next) override { ahead_.announce(next); }
  double seconds_elsewhere() const override { return setup_.sampler().seconds_elsewhere(); }

  void secondary(Stream& random, std::uint64_t, std::span<double> out, Cost& cost) override {
    const auto [draw, difference, density] = next(random);
    if (density < 0) sound_density(setup_.named(), draw.point, density);
    const bool consistent = difference <= rounding_;
    out[0] =
        consistent ? 0 : 1 + static_cast<double>(setup_.cells().index(sound(setup_.named(), draw)));
    out[1] = difference;
    cost.samples += 1;
  }

 private:
  JudgedDraw next(Stream& random) {
    return ahead_.of(random, [&](auto streams) { return judged(setup_.named(), streams); });
  }

  const ConsistencySetup& setup_;
  double rounding_;
  FetchedAhead<JudgedDraw> ahead_;
};

}  // namespace

ConsistencySetup::ConsistencySetup(NamedSampler named)
    : SamplerSetup(std::move(named)), cells_(sampler()) {}

std::vector<Channel> ConsistencySetup::channels() const {
  return {{.name = inconsistent_channel}, {.name = "difference", .diagnostic = true}};
}

std::unique_ptr<Estimator> ConsistencySetup::make() const {
  return std::make_unique<ConsistencyEstimator>(*this);
}

std::optional<std::uint64_t> first_inconsistent(const Pool& pool, std::uint64_t count) {
  const FlushDenormals flush;
  const std::unique_ptr<Estimator> estimator = pool.setup()->make();
  estimator->announce({.key = pool.key(), .first = 0, .last = count});
  std::vector<double> out(pool.channels());
  for (std::uint64_t i = 0; i < count; ++i) {
    pool.draw_again(*estimator, i, out);
    if (out[0] != 0) return i;
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
