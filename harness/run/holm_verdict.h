#pragma once

// Holm's decision over the tests of one suite, run together or in shards.

#include <optional>
#include <vector>

#include "harness/run/evaluate.h"

namespace assay::harness {

/// A claim of the family: its test at the fixed share, and Holm's decision.
struct FamilyMember {
  reports::Verdict verdict = reports::Verdict::skipped;
  double weight = 0;               ///< of one channel
  std::size_t untested = 0;        ///< Channels without a p-value, which count as p = 1.
  std::vector<double> log_p = {};  ///< Of the other channels.
  std::vector<double> log_p_adjusted = {};
  /// The first channel by which Holm refutes a claim that its fixed share did not refute.
  std::optional<std::size_t> refuted_by = {};

  /// Invalid and error count as p = 1.
  bool tested() const {
    return verdict != reports::Verdict::invalid && verdict != reports::Verdict::error;
  }
};

/// Fills in `log_p_adjusted` and `refuted_by` of all claims of a family.
void decide_family(std::vector<FamilyMember>& family, double alpha);

/// Fills in adjusted p-values over a suite's tests inside the family. Turns pass or inconclusive
/// into fail if Holm rejects what the fixed share did not.
void apply_holm(const std::vector<TestWork*>& suite, double alpha);

FamilyMember member_of(const TestOutcome& outcome);

}  // namespace assay::harness
