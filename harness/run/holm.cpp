#include "harness/run/holm.h"

#include "stats/planning/holm.h"

namespace assay::harness {

using reports::Verdict;

void adjust_family(const std::vector<FamilyMember>& family) {
  std::vector<stats::WeightedLogP> entries;
  for (const FamilyMember& member : family) {
    const bool tested = member.verdict != Verdict::invalid && member.verdict != Verdict::error;
    for (const double log_p : member.log_p) {
      entries.push_back({.log_p = tested ? log_p : stats::untested_log_p, .weight = member.weight});
    }
    entries.insert(entries.end(), member.untested,
                   {.log_p = stats::untested_log_p, .weight = member.weight});
  }
  if (entries.empty()) return;
  const std::vector<double> adjusted = stats::weighted_holm(entries);
  auto next = adjusted.cbegin();
  for (const FamilyMember& member : family) {
    for (std::size_t i = 0; i < member.log_p.size(); ++i) member.adjusted(i, *next++);
    next += static_cast<std::ptrdiff_t>(member.untested);
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

void adjust_p_values(std::vector<TestWork>& suite) {
  std::vector<FamilyMember> family;
  for (TestWork& work : suite) {
    if (!work.outcome.place.inside) continue;
    family.push_back(member_of(work.outcome));
    family.back().adjusted = [&channels = work.outcome.channels](std::size_t i, double log_p) {
      channels[i].log_p_adjusted = log_p;
    };
  }
  adjust_family(family);
}

}  // namespace assay::harness
