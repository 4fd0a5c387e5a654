#include <gtest/gtest.h>

#include "harness/plan/critical.h"
#include "harness/plan/looks.h"
#include "harness/plan/outcome.h"
#include "harness/theta/methods.h"
#include "harness/theta/theta.h"
#include "tests/harness/questions.h"

namespace assay::harness {
namespace {

/// Costs of 1, of which every so many-th is dearer.
struct DearOnes {
  int every;
  double more;
};
/// The gates on a thousand of them.
std::vector<Gate> gates_of_costs(const std::string& claim, DearOnes dear) {
  const auto asked = ask_text(R"(suite: costs
estimators: {multi: {plugin: direct_light/multi_sample, primaries: 1}}
tests: [{name: t, claim: )" + claim +
                              "}]\n");
  TestOutcome outcome{.question = asked->question("t"),
                      .place = {.inside = false, .share = {.alpha = 0.01, .beta = 0.01}}};
  outcome.plan.method = methods_for(outcome.question).front();
  outcome.plan.looks = one_look(1000, outcome.place.share);
  std::vector<stats::JointMoments> sums(counted_costs);
  ChannelData data;
  for (int i = 0; i < 1000; ++i) {
    const double value = i % 7;
    data.moments.add(value);
    for (stats::JointMoments& joint : sums)
      joint.add(value, i % dear.every == 0 ? 1 + dear.more : 1);
  }
  data.with_cost = sums;
  data.group_variances = sums[0].cost;
  return outcome.question.theta->gates(
      outcome, 0, {&data, 1}, critical_value(outcome.share().alpha, two_sided(outcome.question)));
}

// One in a thousand as dear as all the others: the logarithm of the mean is not near normal.
TEST(Assumptions, RareCostsThatWeighAreRed) {
  const DearOnes rare_ones{.every = 1000, .more = 1000};
  for (const char* claim : {"cost(multi) == 2", "efficiency(multi) == 1"}) {
    const std::vector<Gate> rare = gates_of_costs(claim, rare_ones);
    ASSERT_EQ(rare.size(), 1) << claim;
    EXPECT_EQ(rare[0].name, "level factor of the mean cost of multi");
    EXPECT_EQ(rare[0].state, "red");
    EXPECT_EQ(gates_of_costs(claim, {.every = 2, .more = 1})[0].state, "green");
    EXPECT_TRUE(gates_of_costs(claim, {.every = 1, .more = 1}).empty())
        << "a cost that does not vary";
  }
  const std::vector<Gate> groups = gates_of_costs("total_variance(multi) == 1", rare_ones);
  ASSERT_EQ(groups.size(), 1);
  EXPECT_EQ(groups[0].name, "level factor of the mean variance of multi");
  EXPECT_EQ(groups[0].state, "red");
  // A pool keeps costs for all its tests.
  for (const char* claim :
       {"mean(multi) == 1", "variance(multi) == 1", "cost(multi) == 1, cost: seconds"}) {
    for (const Gate& gate : gates_of_costs(claim, rare_ones)) {
      EXPECT_EQ(gate.name.find("cost"), std::string::npos) << claim << ": " << gate.name;
    }
  }
}

}  // namespace
}  // namespace assay::harness
