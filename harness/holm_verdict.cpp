#include "harness/holm_verdict.h"

#include <cmath>

#include "harness/narrate.h"
#include "stats/holm.h"

namespace assay::harness {

using reports::Verdict;

void apply_holm(const std::vector<TestWork*>& suite, double alpha) {
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
    const Verdict verdict = tests[i]->verdict;
    const bool judged = verdict != Verdict::invalid && verdict != Verdict::error;
    if (!judged || adjusted[i] > std::log(alpha)) continue;
    owners[i]->decision.rejected = true;
    if (verdict == Verdict::fail) continue;
    tests[i]->verdict = Verdict::fail;
    for (ChannelOutcome& channel : tests[i]->channels) {
      channel.effect = effect_of(*tests[i], channel);
    }
    tests[i]->message = narrate_holm(*tests[i], *owners[i]);
  }
}

}  // namespace assay::harness
