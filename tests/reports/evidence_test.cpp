#include "reports/words/evidence.h"

#include "tests/prelude.h"

namespace assay::reports {
namespace {

reports::Test proof(Verdict verdict) {
  reports::Test test;
  test.claim = "variance(area) < variance(hemisphere)";
  test.method = "F";
  test.tail = "upper";
  test.verdict = verdict;
  test.alpha = 0.001;
  test.beta = 0.01;
  Channel channel;
  channel.p_value = 1;
  channel.log10_p = 0;
  channel.p_pass = 5e-324;
  channel.log10_p_pass = -811.6;
  test.channels = {channel};
  return test;
}

TEST(Evidence, TheRelationStandsOutsideAllBrackets) {
  EXPECT_EQ(relation_of("variance(a) < variance(b)"), "<");
  EXPECT_EQ(relation_of("mean(a) == analytic"), "==");
  EXPECT_EQ(relation_of("variance(a) <= 0.07"), "<=");
  EXPECT_EQ(relation_of("mean(path) within 0.5% of analytic"), "within");
  EXPECT_EQ(relation_of("mean(odd<name) == 1"), "==");
  EXPECT_EQ(relation_of(""), "");
}

TEST(Evidence, OnlyStrictInequalitiesAndNearnessAreProofs) {
  reports::Test test;
  for (const char* claim : {"a() < b()", "a() > 1", "a() within 1% of 2"}) {
    test.claim = claim;
    EXPECT_TRUE(is_proof(test)) << claim;
  }
  for (const char* claim : {"a() == b()", "a() <= 1", "a() >= 1", ""}) {
    test.claim = claim;
    EXPECT_FALSE(is_proof(test)) << claim;
  }
}

TEST(Evidence, TheContraryIsTheClaimTurnedRound) {
  EXPECT_EQ(contrary("variance(a) < variance(b)"), "variance(a) >= variance(b)");
  EXPECT_EQ(contrary("efficiency(a) > 1.1 * efficiency(b)"),
            "efficiency(a) <= 1.1 * efficiency(b)");
  EXPECT_EQ(contrary("mean(a) within 1% of 2"), "mean(a) not within 1% of 2");
  EXPECT_EQ(contrary("mean(a) == 2"), "");
}

TEST(Evidence, AProofThatPassedRestsOnThePValueOfTheContrary) {
  EXPECT_EQ(headline_p(proof(Verdict::pass)).text(), "p(contrary) = 2.5e-812");
  EXPECT_EQ(evidence_text(proof(Verdict::pass)), "p(contrary) = 2.5e-812 (F); beta is 0.01");
  EXPECT_EQ(exclusion_text(proof(Verdict::pass)),
            "p(claim) = 1 (F, upper); its share of alpha is 0.001");
}

TEST(Evidence, AProofThatFailedRestsOnThePValueOfTheClaim) {
  reports::Test test = proof(Verdict::fail);
  test.channels[0].log10_p = -9;
  EXPECT_EQ(headline_p(test).text(), "p(claim) = 1.0e-9");
}

TEST(Evidence, AProofOfSeveralChannelsRestsOnTheOneLeastExcluded) {
  reports::Test test = proof(Verdict::pass);
  Channel other = test.channels[0];
  other.log10_p_pass = -5;
  test.channels.push_back(other);
  EXPECT_EQ(headline_p(test).text(), "p(contrary) = 1.0e-5");
  test.channels[1].p_pass.reset();
  test.channels[1].log10_p_pass.reset();
  EXPECT_EQ(headline_p(test).name, "p(claim)");
}

TEST(Evidence, AnAlarmRestsOnThePValueOfTheClaim) {
  reports::Test test = proof(Verdict::pass);
  test.claim = "mean(area) == analytic";
  EXPECT_EQ(headline_p(test).text(), "p = 1");
  EXPECT_EQ(exclusion_text(test), "p = 2.5e-812 of an effect that must not pass; beta is 0.01");
}

TEST(Evidence, WhatUnderflowedAfterHolmIsWrittenFromItsLogarithm) {
  reports::Test test = proof(Verdict::fail);
  test.channels[0].p_adjusted = 5e-324;
  test.channels[0].log10_p_adjusted = -799.5;
  EXPECT_NE(evidence_text(test).find("3.2e-800 after Holm"), std::string::npos);
}

TEST(Evidence, HolmIsNamedOnlyWhereItChangesWhatIsWritten) {
  reports::Test test = proof(Verdict::fail);
  test.channels[0].p_value = 0.03;
  test.channels[0].log10_p = std::log10(0.03);
  test.channels[0].p_adjusted = test.channels[0].p_value;
  test.channels[0].log10_p_adjusted = test.channels[0].log10_p;
  EXPECT_EQ(evidence_text(test).find("Holm"), std::string::npos);
  test.channels[0].p_adjusted = 0.06;
  test.channels[0].log10_p_adjusted = std::log10(0.06);
  EXPECT_NE(evidence_text(test).find("= 0.03 (F, upper), 0.06 after Holm"), std::string::npos)
      << evidence_text(test);
}

}  // namespace
}  // namespace assay::reports
