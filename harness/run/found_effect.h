#pragma once

// What a test found and could have found, in numbers.

#include "harness/run/evaluate.h"

namespace assay::harness {

/// The effect with the interval that the verdict rests on, at this look's shares. A claim is
/// refuted where the interval of what its test does not reject at alpha misses the claimed region;
/// a pass that excludes the forbidden region does so by the ends of the interval at 1 - 2 beta, one
/// test at beta to each side; what is still undecided is shown by that interval too.
reports::Effect effect_of(const TestOutcome& outcome, const ChannelOutcome& channel);
/// The same, should the claim be refuted.
reports::Effect refuted_effect_of(const TestOutcome& outcome, const ChannelOutcome& channel);

/// Of a decided test: the effect and the least detectable one of every channel, and the least power
/// over them, at `detect` or, of `within`, of showing a theta of 0.
void note_sizes(TestOutcome& outcome, const DrawnTest& test);

}  // namespace assay::harness
