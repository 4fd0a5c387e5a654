#include "harness/observation_faults.h"

#include <fmt/format.h>

#include <cmath>

#include "estimators/ready_made.h"
#include "harness/consistency_setup.h"
#include "harness/pool.h"
#include "harness/shell.h"

namespace assay::harness {
namespace {

/// How to look at one observation again.
std::string replay_line(const TestOutcome& outcome, std::uint64_t observation) {
  return fmt::format(
      "`assay replay RUN.json {} {}` draws it again, where `--report json=RUN.json` saved the run",
      shell_quoted(outcome.question.test->id), observation);
}

std::string not_finite(const TestOutcome& outcome, const Subject& side, const Pool& pool,
                       std::size_t channel, const ChannelSummary& summary) {
  const auto at = side.image ? " at pixel " + element_name(*side.setup->image(), channel) : "";
  const std::string text = fmt::format(
      "{} of {} observations of `{}`{} are not finite, the first is observation {}",
      summary.nonfinite, outcome.secondaries(), side.estimator->name, at, summary.first_nonfinite);
  const auto place = recorded::observation_place(
      *side.setup,
      {.index = summary.first_nonfinite, .key = pool.key(), .primaries = pool.primaries()});
  if (!place.empty()) return text + ", `" + place + "`";
  return text + "; " + replay_line(outcome, summary.first_nonfinite);
}

/// A declared range chooses methods, and one of them rests on it. A sum may be rounded beyond it.
std::string outside_of_range(const Subject& side, const Summary& drawn) {
  // A mutant declares what its original does.
  const bool mutant = !side.estimator->entry->information.original.empty();
  if (mutant || side.image || side.setup->observations()) return "";
  const std::vector<Channel> channels = side.setup->channels();
  const auto finite = [](double end) { return std::isfinite(end) ? std::abs(end) : 0; };
  for (const std::size_t i : side.channels) {
    const Channel& channel = channels[i];
    const double slack = 1e-9 * (finite(channel.low) + finite(channel.high));
    const stats::Moments& seen = drawn.channels[i].moments;
    if (seen.count == 0) continue;
    const bool above = seen.maximum > channel.high + slack;
    if (!above && !(seen.minimum < channel.low - slack)) continue;
    return fmt::format(
        "`{}` gave {:.17g} in its channel `{}`, {} {:.17g}, which it declares to be "
        "its `{}`",
        side.estimator->name, above ? seen.maximum : seen.minimum, channel.name,
        above ? "above" : "below", above ? channel.high : channel.low, above ? "high" : "low");
  }
  return "";
}

}  // namespace

std::string undrawable(const TestWork& work) {
  const TestOutcome& outcome = work.outcome;
  if (!outcome.plan.error.empty()) return lack_of_density(outcome, outcome.plan.error);
  for (std::size_t subject = 0; subject < work.pools.size(); ++subject) {
    const Subject& side = outcome.question.subjects[subject];
    const Pool& pool = *work.pools[subject];
    if (!pool.has(outcome.secondaries())) {
      return fmt::format("`{}` stopped at {}", side.estimator->name, pool.trouble());
    }
    const Summary& drawn = pool.prefix(outcome.secondaries());
    if (drawn.elements) continue;  // all of them are finite
    for (const std::size_t channel : side.channels) {
      const ChannelSummary& summary = drawn.channels[channel];
      if (summary.nonfinite > 0) return not_finite(outcome, side, pool, channel, summary);
    }
    if (std::string fault = outside_of_range(side, drawn); !fault.empty()) return fault;
  }
  return "";
}

std::string lack_of_density(const TestOutcome& outcome, const std::string& why) {
  return fmt::format("the density that `{}` declares cannot be had: {}",
                     outcome.question.subjects[0].estimator->name, why);
}

std::string first_contradiction(const TestWork& work) {
  const TestOutcome& outcome = work.outcome;
  if (outcome.question.kind != QuestionKind::inconsistency ||
      outcome.verdict != reports::Verdict::fail) {
    return "";
  }
  std::optional<std::uint64_t> first;
  try {
    first = first_inconsistent(*work.pools[0], outcome.secondaries());
  } catch (const std::runtime_error&) {
    // Found again by drawing again: a program that ends meanwhile takes no verdict with it.
  }
  if (!first) return "";
  return fmt::format("; the first is observation {}: {}", *first, replay_line(outcome, *first));
}

}  // namespace assay::harness
