#pragma once

// Samples without spread: there is no standard error to test with, and what was never seen may
// still be there.

#include <optional>
#include <span>
#include <string>

#include "harness/theta/decision.h"
#include "harness/theta/family.h"
#include "harness/theta/method.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Whether the values differ by no more than the channel's declared rounding.
bool is_constant(const Question& question, std::size_t subject, std::size_t channel,
                 const stats::Moments& moments);

/// Whether every subject's observations of a channel are the same but for rounding.
bool all_constant(const Question& question, std::size_t channel, std::span<const ChannelData> data);

struct ConstantVerdict {
  reports::Verdict verdict;
  std::string message;
};

/// The verdict of a mean claim whose samples are all constant. An unseen value has probability at
/// most q with (1 - q)^n = level, so that the mean is within q * (declared range) of the constant:
/// exact binomial. Where the constant is as claimed (equal to the reference, or in the claimed
/// region): pass if there is no forbidden region, or if the bound at beta excludes it; else
/// inconclusive. Where it is not: fail only if the bound at alpha excludes the claimed region; else
/// invalid.
ConstantVerdict judge_constant(const Question& question, std::size_t channel,
                               std::span<const ChannelData> data, const Regions& regions,
                               const ErrorShare& share);

/// The verdict of a variance that is bounded from above and has no forbidden region, as each
/// channel of `worst_variance`, of a constant sample: pass. Nothing of other claims, where the
/// sample varies, or where rounding may have hidden a variance beyond the bound.
std::optional<ConstantVerdict> judge_constant_variance(const Question& question,
                                                       std::size_t channel, const ChannelData& data,
                                                       const Regions& regions);

/// The most that values never seen could move the mean of a constant sample, at this level: q times
/// the declared range, to the worse side.
double unseen_shift(const Question& question, std::size_t subject, std::size_t channel,
                    const ChannelData& data, double level);

}  // namespace assay::harness
