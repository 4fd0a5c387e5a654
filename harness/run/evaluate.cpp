#include "harness/run/evaluate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/draws/sampler_setup.h"
#include "harness/families/lost_to_rounding.h"
#include "harness/families/methods.h"
#include "harness/plan/gate_text.h"
#include "harness/plan/plan.h"
#include "harness/plan/rows.h"
#include "harness/run/activation.h"
#include "harness/run/assumptions.h"
#include "harness/run/found_effect.h"
#include "harness/run/image_judge.h"
#include "harness/run/narrate.h"
#include "harness/run/observation_faults.h"
#include "harness/sampling/beyond_doubles.h"
#include "harness/theta/constant.h"

namespace assay::harness {
namespace {

using reports::Verdict;

void settle(TestOutcome& outcome, Verdict verdict, std::string message) {
  outcome.verdict = verdict;
  outcome.message = std::move(message);
}

/// False if the density's integral exceeds 1 or the density is negative somewhere.
bool density_is_proper(TestOutcome& outcome) try {
  if (outcome.question.kind != QuestionKind::fit_to_density) return true;
  const auto& draws = dynamic_cast<const SamplerSetup&>(*outcome.question.subjects[0].setup);
  const double total = draws.density_cells().mass.total;
  const double excess = total - 1;
  if (excess <= draws.density_cells().tolerance()) return true;
  settle(outcome, Verdict::fail,
         fmt::format("the declared density integrates to {:.6g} over its domain (quadrature error "
                     "{:.1g}): more than 1, so no sampler can follow it",
                     total, draws.density_cells().tolerance()));
  return false;
} catch (const std::domain_error& error) {
  settle(outcome, Verdict::invalid, in_words(error));
  return false;
}

ChannelOutcome channel_outcome(const DrawnTest& test, std::size_t channel,
                               std::span<const ChannelData> data) {
  const TestOutcome& outcome = test.outcome;
  const Question& question = outcome.question;
  const Regions& regions = outcome.plan.regions[channel];
  std::optional<ImageOutcome> image;
  Evidence evidence;
  if (question.kind == QuestionKind::image) {
    ImageEvidence found = evidence_of_images(question, image_test(test), data);
    evidence = std::move(found.evidence);
    image = std::move(found.outcome);
  } else {
    evidence = evidence_of(outcome.plan.method, question, channel, data);
  }
  const stats::TestResult at_null = evidence.at(0);
  ChannelOutcome result{.index = channel,
                        .name = question.channel_name(channel),
                        .regions = regions,
                        .at_null = at_null,
                        .evidence = std::move(evidence)};
  result.decision = {.log_p_claimed = log_p_claimed(result.evidence, regions),
                     .log_p_forbidden = log_p_forbidden(result.evidence, regions)};
  result.image = std::move(image);
  if (question.kind == QuestionKind::mean_of_one) {
    result.reference = question.references[channel].value + question.offset;
  } else if (question.kind == QuestionKind::mean_of_two) {
    result.reference = question.factor * data[1].moments.mean + question.offset;
  } else if (question.kind == QuestionKind::quantile && !question.of_two()) {
    result.reference = question.references[channel].value;
  }
  return result;
}

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

/// Why a channel's data cannot be tested; "" if they can.
std::string lack_of_numbers(const TestOutcome& outcome, std::size_t channel,
                            std::span<const ChannelData> data) {
  const Question& question = outcome.question;
  for (std::size_t i = 0; i < data.size() && !question.of_laws(); ++i) {
    if (is_constant(question, i, channel, data[i].moments)) continue;
    std::string reason = beyond_doubles(data[i].moments, question.subjects[i].estimator->name);
    if (!reason.empty()) return reason;
  }
  return lack_of_spread(outcome, channel, data);
}

/// Checks the channels whose variances form a total.
std::string total_lost_to_rounding(const DrawnTest& test) {
  const Question& question = test.outcome.question;
  std::string reason;
  if (question.kind != QuestionKind::total_variance) return reason;
  for (std::size_t i = 0; i < question.compared() && reason.empty(); ++i) {
    std::vector<stats::Moments> channels;
    for (const std::size_t channel : question.subjects[i].channels) {
      channels.push_back(test.samples[i].summary().moments(channel));
    }
    reason =
        variances_lost_to_rounding(question.subjects[i], test.outcome.plan.primaries[i], channels);
  }
  return reason;
}

/// Computes numbers and gates of every channel at the current look. Returns the verdicts of
/// constant channels.
std::vector<ConstantVerdict> evaluate_channels(TestOutcome& outcome, const DrawnTest& test) {
  const Question& question = outcome.question;
  std::vector<ConstantVerdict> constants;
  const auto add = [&](std::size_t channel, ConstantVerdict constant) {
    if (question.channel_count() > 1) {
      constant.message = question.channel_name(channel) + ": " + constant.message;
    }
    constants.push_back(std::move(constant));
  };
  for (std::size_t channel = 0; channel < question.channel_count(); ++channel) {
    const std::vector<ChannelData> data = data_of(test, channel);
    if (question.of_means() && all_constant(question, channel, data)) {
      add(channel,
          judge_constant(question, channel, data, outcome.plan.regions[channel], outcome.share()));
      continue;
    }
    if (auto bounded =
            judge_constant_variance(question, channel, data[0], outcome.plan.regions[channel])) {
      add(channel, *std::move(bounded));
      continue;
    }
    std::string reason = lack_of_numbers(outcome, channel, data);
    if (reason.empty()) reason = total_lost_to_rounding(test);
    if (!reason.empty()) {
      add(channel, {Verdict::invalid, reason});
      continue;
    }
    for (Gate& gate : data_gates(outcome, channel, data)) {
      outcome.gates.push_back(std::move(gate));
    }
    outcome.channels.push_back(channel_outcome(test, channel, data));
    if (const auto& images = outcome.channels.back().image) {
      outcome.gates.push_back(own_skewness_gate(*images));
    }
  }
  return constants;
}

/// Adds the look's p-values to those of all looks, or nothing if it does not count.
void remember(TestOutcome& outcome, bool counts) {
  outcome.history.resize(outcome.question.channel_count());
  for (ChannelHistory& history : outcome.history) {
    history.log_p_claimed.push_back(0);
    history.log_p_forbidden.push_back(0);
  }
  for (ChannelOutcome& channel : outcome.channels) {
    ChannelHistory& history = outcome.history[channel.index];
    if (counts) {
      history.log_p_claimed.back() = channel.decision.log_p_claimed;
      history.log_p_forbidden.back() = channel.decision.log_p_forbidden;
    }
    channel.decision = {
        .log_p_claimed = stats::log_p_over_looks(outcome.plan.looks, history.log_p_claimed),
        .log_p_forbidden = stats::log_p_over_looks(outcome.plan.looks, history.log_p_forbidden)};
    channel.decision.rejected =
        channel.decision.log_p_claimed <= std::log(outcome.place.share.alpha);
  }
  std::stable_sort(outcome.channels.begin(), outcome.channels.end(),
                   [](const ChannelOutcome& a, const ChannelOutcome& b) {
                     return a.decision.log_p_claimed < b.decision.log_p_claimed;
                   });
}

Verdict verdict_of_channels(const TestOutcome& outcome) {
  if (outcome.channels.empty()) return Verdict::pass;
  std::vector<ChannelDecision> decisions;
  for (const ChannelOutcome& channel : outcome.channels) decisions.push_back(channel.decision);
  return decide(decisions, outcome.plan.regions[0], outcome.place.share.beta);
}

/// Points on no power law reject every slope, which says nothing about any, whatever the method.
bool shows_by_no_slope(const TestOutcome& outcome) {
  return outcome.question.kind == QuestionKind::slope && outcome.verdict == Verdict::pass &&
         outcome.plan.regions[0].has_forbidden() && !red_gates(outcome.gates).empty();
}

void conclude(TestOutcome& outcome, const std::vector<ConstantVerdict>& constants) {
  const std::string red = outcome.plan.gates_invalidate ? red_gates(outcome.gates) : "";
  remember(outcome, red.empty());
  if (!red.empty() || !outcome.plan.invalid.empty()) {
    settle(outcome, Verdict::invalid,
           outcome.plan.invalid.empty() ? red + what_would_help(outcome) : outcome.plan.invalid);
    return;
  }
  settle(outcome, verdict_of_channels(outcome), "");
  if (shows_by_no_slope(outcome)) settle(outcome, Verdict::invalid, red_gates(outcome.gates));
  for (const ConstantVerdict& constant : constants) {
    const bool says_all = outcome.channels.empty() && outcome.message.empty();
    if (says_all || badness(constant.verdict) > badness(outcome.verdict)) {
      settle(outcome, constant.verdict, constant.message);
    }
  }
}

void require_activation(TestOutcome& outcome, const DrawnTest& test) {
  // A plan that is invalid draws little, and has its own reason.
  if (outcome.question.test->expect != Expectation::fail || !outcome.plan.invalid.empty()) return;
  for (std::size_t subject = 0; subject < test.samples.size(); ++subject) {
    if (was_activated(outcome.question.subjects[subject], test.samples[subject].pool(),
                      outcome.secondaries(subject))) {
      continue;
    }
    settle(outcome, Verdict::invalid,
           fmt::format("never activated: `{}` drew the same numbers as its original in all {} "
                       "observations",
                       outcome.question.subjects[subject].estimator->name,
                       outcome.secondaries(subject)));
  }
}

void clear_numbers(TestOutcome& outcome) {
  outcome.channels.clear();
  outcome.gates.clear();
  outcome.power.reset();
}

void judge(TestOutcome& outcome, const DrawnTest& test) {
  try {
    conclude(outcome, evaluate_channels(outcome, test));
  } catch (const std::domain_error& error) {
    // stats cannot test these data: no spread, too few cells.
    outcome.channels.clear();
    remember(outcome, false);
    settle(outcome, Verdict::invalid,
           outcome.plan.invalid.empty() ? in_words(error) : outcome.plan.invalid);
  }
}

/// The observations of this look in equal runs of whole blocks.
std::vector<Replicate> replicates_of(const DrawnTest& test, std::size_t subject,
                                     std::size_t channel) {
  const std::uint64_t size = test.outcome.secondaries(subject) / replicate_count;
  std::vector<Replicate> replicates(1);
  for (const BlockSums& block : test.samples[subject].blocks()) {
    if (replicates.back().count >= size) replicates.emplace_back();
    if (replicates.size() > replicate_count) break;
    replicates.back().count += block.count;
    replicates.back().moments.merge(block.channels[channel]);
    replicates.back().seconds += block.seconds;
  }
  replicates.resize(replicate_count);
  return replicates;
}

}  // namespace

Sample TestWork::sample(std::size_t subject) const {
  return pools[subject]->sample(outcome.secondaries(subject));
}

std::vector<Sample> TestWork::samples() const {
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < pools.size(); ++i) samples.push_back(sample(i));
  return samples;
}

