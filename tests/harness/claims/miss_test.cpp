// Misses: claims whose theta lies at the edge of the forbidden region, from YAML to the verdict, of
// tests/tables/misses.txt. They pass with probability beta at most. The seeds are 1, 2, 3, ….

#include <fmt/format.h>

#include "stats/means/binomial.h"
#include "tests/harness/known_effects.h"
#include "tests/harness/many_seeds.h"
#include "tests/philox.h"

namespace assay::harness {
namespace {

constexpr double alpha = 0.1;
constexpr double beta = 0.1;

/// The verdict must be what the p-values say, seed by seed.
void expect_passes_at_beta(const std::string& claim, const Outcomes& outcomes, double share) {
  for (std::size_t i = 0; i < outcomes.verdicts.size(); ++i) {
    // The gate of fit of a slope is red with probability beta at most (tests/stats/slope_test.cpp).
    if (claim.starts_with("slope") && outcomes.verdicts[i] == Verdict::invalid) continue;
    const bool failed = outcomes.log_p[i] <= std::log(share);
    const bool excluded = outcomes.log_p_pass[i] <= std::log(beta);
    const Verdict expected = failed     ? Verdict::fail
                             : excluded ? Verdict::pass
                                        : Verdict::inconclusive;
    EXPECT_EQ(outcomes.verdicts[i], expected) << claim << ", seed " << i + 1;
  }
}

// Wrong alarms: 1.3e-5 for each claim.
void expect_misses(const std::vector<ClaimRow>& rows, double level) {
  std::vector<Shape> shapes;
  std::vector<std::string> claims;
  for (const ClaimRow& row : rows) {
    std::istringstream words(row.text);
    std::string shape, secondaries, claim;
    words >> shape >> secondaries >> std::ws;
    std::getline(words, claim);
    shapes.push_back(shape == "uniform" ? Shape::uniform : Shape::at_most_uniform);
    claims.push_back(with_effect(claim + ", secondaries: " + secondaries));
  }
  const std::string text = suite_of(claims, level, beta);
  const std::size_t runs = tests::repetitions(2000);
  const auto outcomes = first_looks(runs, text);
  const auto whole = over_seeds(3, [&](std::uint64_t) { return text; });
  for (std::size_t i = 0; i < claims.size(); ++i) {
    const std::string name = std::to_string(i);
    expect_p_value(claims[i], outcomes.at(name).log_p_pass, shapes[i]);
    const double passed = outcomes.at(name).share(Verdict::pass);
    EXPECT_FALSE(tests::too_many(passed, beta, static_cast<double>(runs)))
        << claims[i] << ": passed " << passed;
    expect_passes_at_beta(claims[i], whole.at(name), level / static_cast<double>(claims.size()));
  }
  expect_as_in_runs(text);
}

const std::uint64_t planned_runs = tests::is_long() ? 200 : 25;

/// The share of passes over the seeds, of tests in looks.
double passes(const std::function<std::string(std::uint64_t)>& claim) {
  const auto text = [&](std::uint64_t seed) { return suite_of({claim(seed)}, alpha, beta); };
  return over_seeds(planned_runs, text).at("0").share(Verdict::pass);
}

/// At 1e-4 no rate at most `rate` shows so many.
void expect_at_most(const std::string& name, double share, double rate) {
  const auto runs = static_cast<double>(planned_runs);
  const auto hits = static_cast<std::uint64_t>(std::lround(share * runs));
  EXPECT_GT(stats::binomial({hits, planned_runs}, rate).log_p_upper, std::log(1e-4))
      << name << ": " << hits << " of " << planned_runs;
}

class Misses : public TestWithParam<ClaimSection> {};

TEST_P(Misses, AreAtMostBetaAndPlannedClaimsPassWhereTheyAreTrue) {
  const std::size_t comma = GetParam().name.rfind(", ");
  if (comma != std::string::npos) {
    expect_misses(GetParam().rows, std::stod(GetParam().name.substr(comma + 2)));
    return;
  }
  for (const ClaimRow& row : GetParam().rows) {
    expect_at_most(row.text, passes([&](std::uint64_t) { return row.text; }), beta);
    const std::string in_claim = row.words.at(0);
    expect_at_most(in_claim + " does not pass", 1 - passes([&](std::uint64_t) { return in_claim; }),
                   alpha + beta);
  }
}

INSTANTIATE_TEST_SUITE_P(Table, Misses, ValuesIn(sections_of("misses.txt")), name_of_section);

// The reference is drawn anew for every seed from the law that its error declares.
TEST(MissesInLooks, WithinAMarginOfAnUncertainReferenceAreAtMostBetaAndTrueClaimsPass) {
  const auto share = [](double mean) {
    return passes([&](std::uint64_t seed) {
      tests::Philox random(402, static_cast<std::uint32_t>(seed));
      return fmt::format("mean(normal) within 0.2 of {:.17g} +- 0.04",
                         mean + 0.04 * random.normal());
    });
  };
  expect_at_most("at the margin", share(1.8), beta);
  expect_at_most("in the middle, no pass", 1 - share(2), alpha + beta);
}

}  // namespace
}  // namespace assay::harness
