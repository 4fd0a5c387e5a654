#pragma once

// Samples without spread. They have no standard error, and unseen values may still exist.

#include <optional>
#include <string>

#include "harness/theta/decision.h"
#include "harness/theta/methods.h"
#include "reports/record/record.h"

namespace assay::harness {

/// True if the values differ by no more than twice the channel's declared rounding.
bool is_constant(const Question& question, std::size_t subject, std::size_t channel,
                 const stats::Moments& moments);
inline bool is_constant(const Seen& seen, std::size_t subject) {
  return is_constant(seen.question, subject, seen.channel, seen.moments(subject));
}

struct ConstantVerdict {
  reports::Verdict verdict;
  std::string message;
};

/// Verdict on a mean claim whose samples are all constant, where no declared range bounds what was
/// never seen; nullopt if one varies. A constant as claimed passes if there is no forbidden region;
/// else it is inconclusive. Any other constant is invalid.
std::optional<ConstantVerdict> judge_constant(const Seen& seen, const Regions& regions);

/// Passes a constant sample if the claim bounds its variance from above and forbids no region, as
/// each channel of `worst_variance`. Returns nullopt for other claims, for samples that vary, or if
/// rounding may hide a variance beyond the bound.
std::optional<ConstantVerdict> judge_constant_variance(const Seen& seen, const Regions& regions);

/// Bound at this level on a constant sample's shift by unseen values: q times the declared range to
/// the worse side, plus rounding.
double unseen_shift(const Seen& seen, std::size_t subject, double level);

/// Says how to declare the range that bounds what was never seen.
std::string range_advice(const Question& question);

/// Why a channel's variance cannot be tested: a sample without spread; "" if it can.
std::string lack_of_variance(const Seen& seen);

}  // namespace assay::harness
