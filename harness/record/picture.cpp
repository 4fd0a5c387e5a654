#include "harness/record/picture.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "harness/base/numbers.h"
#include "harness/plan/independence.h"
#include "harness/record/maps.h"
#include "harness/sampling/summary.h"
#include "harness/theta/evidence.h"
#include "stats/gates/independence_gates.h"
#include "stats/means/student_t.h"
#include "stats/planning/holm.h"
#include "stats/variances/influence.h"

namespace assay::harness {
namespace {

/// Moments of stats as those of a record, or back: both have the same members in one order.
template <class To>
To in_order(const auto& moments) {
  const auto& [count, mean, m2, m3, m4, least, most, nonzero, rest] = moments;
  return {count, mean, m2, m3, m4, least, most, nonzero, rest};
}

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

double per_primary(const Picture& picture) {
  return picture.estimator->nature().averages ? static_cast<double>(picture.pool->primaries()) : 1;
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
std::span<const double> rows_of(const Picture& picture, const SuiteRun& run, std::size_t channel,
                                std::uint64_t count) {
  const Pilot* const pilot = run.pilots.find(picture.estimator->name);
  if (!picture.pool->setup()->observations() || pilot == nullptr ||
      channel >= pilot->values.size() || count > pilot->values[channel].size()) {
    return {};
  }
  return std::span(pilot->values[channel]).first(count);
}

/// Moments, which for dependent rows count only as many as independent ones would be worth.
stats::Moments moments_of(const Picture& picture, const SuiteRun& run, const Drawn& drawn,
                          std::size_t channel) {
  const stats::Moments& moments = drawn.summary().channels[channel].moments;
  const std::span<const double> rows = rows_of(picture, run, channel, drawn.summary().count);
  const bool all = moments.count == rows.size();  // the others are not finite
  if (!has_spread(moments) || !all || rows.size() < fewest_in_order) return moments;
  const double factor = stats::allowance_for_dependence(rows);
  return factor > 1 ? of_fewer(moments, factor) : moments;
}

reports::EstimatorSummary summarise(const Picture& picture, const SuiteRun& run) {
  const std::uint64_t count = shown_by(picture, run);
  const double confidence = 1 - run.suite.alpha;
  const Information& information = picture.estimator->entry->information;
  const Nature nature = picture.estimator->nature();
  reports::EstimatorSummary row{
      .name = picture.estimator->name,
      .plugin = information.name,
      .parameters = picture.estimator->parameters,
      // Nothing is known of rows made elsewhere.
      .bias = picture.estimator->setup->observations() ? "unknown" : bias_name(nature.bias),
      .original = information.original,
      .defect = information.defect,
      .stream = stream_text(picture.pool->key()),
      .primaries = picture.pool->primaries(),
      .secondaries = count,
      .confidence = confidence,
      .variance_of = nature.averages ? "primary" : "secondary"};
  const Sample sample = picture.pool->sample(count);
  const Drawn* const drawn = sample.drawn();
  if (drawn == nullptr) return row;
  const Summary& summary = drawn->summary();
  row.cost = cost_of(summary);
  if (picture.pool->setup()->image()) {
    row.channels.push_back(
        image_channel(*picture.pool->setup(), summary,
                      {.averaged = per_primary(picture), .confidence = confidence}));
    return row;
  }
  const std::vector<Channel> channels = picture.pool->setup()->channels();
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (channels[i].diagnostic) continue;
    const stats::Moments moments = moments_of(picture, run, *drawn, i);
    reports::EstimatorChannel channel{
        .name = channels[i].name,
        .mean = mean_of(moments, confidence),
        .variance = variance_of(moments, per_primary(picture), confidence)};
    if (channels[i].mean) channel.reference = *channels[i].mean;
    if (channels[i].variance) channel.reference_variance = *channels[i].variance;
    row.channels.push_back(channel);
  }
  return row;
}

// More pairs would not be readable.
constexpr std::size_t most_estimators = 40;

using Pair = std::pair<std::string, std::string>;

std::set<Pair> pairs_of(const std::vector<std::vector<std::string>>& claimed) {
  std::set<Pair> pairs;
  for (const std::vector<std::string>& names : claimed) {
    if (names.size() == 2) pairs.insert(std::minmax(names[0], names[1]));
  }
  return pairs;
}

/// True if both estimate one quantity, as far as known.
bool comparable(const Pictured& first, const Pictured& second, const std::set<Pair>& claimed) {
  const auto untold = [](const Pictured& each) { return each.shown.image || !each.shown.drawn; };
  if (untold(first) || untold(second)) return false;
  if (claimed.contains(std::minmax(first.name, second.name))) return true;
  const std::vector<reports::ShardChannel>& mine = first.shown.channels;
  const std::vector<reports::ShardChannel>& theirs = second.shown.channels;
  if (mine.size() != theirs.size()) return false;
  for (std::size_t i = 0; i < mine.size(); ++i) {
    if (mine[i].name != theirs[i].name || !mine[i].reference || !theirs[i].reference) return false;
    // Two closed forms of one number may differ by rounding.
    const double scale = std::max(std::abs(*mine[i].reference), std::abs(*theirs[i].reference));
    if (std::abs(*mine[i].reference - *theirs[i].reference) > 1e-9 * scale) return false;
  }
  return true;
}

struct ComparedPair {
  reports::Comparison row;
  double log_mean_p = 0;
  double log_variance_p = 0;
};

ComparedPair compare(const Pictured& first, const Pictured& second, std::size_t channel) {
  const auto x = in_order<stats::Moments>(first.shown.channels[channel].moments);
  const auto y = in_order<stats::Moments>(second.shown.channels[channel].moments);
  ComparedPair pair{.row = {.first = first.name,
                            .second = second.name,
                            .channel = first.shown.channels[channel].name}};
  if (!has_spread(x) || !has_spread(y)) return pair;
  const double null = second.shown.averaged / first.shown.averaged;
  pair.log_mean_p = stats::log_p_two_sided(stats::welch_t(x, y, {}));
  pair.row.mean_p = std::exp(pair.log_mean_p);
  pair.row.log10_mean_p = pair.log_mean_p / std::log(10.0);
  // The variance of a primary and that of a secondary are two quantities.
  if (first.averages != second.averages) return pair;
  pair.log_variance_p = stats::log_p_two_sided(stats::influence_t(
      stats::influence_of_variance(x), stats::influence_of_variance(y), std::log(null)));
  pair.row.variance_p = std::exp(pair.log_variance_p);
  pair.row.log10_variance_p = pair.log_variance_p / std::log(10.0);
  const double ratio = x.variance() / y.variance() / null;
  if (std::isfinite(ratio)) pair.row.variance_ratio = ratio;
  return pair;
}

void mark_differences(std::vector<ComparedPair>& pairs, double alpha) {
  std::vector<double> log_p;
  for (const ComparedPair& pair : pairs) {
    log_p.push_back(pair.log_mean_p);
    log_p.push_back(pair.log_variance_p);
  }
  const std::vector<double> adjusted = stats::holm(log_p);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].row.means_differ = adjusted[2 * i] <= std::log(alpha);
    pairs[i].row.variances_differ = adjusted[2 * i + 1] <= std::log(alpha);
  }
}

}  // namespace

