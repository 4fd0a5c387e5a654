#include "harness/picture.h"

#include <cmath>
#include <set>

#include "harness/image_record.h"
#include "stats/holm.h"
#include "stats/log_variance.h"
#include "stats/student_t.h"
#include "stats/welch_t.h"

namespace assay::harness {
namespace {

using reports::Estimate;
using reports::Number;

// More pairs than this are no picture any more.
constexpr std::size_t most_estimators = 40;

Number number(double value) { return std::isfinite(value) ? Number(value) : Number(); }

const char* bias_name(std::optional<BiasClass> bias) {
  if (!bias) return "unknown";
  switch (*bias) {
    case BiasClass::unbiased:
      return "unbiased";
    case BiasClass::inverse_primaries:
      return "O(1/M)";
    case BiasClass::inverse_bootstrap:
      return "O(1/bootstrap)";
    case BiasClass::start_up:
      return "start-up";
    case BiasClass::reconstruction:
      break;
  }
  return "reconstruction";
}

const Summary& summary_of(const Picture& picture) {
  return picture.pool->prefix(picture.pool->largest_prefix());
}

double per_primary(const Picture& picture) {
  return picture.estimator->nature().averages ? static_cast<double>(picture.pool->primaries()) : 1;
}

bool has_spread(const stats::Moments& moments) { return moments.count > 3 && moments.m2 > 0; }

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
  const stats::Interval log = stats::log_variance_interval(moments, 1, confidence);
  return {number(primaries * moments.variance()), number(primaries * std::exp(log.low)),
          number(primaries * std::exp(log.high))};
}

reports::EstimatorSummary summarise(const Picture& picture, double confidence) {
  const Information& information = picture.estimator->entry->information;
  const Nature nature = picture.estimator->nature();
  reports::EstimatorSummary row{
      .name = picture.estimator->name,
      .plugin = information.name,
      .parameters = picture.estimator->parameters,
      // Of rows that were made elsewhere nothing is known.
      .bias = picture.estimator->setup->observations() ? "unknown" : bias_name(nature.bias),
      .original = information.original,
      .defect = information.defect,
      .primaries = picture.pool->primaries(),
      .secondaries = picture.pool->largest_prefix(),
      .confidence = confidence,
      .variance_of = nature.averages ? "primary" : "secondary"};
  if (!picture.pool->trouble().empty()) return row;
  const Summary& summary = summary_of(picture);
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
    const stats::Moments& moments = summary.channels[i].moments;
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

using Pair = std::pair<std::string, std::string>;

std::set<Pair> compared_by_claims(const SuiteRun& run) {
  std::set<Pair> pairs;
  for (const TestWork& work : run.tests) {
    const std::vector<Subject>& subjects = work.outcome.question.subjects;
    if (subjects.size() == 2) {
      pairs.insert(std::minmax(subjects[0].estimator->name, subjects[1].estimator->name));
    }
  }
  return pairs;
}

/// Estimators of one quantity, as far as can be told.
bool comparable(const Picture& first, const Picture& second, const std::set<Pair>& claimed) {
  if (claimed.contains(std::minmax(first.estimator->name, second.estimator->name))) return true;
  const std::vector<Channel> mine = first.pool->setup()->channels();
  const std::vector<Channel> theirs = second.pool->setup()->channels();
  if (mine.size() != theirs.size()) return false;
  for (std::size_t i = 0; i < mine.size(); ++i) {
    if (mine[i].name != theirs[i].name || !mine[i].mean || !theirs[i].mean) return false;
    // Closed forms of one number reached in two ways differ in their last digits.
    const double scale = std::max(std::abs(*mine[i].mean), std::abs(*theirs[i].mean));
    if (std::abs(*mine[i].mean - *theirs[i].mean) > 1e-9 * scale) return false;
  }
  return true;
}

struct ComparedPair {
  reports::Comparison row;
  double log_mean_p = 0;
  double log_variance_p = 0;
};

ComparedPair compare(const Picture& first, const Picture& second, std::size_t channel) {
  const stats::Moments& x = summary_of(first).channels[channel].moments;
  const stats::Moments& y = summary_of(second).channels[channel].moments;
  ComparedPair pair{.row = {.first = first.estimator->name,
                            .second = second.estimator->name,
                            .channel = first.pool->setup()->channels()[channel].name}};
  if (!has_spread(x) || !has_spread(y)) return pair;
  const double null = per_primary(second) / per_primary(first);
  pair.log_mean_p = stats::log_p_two_sided(stats::welch_t(x, y, {}));
  pair.log_variance_p = stats::log_p_two_sided(stats::log_variance_ratio(x, y, null));
  pair.row.mean_p = std::exp(pair.log_mean_p);
  pair.row.variance_p = std::exp(pair.log_variance_p);
  pair.row.log10_mean_p = pair.log_mean_p / std::log(10.0);
  pair.row.log10_variance_p = pair.log_variance_p / std::log(10.0);
  pair.row.variance_ratio = number(x.variance() / y.variance() / null);
  return pair;
}

/// Holm over all means and all variances compared.
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

bool drawn(const Picture& picture) { return picture.pool->trouble().empty(); }

/// Images are compared by claims, not pixel by pixel.
bool is_image(const Picture& picture) { return picture.pool->setup()->image().has_value(); }

}  // namespace

reports::Cost cost_of(const Summary& summary) {
  return {.camera_rays = summary.cost.camera_rays,
          .closest_hit_rays = summary.cost.closest_hit_rays,
          .shadow_rays = summary.cost.shadow_rays,
          .samples = summary.cost.samples,
          .seconds = summary.seconds};
}

void add_pictures(const SuiteRun& run, reports::Suite& suite) {
  for (const Picture& picture : run.pictures) {
    suite.estimators.push_back(summarise(picture, 1 - run.suite.alpha));
  }
  if (run.pictures.size() > most_estimators) return;
  const std::set<Pair> claimed = compared_by_claims(run);
  std::vector<ComparedPair> pairs;
  for (std::size_t i = 0; i < run.pictures.size(); ++i) {
    for (std::size_t j = i + 1; j < run.pictures.size(); ++j) {
      const Picture& first = run.pictures[i];
      const Picture& second = run.pictures[j];
      if (is_image(first) || is_image(second)) continue;
      if (!drawn(first) || !drawn(second) || !comparable(first, second, claimed)) continue;
      const std::size_t channels =
          std::min(first.pool->setup()->channels().size(), second.pool->setup()->channels().size());
      for (std::size_t c = 0; c < channels; ++c) pairs.push_back(compare(first, second, c));
    }
  }
  if (pairs.empty()) return;
  mark_differences(pairs, run.suite.alpha);
  for (ComparedPair& pair : pairs) suite.comparisons.push_back(std::move(pair.row));
}

}  // namespace assay::harness
