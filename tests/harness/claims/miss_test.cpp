// Misses: claims whose theta lies at the edge of the forbidden region, from YAML to the verdict.
// They pass with probability beta at most. The seeds are 1, 2, 3, ….

#include <fmt/format.h>

#include "stats/means/binomial.h"
#include "tests/harness/known_effects.h"
#include "tests/harness/many_seeds.h"
#include "tests/philox.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

using reports::Verdict;

constexpr double alpha = 0.1;
constexpr double beta = 0.1;

/// theta is `detect`, or sits at the margin.
struct AtTheEdge {
  std::string test;   ///< as in a suite, without braces
  std::string count;  ///< secondaries of a test of one look, too few to fail at 1e-6
  Shape shape = Shape::uniform;
};

const std::map<std::string, std::string> estimators = with_known_effects({
    {"normal", "plugin: analytic/normal, mean: 2, primaries: 1"},
    {"again", "plugin: analytic/normal, mean: 2, primaries: 1"},
    {"negative", "plugin: analytic/normal, mean: -2, primaries: 1"},
    {"shifted", "plugin: analytic/normal, mean: 2.5066942, primaries: 1"},
});

std::string suite_of(const std::vector<AtTheEdge>& claims, double level, bool one_look) {
  std::string tests;
  for (std::size_t i = 0; i < claims.size(); ++i) {
    tests += fmt::format("  - {{name: '{}', {}{}}}\n", i, claims[i].test,
                         one_look ? ", secondaries: " + claims[i].count : "");
  }
  return fmt::format("suite: misses\nalpha: {}\nbeta: {}\n{}tests:\n{}", level, beta,
                     estimators_of(estimators, tests), tests);
}

/// The verdict must be what the p-values say, seed by seed.
void expect_passes_at_beta(const std::string& name, const Outcomes& outcomes, double share) {
  for (std::size_t i = 0; i < outcomes.verdicts.size(); ++i) {
    // The gate of fit of a slope is red with probability beta at most (tests/stats/slope_test.cpp).
    const bool on_no_power_law =
        name.starts_with("claim: slope") && outcomes.verdicts[i] == Verdict::invalid;
    if (on_no_power_law) continue;
    const bool failed = outcomes.log_p[i] <= std::log(share);
    const bool excluded = outcomes.log_p_pass[i] <= std::log(beta);
    const Verdict expected = failed     ? Verdict::fail
                             : excluded ? Verdict::pass
                                        : Verdict::inconclusive;
    EXPECT_EQ(outcomes.verdicts[i], expected) << name << ", seed " << i + 1;
  }
}

// One look has so small an alpha that beta alone decides passes. `level` is larger for methods that
// are not valid so far out. The p-value of the forbidden region is uniform if its method is exact.
// Wrong alarms: 1.3e-5 for each claim.
void expect_misses(const std::vector<AtTheEdge>& claims, double level = 1e-6) {
  const std::string text = suite_of(claims, level, true);
  const std::size_t runs = tests::repetitions(2000);
  const auto outcomes = first_looks(runs, text);
  const auto whole = over_seeds(3, [&](std::uint64_t) { return text; });
  for (std::size_t i = 0; i < claims.size(); ++i) {
    const std::string name = std::to_string(i);
    expect_p_value(claims[i].test, outcomes.at(name).log_p_pass, claims[i].shape);
    const double passed = outcomes.at(name).share(Verdict::pass);
    EXPECT_FALSE(tests::too_many(passed, beta, static_cast<double>(runs)))
        << claims[i].test << ": passed " << passed;
    expect_passes_at_beta(claims[i].test, whole.at(name),
                          level / static_cast<double>(claims.size()));
  }
  expect_as_in_runs(text);
}

const std::vector<AtTheEdge> means{
    {"claim: mean(normal) == 1.6, detect: 0.4", "30"},
    {"claim: mean(normal) == 2.5, detect: 20%", "30"},
    {"claim: mean(negative) == -2.5, detect: 20%", "30"},
    {"claim: mean(normal) <= 1.6, detect: 0.4", "30"},
    {"claim: mean(normal) >= 2.5, detect: 20%", "30"},
    {"claim: mean(normal) == 1.6, allow: 0.1, detect: 0.4", "30"},
    {"claim: mean(normal) < 2", "30"},
    {"claim: mean(normal) > 2", "30"},
    {"claim: mean(normal) within 0.6 of 1.4", "60"},
};

TEST(Misses, OfMeansAgainstNumbersAreAtMostBeta) { expect_misses(means); }

