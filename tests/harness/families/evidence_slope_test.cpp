#include "harness/plan/outcome.h"
#include "harness/theta/decision.h"
#include "harness/theta/methods.h"
#include "harness/theta/theta.h"
#include "tests/harness/questions.h"

namespace assay::harness {
namespace {

constexpr double beta = 0.01;

constexpr const char* suite = R"(suite: swept
estimators: {it: {plugin: analytic/ratio}}
tests:
  - {name: within, claim: slope(mean(it)) within 0.3 of -1, over: {primaries: [1, 2, 4, 8]}}
  - {name: alarm, claim: slope(mean(it)) == -1, over: {primaries: [1, 2, 4, 8]}}
)";

/// A million observations with this mean and this standard error of it.
ChannelData point(double mean, double standard_error) {
  constexpr double n = 1e6;
  const double m2 = standard_error * standard_error * n * (n - 1);
  return {.moments = {.count = 1000000,
                      .mean = mean,
                      .m2 = m2,
                      .m4 = 3 * m2 * m2 / n,
                      .minimum = mean - 1,
                      .maximum = mean + 1}};
}

/// 1, 1, 1/4 and 1/8 lie on no power law. With these errors the best slope has Q = 14 with 3
/// degrees of freedom, p = .0029. A test at .01 rejects every slope, and one at .001 none of those
/// around it.
std::array<ChannelData, 4> bent() {
  constexpr double error = 0.1066;
  return {point(1, error), point(1, error), point(.25, error), point(.125, error)};
}

/// The claim `test` of the suite, at its only look.
TestOutcome outcome_of(const Asked& asked, const std::string& test, ErrorShare share) {
  TestOutcome outcome{.question = asked.question(test), .place = {.inside = false, .share = share}};
  outcome.plan.method = methods_for(outcome.question).front();
  outcome.plan.looks = one_look(1000, outcome.place.share);
  outcome.plan.regions = {{.relation = Relation::equal}};
  if (outcome.question.test->claim.relation == Relation::within) {
    outcome.plan.regions = {{.relation = Relation::within, .detect = 0.3}};
  }
  return outcome;
}

std::string state_of(const std::string& test, ErrorShare share, std::span<const ChannelData> data,
                     const char* text = suite) {
  const auto asked = ask_text(text);
  const TestOutcome outcome = outcome_of(*asked, test, share);
  const std::vector<Gate> gates = outcome.question.theta->gates(
      outcome, {outcome.question, 0, data},
      critical_value(outcome.share().alpha, is_two_sided(outcome.question.test->claim.relation)));
  return gates.empty() ? "none" : gates.back().name + " " + gates.back().state;
}

// All slopes outside of the margin are rejected, as a proof demands, and so are all inside.
TEST(EvidenceOfSlope, WhereEverySlopeIsRejectedTheGateIsRed) {
  const auto asked = ask_text(suite);
  const std::array<ChannelData, 4> data = bent();
  const Question question = asked->question("within");
  const Evidence evidence = methods_for(question).front().evidence({question, 0, data});
  const Regions regions{.relation = Relation::within, .detect = 0.1};
  ASSERT_GT(std::abs(evidence.estimate), 0.1);
  ASSERT_LT(log_p_forbidden(evidence, regions), std::log(beta));
  EXPECT_EQ(state_of("within", {.alpha = 1e-4, .beta = beta}, data), "p of a power law red");
}

// A fail rests on rejecting the claimed slopes at alpha, a pass on rejecting the others at beta.
// The gate is green if neither empties the set.
TEST(EvidenceOfSlope, TheGateIsAtTheLevelsThatTheVerdictUses) {
  const std::array<ChannelData, 4> data = bent();
  EXPECT_EQ(state_of("within", {.alpha = 1e-4, .beta = 1e-4}, data), "p of a power law green");
  EXPECT_EQ(state_of("alarm", {.alpha = 1e-4, .beta = beta}, data), "p of a power law green")
      << "no pass by beta";
  EXPECT_EQ(state_of("alarm", {.alpha = beta, .beta = beta}, data), "p of a power law red");
}

TEST(EvidenceOfSlope, PointsOnAPowerLawAreGreen) {
  const std::array<ChannelData, 4> data{point(1, .01), point(.5, .01), point(.25, .01),
                                        point(.125, .01)};
  EXPECT_EQ(state_of("within", {.alpha = beta, .beta = beta}, data), "p of a power law green");
}

// Opposite signs, at two points: no multiple of a power is both.
TEST(EvidenceOfSlope, TwoPointsOfOppositeSignsAreRed) {
  const std::array<ChannelData, 2> data{point(1, .1), point(-1, .1)};
  EXPECT_EQ(state_of("t", {.alpha = beta, .beta = beta}, data, R"(suite: two
estimators: {it: {plugin: analytic/ratio}}
tests: [{name: t, claim: slope(mean(it)) within 0.3 of -1, over: {primaries: [1, 8]}}]
)"),
            "p of a power law red");
}

// Exactly 1, 1/2, 1/4 and 1/8: on a power law, but without an error to say how well.
TEST(EvidenceOfSlope, PointsWithoutSpreadAreSaidToHaveNoError) {
  const auto asked = ask_text(suite);
  std::array<ChannelData, 4> data;
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 100; ++k) data[static_cast<std::size_t>(i)].moments.add(std::ldexp(1, -i));
  }
  const TestOutcome outcome = outcome_of(*asked, "within", {.alpha = beta, .beta = beta});
  const Question& question = outcome.question;
  const auto verdict = question.theta->settled(outcome, {question, 0, data});
  EXPECT_THAT(verdict.value().message, HasSubstr("`it (primaries = 1)` is 1 but for rounding"));
  EXPECT_EQ(question.theta->settled(outcome, {question, 0, bent()}), std::nullopt);
}

}  // namespace
}  // namespace assay::harness
