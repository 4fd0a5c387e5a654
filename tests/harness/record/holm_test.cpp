#include "harness/families/families.h"
#include "harness/record/record_of.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

const Suite of_one_test{.tests = {TestEntry{}}};

/// A test of one channel, with this p-value if it has numbers.
FamilyMember judged_by_p(std::optional<double> p, double weight, Verdict verdict,
                         bool inside = true) {
  TestOutcome outcome;
  outcome.question.test = &of_one_test.tests[0];
  outcome.question.theta = &theta_of_means();
  outcome.question.subjects = {Subject{.channels = {0, 1, 1}}};
  outcome.place = {.inside = inside, .weight = weight};
  if (p) outcome.channels.emplace_back().decision.log_p_claimed = std::log(*p);
  return {{.verdict = verdict, .channels = std::vector<reports::Channel>(p ? 1 : 0)},
          place_in_family(outcome, of_one_test)};
}

std::vector<double> adjusted(std::vector<FamilyMember> tests) {
  adjust_p_values(tests);
  std::vector<double> p;
  for (const FamilyMember& each : tests) {
    for (const reports::Channel& channel : each.test.channels) {
      p.push_back(channel.p_adjusted.value_or(-1));
      EXPECT_NEAR(channel.log10_p_adjusted.value_or(0), std::log10(std::abs(p.back())), 1e-12);
    }
  }
  return p;
}

// The first p takes all of alpha, the second what the first leaves.
TEST(Holm, AdjustsByTheSharesThatSmallerPValuesFree) {
  const auto with = [&](Verdict first) {
    return adjusted({judged_by_p(1e-9, 0.5, first), judged_by_p(0.03, 0.5, Verdict::pass)});
  };
  EXPECT_THAT(with(Verdict::fail), Pointwise(DoubleNear(1e-15), {2e-9, 0.03}));
  // Invalid and error count as p = 1 and free nothing.
  for (const Verdict verdict : {Verdict::invalid, Verdict::error}) {
    EXPECT_THAT(with(verdict), Pointwise(DoubleNear(1e-15), {1., 0.06}));
  }
}

TEST(Holm, CountsATestWithoutNumbersAsNotRejected) {
  EXPECT_THAT(
      adjusted({judged_by_p({}, 0.5, Verdict::error), judged_by_p(0.03, 0.5, Verdict::pass)}),
      Pointwise(DoubleNear(1e-15), {0.06}));
}

TEST(Holm, IsNotForTestsOutsideTheFamily) {
  EXPECT_THAT(
      adjusted({judged_by_p(1e-9, 1, Verdict::fail), judged_by_p(0.03, 1, Verdict::pass, false)}),
      Pointwise(DoubleNear(1e-15), {1e-9, -1.}));
}

}  // namespace
}  // namespace assay::harness