const std::vector<AtTheEdge> two_means{
    {"claim: mean(normal) == 0.8 * mean(again), detect: 25%", "80"},
    {"claim: mean(normal) == -0.8 * mean(negative), detect: 0.4", "40"},
    {"claim: mean(normal) <= 0.8 * mean(again), detect: 25%", "80"},
    {"claim: mean(normal) >= 1.25 * mean(again), detect: 20%", "80"},
    {"claim: mean(normal) < mean(again)", "40"},
    {"claim: mean(normal) within 25% of 0.8 * mean(again)", "100", Shape::at_most_uniform},
};

TEST(Misses, OfTwoMeansAreAtMostBeta) { expect_misses(two_means); }

const std::vector<AtTheEdge> variances{
    {"claim: variance(normal) == 0.8, detect: 25%, test: chi-square", "150"},
    {"claim: variance(normal) <= 0.8, detect: 25%, test: chi-square", "150"},
    {"claim: variance(normal) >= 1.25, detect: 25%, test: chi-square", "150"},
    {"claim: variance(normal) < 1, test: chi-square", "150"},
    {"claim: variance(normal) within 50% of 0.6666666666666666, test: chi-square", "200"},
    {"claim: variance(normal) == 0.8 * variance(again), detect: 25%, test: F", "200",
     Shape::at_most_uniform},
    {"claim: variance(normal) <= 0.8 * variance(again), detect: 25%, test: F", "200"},
    {"claim: variance(normal) < variance(again), test: F", "200"},
    {"claim: variance(normal) within 50% of 0.6666666666666666 * variance(again), test: F", "400"},
};

TEST(Misses, OfVariancesAreAtMostBeta) { expect_misses(variances); }

// sup |Phi(x) - Phi(x - 0.5066942)| = .2.
const std::vector<AtTheEdge> laws{
    {"claim: 'distribution(normal) == normal(2.5066942, 1)', detect: 0.2", "150",
     Shape::at_most_uniform},
    {"claim: distribution(normal) == distribution(shifted), detect: 0.2", "300",
     Shape::at_most_uniform},
};

TEST(Misses, OfLawsAreAtMostBeta) { expect_misses(laws); }

const std::vector<AtTheEdge> quantiles_and_costs{
    {"claim: 'quantile(normal, 0.5) == 1.6', detect: 0.4", "60", Shape::at_most_uniform},
    {"claim: 'quantile(normal, 0.5) >= 2.4', detect: 0.4", "60", Shape::at_most_uniform},
    {"claim: 'quantile(normal, 0.5) <= 0.8 * quantile(again, 0.5)', detect: 0.4", "100",
     Shape::at_most_uniform},
    {"claim: cost(path) == 0.8 * cost(path_again), detect: 25%", "600", Shape::at_most_uniform},
    {"claim: cost(path) < cost(path_again)", "600"},
    {"claim: efficiency(normal) == 0.8 * efficiency(again), cost: samples, detect: 25%", "1200",
     Shape::at_most_uniform},
    {"claim: efficiency(normal) > efficiency(again), cost: samples", "1200"},
};

TEST(Misses, OfQuantilesCostsAndEfficienciesAreAtMostBeta) {
  expect_misses(quantiles_and_costs, 0.05);
}

const std::vector<AtTheEdge> slopes{
    {"claim: slope(mean(normal)) == 0.9, detect: 0.1, over: {mean: [1, 2, 4]}", "100",
     Shape::at_most_uniform},
    {"claim: slope(variance(normal)) == 1.8, detect: 0.2, over: {deviation: [1, 2, 4]}", "1200",
     Shape::at_most_uniform},
    {"claim: slope(variance(normal)) within 0.2 of 1.8, over: {deviation: [1, 2, 4]}", "1200",
     Shape::at_most_uniform},
};

TEST(Misses, OfSlopesAreAtMostBeta) { expect_misses(slopes, 0.05); }

TEST(Misses, OfCellsAreAtMostBeta) {
  const std::vector<AtTheEdge> cells{
      {fmt::format("claim: distribution(three_in_ten) == distribution(half), "
                   "test: chi-square-two-sample, detect: {:.17g}",
                   effect_of_halves()),
       "100", Shape::at_most_uniform},
      {fmt::format("claim: distribution(triangle.point) == density, detect: {:.17g}",
                   effect_of_triangle(12000)),
       "12000", Shape::at_most_uniform},
  };
  expect_misses(cells, 0.05);
}

/// A test planned for its `detect`, in looks: at 1e-4 no rate at most (or at least) `rate` shows so
/// many (few) of `runs`.
void expect_at_most(const std::string& name, double share, double rate, std::uint64_t runs) {
  const auto hits = static_cast<std::uint64_t>(std::lround(share * static_cast<double>(runs)));
  EXPECT_GT(stats::binomial({hits, runs}, rate).log_p_upper, std::log(1e-4))
      << name << ": " << hits << " of " << runs;
}

