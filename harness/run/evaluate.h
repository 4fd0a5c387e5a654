#pragma once

// From drawn observations to the numbers and the verdict of a test.

#include <memory>
#include <optional>
#include <vector>

#include "harness/plan/outcome.h"
#include "harness/sampling/pool.h"

namespace assay::harness {

/// A test with the pools its subjects read, one each.
struct TestWork {
  const Budget* suite_budget = nullptr;  ///< the same for all tests of the suite; null: none
  TestOutcome outcome;
  std::vector<std::shared_ptr<Pool>> pools = {};
  /// Whether the verdict is all that is wanted: no interval of the effect, no power, no sentence.
  bool verdict_only = false;

  /// What a subject yields for the current look, once it is drawn.
  Sample sample(std::size_t subject) const;
  /// The same for each subject.
  std::vector<Sample> samples() const;
};

/// A test at its current look, for which every subject yielded its observations.
struct DrawnTest {
  const TestOutcome& outcome;
  std::vector<Drawn> samples;  ///< one of each subject
};

/// The test where every subject yielded its observations; nullopt where one has a fault.
std::optional<DrawnTest> drawn(const TestWork& work);

/// Numbers, gates and the verdict on the test's fixed share at the current look, once its
/// observations are drawn; `decided` is set where no further look can or need change it, or none
/// may be taken.
void take_look(TestWork& work, bool may_go_on = true);

/// The data a channel of the test is judged by.
std::vector<ChannelData> data_of(const DrawnTest& test, std::size_t channel);

}  // namespace assay::harness
