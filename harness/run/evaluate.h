#pragma once

// Turns drawn observations into the numbers and the verdict of a test.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "harness/plan/outcome.h"
#include "harness/sampling/pool.h"

namespace assay::harness {

/// A test with one pool for each subject.
struct TestWork {
  const Budget* suite_budget = nullptr;  ///< shared by the suite's tests; null: none
  TestOutcome outcome;
  std::vector<std::shared_ptr<Pool>> pools = {};
  /// The look that a recorded run ended with.
  std::optional<std::size_t> last_look = {};
  /// Skips the interval of the effect, the power and the sentence.
  bool verdict_only = false;

  /// A subject's sample at the current look, once it is drawn.
  Sample sample(std::size_t subject) const;
  std::vector<Sample> samples() const;
};

/// A test at its current look, without faults.
struct DrawnTest {
  const TestOutcome& outcome;
  std::vector<Drawn> samples;  ///< one for each subject
};

/// The test, or nullopt if a subject has a fault.
std::optional<DrawnTest> drawn(const TestWork& work);

/// Computes numbers, gates and the verdict on the test's fixed share at the current look, once it
/// is drawn. Sets `decided` if no later look can or need change it, or none is allowed.
void take_look(TestWork& work, bool may_go_on = true);

std::vector<ChannelData> data_of(const DrawnTest& test, std::size_t channel);

// Holm's adjusted p-values over the tests of one suite, run together or in shards. They are shown
// and decide nothing: a verdict rests on its test's own share of alpha.

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
