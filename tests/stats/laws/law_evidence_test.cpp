#include "stats/laws/law_evidence.h"

#include "stats/means/binomial.h"
#include "tests/philox.h"
#include "tests/prelude.h"

namespace assay::stats {
namespace {

Points uniform_points(std::uint64_t draws, std::uint64_t missing, tests::Philox& random) {
  Points points{.draws = draws, .of_a_sampler = true};
  for (std::uint64_t i = missing; i < draws; ++i) points.sorted.push_back(random.uniform());
  std::sort(points.sorted.begin(), points.sorted.end());
  return points;
}

DeclaredLaw uniform_law(double missing, double error = 0) {
  return {.law = [](double x) { return x; }, .error = error, .missing = missing};
}

double p_of(const Evidence& evidence) { return std::exp(evidence.at(0).log_p_upper); }

TEST(LawEvidence, MissingMassThatWasNotDeclaredRejects) {
  tests::Philox random(1);
  const Points points = uniform_points(20000, 400, random);
  EXPECT_GT(p_of(points_against_law(points, uniform_law(0.02))), 1e-4);
  EXPECT_LT(p_of(points_against_law(points, uniform_law(0.03))), 1e-9);
  EXPECT_LT(p_of(points_against_law(points, uniform_law(0))), 1e-9);
  const Points whole = uniform_points(20000, 0, random);
  EXPECT_LT(p_of(points_against_law(whole, uniform_law(0.02))), 1e-9);
  EXPECT_LT(p_of(points_against_points(points, whole)), 1e-9);
}

// Binomial(20000, 0.02) at 500: twice the tail, and twice that for the two parts.
TEST(LawEvidence, SharesTheLevelBetweenPointsAndMissingMass) {
  tests::Philox random(1);
  const Points points = uniform_points(20000, 500, random);
  double tail = 0;
  for (int k = 500; k < 2000; ++k) {
    tail += std::exp(std::lgamma(20001) - std::lgamma(k + 1) - std::lgamma(20001 - k) +
                     k * std::log(0.02) + (20000 - k) * std::log1p(-0.02));
  }
  EXPECT_NEAR(p_of(points_against_law(points, uniform_law(0.02))) / (4 * tail), 1, 1e-6);
}

// In 20000 draws .04 yield no point where .01 should. That is some hundreds of standard errors, and
// less than the points' distance of .07.
TEST(LawEvidence, SaysOfWhichPartThePIsAtTheMarginThatIsTested) {
  tests::Philox random(1);
  Points points = uniform_points(20000, 800, random);
  for (double& x : points.sorted) x = std::pow(x, 1.2);
  const Evidence evidence = points_against_law(points, uniform_law(0.01));
  EXPECT_THAT(evidence.most_against(0),
              testing::HasSubstr("the masses without a point decide: their shares are 0.03 apart"));
  EXPECT_EQ(evidence.most_against(0.05), "");
}

TEST(LawEvidence, PointsHaveTheWholeLevelWhereNoMassIsMissing) {
  tests::Philox random(1);
  const Points points = uniform_points(1000, 0, random);
  const auto distance = ks_distance(points.sorted, uniform_law(0).law);
  EXPECT_EQ(points_against_law(points, uniform_law(0)).at(0).log_p_upper,
            kolmogorov_smirnov(distance).log_p_upper);
}

// The masses decide neither end, the upper one, both.
TEST(LawEvidence, AnIntervalReachesAsFarAsThatOfEitherPart) {
  tests::Philox random(1);
  constexpr double confidence = 0.98;
  constexpr double halved = 1 - (1 - confidence) / 2;
  const Points whole = uniform_points(3000, 0, random);
  for (const std::uint64_t missing : {0u, 150u, 1500u}) {
    const Points points = uniform_points(3000, missing, random);
    const Evidence of_points =
        points_against_points({.sorted = points.sorted}, {.sorted = whole.sorted});
    const TwoValued one{.range = {0, 1}, .high = {.successes = missing, .trials = 3000}};
    const TwoValued other{.range = {0, 1}, .high = {.successes = 0, .trials = 3000}};
    const auto low = two_valued_difference_interval(one, other, halved).low;
    const auto high = two_valued_difference_interval(one, other, confidence).high;
    const Interval found = points_against_points(points, whole).interval(confidence);
    EXPECT_EQ(found.low, std::max(of_points.interval(halved).low, low)) << missing;
    EXPECT_EQ(found.high, std::max(of_points.interval(confidence).high, high)) << missing;
  }
}

// A table's error e reduces the distance against the claim, and raises it for the claim.
TEST(LawEvidence, TheTablesErrorCountsAgainstEveryConclusion) {
  tests::Philox random(1);
  const Points points = uniform_points(10000, 0, random);
  const DeclaredLaw off{.law = [](double x) { return std::clamp(x + 0.03, 0.0, 1.0); },
                        .error = 0.03};
  const Evidence evidence = points_against_law(points, off);
  EXPECT_GT(p_of(evidence), 1e-4);
  DeclaredLaw exact = off;
  exact.error = 0;
  const Evidence blunt = points_against_law(points, exact);
  EXPECT_LT(p_of(blunt), 1e-4);
  EXPECT_EQ(evidence.estimate, blunt.estimate);
  EXPECT_LT(evidence.interval(0.99).low, blunt.interval(0.99).low);
  EXPECT_GT(evidence.interval(0.99).high, blunt.interval(0.99).high);
  EXPECT_GT(evidence.at(0.07).log_p_lower, blunt.at(0.07).log_p_lower);
}

TEST(LawEvidence, IntervalHoldsTheLargerOfBothDistances) {
  tests::Philox random(1);
  const Points x = uniform_points(20000, 2000, random);
  const Points y = uniform_points(20000, 400, random);
  const Evidence evidence = points_against_points(x, y);
  EXPECT_NEAR(evidence.estimate, 0.08, 1e-12);
  const Interval interval = evidence.interval(0.99);
  EXPECT_LT(interval.low, 0.08);
  EXPECT_GT(interval.low, 0.06);
  EXPECT_GT(interval.high, 0.08);
  EXPECT_GT(std::exp(evidence.at(0.08).log_p_upper), 0.1);
  EXPECT_LT(std::exp(evidence.at(0.2).log_p_lower), 1e-9) << "it is shown to be less";
}

// Under the null hypothesis, of 10000 experiments with 300 draws and 5 % missing: rejections at
// 0.05 exceed nominal by no more than chance. False alarm 1e-5: 4.27 standard deviations.
TEST(LawEvidence, KeepsItsLevel) {
  tests::Philox random(1);
  constexpr int runs = 10000;
  int one = 0, two = 0;
  for (int run = 0; run < runs; ++run) {
    const auto draw = [&] {
      std::uint64_t missing = 0;
      for (int i = 0; i < 300; ++i) missing += random.uniform() < 0.05;
      return uniform_points(300, missing, random);
    };
    const Points x = draw();
    one += p_of(points_against_law(x, uniform_law(0.05))) <= 0.05;
    if (run % 20 == 0) two += p_of(points_against_points(x, draw())) <= 0.05;
  }
  const auto limit = [](double n) { return 0.05 * n + 4.27 * std::sqrt(n * 0.05 * 0.95); };
  EXPECT_LT(one, limit(runs));
  EXPECT_LT(two, limit(runs / 20.0));
  EXPECT_GT(one, 0.02 * runs) << "nor is it idle";
}

TEST(LawEvidence, WithoutAPointThereIsNothingToTest) {
  const Points none{.draws = 10, .of_a_sampler = true};
  EXPECT_THROW(points_against_law(none, uniform_law(0)), std::domain_error);
}

}  // namespace
}  // namespace assay::stats
