#include "harness/record/estimators.h"

#include <algorithm>
#include <cmath>

#include "harness/base/numbers.h"
#include "harness/plan/independence.h"
#include "harness/record/maps.h"
#include "harness/sampling/summary.h"
#include "harness/theta/evidence.h"
#include "stats/gates/independence_gates.h"
#include "stats/means/student_t.h"
#include "stats/variances/influence.h"

namespace assay::harness {
namespace {

/// True if moments suffice for intervals of mean and variance.
bool has_spread(const stats::Moments& moments) {
  return moments.count > 3 && moments.m2 > 0 && beyond_doubles(moments, "").empty();
}

using reports::Estimate;
using reports::Number;

const char* bias_name(std::optional<BiasClass> bias) {
  constexpr const char* names[] = {"unbiased", "O(1/M)", "O(1/bootstrap)", "start-up",
                                   "reconstruction"};
  return bias ? names[static_cast<int>(*bias)] : "unknown";
}

/// The draws of an estimator itself for a test.
struct Draw {
  std::shared_ptr<Pool> pool;
  std::uint64_t secondaries = 0;
};

/// The draw of the test that drew most; nullopt if none did.
std::optional<Draw> most_drawn(const PreparedEstimator& estimator, const SuiteRun& run) {
  std::optional<Draw> most;
  for (const TestWork& work : run.tests) {
    for (std::size_t i = 0; i < work.pools.size(); ++i) {
      const Subject& side = work.outcome.question.subjects[i];
      const bool its = side.estimator == &estimator && side.purpose.empty() &&
                       work.pools[i]->setup() == estimator.setup;
      const std::uint64_t secondaries = work.outcome.secondaries(i);
      if (its && (!most || most->secondaries < secondaries)) most = {work.pools[i], secondaries};
    }
  }
  return most;
}

Estimate mean_of(const stats::Moments& moments, double confidence) {
  if (moments.count == 0) return {};
  if (moments.m2 == 0) return {number(moments.mean), number(moments.mean), number(moments.mean)};
  if (!has_spread(moments)) return {number(moments.mean), {}, {}};  // too few for an interval
  const stats::Interval interval = stats::student_t_interval(moments, {.value = 0}, confidence);
  return {number(moments.mean), number(interval.low), number(interval.high)};
}

Estimate variance_of(const stats::Moments& moments, double primaries, double confidence) {
  if (moments.count < 2) return {};
  if (moments.m2 == 0) return {0.0, 0.0, 0.0};
  if (!has_spread(moments)) return {number(primaries * moments.variance()), {}, {}};
  const stats::Influence influence = stats::influence_of_variance(moments);
  const stats::Interval log = interval_by_inversion(
      [&](double theta) { return stats::influence_t(influence, theta); },
      {.estimate = influence.log_value, .step = influence.relative.standard_error()}, confidence);
  return {number(primaries * moments.variance()), number(primaries * std::exp(log.low)),
          number(primaries * std::exp(log.high))};
}

/// Moments of fewer independent values with the same mean and variance.
stats::Moments of_fewer(stats::Moments x, double factor) {
  const double before = static_cast<double>(x.count);
  const double after = std::max(4.0, std::round(before / factor));
  x.count = static_cast<std::uint64_t>(after);
  x.m2 *= (after - 1) / (before - 1);
  x.m3 *= after / before;
  x.m4 *= after / before;
  return x;
}

/// The first `count` rows of one channel; empty if they are not kept.
std::span<const double> rows_of(const PreparedEstimator& estimator, const SuiteRun& run,
                                std::size_t channel, std::uint64_t count) {
  const Pilot* const pilot = run.pilots.find(estimator.name);
  if (!estimator.setup->observations() || pilot == nullptr || channel >= pilot->values.size() ||
      count > pilot->values[channel].size()) {
    return {};
  }
  return std::span(pilot->values[channel]).first(count);
}

/// Moments, which for dependent rows count only as many as independent ones would be worth.
stats::Moments moments_of(const PreparedEstimator& estimator, const SuiteRun& run,
                          const Drawn& drawn, std::size_t channel) {
  const stats::Moments& moments = drawn.summary().channels[channel].moments;
  const std::span<const double> rows = rows_of(estimator, run, channel, drawn.summary().count);
  const bool all = moments.count == rows.size();  // the others are not finite
  if (!has_spread(moments) || !all || rows.size() < fewest_in_order) return moments;
  const double factor = stats::allowance_for_dependence(rows);
  return factor > 1 ? of_fewer(moments, factor) : moments;
}

reports::EstimatorSummary summarise(const PreparedEstimator& estimator, const SuiteRun& run) {
  const double confidence = 1 - run.suite.alpha;
  const Information& information = estimator.entry->information;
  const Nature nature = estimator.nature();
  reports::EstimatorSummary row{
      .name = estimator.name,
      .plugin = information.name,
      .parameters = estimator.parameters,
      // Nothing is known of rows made elsewhere.
      .bias = estimator.setup->observations() ? "unknown" : bias_name(nature.bias),
      .original = information.original,
      .defect = information.defect,
      .confidence = confidence,
      .variance_of = nature.averages ? "primary" : "secondary"};
  const std::optional<Draw> draw = most_drawn(estimator, run);
  if (!draw) return row;
  row.primaries = draw->pool->primaries();
  row.secondaries = draw->secondaries;
  const Sample sample = draw->pool->sample(draw->secondaries);
  const Drawn* const drawn = sample.drawn();
  if (drawn == nullptr) return row;
  const Summary& summary = drawn->summary();
  row.cost = cost_of(summary);
  const double averaged = nature.averages ? static_cast<double>(row.primaries) : 1;
  if (estimator.setup->image()) {
    row.channels.push_back(
        image_channel(*estimator.setup, summary, {.averaged = averaged, .confidence = confidence}));
    return row;
  }
  const std::vector<Channel> channels = estimator.setup->channels();
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (channels[i].diagnostic) continue;
    const stats::Moments moments = moments_of(estimator, run, *drawn, i);
    reports::EstimatorChannel channel{.name = channels[i].name,
                                      .mean = mean_of(moments, confidence),
                                      .variance = variance_of(moments, averaged, confidence)};
    if (channels[i].mean) channel.reference = *channels[i].mean;
    if (channels[i].variance) channel.reference_variance = *channels[i].variance;
    row.channels.push_back(channel);
  }
  return row;
}

}  // namespace

reports::Cost cost_of(const Summary& summary) {
  return {.camera_rays = summary.cost.camera_rays,
          .closest_hit_rays = summary.cost.closest_hit_rays,
          .shadow_rays = summary.cost.shadow_rays,
          .samples = summary.cost.samples,
          .seconds = summary.seconds};
}

void add_estimators(const SuiteRun& run, reports::Suite& suite) {
  for (const PreparedEstimator* each : run.used) suite.estimators.push_back(summarise(*each, run));
}

}  // namespace assay::harness
