#include "harness/observation_faults.h"

#include <fmt/format.h>

#include "estimators/ready_made.h"
#include "harness/consistency_setup.h"
#include "harness/declared_range.h"
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

}  // namespace

std::string undrawable(const TestWork& work) {
  const TestOutcome& outcome = work.outcome;
  if (!outcome.plan.error.empty()) return outcome.plan.error;
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
