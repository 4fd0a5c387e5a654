#include "stats/gates/unpiloted_gates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "stats/basics/errors.h"
#include "tests/philox.h"
#include "tests/stats/laws.h"
#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

using tests::draw_moments;
using tests::Philox;
namespace laws = tests::laws;

TEST(UnpilotedGates, AskForMoreValuesWhereTheCriticalValueIsLarger) {
  EXPECT_EQ(fewest_unpiloted(1.645), 50U);
  EXPECT_EQ(fewest_unpiloted(3), 162U);
  // A sample with a tenth of the variance of a contrast has a thousandth of the say.
  EXPECT_EQ(fewest_unpiloted(3, 0.1), 2U);
  EXPECT_THROW(fewest_unpiloted(0), std::domain_error);
  EXPECT_THROW(fewest_unpiloted(3, 1.5), std::domain_error);
  EXPECT_EQ(unpiloted_count_gate({.count = 161}, 3).state, GateState::red);
  EXPECT_EQ(unpiloted_count_gate({.count = 162}, 3).state, GateState::green);
}

TEST(UnpilotedGates, ValueIsTheSkewnessOfTheMean) {
  const Moments x = draw_moments(400, [k = 0]() mutable { return std::exp(.01 * ++k); });
  EXPECT_NEAR(unpiloted_skewness_gate(x, 3).value, x.skewness() / 20, 1e-12);
  EXPECT_NEAR(unpiloted_skewness_gate(x, 2).limit, normal_skewness_quantile(400, 5e-5) / 20, 0.15);
  // In a difference from itself the skewness cancels. In a sum it is that of twice as many.
  EXPECT_NEAR(unpiloted_skewness_gate(x, x, 1, 3).value, 0, 1e-12);
  EXPECT_NEAR(unpiloted_skewness_gate(x, x, -1, 3).value, x.skewness() / std::sqrt(800), 1e-12);
  EXPECT_THROW(unpiloted_skewness_gate({.count = 3}, 3), ZeroVariance);
}

// A sound gate is called wrong with probability at most 4e-5: Poisson(2) of 40000 samples at 5e-5
// exceeds 10.
TEST(UnpilotedGates, AreSilentOnNormalSamples) {
  Philox random(1);
  int red = 0;
  for (int k = 0; k < 40000; ++k) {
    const Moments x = draw_moments(120, [&] { return random.normal(); });
    red += unpiloted_skewness_gate(x, 2.6).state == GateState::red ? 1 : 0;
  }
  EXPECT_LE(red, 10);
}

// On 50 values of lognormal(1.5) the t test at .05 rejects a true mean 18 times too often from
// below. Those samples are rare behind the gate. Power of the gate: .99.
TEST(UnpilotedGates, TurnAwaySkewedSamples) {
  Philox random(2);
  int red = 0;
  for (int k = 0; k < 1000; ++k) {
    const Moments x = draw_moments(50, [&] { return std::exp(1.5 * random.normal()); });
    red += unpiloted_skewness_gate(x, 1.96).state == GateState::red ? 1 : 0;
  }
  EXPECT_GE(red, 950);
}

}  // namespace
}  // namespace assay::stats
