#include "harness/run/assumptions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/families/evidence_ratio.h"
#include "harness/families/evidence_slope.h"
#include "harness/families/lost_to_rounding.h"
#include "harness/families/methods.h"
#include "harness/plan/rows.h"
#include "harness/theta/constant.h"
#include "harness/theta/critical.h"
#include "harness/theta/gate.h"
#include "stats/means/skewness_corrected_t.h"

namespace assay::harness {
namespace {

std::string variance_without_spread(const Question& question, std::size_t channel,
                                    std::span<const ChannelData> data) {
  for (std::size_t subject = 0; subject < question.compared(); ++subject) {
    if (is_constant(question, subject, channel, data[subject].moments)) {
      return fmt::format(
          "every observation of `{}` is {:.10g} but for rounding: a sample without spread says "
          "nothing of a variance, and a rare value may be unseen; take more observations{}",
          question.subjects[subject].estimator->name, data[subject].moments.mean,
          question.of_two() ? ", or compare the other with a number" : "");
    }
  }
  return "";
}

// A shift of a tenth of a standard error raises a tail of one per cent by a third.
constexpr double tolerated_shift = 0.1;

/// Why two means cannot be compared if one is constant and its unseen values could decide; "" if
/// they can.
std::string unseen_could_decide(const TestOutcome& outcome, std::size_t channel,
                                std::span<const ChannelData> data) {
  const Question& question = outcome.question;
  for (std::size_t subject = 0; subject < data.size() && question.of_two(); ++subject) {
    const ChannelData& mine = data[subject];
    const ChannelData& other = data[1 - subject];
    if (!is_constant(question, subject, channel, mine.moments)) continue;
    // The second mean enters times the factor.
    const double factor = std::abs(question.factor);
    const double shift = (subject == 1 ? factor : 1) *
                         unseen_shift(question, subject, channel, mine, outcome.share().alpha);
    const double error = (subject == 0 ? factor : 1) * other.moments.standard_error();
    if (shift <= tolerated_shift * error) continue;
    return fmt::format(
        "every observation of `{}` is {:.10g}, and values never seen could move its mean by {:.3g} "
        "where the comparison's standard error is {:.3g}; {}",
        question.subjects[subject].estimator->name, mine.moments.mean, shift, error,
        std::isfinite(shift) ? "take more observations"
                             : "declare the range, or take more observations");
  }
  return "";
}

stats::Gate skewness_gate(const Question& question, std::span<const ChannelData> data, double x) {
  if (data.size() == 1) return stats::skewness_gate(data[0].moments, x);
  return stats::skewness_gate(data[0].moments, data[1].moments, question.factor, x);
}

stats::Gate residual_gate(const Question& question, std::size_t channel,
                          std::span<const ChannelData> data, double x) {
  if (data.size() == 2) {
    return stats::residual_skewness_gate(data[0].moments, data[1].moments, question.factor, x);
  }
  const Constant& reference = question.references[channel];
  return stats::residual_skewness_gate(
      data[0].moments, {reference.value + question.offset, reference.standard_error}, x);
}

/// Gates for tests by the logarithm of a mean: of counted costs, or of groups' variances.
std::vector<Gate> log_mean_gates(const Question& question, std::span<const ChannelData> data,
                                 double x) {
  const bool variances = question.kind == QuestionKind::total_variance;
  std::vector<Gate> gates;
  for (std::size_t subject = 0; subject < question.compared(); ++subject) {
    const stats::Moments& values = variances ? data[subject].group_variances
                                             : by_its_cost(question, data[subject].with_cost).cost;
    if (!(values.m2 > 0 && values.mean > 0)) continue;
    gates.push_back(gate_of(stats::log_mean_gate(values, x, variances ? "variance" : "cost"),
                            " of " + question.subjects[subject].estimator->name));
  }
  return gates;
}

/// The level at which the verdict rejects theta: a pass beyond its margin, a fail elsewhere.
double largest_level(const ErrorShare& share, const Regions& regions) {
  return regions.has_forbidden() ? std::max(share.alpha, share.beta) : share.alpha;
}

}  // namespace

std::vector<Gate> data_gates(const TestOutcome& outcome, std::size_t channel,
                             std::span<const ChannelData> data) {
  std::vector<Gate> gates;
  const Question& question = outcome.question;
  const MethodTraits& method = outcome.plan.method.is;
  const bool several = question.channel_count() > 1;
  const std::string name = several ? ", " + question.channel_name(channel) : "";
  const double x = critical_value(outcome.share().alpha, two_sided(question));
  const bool by_t = question.of_means() && !method.exact && !method.of_batches;
  for (const stats::Gate& gate : row_gates(outcome, data, x)) gates.push_back(gate_of(gate, name));
  if (by_t) {
    gates.push_back(gate_of(method.corrects_skewness ? residual_gate(question, channel, data, x)
                                                     : skewness_gate(question, data, x),
                            name));
  }
  for (std::size_t subject = 0; subject < data.size(); ++subject) {
    if (!(data[subject].moments.m2 > 0)) continue;
    const std::string whose = name + " of " + question.subjects[subject].estimator->name;
    // Two values cannot show an outlier, and three no kurtosis.
    const std::uint64_t count = data[subject].moments.count;
    if (by_t && count > 2) {
      gates.push_back(gate_of(stats::dominance_gate(data[subject].moments), whose));
    }
    if (method.of_normal_values && count > 3) {
      gates.push_back(gate_of(stats::kurtosis_gate(data[subject].moments), whose));
    }
  }
  // Channels share their costs.
  const Keeps keeps = outcome.plan.method.keeps;
  if ((keeps == Keeps::costs || keeps == Keeps::group_variances) && channel == 0) {
    for (const Gate& gate : log_mean_gates(question, data, x)) gates.push_back(gate);
  }
  if (question.kind == QuestionKind::slope) {
    gates.push_back(power_law_gate(question, channel, data,
                                   largest_level(outcome.share(), outcome.plan.regions[channel])));
  }
  return gates;
}

std::string lack_of_spread(const TestOutcome& outcome, std::size_t channel,
                           std::span<const ChannelData> data) {
  const QuestionKind kind = outcome.question.kind;
  if (outcome.question.of_variances() || kind == QuestionKind::efficiency) {
    std::string reason = variance_without_spread(outcome.question, channel, data);
    for (std::size_t i = 0; i < outcome.question.compared() && reason.empty(); ++i) {
      reason = variances_lost_to_rounding(outcome.question.subjects[i], data[i].primaries,
                                          {&data[i].moments, 1});
    }
    return reason;
  }
  if (kind == QuestionKind::slope) return point_without_spread(outcome.question, channel, data);
  if (!outcome.question.of_means()) return "";
  std::string reason =
      outcome.plan.method.is.exact ? "" : lost_to_rounding(outcome.question, channel, data);
  return reason.empty() ? unseen_could_decide(outcome, channel, data) : reason;
}

}  // namespace assay::harness
