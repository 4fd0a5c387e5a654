#include "harness/run/observation_faults.h"

#include <fmt/format.h>

#include "estimators/core/quoting.h"
#include "estimators/ready_made.h"
#include "harness/draws/consistency_setup.h"
#include "harness/question/question_sources.h"
#include "harness/sampling/pool.h"

namespace assay::harness {
namespace {

/// The command that repeats one observation.
std::string replay_line(const TestOutcome& outcome, std::uint64_t observation) {
  return fmt::format(
      "`assay replay RUN.json {} {}` draws it again, where `--report json=RUN.json` saved the run",
      shell_quoted(outcome.question.test->id), observation);
}

std::string not_finite(const TestOutcome& outcome, const Subject& side, const Drawn& drawn,
                       std::size_t channel) {
  const ChannelSummary& summary = drawn.summary().channels[channel];
  const Pool& pool = drawn.pool();
  const auto at = side.image ? " at pixel " + element_name(*side.setup->image(), channel) : "";
  const std::string text = fmt::format(
      "{} of {} observations of `{}`{} are not finite, the first is observation {}",
      summary.nonfinite, drawn.summary().count, side.estimator->name, at, summary.first_nonfinite);
  const auto place = recorded::observation_place(
      *side.setup,
      {.index = summary.first_nonfinite, .key = pool.key(), .primaries = pool.primaries()});
  if (!place.empty()) return text + ", `" + place + "`";
  return text + "; " + replay_line(outcome, summary.first_nonfinite);
}

}  // namespace

std::string where_it_stopped(const TestWork& work) {
  const std::vector<Sample> samples = work.samples();
  for (std::size_t subject = 0; subject < samples.size(); ++subject) {
    if (const Fault* fault = samples[subject].fault()) {
      return sentence_of(*fault, work.outcome.question.subjects[subject].estimator->name);
    }
  }
  return "";
}

std::string unusable(const DrawnTest& test) {
  const TestOutcome& outcome = test.outcome;
  for (std::size_t subject = 0; subject < test.samples.size(); ++subject) {
    const Subject& side = outcome.question.subjects[subject];
    const Summary& drawn = test.samples[subject].summary();
    if (drawn.elements) continue;  // all finite
    for (const std::size_t channel : side.channels) {
      if (drawn.channels[channel].nonfinite == 0) continue;
      return not_finite(outcome, side, test.samples[subject], channel);
    }
    if (std::string fault = outside_of_range(side, drawn); !fault.empty()) return fault;
  }
  return "";
}

std::string first_contradiction(const DrawnTest& test) {
  const TestOutcome& outcome = test.outcome;
  if (outcome.verdict != reports::Verdict::fail) return "";
  std::optional<std::uint64_t> first;
  try {
    first = first_inconsistent(test.samples[0].pool(), outcome.secondaries());
  } catch (...) {
    // It is found by drawing again, which may fail: a program that ends meanwhile takes no verdict
    // with it.
  }
  if (!first) return "";
  return fmt::format("; the first is observation {}: {}", *first, replay_line(outcome, *first));
}

}  // namespace assay::harness
