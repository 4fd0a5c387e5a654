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
  std::vector<stats::JointSums> sums(counted_costs);
  ChannelData data;
  for (int i = 0; i < 1000; ++i) {
    const double value = i % 7;
    data.moments.add(value);
    for (stats::JointSums& joint : sums) joint.add(value, i % dear.every == 0 ? 1 + dear.more : 1);
  }
  for (const stats::JointSums& joint : sums) data.joint.push_back(joint.moments());
  data.group_variances = data.joint[0].cost();
  return outcome.question.theta->gates(
      outcome, {outcome.question, 0, {&data, 1}},
      critical_value(outcome.share().alpha, is_two_sided(outcome.question.test->claim.relation)));
}

bool is_red(const std::vector<Gate>& gates, const std::string& kind) {
  return std::ranges::any_of(gates, [&](const Gate& gate) {
    return gate.is_red() && gate.kind == kind && gate.row().needs_more();
  });
}

// One in a thousand as dear as a thousand others: it is nearly all of their sum of squares.
TEST(Assumptions, RareCostsThatWeighAreRed) {
  const DearOnes rare_ones{.every = 1000, .more = 1000};
  for (const char* claim :
       {"cost(multi) == 2", "efficiency(multi) == 1", "total_variance(multi) == 1"}) {
    const std::vector<Gate> rare = gates_of_costs(claim, rare_ones);
    EXPECT_TRUE(is_red(rare, "effective observations")) << claim;
    EXPECT_EQ(rare[0].name, "effective observations");
    for (const Gate& gate : gates_of_costs(claim, {.every = 2, .more = 1})) {
      EXPECT_EQ(gate.state, "green") << claim << ": " << gate.name;
    }
  }
  EXPECT_TRUE(gates_of_costs("cost(multi) == 2", {.every = 1, .more = 1}).empty())
      << "a cost that does not vary";
  // A pool keeps costs for all its tests.
  EXPECT_FALSE(is_red(gates_of_costs("variance(multi) == 1", rare_ones), "effective observations"));
  EXPECT_TRUE(gates_of_costs("cost(multi) == 1, cost: seconds", rare_ones).empty());
}

}  // namespace
}  // namespace assay::harness
