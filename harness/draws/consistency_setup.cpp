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

/// True if the draw alone tells how far it is from what its sampler declares.
bool needs_no_density(const Sampler& sampler, const SamplerDraw& draw) {
  return !draw.valid || sampler.point_mass(draw.lobe) > 0;
}

double without_density(const SamplerDraw& draw) {
  return draw.valid || draw.weight == 0 ? 0 : std::numeric_limits<double>::infinity();
}

double with_density(const SamplerDraw& draw, double density, double evaluation) {
  return farther(relative_difference(draw.density, density),
                 relative_difference(draw.weight * density, evaluation));
}

struct JudgedDraw {
  SamplerDraw draw;
  double difference = 0;
  double density = 0;  ///< declared at its point, if asked for
};

std::vector<JudgedDraw> judged(const NamedSampler& named, std::span<const Stream> streams) {
  const Sampler& sampler = *named.sampler;
  std::vector<JudgedDraw> all;
  std::vector<std::size_t> places;
  std::vector<Point> points;
  for (const SamplerDraw& draw : sound_draws(named, streams)) {
    if (!needs_no_density(sampler, draw)) {
      places.push_back(all.size());
      points.push_back(draw.point);
    }
    all.push_back({draw, without_density(draw)});
  }
  std::vector<double> densities(points.size());
  std::vector<double> evaluations(points.size());
  all.resize(leading(places, all.size(), [&] {
    const std::size_t known = write_some(
        points, densities, [&](auto some, auto out) { return sampler.densities(some, out); });
    return write_some(std::span(points).first(known), evaluations,
                      [&](auto some, auto out) { return sampler.evaluations(some, out); });
  }));
  for (std::size_t i = 0; i < places.size() && places[i] < all.size(); ++i) {
    JudgedDraw& mine = all[places[i]];
    mine.difference = with_density(mine.draw, densities[i], evaluations[i]);
    mine.density = densities[i];
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

double inconsistency(const Sampler& sampler, const SamplerDraw& draw) {
  if (needs_no_density(sampler, draw)) return without_density(draw);
  return with_density(draw, sampler.density(draw.point), sampler.evaluate(draw.point));
}

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
    Stream random(pool.key(), i);
    Cost unused;
    estimator->secondary(random, pool.primaries(), out, unused);
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
