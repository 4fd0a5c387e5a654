#pragma once

// Holm's adjusted p-values over the tests of one suite, run together or in shards. They are shown
// and decide nothing: a verdict rests on its test's own share of alpha.

#include <functional>
#include <vector>

#include "harness/run/evaluate.h"

namespace assay::harness {

/// A claim of the family, with the p-values of its channels.
struct FamilyMember {
  reports::Verdict verdict = reports::Verdict::skipped;
  double weight = 0;               ///< of one channel
  std::size_t untested = 0;        ///< Channels without a p-value, which count as p = 1.
  std::vector<double> log_p = {};  ///< Of the other channels.
  /// Hears the adjusted p-value of each of them.
  std::function<void(std::size_t channel, double log_p)> adjusted = {};
};

/// Adjusts the p-values of all claims of a family. Invalid and error count as p = 1.
void adjust_family(const std::vector<FamilyMember>& family);

/// Fills in the adjusted p-values of a suite's tests inside the family.
void adjust_p_values(std::vector<TestWork>& suite);

FamilyMember member_of(const TestOutcome& outcome);

}  // namespace assay::harness
