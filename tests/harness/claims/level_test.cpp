// False alarms: p-values of single true claims, from YAML to the record, of
// tests/tables/levels.txt. Each p-value is valid at .1, .01 and .001, and uniform if its method is
// exact. A sound engine is called wrong with probability 1.3e-5 for each claim. The seeds are 1, 2,
// 3, ….

#include <fmt/format.h>

#include "tests/harness/known_effects.h"
#include "tests/harness/many_seeds.h"
#include "tests/philox.h"

namespace assay::harness {
namespace {

constexpr double rate_of_each = 0.1;  // alpha and beta of the suites

class Level : public TestWithParam<ClaimSection> {};

TEST_P(Level, IsWhatThePValuesSay) {
  std::vector<Shape> shapes;
  std::vector<std::string> claims;
  for (const ClaimRow& row : GetParam().rows) {
    shapes.push_back(row.text.starts_with("uniform ") ? Shape::uniform : Shape::at_most_uniform);
    claims.push_back(with_effect(row.text.substr(row.text.find(' ') + 1)));
  }
  const std::string text = suite_of(claims, rate_of_each, rate_of_each);
  const std::uint64_t seeds = std::stoul(GetParam().name.substr(GetParam().name.rfind(' ')));
  const bool in_looks = GetParam().name.starts_with("in looks");
  const auto outcomes =
      in_looks ? over_seeds(tests::repetitions(seeds), [&](std::uint64_t) { return text; })
               : first_looks(tests::repetitions(seeds), text);
  for (std::size_t i = 0; i < claims.size(); ++i) {
    expect_p_value(claims[i], outcomes.at(std::to_string(i)).log_p, shapes[i]);
  }
  if (!in_looks) expect_as_in_runs(text);
}

std::vector<ClaimSection> levels() {
  std::vector<ClaimSection> sections = sections_of("levels.txt");
  sections.erase(sections.begin());  // the estimators
  return sections;
}

INSTANTIATE_TEST_SUITE_P(Table, Level, ValuesIn(levels()), name_of_section);

// The reference is drawn anew for every seed from the law that its error declares.
TEST(Levels, AgainstAnUncertainReferenceAreWhatThePValuesSay) {
  std::map<std::string, Outcomes> outcomes;
  for (std::uint64_t seed = 1; seed <= tests::repetitions(1000); ++seed) {
    tests::Philox random(401, static_cast<std::uint32_t>(seed));
    const std::string reference = fmt::format("{:.17g} +- 0.1", 2 + 0.1 * random.normal());
    const std::string of_darts = fmt::format("{:.17g} +- 0.1", pi + 0.1 * random.normal());
    const std::string text =
        suite_of({"mean(normal) == " + reference + ", secondaries: 100",
                  "mean(normal) <= " + reference + ", secondaries: 100",
                  "mean(normal) == " + reference + ", allow: 5%, secondaries: 100",
                  "mean(darts) == " + of_darts + ", test: binomial, secondaries: 400",
                  "mean(darts) <= " + of_darts + ", test: betting, secondaries: 400"},
                 rate_of_each, rate_of_each);
    take_first_looks(prepare_text(text, seed), seed, outcomes);
  }
  for (const auto& [name, outcome] : outcomes) {
    const bool is_exact = name == "0" || name == "1";
    expect_p_value(name, outcome.log_p, is_exact ? Shape::uniform : Shape::at_most_uniform);
  }
}

TEST(Levels, OfAWholeSuiteAreAtMostAlpha) {
  const Workplace place;
  const std::string file =
      place.write("suite.yaml", suite_of({"mean(normal) == 2, secondaries: 20",
                                          "mean(normal) == mean(again), secondaries: 20",
                                          "variance(normal) == variance(again), secondaries: 50",
                                          "'distribution(normal) == normal(2, 1)', secondaries: 50",
                                          "mean(wide) <= 4, secondaries: 20"},
                                         rate_of_each, rate_of_each));
  std::vector<double> smallest;
  for (std::uint64_t seed = 1; seed <= tests::repetitions(250); ++seed) {
    const reports::Record record = run_files({file}, {.seed = seed, .threads = 1});
    double least = 0;
    bool failed = false;
    for (const reports::Test& test : record.suites[0].tests) {
      least = std::min(least, log_of(test.channels.at(0).log10_p_adjusted));
      failed = failed || test.verdict == reports::Verdict::fail;
    }
    EXPECT_EQ(failed, least <= std::log(rate_of_each)) << seed;
    smallest.push_back(least);
  }
  expect_p_value("Holm's least", smallest, Shape::at_most_uniform);
}

// 2.075 is three quarters of a standard error of 100 away: so little must already show.
TEST(Levels, OfAClaimThatIsALittleWrongAreSeenToBeMore) {
  const std::size_t runs = 2000;
  const auto outcomes = first_looks(
      runs, suite_of({"mean(normal) == 2.075, secondaries: 100"}, rate_of_each, rate_of_each));
  EXPECT_TRUE(tests::too_many(rate_at(outcomes.at("0").log_p, rate_of_each), rate_of_each,
                              static_cast<double>(runs)));
}

}  // namespace
}  // namespace assay::harness