reports::Cost cost_of(const Summary& summary) {
  return {.camera_rays = summary.cost.camera_rays,
          .closest_hit_rays = summary.cost.closest_hit_rays,
          .shadow_rays = summary.cost.shadow_rays,
          .samples = summary.cost.samples,
          .seconds = summary.seconds};
}

Pictured pictured(const Picture& picture, const SuiteRun& run) {
  const std::uint64_t count = shown_by(picture, run);
  const Sample sample = picture.pool->sample(count);
  const Drawn* const drawn = sample.drawn();
  const std::string& name = picture.estimator->name;
  const auto entry = std::ranges::find(run.suite.estimators, name, &EstimatorEntry::name);
  Pictured result{
      .name = name,
      .averages = picture.estimator->nature().averages,
      .shown = {.position = static_cast<std::uint64_t>(entry - run.suite.estimators.begin()),
                .by_tests = !picture.own,
                .secondaries = count,
                .drawn = drawn != nullptr,
                .averaged = per_primary(picture),
                .image = picture.pool->setup()->image().has_value()}};
  if (result.shown.image || drawn == nullptr) return result;
  const std::vector<Channel> channels = picture.pool->setup()->channels();
  for (std::size_t i = 0; i < channels.size(); ++i) {
    result.shown.channels.push_back(
        {channels[i].name, channels[i].mean,
         in_order<reports::Moments>(moments_of(picture, run, *drawn, i))});
  }
  return result;
}

std::vector<std::string> compared_by(const Question& question) {
  if (question.subjects.size() != 2) return {};
  return {question.subjects[0].estimator->name, question.subjects[1].estimator->name};
}

void add_pictures(const SuiteRun& run, reports::Suite& suite) {
  std::vector<Pictured> all;
  for (const Picture& picture : run.pictures) {
    suite.estimators.push_back(summarise(picture, run));
    all.push_back(pictured(picture, run));
  }
  std::vector<std::vector<std::string>> claimed;
  for (const TestWork& work : run.tests) claimed.push_back(compared_by(work.outcome.question));
  suite.comparisons = comparisons(all, claimed, run.suite.alpha);
}

std::vector<reports::Comparison> comparisons(const std::vector<Pictured>& estimators,
                                             const std::vector<std::vector<std::string>>& claimed,
                                             double alpha) {
  if (estimators.size() > most_estimators) return {};
  const std::set<Pair> together = pairs_of(claimed);
  std::vector<ComparedPair> pairs;
  for (std::size_t i = 0; i < estimators.size(); ++i) {
    for (std::size_t j = i + 1; j < estimators.size(); ++j) {
      const Pictured& first = estimators[i];
      const Pictured& second = estimators[j];
      if (!comparable(first, second, together)) continue;
      const std::size_t channels =
          std::min(first.shown.channels.size(), second.shown.channels.size());
      for (std::size_t c = 0; c < channels; ++c) pairs.push_back(compare(first, second, c));
    }
  }
  mark_differences(pairs, alpha);
  std::vector<reports::Comparison> rows;
  for (ComparedPair& pair : pairs) rows.push_back(std::move(pair.row));
  return rows;
}

}  // namespace assay::harness