std::optional<DrawnTest> drawn(const TestWork& work) {
  DrawnTest test{.outcome = work.outcome, .samples = {}};
  for (const Sample& sample : work.samples()) {
    if (sample.drawn() == nullptr) return std::nullopt;
    test.samples.push_back(*sample.drawn());
  }
  return test;
}

std::vector<ChannelData> data_of(const DrawnTest& test, std::size_t channel) {
  std::vector<ChannelData> data;
  const Plan& plan = test.outcome.plan;
  for (std::size_t subject = 0; subject < test.samples.size(); ++subject) {
    const Drawn& sample = test.samples[subject];
    const std::vector<std::size_t>& channels = test.outcome.question.subjects[subject].channels;
    const std::size_t index = channels[channel];
    const Summary& summary = sample.summary();
    const std::span<const double> values = sample.values(index);
    data.push_back({.primaries = plan.primaries[subject],
                    .moments = as_tested(plan, subject, channel, values, summary.moments(index)),
                    .values = values,
                    .cells = summary.details(index).cells,
                    .with_cost = summary.details(index).with_cost,
                    .group_variances = summary.group_variances});
    if (plan.method.keeps == Keeps::points) {
      for (const std::size_t each : channels) data.back().all_values.push_back(sample.values(each));
    }
    if (plan.method.keeps == Keeps::images) data.back().images = images_of(test, subject);
    if (plan.method.keeps == Keeps::blocks) {
      data.back().replicates = replicates_of(test, subject, index);
    }
  }
  return data;
}

