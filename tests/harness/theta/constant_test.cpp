#include "harness/theta/constant.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/harness/questions.h"

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
  - {name: nothing, claim: mean(nil) == mean(none)}
  - {name: nothing to find, claim: mean(nil) == mean(none), detect: 1%}
  - {name: two alike, claim: mean(spike) == 0.25 * mean(normal), detect: 0.4}
)";

struct Judged {
  Verdict verdict;
  std::string message;
};

/// The verdict of a test whose subjects were seen `count` times, always at `values`.
Judged judge(const std::string& name, std::uint64_t count, std::vector<double> values) {
  const auto asked = ask_text(suite);
  const Question& question = asked->question(name);
  std::vector<ChannelData> data(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::uint64_t k = 0; k < count; ++k) data[i].moments.add(values[i]);
  }
  const TestEntry& test = *question.test;
  Regions regions{.relation = test.claim.relation, .within = test.claim.margin.value};
  if (test.allow) regions.allow = test.allow->value;
  if (test.detect) regions.detect = test.detect->value;
  const ConstantVerdict verdict =
      judge_constant(question, 0, data, regions, {.alpha = 0.01, .beta = 0.01});
  return {verdict.verdict, verdict.message};
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

// A value that was unseen n times has probability at most 1 - 0.01^(1/n) at beta = 0.01. It can add
// at most 10 times that, which must be below the margin of 0.1. So n >= ln 0.01 / ln(1 - 0.01) =
// 458.2.
TEST(Constant, EqualToItsReferencePassesWhenTheRangeBoundsTheUnseen) {
  EXPECT_EQ(judge("detect", 459, {0.5}).verdict, Verdict::pass);
  EXPECT_EQ(judge("detect", 458, {0.5}).verdict, Verdict::inconclusive);
}

TEST(Constant, EqualToItsReferenceIsInconclusiveWithoutARange) {
  const Judged judged = judge("unbounded", 100000, {2});
  EXPECT_EQ(judged.verdict, Verdict::inconclusive);
  EXPECT_NE(judged.message.find("declare the range"), std::string::npos);
}

TEST(Constant, DifferentIsInvalidWhileTheUnseenCouldMakeUpTheDifference) {
  const Judged judged = judge("unseen", 1000, {0.5});
  EXPECT_EQ(judged.verdict, Verdict::invalid);
  EXPECT_NE(judged.message.find("unseen"), std::string::npos);
}

// 10 (1 - 0.01^(1/n)) < 0.01 from n = 4603 on: then a mean of 0.51 is refuted.
TEST(Constant, DifferentFailsOnceTheUnseenCannot) {
  EXPECT_EQ(judge("unseen", 4602, {0.5}).verdict, Verdict::invalid);
  EXPECT_EQ(judge("unseen", 4603, {0.5}).verdict, Verdict::fail);
}

TEST(Constant, DifferentOnTheSideWhereNothingLiesFailsAtOnce) {
  EXPECT_EQ(judge("too low", 10, {0.5}).verdict, Verdict::fail);
}

TEST(Constant, DifferentWithoutARangeIsNeverAFailure) {
  EXPECT_EQ(judge("other", 100000, {2}).verdict, Verdict::invalid);
}

TEST(Constant, BelowAnUpperBoundIsAsClaimed) {
  EXPECT_EQ(judge("bound", 10, {0.5}).verdict, Verdict::pass);
  EXPECT_EQ(judge("bound with detect", 10, {0.5}).verdict, Verdict::inconclusive);
  EXPECT_EQ(judge("bound with detect", 1000, {0.5}).verdict, Verdict::pass);
}

TEST(Constant, BelowALowerBoundFailsOnlyOnceTheUnseenCannotRaiseIt) {
  EXPECT_EQ(judge("lower bound", 10, {0.5}).verdict, Verdict::invalid);
  EXPECT_EQ(judge("lower bound", 1000, {0.5}).verdict, Verdict::fail);
}

TEST(Constant, ProvesAnInequalityWithItsRange) {
  EXPECT_EQ(judge("below", 10, {integral}).verdict, Verdict::pass);
  EXPECT_EQ(judge("above itself", 10, {0.5}).verdict, Verdict::pass);
  EXPECT_EQ(judge("below itself", 10, {0.5}).verdict, Verdict::fail)
      << "0.5 is the least value there is, so the mean cannot be below it";
}

TEST(Constant, IsProvedOrRefutedWithinAMargin) {
  EXPECT_EQ(judge("within", 10, {integral}).verdict, Verdict::pass);
  EXPECT_EQ(judge("not within", 10, {integral}).verdict, Verdict::fail);
}

TEST(Constant, MayDifferByWhatIsAllowed) {
  EXPECT_EQ(judge("allowed", 1000, {0.5}).verdict, Verdict::pass);
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

TEST(Constant, ComparesTwoByBothRanges) {
  EXPECT_EQ(judge("two", 1000, {0.5, 2}).verdict, Verdict::invalid);
  EXPECT_EQ(judge("two alike", 1000, {0.5, 2}).verdict, Verdict::inconclusive);
}

}  // namespace
}  // namespace assay::harness
