#include "harness/run/holm_verdict.h"

#include <cmath>

#include "harness/base/numbers.h"
#include "harness/run/found_effect.h"
#include "harness/run/verdict_text.h"
#include "stats/planning/holm.h"

namespace assay::harness {

using reports::Verdict;

namespace {

std::uint64_t look_of_p(const TestOutcome& outcome, const ChannelOutcome& channel) {
  // With several channels the record does not tell their looks apart.
  if (outcome.question.channel_count() > 1) return 0;
  const std::vector<double>& log_p = outcome.history[channel.index].log_p_claimed;
  const stats::LookSchedule& schedule = outcome.plan.looks;
  std::vector<reports::Look> looks;
  for (std::size_t k = 0; k < log_p.size(); ++k) {
    looks.push_back({.secondaries = schedule.sizes[k],
                     .weight = schedule.weights[k],
                     .log10_p = log10_of(log_p[k])});
  }
  return earlier_look(looks);
}

void refute(TestOutcome& outcome, std::size_t by) {
  outcome.verdict = Verdict::fail;
  for (ChannelOutcome& channel : outcome.channels) channel.effect = effect_of(outcome, channel);
  const ChannelOutcome& channel = outcome.channels[by];
  outcome.message =
      narrate_holm({.effect = channel.effect,
                    .channel = outcome.question.channel_count() > 1 ? channel.name : "",
                    .log_p = channel.decision.log_p_claimed,
                    .log_p_adjusted = channel.log_p_adjusted,
                    .earlier_look = look_of_p(outcome, channel)});
}

void take_over(const FamilyMember& member, TestOutcome& outcome, double alpha) {
  for (std::size_t i = 0; i < outcome.channels.size(); ++i) {
    ChannelOutcome& channel = outcome.channels[i];
    channel.log_p_adjusted = member.log_p_adjusted[i];
    if (member.tested() && channel.log_p_adjusted <= std::log(alpha)) {
      channel.decision.rejected = true;
    }
  }
  if (member.refuted_by) refute(outcome, *member.refuted_by);
}

}  // namespace

void decide_family(std::vector<FamilyMember>& family, double alpha) {
  std::vector<stats::WeightedLogP> entries;
  for (const FamilyMember& member : family) {
    for (const double log_p : member.log_p) {
      entries.push_back(
          {.log_p = member.tested() ? log_p : stats::untested_log_p, .weight = member.weight});
    }
    entries.insert(entries.end(), member.untested,
                   {.log_p = stats::untested_log_p, .weight = member.weight});
  }
  if (entries.empty()) return;
  auto adjusted = stats::weighted_holm(entries);
  auto next = adjusted.cbegin();
  for (FamilyMember& member : family) {
    const auto end = next + static_cast<std::ptrdiff_t>(member.log_p.size());
    member.log_p_adjusted.assign(next, end);
    next = end + static_cast<std::ptrdiff_t>(member.untested);
    if (!member.tested() || member.verdict == Verdict::fail) continue;
    for (std::size_t i = member.log_p.size(); i-- > 0;) {
      if (member.log_p_adjusted[i] <= std::log(alpha)) member.refuted_by = i;
    }
  }
}

FamilyMember member_of(const TestOutcome& outcome) {
  FamilyMember member{.verdict = outcome.verdict,
                      .weight = outcome.place.weight,
                      .untested = outcome.question.channel_count() - outcome.channels.size()};
  for (const ChannelOutcome& channel : outcome.channels) {
    member.log_p.push_back(channel.decision.log_p_claimed);
  }
  return member;
}

void apply_holm(const std::vector<TestWork*>& suite, double alpha) {
  std::vector<FamilyMember> family;
  std::vector<TestOutcome*> outcomes;
  for (TestWork* work : suite) {
    if (!work->outcome.place.inside) continue;
    family.push_back(member_of(work->outcome));
    outcomes.push_back(&work->outcome);
  }
  decide_family(family, alpha);
  for (std::size_t i = 0; i < family.size(); ++i) take_over(family[i], *outcomes[i], alpha);
}

}  // namespace assay::harness
