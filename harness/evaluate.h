#pragma once

// From drawn observations to the numbers and the verdict of a test.

#include <memory>
#include <vector>

#include "harness/outcome.h"
#include "harness/pool.h"

namespace assay::harness {

/// A test with the pools its subjects read, one each.
struct TestWork {
  TestOutcome outcome;
  std::vector<std::shared_ptr<Pool>> pools = {};
};

/// Numbers, gates and the verdict on the test's fixed share.
void evaluate(TestWork& work);

/// Holm over the tests of one suite inside the family: fills in adjusted p-values and turns a pass
/// or inconclusive into a fail where Holm rejects what the fixed share did not. Invalid and error
/// enter as 1.
void apply_holm(std::vector<TestWork*>& suite, double alpha);

/// The data a channel of the test is judged by.
std::vector<ChannelData> data_of(const TestWork& work, std::size_t channel);

}  // namespace assay::harness
