
#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

Test claim_of(const std::string& claim, Verdict verdict, const Effect& effect) {
  reports::Test test = base(claim);
  test.verdict = verdict;
  test.ok = verdict == Verdict::pass;
  test.channels = {channel(effect)};
  return test;
}

std::string sentence(const std::string& claim, const Effect& effect) {
  return display(claim_of(claim, Verdict::fail, effect)).sentence;
}

TEST(Display, SaysOnWhichSideAnEstimateLies) {
  EXPECT_EQ(sentence("mean(a) == analytic", mean_effect(0.0107, 0.0101)),
            "mean(a) is 1.07\u00A0% above analytic (+0.06\u00A0% to +2.08\u00A0%).");
  EXPECT_EQ(sentence("mean(a) == mean(b)", mean_effect(-0.02, 0.01)),
            "mean(a) is 2\u00A0% below mean(b) (-3\u00A0% to -1\u00A0%).");
}

TEST(Display, WhatDoesNotFailSaysWhatWasAskedForAndSeveralChannelsWhich) {
  reports::Test test =
      claim_of("mean(a) == analytic", Verdict::inconclusive, mean_effect(0.0107, 0.0201));
  EXPECT_THAT(display(test).sentence, EndsWith("); 0.5\u00A0% must be caught."));
  test.channels.push_back(test.channels[0]);
  test.channels[0].name = "r";
  EXPECT_THAT(display(test).sentence, EndsWith(") in channel r; 0.5\u00A0% must be caught."));
}

TEST(Display, FactorsAndQuantitiesWithoutASideKeepTheirWords) {
  const Effect factor{"ln(ratio of variances)", 2.302585092994046, 2, 2.5, 0.99, false};
  EXPECT_THAT(sentence("variance(a) == variance(b)", factor),
              HasSubstr("variance(a) is 10 times variance(b) (×7.39 to ×12.2)"));
  const Effect distance{"largest distance between distribution functions", .2, .1, {}, .99, false};
  EXPECT_THAT(sentence("distribution(a.x) == distribution(b.x)", distance),
              HasSubstr("largest distance between distribution functions is +0.2 (at least +0.1)"));
}

TEST(Display, APassWhoseRangeLeavesTheClaimOutSaysSo) {
  reports::Test test = claim_of("mean(a) == analytic", Verdict::pass, mean_effect(-0.002, 0.001));
  EXPECT_THAT(display(test).sentence, HasSubstr("It is off, but by less than 0.5\u00A0%."));
  test.detect.reset();
  EXPECT_THAT(display(test).sentence, HasSubstr("That is not enough evidence against the claim."));
  test.allow = 0.0015;
  EXPECT_THAT(display(test).sentence, testing::Not(HasSubstr("not enough evidence")));
}

TEST(Display, AnImageWithoutAnEffectIsHeadlinedByItsPlace) {
  reports::Test test = failing();
  test.image->winner.effect.reset();
  EXPECT_THAT(display(test).sentence, HasSubstr("x 2-3, y 1-2 of green is too dark"));
}

TEST(Display, ChancesHaveTwoDigits) {
  reports::Test test = claim_of("mean(a) == analytic", Verdict::fail, mean_effect(0.02, 0.01));
  const auto chance = [&](double log10_p) {
    test.channels[0].log10_p = log10_p;
    return display(test).chance;
  };
  EXPECT_EQ(chance(std::log10(1 / 17234.0)), "1 in 17,000");
  EXPECT_EQ(chance(-6.5), "1 in 3,200,000");
  EXPECT_EQ(chance(std::log10(0.04)), "1 in 25");
  EXPECT_EQ(chance(-0.1), "more than 1 in 2");
  EXPECT_EQ(chance(-300), "less than 1 in a billion");
}

Test broken_claim(const std::string& name, const std::vector<std::string>& estimators) {
  reports::Test test = claim_of(name, Verdict::fail, mean_effect(0.02, 0.01));
  for (const std::string& estimator : estimators) test.samples.push_back(sample(estimator));
  if (estimators.size() == 2) test.claim = estimators[0] + " == " + estimators[1];
  return test;
}

TEST(Suspects, AreTheEstimatorsOnTheLeftOfBrokenClaims) {
  Suite suite;
  suite.name = "s";
  suite.tests = {broken_claim("1", {"shared", "a"}), broken_claim("2", {"shared", "b"}),
                 broken_claim("3", {"c", "b"}), broken_claim("4", {"dead", "b"})};
  suite.tests[3].samples.erase(suite.tests[3].samples.begin());
  suite.tests.push_back(broken_claim("5", {"shared", "c"}));
  suite.tests.back().ok = true;
  for (const char* name : {"6", "7"}) suite.tests.push_back(broken_claim(name, {"sound", "x"}));
  for (auto* test : {&suite.tests[5], &suite.tests[6]}) test->verdict = Verdict::error;
  const std::vector<Suspect> found = suspects(suite);
  ASSERT_EQ(found.size(), 4u);
  EXPECT_THAT(found[3].tests, ElementsAre("triangle/6", "triangle/7"));
  EXPECT_EQ(found[0].name, "shared");
  EXPECT_THAT(found[0].tests, ElementsAre("triangle/1", "triangle/2"));
  EXPECT_EQ(found[0].sentence, "2 of its 3\u00A0claims broken");
  EXPECT_EQ(found[1].name, "c");
  EXPECT_EQ(found[1].sentence, "1 of its 2\u00A0claims broken");
  EXPECT_EQ(found[2].name, "4");
  EXPECT_THAT(found[2].sentence, IsEmpty());
}

RC_GTEST_PROP(Suspects, HoldEveryBrokenClaimOnce, ()) {
  for (const Suite& suite : random_record().suites) {
    std::multiset<std::string> broken, named;
    for (const reports::Test& test : suite.tests) {
      const Standing how = standing(test);
      if (how == Standing::broken || how == Standing::no_verdict) broken.insert(test.id);
    }
    for (const Suspect& suspect : suspects(suite)) {
      named.insert(suspect.tests.begin(), suspect.tests.end());
    }
    RC_ASSERT(broken == named);
  }
}

}  // namespace
}  // namespace assay::reports
