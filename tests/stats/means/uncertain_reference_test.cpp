#include "stats/means/uncertain_reference.h"

#include "stats/tails/tails.h"
#include "stats/variances/influence.h"
#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

// Z test of a mean, one-sided: ln P(Z >= (10 - t) / 1).
double log_p_of_mean(std::span<const double> truth) { return normal_tails(10 - truth[0]).upper; }

TEST(UncertainReference, AnExactReferenceChangesNothing) {
  const std::array exact{UncertainReference{.known = {7, 0}}};
  const double truth = 7;
  EXPECT_EQ(log_p_over_references(log_p_of_mean, exact), log_p_of_mean({&truth, 1}));
}

// By its definition: a tenth of p leaves an interval of references, and the sample rejects at 0.9 p
// given the worst of them.
TEST(UncertainReference, PIsWhereTheWorstReferenceRejects) {
  for (const double error : {.01, .3, 2.0}) {
    const std::array reference{UncertainReference{.known = {7, error}}};
    const double log_p = log_p_over_references(log_p_of_mean, reference);
    const double worst = 7 + error * normal_quantile({Tail::upper, log_p + std::log(.05)});
    EXPECT_NEAR(log_p_of_mean({&worst, 1}), log_p + std::log(.9), 1e-7) << error;
  }
}

TEST(UncertainReference, TheTurnIsLookedAt) {
  // p is 1 in a sliver about t = 7.05 alone, between two of the nine places.
  const auto sliver = [](std::span<const double> truth) {
    return std::abs(truth[0] - 7.05) < 1e-6 ? 0.0 : -50.0;
  };
  const std::array without{UncertainReference{.known = {7, 1}, .turn = 7}};
  const std::array with{UncertainReference{.known = {7, 1}, .turn = 7.05}};
  EXPECT_LT(log_p_over_references(sliver, without), -40);
  EXPECT_EQ(log_p_over_references(sliver, with), 0);
}

// An estimator of variance 1 and of this bias against a reference of this error, n = 2000. The
// claim is the true mean squared error, both sides. With errors far beyond the bias an expansion in
// the reference fails a tenth of the runs at .01, or gives no number.
struct Case {
  double bias;
  double error;
};

JointMoments sample_of(Philox& random, double bias) {
  JointSums x;
  for (int i = 0; i < 2000; ++i) x.add(bias + random.normal(), 1);
  return x.moments();
}

double log_p_of_truth(Philox& random, Case of, double claimed_error) {
  const JointMoments x = sample_of(random, of.bias);
  const std::array reference{UncertainReference{
      .known = {of.error * random.normal(), claimed_error}, .turn = x.of_x.mean}};
  const double log_error = std::log(1 + of.bias * of.bias);
  const auto p = [&](bool upper) {
    return log_p_over_references(
        [&](std::span<const double> truth) {
          const TestResult result =
              influence_t(influence_of_error_and_cost(x, truth[0]), log_error);
          return upper ? result.log_p_upper : result.log_p_lower;
        },
        reference);
  };
  return std::min(0.0, std::numbers::ln2 + std::min(p(true), p(false)));
}

TEST(UncertainReference, OfAMeanSquaredErrorKeepsItsLevelWhateverItsSize) {
  std::uint32_t test_case = 361;
  for (const Case of : {Case{0, .003}, {0, .3}, {0, 10}, {.3, .03}, {1, .03}, {1, 1}, {10, 3}}) {
    SCOPED_TRACE(testing::Message() << "bias " << of.bias << ", error " << of.error);
    expect_calibrated({test_case++, tests::repetitions(2000), Shape::at_most_uniform},
                      [&](Philox& random) { return log_p_of_truth(random, of, of.error); });
  }
}

CAUGHT(UncertainReference, HalfTheErrorIsNoticed, 368, 2000, Shape::at_most_uniform) {
  return log_p_of_truth(random, {1, .3}, .15);
}

}  // namespace
}  // namespace assay::stats
