// Claims about laws beyond the default methods, from YAML to verdict. True claims pass, broken ones
// fail, and a method refuses what it cannot answer.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "harness/draws/consistency_setup.h"
#include "tests/harness/questions.h"
#include "tests/harness/refusal.h"
#include "tests/harness/running.h"

namespace assay::harness {
namespace {

using reports::Verdict;

const std::string estimators = R"(suite: claims
alpha: 0.0001
beta: 0.0001
estimators:
  normal: {plugin: analytic/normal, mean: 2, primaries: 1}
  again: {plugin: analytic/normal, mean: 2, primaries: 1}
  importance: {plugin: analytic/exponential_importance}
  ward: {plugin: brdf/ward}
  redrawn: {plugin: mutants/ward_redrawn}
  wide: {plugin: analytic/normal, mean: 2, deviation: 1.2, primaries: 1}
  hits: {plugin: luminaire/hemisphere, scene: triangle}
  hits_again: {plugin: luminaire/hemisphere, scene: triangle}
  area: {plugin: luminaire/area, scene: triangle}
  no_jacobian: {plugin: mutants/ward_no_jacobian}
  mirrored: {plugin: mutants/ward_weight_mirrored}
  no_cosine: {plugin: mutants/ward_weight_without_cosine}
  sector: {plugin: mutants/ward_density_sector}
  density: {plugin: brdf/ward, sampler: density_rejection}
tests:
  - )";

reports::Test tested(const std::string& test) { return run_test(estimators + test + "\n"); }

Verdict verdict_of(const std::string& test) { return run_verdict(estimators + test + "\n"); }

std::string refused(const std::string& test) {
  return refusal([&] { run_text(estimators + test + "\n"); });
}

// Ward's rejection sampler has no draws without a point, the other 2 %: more than the distance of
// the points tells.
TEST(TwoLaws, SayWhichPartRejects) {
  const reports::Test test = tested(
      "{claim: distribution(ward.direction.phi) == distribution(density.direction.phi), "
      "secondaries: 2000}");
  EXPECT_EQ(test.verdict, Verdict::fail) << test.message;
  EXPECT_THAT(test.message, testing::HasSubstr("p is that of the masses without a point"));
}

TEST(TwoLaws, OfDifferentDomainsAreNotCompared) {
  EXPECT_THAT(refused("{claim: distribution(area.point) == distribution(ward.direction)}"),
              testing::HasSubstr("points are u, v, the second's theta, phi"));
  EXPECT_EQ(verdict_of("{claim: distribution(area.point.u) == distribution(ward.direction.theta), "
                       "secondaries: 2000}"),
            Verdict::fail)
      << "one marginal of each, as asked";
}

TEST(Means, OfASamplerAreRefusedByName) {
  EXPECT_THAT(refused("{claim: mean(ward.direction) == analytic}"),
              testing::HasSubstr("`direction` is a sampler of `ward`"));
}

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

// Verdicts below are right with probability 1 - alpha - beta = 0.9998 at least, with the seed 1.

// Nine in ten values of `hits` are 0.
TEST(TwoLawsClaim, HoldsForLawsWithAFrequentValue) {
  const reports::Test same =
      tested("{claim: distribution(hits) == distribution(hits_again), detect: 0.1}");
  EXPECT_EQ(same.verdict, Verdict::pass) << same.message;
  EXPECT_EQ(same.method, "ks");
}

// The light is missed by more than nine in ten directions, and never by points on it.
TEST(TwoLawsClaim, FailsForAnotherShareOfAFrequentValueAndSaysWhich) {
  const reports::Test apart =
      tested("{claim: distribution(hits) == distribution(area), secondaries: 1000}");
  EXPECT_EQ(apart.verdict, Verdict::fail);
  EXPECT_THAT(apart.message, testing::HasSubstr("p is that of the values at 0, 0.9"));
}

TEST(TwoLawsClaim, IsRefusedForAMethodOfAnother) {
  EXPECT_EQ(refused("{claim: 'distribution(hits) == normal(0, 1)', test: chi-square-two-sample}"),
            "20:51: `test: chi-square-two-sample` does not answer this claim; there is `ks`");
}

TEST(TwoSampleCellsClaim, ComparesSamplersAndEstimatorsAsAWhole) {
  const reports::Test same = tested(
      "{claim: distribution(ward.direction) == distribution(ward.direction), test: "
      "chi-square-two-sample, secondaries: 20000}");
  EXPECT_EQ(same.verdict, Verdict::pass) << same.message;
  EXPECT_EQ(same.method, "chi-square-two-sample");
  EXPECT_EQ(same.channels[0].name, "cells");
  EXPECT_EQ(verdict_of("{claim: distribution(normal) == distribution(again), test: "
                       "chi-square-two-sample, detect: 0.3}"),
            Verdict::pass);
  // 2 % of Ward's draws are below the horizon, and no draw of its rejection sampler is.
  const reports::Test horizon = tested(
      "{claim: distribution(ward.direction) == distribution(density.direction), test: "
      "chi-square-two-sample, secondaries: 20000}");
  EXPECT_EQ(horizon.verdict, Verdict::fail);
  EXPECT_THAT(horizon.message, testing::HasSubstr("farthest apart in the draws without a point"));
  const reports::Test spread = tested(
      "{claim: distribution(normal) == distribution(wide), test: chi-square-two-sample, "
      "secondaries: 5000}");
  EXPECT_EQ(spread.verdict, Verdict::fail);
  EXPECT_THAT(spread.message, testing::HasSubstr("farthest apart in value"));
}

TEST(TwoSampleCellsClaim, IsRefusedWhereItHasNoAnswer) {
  EXPECT_EQ(refused("{claim: distribution(ward.direction) == distribution(normal), test: "
                    "chi-square-two-sample}"),
            "20:67: `chi-square-two-sample` counts in cells of one or two coordinates, the same of "
            "both sides, which have 2 and 1; name one channel of each");
  EXPECT_EQ(refused("{claim: distribution(ward.direction) == density, test: "
                    "chi-square-two-sample}"),
            "20:54: `test: chi-square-two-sample` does not answer this claim; there is "
            "`chi-square-fit`");
}

TEST(IntegralClaim, CountsTheMassWithoutAPoint) {
  EXPECT_EQ(verdict_of("{claim: integral(ward.direction) == 1, detect: 0.005}"), Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: integral(density.direction) within 0.001 of 1}"), Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: integral(importance) == 1}"), Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: integral(area.point) == 1}"), Verdict::pass);
  // 2 % below the horizon: drawn again, they are missing from the density and from the draws.
  EXPECT_EQ(verdict_of("{claim: integral(redrawn.direction) == 1, detect: 0.01}"), Verdict::fail);
  EXPECT_EQ(verdict_of("{claim: integral(redrawn.direction) within 0.001 of 0.980181}"),
            Verdict::pass);
  EXPECT_EQ(verdict_of("{claim: integral(no_jacobian.direction) == 1}"), Verdict::fail);
  EXPECT_EQ(verdict_of("{claim: integral(ward.direction) == 0.99, detect: 0.005}"), Verdict::fail);
}

