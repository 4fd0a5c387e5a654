#include "harness/theta/constant.h"

#include <gtest/gtest.h>

#include <cmath>

#include "harness/theta/decision.h"
#include "harness/theta/methods.h"
#include "tests/harness/questions.h"
#include "tests/harness/running.h"

namespace assay::harness {
namespace {

using reports::Verdict;

constexpr const char* suite = R"(suite: constants
estimators:
  zero: {plugin: analytic/zero_variance}                # its range is the constant, to rounding
  normal: {plugin: analytic/normal, mean: 2, deviation: 0}   # no range is declared
  nil: {plugin: analytic/normal, deviation: 0}
  none: {plugin: analytic/normal, deviation: 0}
  spike: {plugin: analytic/rare_spike, height: 10}      # values in [0.5, 10.5]
  dimmer: {plugin: analytic/rare_spike, height: 10}
tests:
  - {name: classical, claim: mean(spike) == 0.5}
  - {name: detect, claim: mean(spike) == 0.5, detect: 0.1}
  - {name: unbounded, claim: mean(normal) == 2, detect: 1%}
  - {name: unseen, claim: mean(spike) == 0.51}
  - {name: too low, claim: mean(spike) == 0.4}
  - {name: other, claim: mean(normal) == 3}
  - {name: bound, claim: mean(spike) <= 0.7}
  - {name: bound with detect, claim: mean(spike) <= 0.7, detect: 10%}
  - {name: lower bound, claim: mean(spike) >= 0.7}
  - {name: below, claim: mean(zero) < 7}
  - {name: below itself, claim: mean(spike) < 0.5}
  - {name: above itself, claim: mean(spike) > 0.49}
  - {name: within, claim: mean(zero) within 1% of 6.36}
  - {name: not within, claim: mean(zero) within 1% of 7}
  - {name: allowed, claim: mean(spike) == 0.499, allow: 1%, detect: 20%}
  - {name: uncertain, claim: mean(spike) == 0.4 +- 0.5}
  - {name: two, claim: mean(spike) == mean(normal), detect: 1%}
  - {name: two in ranges, claim: mean(spike) == mean(dimmer), detect: 0.4}
  - {name: nothing, claim: mean(nil) == mean(none)}
  - {name: nothing to find, claim: mean(nil) == mean(none), detect: 1%}
  - {name: two alike, claim: mean(spike) == 0.25 * mean(normal), detect: 0.4}
)";

struct Judged {
  Verdict verdict;
  std::string message;
};

Regions regions_of(const TestEntry& test) {
  Regions regions{.relation = test.claim.relation};
  if (regions.within()) regions.detect = test.claim.margin.value;
  if (test.allow) regions.allow = test.allow->value;
  if (test.detect) regions.detect = test.detect->value;
  return regions;
}

/// The verdict of a test whose subjects were seen `count` times, always at `values`.
Judged judge(const std::string& name, std::uint64_t count, std::vector<double> values) {
  const auto asked = ask_text(suite);
  const Question& question = asked->question(name);
  std::vector<ChannelData> data(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::uint64_t k = 0; k < count; ++k) data[i].moments.add(values[i]);
  }
  const Regions regions = regions_of(*question.test);
  const ConstantVerdict verdict = judge_constant(question, 0, data, regions);
  return {verdict.verdict, verdict.message};
}

/// The same by bets on the declared range, at alpha = beta = .01.
Verdict bet_on(const std::string& name, std::uint64_t count, std::vector<double> seen) {
  const auto asked = ask_text(suite);
  const Question& question = asked->question(name);
  std::vector<std::vector<double>> values;
  for (const double value : seen) values.emplace_back(count, value);
  std::vector<ChannelData> data(seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    data[i].values = values[i];
    for (const double value : values[i]) data[i].moments.add(value);
  }
  const Regions regions = regions_of(*question.test);
  const Evidence evidence = evidence_of(find_method(question, "betting"), question, 0, data);
  return decide({{.log_p_claimed = log_p_claimed(evidence, regions),
                  .log_p_forbidden = log_p_forbidden(evidence, regions),
                  .rejected = log_p_claimed(evidence, regions) <= std::log(.01)}},
                regions, .01);
}

const double integral = std::expm1(3) / 3;

TEST(Constant, IsSpreadWithinTheDeclaredRounding) {
  const auto asked = ask_text(suite);
  stats::Moments moments;
  moments.add(integral);
  moments.add(integral * (1 + 0x1p-45));
  EXPECT_TRUE(is_constant(asked->question("below"), 0, 0, moments));
  EXPECT_FALSE(is_constant(asked->question("other"), 0, 0, moments)) << "declares no rounding";
  moments.add(integral * (1 + 0x1p-30));
  EXPECT_FALSE(is_constant(asked->question("below"), 0, 0, moments));
}

TEST(Constant, EqualToItsReferencePassesAClassicalTest) {
  EXPECT_EQ(judge("classical", 10, {0.5}).verdict, Verdict::pass);
}

