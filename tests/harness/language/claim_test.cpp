#include "harness/language/claim.h"

#include <gtest/gtest.h>

#include "tests/harness/refusal.h"

namespace assay::harness {
namespace {

Claim parsed(const std::string& text) { return parse_claim(text, {"suite.yaml", 3, 11}); }

std::string refused(const std::string& text) {
  return refusal([&] { parse_claim(text, {"claim", 1, 1}); });
}

TEST(Claim, ReadsAMeanAgainstTheAnalyticReference) {
  const Claim claim = parsed("mean(area) == analytic");
  EXPECT_EQ(claim.text, "mean(area) == analytic");
  EXPECT_EQ(claim.left.row->word, "mean");
  EXPECT_EQ(claim.left.source, (Source{"area", ""}));
  EXPECT_EQ(claim.relation, Relation::equal);
  EXPECT_TRUE(std::holds_alternative<Analytic>(claim.right));
}

TEST(Claim, ReadsAConstantWithItsStandardError) {
  const Constant constant = std::get<Constant>(parsed("mean(area)==.481+-1e-4").right);
  EXPECT_EQ(constant.value, 0.481);
  EXPECT_EQ(constant.standard_error, 1e-4);
  EXPECT_EQ(std::get<Constant>(parsed("mean(a) == -3").right).value, -3);
  EXPECT_EQ(std::get<Constant>(parsed("mean(a) == +3").right).value, 3);
}

TEST(Claim, ReadsEveryRelation) {
  EXPECT_EQ(parsed("variance(a) <= 0.07").relation, Relation::at_most);
  EXPECT_EQ(parsed("variance(a) >= 0.07").relation, Relation::at_least);
  EXPECT_EQ(parsed("variance(a)<variance(b)").relation, Relation::less);
  EXPECT_EQ(parsed("variance(a) > variance(b)").relation, Relation::greater);
}

TEST(Claim, ReadsAMarginInPerCentAndAbsolute) {
  const Claim relative = parsed("mean(path) within 0.5% of analytic");
  EXPECT_EQ(relative.relation, Relation::within);
  EXPECT_EQ(relative.margin.value, 0.005);
  EXPECT_TRUE(relative.margin.relative);
  const Claim absolute = parsed("mean(path) within 2e-3 of 1");
  EXPECT_EQ(absolute.margin.value, 0.002);
  EXPECT_FALSE(absolute.margin.relative);
}

TEST(Claim, ReadsAFactorBeforeAQuantity) {
  const auto side = std::get<ScaledQuantity>(parsed("efficiency(w) > 1.1*efficiency(r)").right);
  EXPECT_EQ(side.factor, 1.1);
  EXPECT_EQ(side.quantity.source.estimator, "r");
}

TEST(Claim, ReadsSlopesQuantilesAndLaws) {
  const Claim slope = parsed("slope(bias(wis)) within 0.1 of -1");
  EXPECT_TRUE(slope.left.slope);
  EXPECT_EQ(slope.left.row->word, "bias");
  EXPECT_EQ(parsed("quantile(a, 0.25) <= 3").left.arguments, std::vector<double>{0.25});
  const Law law = std::get<Law>(parsed("distribution(a) == normal(1, 2)").right);
  EXPECT_EQ(law.name, "normal");
  EXPECT_EQ(law.arguments, (std::vector<double>{1, 2}));
  EXPECT_EQ(std::get<Law>(parsed("distribution(ward) == density").right).name, "density");
}

TEST(Claim, SplitsPartsAtTheFirstDot) {
  EXPECT_EQ(parsed("distribution(ward.direction.theta) == uniform(0, 1)").left.source,
            (Source{"ward", "direction.theta"}));
  EXPECT_EQ(parsed("mean(luminaire/area-2_x.0) == analytic").left.source,
            (Source{"luminaire/area-2_x", "0"}));
}

TEST(Claim, PutsPlacesOnTheColumnsOfTheFile) {
  const Claim claim = parsed("mean(area) == 2 * mean(hemisphere)");
  EXPECT_EQ(claim.left.where.column, 11);
  EXPECT_EQ(claim.left.source.where.column, 16);
  const auto& right = std::get<ScaledQuantity>(claim.right).quantity;
  EXPECT_EQ(right.where.column, 29);
  EXPECT_EQ(right.source.where.column, 34);
  EXPECT_EQ(right.source.where.line, 3);
}

TEST(Claim, SaysWhatWasExpectedAndWhere) {
  EXPECT_EQ(refused(""),
            "1:1: expected a quantity (mean, variance, distribution …), found the end");
  EXPECT_EQ(refused("maen(a) == 1"), "1:1: there is no quantity `maen`; did you mean `mean`?");
  EXPECT_EQ(refused("mean a == 1"), "1:6: expected `(` after `mean`, found `a`");
  EXPECT_EQ(refused("mean() == 1"), "1:6: expected the name of an estimator, found `)`");
  EXPECT_EQ(refused("mean(a == 1"), "1:8: expected `)` or `,`, found `==`");
  EXPECT_EQ(refused("mean(a) 1"),
            "1:9: expected `==`, `<=`, `>=`, `<`, `>` or `within … of`, found the number `1`");
  EXPECT_EQ(refused("mean(a) wihtin 1% of 2"),
            "1:9: expected `==`, `<=`, `>=`, `<`, `>` or `within … of`, found `wihtin`; did "
            "you mean `within`?");
  EXPECT_EQ(refused("mean(a) within small of 1"),
            "1:16: expected a margin, as `0.5%` or `0.002`, found `small`");
  EXPECT_EQ(refused("mean(a) within 1% 2"),
            "1:19: expected `of` after the margin, found the number `2`");
  EXPECT_EQ(refused("mean(a) within -1% of 2"), "1:16: a margin cannot be negative");
  EXPECT_EQ(refused("mean(a) == anlytic"),
            "1:12: `anlytic` is nothing that a quantity can be compared with; did you mean "
            "`analytic`?");
  EXPECT_EQ(refused("distribution(a) == nromal(0, 1)"),
            "1:20: `nromal` is nothing that a quantity can be compared with; did you mean "
            "`normal`?");
  EXPECT_EQ(refused("mean(a) == hemisphere"),
            "1:12: `hemisphere` is nothing that a quantity can be compared with; of an estimator, "
            "write its quantity, as in `mean(hemisphere)`");
  EXPECT_EQ(refused("mean(a) == zzz(1)"),
            "1:12: `zzz` is nothing that a quantity can be compared with; expected a number, "
            "`analytic`, a quantity as `mean(…)`, or a law as `uniform(0, 1)`");
  EXPECT_EQ(refused("area == analytic"),
            "1:1: expected a quantity, as in `mean(area)`, found `area`");
  EXPECT_EQ(refused("analytic == mean(a)"),
            "1:1: `analytic` stands on the right, as in `mean(area) == analytic` or "
            "`distribution(x) == normal(0, 1)`");
  EXPECT_EQ(refused("skewness(a) == 1"),
            "1:1: there is no quantity `skewness`; expected one of mean, bias, variance, "
            "total_variance, worst_variance, quantile, efficiency, cost, distribution, "
            "integral, inconsistency");
  EXPECT_EQ(refused("mean(a) == 0,25"),
            "1:13: the claim is over before `,`; decimals stand after a point");
  EXPECT_EQ(refused("mean(a) == 1 2"), "1:14: the claim is over before the number `2`");
  EXPECT_EQ(refused("1 == mean(a)"),
            "1:1: a claim begins with a quantity, as in `mean(area) == 0.5`");
  EXPECT_EQ(refused("mean(a) == 5%"),
            "1:13: a value has no per cent: write `0.05`, or a margin, as in `mean(a) within 5% of "
            "0.5`");
  EXPECT_EQ(refused("mean(a)"),
            "1:8: the claim says nothing of it yet: add `== analytic`, `<= 0.5`, …");
  EXPECT_EQ(refused("distribution(a) == gaussian(0, 1)"),
            "1:20: `gaussian` is nothing that a quantity can be compared with; did you mean "
            "`normal(0, 1)`?");
}

TEST(Claim, KnowsTheHabitsOfOtherLanguages) {
  EXPECT_EQ(refused("mean(a) = 1"), "1:9: a lone `=`; did you mean `==`?");
  EXPECT_EQ(refused("mean(a) != 1"),
            "1:9: a claim cannot be `!=`; claim `==` and expect it to fail, or claim `<` or `>`");
  EXPECT_EQ(refused("mean(a) ~= 1"),
            "1:9: write `==`, or `within 1% of` for what need only be close");
  EXPECT_EQ(refused("mean(a) == \"analytic\""), "1:12: no quotes inside a claim");
  EXPECT_EQ(refused("mean(a) - mean(b) == 0"),
            "1:9: a claim has no arithmetic; compare two quantities, as in `mean(a) == mean(b)` "
            "or `mean(a) == 2 * mean(b)`");
  EXPECT_EQ(refused("variance(a) < variance(b) * 0.5"),
            "1:27: a factor stands before its quantity: `0.5 * mean(b)`");
  EXPECT_EQ(refused("mean(a) == 2 * 0.24"),
            "1:16: a claim has no arithmetic; write the product as one number");
  EXPECT_EQ(refused("stddev(a) == 1"),
            "1:1: there is no quantity `stddev`; square it: `variance(…)`");
  EXPECT_EQ(refused("mean(a) ≤ 1"), "1:9: write `<=` for `≤`");
  EXPECT_EQ(refused("mean(a) == 1 ± 2"), "1:14: write `+-` for `±`");
  EXPECT_EQ(refused("mean(a.) == 1"), "1:7: the name of a part must follow the `.` at once");
  EXPECT_EQ(refused("mean(ä) == 1"), "1:6: `ä` has no meaning in a claim");
}

TEST(Claim, RefusesNumbersThatAreNone) {
  EXPECT_EQ(refused("mean(a) == 1e999"), "1:12: the number `1e999` does not fit a double");
  EXPECT_EQ(refused("mean(a) == 0e99999999999"),
            "1:12: the number `0e99999999999` does not fit a double");
  EXPECT_EQ(refused("mean(a) == 1 +- -2"), "1:17: a standard error cannot be negative");
  EXPECT_EQ(refused("mean(a) == inf").substr(0, 12), "1:12: `inf` ");
  EXPECT_EQ(refused("mean(a) == nan").substr(0, 12), "1:12: `nan` ");
}

TEST(Claim, RefusesSidesThatDoNotGoWithTheQuantity) {
  EXPECT_EQ(refused("mean(a) == uniform(0, 1)"),
            "1:12: `uniform` is a law, to which only `distribution(…)` can be equal");
  EXPECT_EQ(refused("variance(a) == density"),
            "1:16: `density` is a law, to which only `distribution(…)` can be equal");
  EXPECT_EQ(refused("distribution(a) == 3"),
            "1:1: a distribution is compared with `density`, a law or another distribution");
  EXPECT_EQ(refused("distribution(a) == analytic"),
            "1:1: `analytic` is a mean or a variance; there is none of `distribution`");
  EXPECT_EQ(refused("distribution(a) <= distribution(b)"),
            "1:1: laws are equal or not: `distribution(…)` goes with `==`, not with `<=`");
  EXPECT_EQ(refused("distribution(a) == 2 * distribution(b)"),
            "1:24: a distribution cannot be multiplied");
  EXPECT_EQ(refused("bias(a) == analytic"),
            "1:1: `analytic` is a mean or a variance; there is none of `bias`; claim "
            "`bias(…) == 0`");
  EXPECT_EQ(refused("mean(a) == variance(b)"),
            "1:12: `mean` on the left cannot be compared with `variance`; both sides must be the "
            "same quantity");
  EXPECT_EQ(refused("mean(a) == 0 * mean(b)"),
            "1:16: a factor of 0 leaves nothing to compare; give the number");
  EXPECT_EQ(refused("variance(a) == -1 * variance(b)"),
            "1:21: `variance` is never negative; the factor must be above 0");
  EXPECT_EQ(refused("variance(a) <= -1"),
            "1:1: `variance` is never negative, but it is compared with -1");
  EXPECT_EQ(refused("worst_variance(a.red) <= 1"),
            "1:16: `worst_variance` is over all channels; name the estimator alone, or use "
            "`variance`");
}

TEST(Claim, RefusesSlopesOfWhatHasNone) {
  EXPECT_EQ(refused("slope(slope(mean(a))) == 1"), "1:7: a slope has no slope");
  EXPECT_EQ(refused("slope(distribution(a)) == 1"), "1:1: a distribution has no slope");
  EXPECT_EQ(refused("slope(mean(a)) == slope(mean(b))"), "1:19: a slope is compared with a number");
  EXPECT_EQ(refused("slope(mean(a)) == analytic"),
            "1:1: `analytic` is a mean or a variance; there is none of `slope`");
}

TEST(Claim, RefusesMarginsThatMeanNothing) {
  EXPECT_EQ(refused("mean(a) within 0 of 1"),
            "1:1: a margin of 0 can never be shown; give one above 0");
  EXPECT_EQ(refused("mean(a) within 1% of 0"),
            "1:1: a margin in per cent of 0 is no margin; give a number");
}

TEST(Claim, RefusesWrongArguments) {
  EXPECT_EQ(refused("mean(a, 3) == 1"),
            "1:1: `mean` takes an estimator alone; only `quantile` has a number");
  EXPECT_EQ(refused("quantile(a) == 1"),
            "1:1: `quantile` takes an estimator and one probability: `quantile(x, 0.5)`");
  EXPECT_EQ(refused("quantile(a, 1) == 1"),
            "1:1: the probability of a quantile lies between 0 and 1, but it is 1");
  EXPECT_EQ(refused("distribution(a) == normal(0)"),
            "1:20: `normal` has 1 of its numbers; write normal(mean, sd)");
  EXPECT_EQ(refused("distribution(a) == exponential"),
            "1:20: `exponential` has 0 of its numbers; write exponential(rate)");
  EXPECT_EQ(refused("distribution(a) == normal(0, 0)"),
            "1:20: `sd` of normal(mean, sd) must be above 0, but it is 0");
  EXPECT_EQ(refused("distribution(a) == uniform(1, 0)"),
            "1:20: the numbers of uniform(low, high) must ascend");
  EXPECT_EQ(refused("distribution(a) == triangular(2, 2, 2)"),
            "1:20: triangular(low, mode, high) with equal ends has no density");
  EXPECT_EQ(refused("distribution(a) == density(1)"), "1:27: `density` takes no numbers");
}

TEST(Margin, IsAHundredthRoundedOnce) {
  EXPECT_EQ(parse_margin("0.1%", {}, "x").value, 0.001);
  EXPECT_EQ(parse_margin("0.1e0 %", {}, "x").value, 0.001);
  EXPECT_EQ(parse_margin("7 %", {}, "x").value, 0.07);
  EXPECT_EQ(to_string(parse_margin("7%", {}, "x")), "7%");
  EXPECT_EQ(to_string(Margin{0.002, false}), "0.002");
}

TEST(Margin, NamesWhatIsWrong) {
  EXPECT_EQ(refusal([] { parse_margin("5 %%", {}, "--detect"); }),
            "--detect must be a margin such as `0.5%` or `0.002`, but it is `5 %%`: the margin is "
            "over before `%`");
  EXPECT_EQ(refusal([] { parse_margin("-1", {}, "--detect"); }),
            "--detect must be a margin such as `0.5%` or `0.002`, but it is `-1`: a margin cannot "
            "be negative");
}

TEST(Source, IsAnEstimatorWithPerhapsAPart) {
  EXPECT_EQ(parse_source("ward.direction.theta", {}), (Source{"ward", "direction.theta"}));
  EXPECT_EQ(to_string(Source{"ward", "direction.theta"}), "ward.direction.theta");
  EXPECT_EQ(refusal([] {
              parse_source("a b", {"claim", 1, 1});
            }),
            "1:3: the source is over before `b`");
}

TEST(EstimatorName, IsWhatAClaimCanName) {
  for (const char* good : {"a", "_x", "luminaire/area", "MIS-2_b"}) {
    EXPECT_TRUE(is_estimator_name(good)) << good;
  }
  for (const char* bad : {"", "2a", "a.b", "a b", "-a", "a+", "ä", "a\n b"}) {
    EXPECT_FALSE(is_estimator_name(bad)) << bad;
  }
}

}  // namespace
}  // namespace assay::harness
