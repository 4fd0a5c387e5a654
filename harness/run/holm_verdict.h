#pragma once

// Holm's decision over the tests of one suite, whether they ran together or in shards.

#include <optional>
#include <vector>

#include "harness/run/evaluate.h"

namespace assay::harness {

/// A claim of the family, tested on its fixed share, and what Holm's method says of it.
struct FamilyMember {
  reports::Verdict verdict = reports::Verdict::skipped;
  double weight = 0;               ///< of one channel
  std::size_t untested = 0;        ///< channels without a p-value: they enter as 1
  std::vector<double> log_p = {};  ///< of the others
  std::vector<double> log_p_adjusted = {};
  /// The first channel by which the claim is refuted, though its fixed share did not.
  std::optional<std::size_t> refuted_by = {};

  /// Invalid and error enter as 1.
  bool tested() const {
    return verdict != reports::Verdict::invalid && verdict != reports::Verdict::error;
  }
};

/// Fills in `log_p_adjusted` and `refuted_by` of all claims of a family.
void decide_family(std::vector<FamilyMember>& family, double alpha);

/// Holm over the tests of one suite inside the family: fills in adjusted p-values and turns a pass
/// or inconclusive into a fail where Holm rejects what the fixed share did not.
void apply_holm(const std::vector<TestWork*>& suite, double alpha);

/// A test's place in its family.
FamilyMember member_of(const TestOutcome& outcome);

}  // namespace assay::harness