// Each value takes (0.6 - 0.5) / (10.5 - 0.6) of the stake from "the mean is at least 0.6". To 100
// times the 23 bets of the mixture it takes ln(2300) / ln(1.0101) = 770 values.
TEST(Constant, EqualToItsReferencePassesWhenTheRangeBoundsTheUnseen) {
  EXPECT_EQ(bet_on("detect", 775, {0.5}), Verdict::pass);
  EXPECT_EQ(bet_on("detect", 458, {0.5}), Verdict::inconclusive)
      << "(1 - 0.01)^458 is above 0.01: no test excludes it";
}

TEST(Constant, EqualToItsReferenceIsInconclusiveWithoutARange) {
  const Judged judged = judge("unbounded", 100000, {2});
  EXPECT_EQ(judged.verdict, Verdict::inconclusive);
  EXPECT_NE(judged.message.find("declare the range"), std::string::npos);
}

// (10.49 / 10.5)^n <= 0.005 from n = 5561 on, and a mixture of 23 takes ln(4600) / ln(10 / 9.99).
TEST(Constant, DifferentFailsOnceTheUnseenCannotMakeItUp) {
  EXPECT_EQ(bet_on("unseen", 5200, {0.5}), Verdict::pass) << "nothing is forbidden";
  EXPECT_EQ(bet_on("unseen", 8500, {0.5}), Verdict::fail);
}

TEST(Constant, DifferentOnTheSideWhereNothingLiesFailsAtOnce) {
  EXPECT_EQ(bet_on("too low", 2, {0.5}), Verdict::fail);
}

TEST(Constant, DifferentWithoutARangeIsNeverAFailure) {
  EXPECT_EQ(judge("other", 100000, {2}).verdict, Verdict::invalid);
}

TEST(Constant, BelowAnUpperBoundIsAsClaimed) {
  EXPECT_EQ(bet_on("bound", 10, {0.5}), Verdict::pass);
  EXPECT_EQ(bet_on("bound with detect", 10, {0.5}), Verdict::inconclusive);
  EXPECT_EQ(bet_on("bound with detect", 1000, {0.5}), Verdict::pass);
}

TEST(Constant, BelowALowerBoundFailsOnlyOnceTheUnseenCannotRaiseIt) {
  EXPECT_EQ(bet_on("lower bound", 10, {0.5}), Verdict::pass) << "nothing is forbidden";
  EXPECT_EQ(bet_on("lower bound", 1000, {0.5}), Verdict::fail);
}

TEST(Constant, ProvesAnInequalityWithItsRange) {
  EXPECT_EQ(bet_on("below", 2, {integral}), Verdict::pass);
  EXPECT_EQ(bet_on("above itself", 2, {0.5}), Verdict::pass);
  EXPECT_EQ(bet_on("below itself", 10, {0.5}), Verdict::inconclusive)
      << "0.5 is the least value there is, so the mean cannot be shown to be below it";
}

TEST(Constant, IsProvedOrRefutedWithinAMargin) {
  EXPECT_EQ(bet_on("within", 2, {integral}), Verdict::pass);
  EXPECT_EQ(bet_on("not within", 2, {integral}), Verdict::fail);
}

TEST(Constant, MayDifferByWhatIsAllowed) {
  EXPECT_EQ(bet_on("allowed", 1000, {0.5}), Verdict::pass);
}

TEST(Constant, CarriesTheReferencesError) {
  EXPECT_EQ(judge("uncertain", 100000, {0.5}).verdict, Verdict::invalid)
      << "0.1 off a reference known to 0.5 refutes nothing";
}

// A difference of 0 relative to 0 is none.
TEST(Constant, ComparesTwoZeros) {
  EXPECT_EQ(judge("nothing", 1000, {0, 0}).verdict, Verdict::pass);
  EXPECT_EQ(judge("nothing to find", 1000, {0, 0}).verdict, Verdict::inconclusive);
}

TEST(Constant, ComparesTwoWithoutARange) {
  EXPECT_EQ(judge("two", 1000, {0.5, 2}).verdict, Verdict::invalid);
  EXPECT_EQ(judge("two alike", 1000, {0.5, 2}).verdict, Verdict::inconclusive);
}

// The other's values lie in [0.5, 10.5] too.
// Bets bound what was never seen, so that a run needs no spread to compare by.
TEST(Constant, ComparesTwoByBetsInARun) {
  const std::string text = R"(suite: constants
estimators:
  low: {plugin: analytic/rare_spike, height: 10, probability: 0}
  high: {plugin: analytic/zero_variance}   # 6.36
tests:
  - {name: two constants, claim: mean(low) == mean(high), secondaries: 1000)";
  EXPECT_EQ(run_verdict(text + "}\n"), Verdict::fail);
  EXPECT_EQ(run_verdict(text + ", test: welch}\n"), Verdict::invalid);
}

TEST(Constant, ComparesTwoByBothRanges) {
  EXPECT_EQ(bet_on("two in ranges", 1000, {0.5, 9}), Verdict::fail);
  EXPECT_EQ(bet_on("two in ranges", 2000, {0.5, 0.5}), Verdict::pass);
  EXPECT_EQ(bet_on("two in ranges", 10, {0.5, 0.5}), Verdict::inconclusive);
}

}  // namespace
}  // namespace assay::harness