namespace {

void take_sound_look(TestWork& work, const DrawnTest& test, bool may_go_on) {
  TestOutcome& outcome = work.outcome;
  if (!density_is_proper(outcome)) return;
  judge(outcome, test);
  const bool last = outcome.look + 1 == outcome.plan.looks.sizes.size();
  const bool settled = outcome.verdict == Verdict::fail || outcome.verdict == Verdict::pass;
  if (may_go_on && !last && !settled && outcome.plan.invalid.empty()) {
    outcome.decided = false;
    return;
  }
  if (!work.verdict_only) {
    note_sizes(outcome, test);
    if (outcome.message.empty()) {
      outcome.message = narrate(outcome) + means_where_it_differs(test) + first_contradiction(test);
      if (outcome.verdict == Verdict::fail) {
        outcome.message += outcome.plan.hint + taken_as_exact(outcome.question);
      }
    }
  }
  require_activation(outcome, test);
}

/// The reason why the look cannot be taken; nullopt if it was.
std::optional<std::string> take_drawn_look(TestWork& work, bool may_go_on) {
  if (!work.outcome.plan.error.empty()) return work.outcome.plan.error;
  const std::optional<DrawnTest> test = drawn(work);
  if (!test) return where_it_stopped(work);
  if (std::string why = unusable(*test); !why.empty()) return why;
  if (!work.outcome.plan.pilot_error.empty()) return work.outcome.plan.pilot_error;
  take_sound_look(work, *test, may_go_on);
  return std::nullopt;
}

}  // namespace

void take_look(TestWork& work, bool may_go_on) {
  TestOutcome& outcome = work.outcome;
  outcome.decided = true;
  clear_numbers(outcome);
  std::optional<std::string> why;
  try {
    why = take_drawn_look(work, may_go_on);
  } catch (const NoDensity& failure) {
    why = lack_of_density(outcome.question, failure);
  } catch (const std::domain_error& error) {
    // A defect of this program stops this test and no other.
    why = fmt::format("internal error: {}", error.what());
  } catch (...) {
    // Judging asks some sources again: for densities, and for a mutant's original.
    why = words_of(std::current_exception());
  }
  if (!why) return;
  clear_numbers(outcome);
  settle(outcome, Verdict::error, *std::move(why));
}

}  // namespace assay::harness