/// theta = 0 of the same claim, or the advantage planned for.
struct Planned {
  std::string at_edge;
  std::string in_claim;
};

const std::uint64_t planned_runs = tests::repetitions(200);

void expect_planned(const std::vector<Planned>& claims) {
  for (const Planned& claim : claims) {
    const auto passes = [&](const std::string& test) {
      const auto text = [&](std::uint64_t) { return suite_of({{test, ""}}, alpha, false); };
      return over_seeds(planned_runs, text).at("0").share(Verdict::pass);
    };
    expect_at_most(claim.at_edge, passes(claim.at_edge), beta, planned_runs);
    expect_at_most(claim.in_claim + " does not pass", 1 - passes(claim.in_claim), alpha + beta,
                   planned_runs);
  }
}

TEST(Misses, OfMeansPlannedInLooksAreAtMostBetaAndTrueClaimsPass) {
  expect_planned({
      {"claim: mean(normal) == 1.6, detect: 0.4", "claim: mean(normal) == 2, detect: 0.4"},
      {"claim: mean(normal) <= 1.8, detect: 0.2", "claim: mean(normal) <= 2, detect: 0.2"},
      {"claim: mean(normal) < 2, detect: 0.2", "claim: mean(normal) < 2.2, detect: 0.2"},
      {"claim: mean(normal) within 0.2 of 1.8", "claim: mean(normal) within 0.2 of 2"},
      {"claim: mean(normal) == 0.8 * mean(again), detect: 25%",
       "claim: mean(normal) == mean(again), detect: 25%"},
      {"claim: mean(normal) <= 0.9 * mean(again), detect: 0.2",
       "claim: mean(normal) <= mean(again), detect: 0.2"},
      {"claim: mean(normal) < mean(again), detect: 0.2",
       "claim: mean(normal) < 1.1 * mean(again), detect: 0.2"},
      {"claim: mean(normal) within 25% of 0.8 * mean(again)",
       "claim: mean(normal) within 25% of mean(again)"},
  });
}

TEST(Misses, OfVariancesPlannedInLooksAreAtMostBetaAndTrueClaimsPass) {
  expect_planned({
      {"claim: variance(normal) == 0.8, detect: 25%", "claim: variance(normal) == 1, detect: 25%"},
      {"claim: variance(normal) <= 0.8, detect: 25%", "claim: variance(normal) <= 1, detect: 25%"},
      {"claim: variance(normal) < 1, detect: 25%", "claim: variance(normal) < 1.25, detect: 25%"},
      {"claim: variance(normal) within 25% of 0.8", "claim: variance(normal) within 25% of 1"},
      {"claim: variance(normal) == 0.8 * variance(again), detect: 25%",
       "claim: variance(normal) == variance(again), detect: 25%"},
      {"claim: variance(normal) < variance(again), detect: 25%",
       "claim: variance(normal) < 1.25 * variance(again), detect: 25%"},
      {"claim: variance(normal) within 50% of 0.6666666666666666 * variance(again)",
       "claim: variance(normal) within 50% of variance(again)"},
  });
}

// The reference is drawn anew for every seed from the law that its error declares.
TEST(Misses, WithinAMarginOfAnUncertainReferenceAreAtMostBetaAndTrueClaimsPass) {
  const auto share = [](double mean) {
    const auto text = [&](std::uint64_t seed) {
      tests::Philox random(402, static_cast<std::uint32_t>(seed));
      const double reference = mean + 0.04 * random.normal();
      return suite_of(
          {{fmt::format("claim: mean(normal) within 0.2 of {:.17g} +- 0.04", reference), ""}},
          alpha, false);
    };
    return over_seeds(planned_runs, text).at("0").share(Verdict::pass);
  };
  expect_at_most("at the margin", share(1.8), beta, planned_runs);
  expect_at_most("in the middle, no pass", 1 - share(2), alpha + beta, planned_runs);
}

TEST(Misses, OfLawsPlannedInLooksAreAtMostBetaAndTrueClaimsPass) {
  expect_planned({
      {"claim: 'distribution(normal) == normal(2.5066942, 1)', detect: 0.2",
       "claim: 'distribution(normal) == normal(2, 1)', detect: 0.2"},
      {"claim: distribution(normal) == distribution(shifted), detect: 0.2",
       "claim: distribution(normal) == distribution(again), detect: 0.2"},
  });
}

}  // namespace
}  // namespace assay::harness
