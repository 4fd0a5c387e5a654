#pragma once

#include "harness/run/evaluate.h"

namespace assay::harness {

/// The effect with the interval behind the verdict, at this look's shares. A fail shows the
/// interval at alpha, which misses the claimed region. A pass that excludes the forbidden region
/// shows the interval at 1 - 2 beta: one test at beta to each side. An undecided test shows that
/// interval too.
reports::Effect effect_of(const TestOutcome& outcome, const ChannelOutcome& channel);
/// The effect as it is shown if the claim is refuted.
reports::Effect refuted_effect_of(const TestOutcome& outcome, const ChannelOutcome& channel);

/// Fills in a decided test's effect and least detectable effect for every channel, and the least
/// power over them. The power is that at `detect`; for `within` it is that of showing theta = 0.
void note_sizes(TestOutcome& outcome, const DrawnTest& test);

}  // namespace assay::harness
