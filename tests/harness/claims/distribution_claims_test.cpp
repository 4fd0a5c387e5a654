// Claims about laws beyond the default methods: what is shared, and what their records say. More of
// their verdicts are in tests/tables/verdicts.txt.

#include "harness/draws/consistency_setup.h"
#include "tests/harness/running.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

using reports::Verdict;

const std::string estimators = R"(suite: claims
alpha: 0.0001
beta: 0.0001
estimators:
  normal: {plugin: analytic/normal, mean: 2, primaries: 1}
  ward: {plugin: brdf/ward}
  redrawn: {plugin: mutants/ward_redrawn}
  hits: {plugin: luminaire/hemisphere, scene: triangle}
  hits_again: {plugin: luminaire/hemisphere, scene: triangle}
tests:
  - )";

reports::Test tested(const std::string& test) { return run_test(estimators + test + "\n"); }

// Two entries of one plugin share a pool. A claim that needs no density draws it first; its draws
// are still counted in the cells of the density. Two suites of one run do the same.
TEST(CellsOfADensity, AreCountedWhoeverElseDrawsOfThePool) {
  const std::string head =
      "suite: s\nestimators:\n  a: {plugin: brdf/ward}\n  b: {plugin: brdf/ward}\ntests:\n";
  const std::string law =
      "  - {name: law, claim: 'distribution(a.direction.phi) == uniform(0, 6.283185307179586)', "
      "secondaries: 2000}\n";
  const std::string cells =
      "  - {name: cells, claim: distribution(b.direction) == density, secondaries: 2000}\n";
  const std::string whole =
      "  - {name: whole, claim: integral(b.direction) == 1, secondaries: 2000}\n";
  const Workplace place;
  const std::string alone = place.write("alone.yaml", head + cells + whole);
  const std::string other = place.write("other.yaml", head + law);
  const reports::Suite expected = run_files({alone}).suites[0];
  EXPECT_EQ(expected.tests[0].verdict, Verdict::pass) << expected.tests[0].message;
  const auto expect_same = [&](const reports::Test& test, const reports::Test& as) {
    EXPECT_EQ(test.verdict, as.verdict) << test.message;
    EXPECT_EQ(test.channels.at(0).statistic, as.channels.at(0).statistic) << test.name;
    EXPECT_EQ(test.channels.at(0).log10_p, as.channels.at(0).log10_p) << test.name;
  };
  const std::string together = place.write("together.yaml", head + law + cells + whole);
  const reports::Suite shared = run_files({together}).suites[0];
  const reports::Record both = run_files({other, alone});
  for (std::size_t i = 0; i < 2; ++i) {
    expect_same(shared.tests[i + 1], expected.tests[i]);
    expect_same(both.suites[1].tests[i], expected.tests[i]);
  }
}

// So few doubles lie between its ends that some of 64 cells would be empty, and that rounded draws
// do not follow the density.
TEST(CellsOfADensity, OfAnIntervalAsNarrowAsRoundingAreFewer) {
  const reports::Test test = run_test(
      "suite: s\nalpha: 0.0001\nestimators:\n"
      "  tiny: {plugin: analytic/law, shift: 1.0e+9, scale: 1.0e-7}\n"
      "tests:\n  - {claim: distribution(tiny.x) == density, secondaries: 2000}\n");
  EXPECT_EQ(test.verdict, Verdict::fail) << test.message;
}

// Verdicts are right with probability 1 - alpha - beta = 0.9998 at least, with the seed 1.
// Nine in ten values of `hits` are 0.
TEST(TwoLawsClaim, HoldsForLawsWithAFrequentValue) {
  const reports::Test same =
      tested("{claim: distribution(hits) == distribution(hits_again), detect: 0.1}");
  EXPECT_EQ(same.verdict, Verdict::pass) << same.message;
  EXPECT_EQ(same.method, "ks");
}

TEST(TwoSampleCellsClaim, ComparesSamplersAndEstimatorsAsAWhole) {
  const reports::Test same = tested(
      "{claim: distribution(ward.direction) == distribution(ward.direction), test: "
      "chi-square-two-sample, secondaries: 20000}");
  EXPECT_EQ(same.verdict, Verdict::pass) << same.message;
  EXPECT_EQ(same.method, "chi-square-two-sample");
  EXPECT_EQ(same.channels[0].name, "cells");
}

TEST(InconsistencyClaim, OfADrawIsTheLargerOfTwoRelativeDifferences) {
  class One final : public Sampler {
   public:
    Domain domain() const override { return Domain::interval; }
    SamplerDraw sample(Stream&) const override { return {}; }
    double density(const Point&) const override { return 2; }
    double evaluate(const Point&) const override { return 3; }
  };
  const One sampler;
  EXPECT_EQ(inconsistency(sampler, {.density = 2, .weight = 1.5}), 0);
  EXPECT_NEAR(inconsistency(sampler, {.density = 2.2, .weight = 1.5}), 0.2 / 2.2, 1e-15);
  EXPECT_NEAR(inconsistency(sampler, {.density = 2, .weight = 3}), 0.5, 1e-15);
  EXPECT_EQ(inconsistency(sampler, {.weight = 0, .valid = false}), 0);
  EXPECT_TRUE(std::isinf(inconsistency(sampler, {.weight = 1, .valid = false})));
  EXPECT_TRUE(std::isnan(inconsistency(sampler, {.density = 2, .weight = std::nan("")})));
}

TEST(EmpiricalLaws, AreInTheRecordOfEveryTestOfValues) {
  const reports::Test one =
      tested("{claim: 'distribution(normal) == normal(2, 1)', secondaries: 500}");
  ASSERT_EQ(one.channels[0].laws.size(), 1U);
  const reports::EmpiricalLaw& law = one.channels[0].laws[0];
  EXPECT_EQ(law.source, "normal");
  EXPECT_EQ(law.points.size(), 63U);
  double before = 0;
  for (const reports::LawPoint& point : law.points) {
    EXPECT_GT(point.observed, before);
    before = point.observed;
    EXPECT_LE(point.low, *point.law) << "at 1e-4 the band holds the law, but once in 1e4 seeds";
    EXPECT_GE(point.high, *point.law);
    EXPECT_NEAR(*point.law, std::erfc((2 - point.value) / std::sqrt(2)) / 2, 1e-12);
  }
  const reports::Test two = tested(
      "{claim: distribution(ward.direction.theta) == distribution(redrawn.direction.theta), "
      "secondaries: 500}");
  ASSERT_EQ(two.channels[0].laws.size(), 2U);
  EXPECT_FALSE(two.channels[0].laws[1].points[0].law.has_value());
  EXPECT_GE(two.channels[0].laws[0].points[0].value, 0) << "draws without a point are left out";
  EXPECT_TRUE(tested("{claim: mean(normal) == 2}").channels[0].laws.empty());
}

}  // namespace
}  // namespace assay::harness
