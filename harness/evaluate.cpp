#include "harness/evaluate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/activation.h"
#include "harness/constant.h"
#include "harness/narrate.h"
#include "harness/plan.h"
#include "harness/sample_size.h"
#include "harness/sampler_setup.h"
#include "stats/assumption_gates.h"
#include "stats/holm.h"

namespace assay::harness {
namespace {

using reports::Verdict;

void settle(TestOutcome& outcome, Verdict verdict, std::string message) {
  outcome.verdict = verdict;
  outcome.message = std::move(message);
}

const Summary& summary_of(const TestWork& work, std::size_t subject) {
  return work.pools[subject]->prefix(work.outcome.plan.secondaries);
}

/// Whether the observations are all there and finite; the verdict is `error` where not.
bool could_be_drawn(TestWork& work) {
  for (std::size_t subject = 0; subject < work.pools.size(); ++subject) {
    const Subject& side = work.outcome.question.subjects[subject];
    const Pool& pool = *work.pools[subject];
    if (!pool.has(work.outcome.plan.secondaries)) {
      settle(work.outcome, Verdict::error,
             fmt::format("`{}` stopped at {}", side.estimator->name, pool.trouble()));
      return false;
    }
    for (const std::size_t channel : side.channels) {
      const ChannelSummary& summary = summary_of(work, subject).channels[channel];
      if (summary.nonfinite == 0) continue;
      settle(work.outcome, Verdict::error,
             fmt::format("{} of {} observations of `{}` are not finite, the first is observation "
                         "{}; `assay replay RUN.json '{}' {}` draws it again",
                         summary.nonfinite, work.outcome.plan.secondaries, side.estimator->name,
                         summary.first_nonfinite, work.outcome.question.test->id,
                         summary.first_nonfinite));
      return false;
    }
  }
  return true;
}

bool about_means(const Question& question) {
  return question.kind == QuestionKind::mean_of_one || question.kind == QuestionKind::mean_of_two;
}

bool about_variances(const Question& question) {
  return question.kind == QuestionKind::variance_of_one ||
         question.kind == QuestionKind::variance_of_two;
}

/// A density whose integral exceeds 1 is none, whatever its samples do.
bool density_is_proper(TestOutcome& outcome) {
  if (outcome.question.kind != QuestionKind::fit_to_density) return true;
  const auto& draws = dynamic_cast<const SamplerSetup&>(*outcome.question.subjects[0].setup);
  const stats::CellProbabilities& grid = draws.cells().grid;
  const double excess = grid.total - 1;
  if (excess <= std::max(1e-9, 2 * grid.total_error)) return true;
  settle(outcome, Verdict::fail,
         fmt::format("the declared density integrates to {:.6g} over its domain (quadrature error "
                     "{:.1g}): more than 1, so no sampler can follow it",
                     grid.total, grid.total_error));
  return false;
}

/// A reason why a variance cannot be tested: a sample without spread.
std::string lack_of_spread(const Question& question, std::size_t channel,
                           std::span<const ChannelData> data) {
  for (std::size_t subject = 0; subject < data.size(); ++subject) {
    if (is_constant(question, subject, channel, data[subject].moments)) {
      return fmt::format(
          "every observation of `{}` is {:.10g} but for rounding: a sample without spread says "
          "nothing of a variance, and a rare value may be unseen; take more observations",
          question.subjects[subject].estimator->name, data[subject].moments.mean);
    }
  }
  return "";
}

bool all_constant(const Question& question, std::size_t channel,
                  std::span<const ChannelData> data) {
  for (std::size_t subject = 0; subject < data.size(); ++subject) {
    if (!is_constant(question, subject, channel, data[subject].moments)) return false;
  }
  return true;
}

reports::Gate gate_of(const stats::Gate& gate, const std::string& where) {
  constexpr const char* states[] = {"green", "amber", "red"};
  return {.name = gate.name + where,
          .value = gate.value,
          .limit = gate.limit,
          .state = states[static_cast<int>(gate.state)]};
}

/// Gates on the test's own data; they can only invalidate.
std::vector<reports::Gate> data_gates(const TestOutcome& outcome, std::size_t channel,
                                      std::span<const ChannelData> data) {
  std::vector<reports::Gate> gates;
  const Question& question = outcome.question;
  const bool several = question.channel_count() > 1;
  const std::string name = several ? ", " + question.channel_name(channel) : "";
  const double x =
      critical_value(outcome.place.share.alpha, outcome.plan.regions[channel].two_sided());
  if (about_means(question)) {
    gates.push_back(
        gate_of(data.size() == 1
                    ? stats::skewness_gate(data[0].moments, x)
                    : stats::skewness_gate(data[0].moments, data[1].moments, question.factor, x),
                name));
  }
  for (std::size_t subject = 0; subject < data.size(); ++subject) {
    if (!(data[subject].moments.m2 > 0)) continue;
    const std::string whose = name + " of " + question.subjects[subject].estimator->name;
    if (about_means(question)) {
      gates.push_back(gate_of(stats::dominance_gate(data[subject].moments), whose));
    }
    if (outcome.plan.method.name == "F" || outcome.plan.method.name == "chi-square") {
      gates.push_back(gate_of(stats::kurtosis_gate(data[subject].moments), whose));
    }
  }
  return gates;
}

// A shift of a tenth of a standard error raises a tail of one per cent by a third.
constexpr double tolerated_shift = 0.1;

/// Why two means cannot be compared of which one is constant: what was never seen of it could
/// decide. "" where they can.
std::string unseen_could_decide(const TestOutcome& outcome, std::size_t channel,
                                std::span<const ChannelData> data) {
  const Question& question = outcome.question;
  for (std::size_t subject = 0; subject < data.size() && question.of_two(); ++subject) {
    const ChannelData& mine = data[subject];
    const ChannelData& other = data[1 - subject];
    if (!is_constant(question, subject, channel, mine.moments)) continue;
    // On the scale of the first mean: the second enters times the factor.
    const double factor = std::abs(question.factor);
    const double shift = (subject == 1 ? factor : 1) *
                         unseen_shift(question, subject, channel, mine, outcome.place.share.alpha);
    const double error = (subject == 0 ? factor : 1) * other.moments.standard_error();
    if (shift <= tolerated_shift * error) continue;
    return fmt::format(
        "every observation of `{}` is {:.10g}, and values never seen could move its mean by {:.3g} "
        "where the comparison's standard error is {:.3g}; declare the range, or take more "
        "observations",
        question.subjects[subject].estimator->name, mine.moments.mean, shift, error);
  }
  return "";
}

/// Ends of the effect's interval: at the level at which this channel is tested.
reports::Effect effect_of(const Evidence& evidence, const ErrorShare& share) {
  const double confidence = 1 - share.alpha;
  const stats::Interval interval = evidence.interval(confidence);
  const auto number = [](double value) {
    return std::isfinite(value) ? reports::Number(value) : reports::Number();
  };
  return {.quantity = evidence.ratio ? "ln(" + evidence.quantity + ")" : evidence.quantity,
          .estimate = number(evidence.estimate),
          .low = number(interval.low),
          .high = number(interval.high),
          .confidence = confidence,
          .relative = evidence.relative};
}

/// The least power over the channels: at `detect`; of `within`, of showing a theta of 0.
void note_power(TestOutcome& outcome, std::size_t channel, std::span<const ChannelData> data) {
  const Regions& regions = outcome.plan.regions[channel];
  const bool equivalence = regions.relation == Relation::within;
  if (!equivalence && !regions.detect) return;
  const std::optional<double> power = power_at(outcome.question, outcome.place.share, outcome.plan,
                                               observed_channel(outcome.question, channel, data),
                                               equivalence ? 0 : *regions.detect);
  if (power) outcome.plan.power = std::min(*power, outcome.plan.power.value_or(1));
}

ChannelOutcome channel_outcome(const TestOutcome& outcome, std::size_t channel,
                               std::span<const ChannelData> data) {
  const Question& question = outcome.question;
  const Regions& regions = outcome.plan.regions[channel];
  Evidence evidence = evidence_of(outcome.plan.method, question, channel, data);
  const stats::TestResult at_null = evidence.at(0);
  ChannelOutcome result{
      .name = question.channel_name(channel), .at_null = at_null, .evidence = std::move(evidence)};
  result.decision.log_p_claimed = log_p_claimed(result.evidence, regions);
  result.decision.log_p_forbidden = log_p_forbidden(result.evidence, regions);
  result.decision.rejected = result.decision.log_p_claimed <= std::log(outcome.place.share.alpha);
  result.effect = effect_of(result.evidence, outcome.place.share);
  result.detectable = detectable_effect(question, outcome.place.share, outcome.plan,
                                        observed_channel(question, channel, data));
  if (question.kind == QuestionKind::mean_of_one) {
    result.reference = question.references[channel].value;
  } else if (question.kind == QuestionKind::mean_of_two) {
    result.reference = question.factor * data[1].moments.mean;
  }
  return result;
}

/// Constant channels are judged by themselves; the test's verdict is the worst of theirs.
struct Settled {
  std::vector<ConstantVerdict> constants = {};
  bool stopped = false;
};

int badness(Verdict verdict) {
  switch (verdict) {
    case Verdict::error:
      return 4;
    case Verdict::fail:
      return 3;
    case Verdict::invalid:
      return 2;
    case Verdict::inconclusive:
      return 1;
    case Verdict::pass:
    case Verdict::skipped:
      break;
  }
  return 0;
}

void evaluate_channels(TestWork& work, Settled& settled) {
  TestOutcome& outcome = work.outcome;
  const Question& question = outcome.question;
  for (std::size_t channel = 0; channel < question.channel_count(); ++channel) {
    const std::vector<ChannelData> data = data_of(work, channel);
    if (about_means(question) && all_constant(question, channel, data)) {
      settled.constants.push_back(judge_constant(
          question, channel, data, outcome.plan.regions[channel], outcome.place.share));
      continue;
    }
    std::string reason;
    if (about_variances(question)) reason = lack_of_spread(question, channel, data);
    if (about_means(question)) reason = unseen_could_decide(outcome, channel, data);
    if (!reason.empty()) {
      settled.constants.push_back({Verdict::invalid, reason});
      continue;
    }
    for (reports::Gate& gate : data_gates(outcome, channel, data)) {
      outcome.plan.gates.push_back(std::move(gate));
    }
    outcome.channels.push_back(channel_outcome(outcome, channel, data));
    note_power(outcome, channel, data);
  }
  std::stable_sort(outcome.channels.begin(), outcome.channels.end(),
                   [](const ChannelOutcome& a, const ChannelOutcome& b) {
                     return a.decision.log_p_claimed < b.decision.log_p_claimed;
                   });
}

std::string red_gates(const Plan& plan) {
  std::string text;
  for (const reports::Gate& gate : plan.gates) {
    if (gate.state != "red") continue;
    text += fmt::format("{}{} is {:.3g}, limit {:.3g}", text.empty() ? "" : "; ", gate.name,
                        gate.value.value_or(0), gate.limit.value_or(0));
  }
  return text;
}

Verdict verdict_of_channels(const TestOutcome& outcome) {
  if (outcome.channels.empty()) return Verdict::pass;
  std::vector<ChannelDecision> decisions;
  for (const ChannelOutcome& channel : outcome.channels) decisions.push_back(channel.decision);
  return decide(decisions, outcome.plan.regions[0], outcome.place.share.beta);
}

/// The verdict of everything known, and why.
void conclude(TestWork& work, const Settled& settled) {
  TestOutcome& outcome = work.outcome;
  // A forced method runs as asked: its gates are shown, and do not invalidate.
  const std::string red = outcome.question.test->method ? "" : red_gates(outcome.plan);
  if (!red.empty() || !outcome.plan.invalid.empty()) {
    const std::string help = "; a larger `primaries` or more `secondaries` would help";
    settle(outcome, Verdict::invalid,
           outcome.plan.invalid.empty() ? red + help : outcome.plan.invalid);
    return;
  }
  settle(outcome, verdict_of_channels(outcome), "");
  for (const ConstantVerdict& constant : settled.constants) {
    if (badness(constant.verdict) > badness(outcome.verdict) || outcome.message.empty()) {
      if (badness(constant.verdict) >= badness(outcome.verdict)) {
        settle(outcome, constant.verdict, constant.message);
      }
    }
  }
  if (outcome.message.empty()) outcome.message = narrate(outcome);
}

void require_activation(TestWork& work) {
  TestOutcome& outcome = work.outcome;
  if (outcome.question.test->expect != Expectation::fail) return;
  for (std::size_t subject = 0; subject < work.pools.size(); ++subject) {
    if (was_activated(outcome.question.subjects[subject], *work.pools[subject],
                      outcome.plan.secondaries)) {
      continue;
    }
    settle(
        outcome, Verdict::invalid,
        fmt::format("never activated: `{}` drew the same numbers as its original in all {} "
                    "observations",
                    outcome.question.subjects[subject].estimator->name, outcome.plan.secondaries));
  }
}

}  // namespace

std::vector<ChannelData> data_of(const TestWork& work, std::size_t channel) {
  std::vector<ChannelData> data;
  for (std::size_t subject = 0; subject < work.pools.size(); ++subject) {
    const std::size_t index = work.outcome.question.subjects[subject].channels[channel];
    const ChannelSummary& summary = summary_of(work, subject).channels[index];
    data.push_back({.primaries = work.outcome.plan.primaries[subject],
                    .moments = summary.moments,
                    .values = work.pools[subject]->values(index, work.outcome.plan.secondaries),
                    .cells = summary.cells});
  }
  return data;
}

void evaluate(TestWork& work) {
  if (!could_be_drawn(work) || !density_is_proper(work.outcome)) return;
  Settled settled;
  try {
    evaluate_channels(work, settled);
  } catch (const std::domain_error& error) {
    // What stats cannot test: no spread where one is needed, too few cells.
    work.outcome.channels.clear();
    settle(work.outcome, Verdict::invalid, error.what());
    return;
  }
  conclude(work, settled);
  require_activation(work);
}

void apply_holm(std::vector<TestWork*>& suite, double alpha) {
  std::vector<stats::WeightedLogP> entries;
  std::vector<ChannelOutcome*> owners;
  std::vector<TestOutcome*> tests;
  for (TestWork* work : suite) {
    TestOutcome& outcome = work->outcome;
    if (!outcome.place.inside) continue;
    const bool counted = outcome.verdict != Verdict::invalid && outcome.verdict != Verdict::error;
    const std::size_t untested = outcome.question.channel_count() - outcome.channels.size();
    for (ChannelOutcome& channel : outcome.channels) {
      entries.push_back({.log_p = counted ? channel.decision.log_p_claimed : stats::untested_log_p,
                         .weight = outcome.place.weight});
      owners.push_back(&channel);
      tests.push_back(&outcome);
    }
    for (std::size_t i = 0; i < untested; ++i) {
      entries.push_back({.log_p = stats::untested_log_p, .weight = outcome.place.weight});
      owners.push_back(nullptr);
      tests.push_back(&outcome);
    }
  }
  if (entries.empty()) return;
  const std::vector<double> adjusted = stats::weighted_holm(entries);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (owners[i] == nullptr) continue;
    owners[i]->log_p_adjusted = adjusted[i];
    const bool open =
        tests[i]->verdict == Verdict::pass || tests[i]->verdict == Verdict::inconclusive;
    if (!open || adjusted[i] > std::log(alpha)) continue;
    owners[i]->decision.rejected = true;
    tests[i]->verdict = Verdict::fail;
    tests[i]->message = narrate(*tests[i]);
  }
}

}  // namespace assay::harness