TEST(IntegralClaim, IsRefusedWhereItMeansNothing) {
  EXPECT_EQ(refused("{claim: integral(normal) == 1}"),
            "20:22: `normal` has no sampler whose draws could be tested; it has `value`");
  EXPECT_EQ(refused("{claim: integral(ward.direction.theta) == 1}"),
            "20:22: `integral` and `inconsistency` are about a whole sampler: name "
            "`ward.direction`");
  EXPECT_EQ(refused("{claim: integral(ward.direction) == 1, detect: 1%}"),
            "20:52: a margin in per cent has no meaning here: this is a probability; give an "
            "absolute number");
  EXPECT_EQ(refused("{claim: integral(ward.direction) == 1 +- 0.1}"),
            "20:13: `integral` is held against an exact number: `+-` has no method here");
  EXPECT_EQ(refused("{claim: integral(ward.direction) == integral(density.direction)}"),
            "20:41: `integral` is compared with a number");
  EXPECT_EQ(refused("{claim: integral(ward.direction) == -1}"),
            "20:13: `integral` is never negative, but it is compared with -1");
  EXPECT_EQ(refused("{claim: slope(inconsistency(ward.direction)) == 1}"),
            "20:13: `inconsistency` is about a sampler, which has no slope");
}

TEST(InconsistencyClaim, HoldsForSoundSamplers) {
  for (const char* source : {"ward.direction", "density.direction", "importance", "area.point"}) {
    EXPECT_EQ(verdict_of("{claim: inconsistency(" + std::string(source) + ") == 0, detect: 1e-4}"),
              Verdict::pass)
        << source;
  }
}

TEST(InconsistencyClaim, FailsForEachDefectAndNamesCellAndDraw) {
  for (const char* source : {"no_cosine", "mirrored", "no_jacobian"}) {
    const std::string claim = "{claim: inconsistency(" + std::string(source) + ".direction) == 0}";
    EXPECT_EQ(verdict_of(claim),
              std::string(source) == "no_jacobian" ? Verdict::pass : Verdict::fail)
        << source << ": a density without its Jacobian is wrong and yet what the weight uses";
  }
  const reports::Test sector =
      tested("{claim: inconsistency(sector.direction) == 0, detect: 0.002}");
  EXPECT_EQ(sector.verdict, Verdict::fail);
  EXPECT_THAT(sector.message, testing::HasSubstr("phi 3.14 to 3.34"));
  EXPECT_THAT(sector.message, testing::HasSubstr("; the first is observation "));
  EXPECT_EQ(verdict_of("{claim: inconsistency(sector.direction) == 0, allow: 0.1, detect: 0.2}"),
            Verdict::pass)
      << "a hundredth of the azimuth, where the lobe is highest";
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
