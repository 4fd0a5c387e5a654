#include "reports/words/describe.h"
#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

reports::Test proof(Verdict verdict) {
  reports::Test test = judged(verdict);
  test.claim = "variance(area) < variance(hemisphere)";
  test.method = "F";
  test.tail = "upper";
  test.alpha = 0.001;
  test.beta = 0.01;
  test.channels = {{.p_value = 1, .log10_p = 0, .p_pass = 5e-324, .log10_p_pass = -811.6}};
  return test;
}

TEST(Evidence, AProofThatPassedRestsOnThePValueOfTheContrary) {
  EXPECT_EQ(headline_p(proof(Verdict::pass)).text(), "p(contrary) = 2.5e-812");
  EXPECT_EQ(evidence_text(proof(Verdict::pass)),
            "p(contrary) = 2.5e-812 (F); a pass needs p at most 0.01 (beta)");
  EXPECT_EQ(exclusion_text(proof(Verdict::pass)),
            "p(claim) = 1 (F, upper); its share of alpha is 0.001");
}

TEST(Evidence, APValueNearOneIsPlain) {
  EXPECT_EQ((NamedP{"p", 0.9995, {}}.text()), "p = 0.9995");
  EXPECT_EQ((NamedP{"p", 0.99999, {}}.text()), "p above 0.9999");
}

TEST(Evidence, AProofThatFailedRestsOnThePValueOfTheClaim) {
  reports::Test test = proof(Verdict::fail);
  test.channels[0].log10_p = -9;
  EXPECT_EQ(headline_p(test).text(), "p(claim) = 1.0e-9");
}

TEST(Evidence, AProofOfSeveralChannelsRestsOnTheOneLeastExcluded) {
  reports::Test test = proof(Verdict::pass);
  test.channels.push_back(test.channels[0]);
  test.channels[1].log10_p_pass = -5;
  EXPECT_EQ(headline_p(test).text(), "p(contrary) = 1.0e-5");
  test.channels[1].p_pass.reset();
  test.channels[1].log10_p_pass.reset();
  EXPECT_EQ(headline_p(test).name, "p(claim)");
}

TEST(Evidence, AnAlarmRestsOnThePValueOfTheClaim) {
  reports::Test test = proof(Verdict::pass);
  test.claim = "mean(area) == analytic";
  test.detect = 0.5;
  EXPECT_EQ(headline_p(test).text(), "p = 1");
  EXPECT_EQ(exclusion_text(test),
            "p = 2.5e-812 if the error is 0.5; a pass needs p at most 0.01 (beta)");
}

TEST(Evidence, WhatUnderflowedAfterHolmIsWrittenFromItsLogarithm) {
  reports::Test test = proof(Verdict::fail);
  test.channels[0].p_adjusted = 5e-324;
  test.channels[0].log10_p_adjusted = -799.5;
  EXPECT_THAT(evidence_text(test), HasSubstr("3.2e-800 over all claims (Holm)"));
}

TEST(Evidence, HolmIsNamedOnlyWhereItChangesWhatIsWritten) {
  reports::Test test = proof(Verdict::fail);
  Channel& channel = test.channels[0];
  channel.p_value = channel.p_adjusted = 0.03;
  channel.log10_p = channel.log10_p_adjusted = std::log10(0.03);
  EXPECT_THAT(evidence_text(test), Not(HasSubstr("Holm")));
  channel.p_adjusted = 0.06;
  channel.log10_p_adjusted = std::log10(0.06);
  EXPECT_THAT(evidence_text(test), HasSubstr("= 0.03 (F, upper), 0.06 over all claims (Holm)"));
}

}  // namespace
}  // namespace assay::reports
