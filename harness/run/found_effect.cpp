#include "harness/run/found_effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/base/numbers.h"
#include "harness/plan/sizes.h"
#include "harness/run/image_judge.h"
#include "harness/theta/theta.h"

namespace assay::harness {
namespace {

using reports::Verdict;

/// The size for which detectable effect and power are quoted: the last look, or where a budget
/// ended.
TestSize full_size(const TestOutcome& outcome) {
  const stats::LookSchedule& looks = outcome.plan.looks;
  const bool ended = outcome.verdict == Verdict::inconclusive;
  const std::size_t look = ended ? outcome.look : looks.sizes.size() - 1;
  return {.share = outcome.share_at(look), .secondaries = looks.sizes[look]};
}

/// Error of the interval whose ends decide: two tests at beta, or one or two tails at alpha.
double deciding_error(const TestOutcome& outcome, const ChannelOutcome& channel,
                      const ErrorShare& share) {
  if (outcome.verdict != Verdict::fail && channel.regions.has_forbidden()) return 2 * share.beta;
  const bool two_tails = channel.regions.two_sided() && !channel.evidence.distance;
  return (two_tails ? 1 : 2) * share.alpha;
}

/// With a factor the effect is relative to factor * second.
std::string quantity_of(const Evidence& evidence, double factor) {
  std::string quantity = evidence.quantity;
  if (factor != 1) {
    quantity += fmt::format(" {} {:g} times the second",
                            quantity.starts_with("ratio") ? "to" : "from", factor);
  }
  return evidence.ratio ? "ln(" + quantity + ")" : quantity;
}

/// The effect with the interval behind the verdict. Its ends are at this look's levels, so it holds
/// theta with the confidence shown wherever sampling stops (repeated confidence interval). A fail
/// shows the interval at alpha, which misses the claimed region. A pass that excludes the forbidden
/// region shows the interval at 1 - 2 beta: one test at beta to each side. An undecided test shows
/// that interval too.
reports::Effect effect_of(const TestOutcome& outcome, const ChannelOutcome& channel) {
  const Evidence& evidence = channel.evidence;
  // A smaller error is lost in 1 - error. A narrower interval shows the same verdict.
  constexpr double least_error = 1e-12;
  const double error = std::max(deciding_error(outcome, channel, outcome.share()), least_error);
  const stats::Interval interval = evidence.interval(1 - error);
  const auto number = [](double value) {
    return std::isfinite(value) ? reports::Number(value) : reports::Number();
  };
  return {.quantity = quantity_of(evidence, outcome.question.factor),
          .estimate = number(evidence.estimate),
          .low = number(interval.low),
          .high = number(interval.high),
          .confidence = 1 - deciding_error(outcome, channel, outcome.place.share),
          .relative = evidence.relative};
}

}  // namespace

void note_sizes(TestOutcome& outcome, const DrawnTest& test) {
  for (ChannelOutcome& channel : outcome.channels) {
    channel.effect = effect_of(outcome, channel);
    if (channel.image) {
      channel.detectable = detectable_uniformly(outcome, full_size(outcome), channel);
      continue;
    }
    const std::vector<ChannelData> data = data_of(test, channel.index);
    PlannedChannel observed =
        outcome.question.theta->observed(outcome.question, channel.regions, channel.index, data);
    if (outcome.plan.method.is.of_batches) {
      // The deviations of independent values whose means are as uncertain.
      const auto deviation = [&](std::size_t subject) {
        return std::sqrt(static_cast<double>(outcome.secondaries(subject))) *
               data[subject].moments.standard_error();
      };
      observed.standard_deviation = deviation(0);
      if (outcome.question.of_two()) {
        observed.other_deviation = std::abs(outcome.question.factor) * deviation(1);
      }
    }
    channel.detectable =
        detectable_effect(outcome.question, full_size(outcome), outcome.plan, observed);
    channel.finds_nothing =
        !channel.detectable && outcome.question.theta->finds_nothing(
                                   outcome.question, full_size(outcome), outcome.plan, observed);
    const bool equivalence = channel.regions.relation == Relation::within;
    if (!equivalence && !channel.regions.detect) continue;
    const std::optional<double> power =
        outcome.question.theta->power(outcome.question, full_size(outcome), outcome.plan, observed,
                                      equivalence ? 0 : *channel.regions.detect);
    if (power) outcome.power = std::min(*power, outcome.power.value_or(1));
  }
}

}  // namespace assay::harness
