#include "harness/googletest/claims.h"

#include "harness/googletest/matchers.h"
#include "tests/prelude.h"

namespace assay::googletest {
namespace {

// The claims that are judged below are fewer; ASSAY_SEED is not set. Each has its false-alarm rate
// from the binary: 1e-5 / 40.
const DeclaredClaims budget{{.claims = 40, .alpha = 1e-5}};

double cube(Stream& random) { return std::pow(random.uniform(), 3); }
void sides(Stream& random, std::span<double> out) {
  out[0] = random.uniform();
  out[1] = 1 - out[0];
}

std::string message(const std::string& claim, const std::vector<Part>& parts) {
  const testing::AssertionResult result = claim_holds(claim, parts);
  return (result ? "holds: " : "fails: ") + std::string(result.message());
}

TEST(Claims, OfACallableHoldWhereTheyAreTrue) {
  EXPECT_CLAIM("mean(mine) == 0.25", primary("mine", cube), detect("5%"));
  EXPECT_CLAIM("mean(both) == 0.5", secondary("both", 2, sides));
  EXPECT_CLAIM("mean(both.value2) == mean(mine)", secondary("both", 2, sides, 0, 1),
               primary("mine", [](Stream& random) { return random.uniform(); }));
}

TEST(Claims, SayWhatWasFoundWhereTheyAreNot) {
  const auto ninth = [](Stream& random, std::span<double> out) {
    out[0] = std::pow(random.uniform(), 9);
  };
  const std::string said = message("mean(mine) == 0.1125", {secondary("mine", 1, ninth)});
  EXPECT_THAT(said, testing::StartsWith("fails: fail: relative difference from the reference"));
  EXPECT_THAT(said, HasSubstr("null hypothesis: mean(mine) = 0.1125"));
  EXPECT_THAT(said, HasSubstr("may explain it; declare their `high` end"));
  EXPECT_THAT(message("mean(mine) == 0.1125", {secondary("mine", 1, ninth, 0, 1)}),
              testing::Not(HasSubstr("may explain it")));
  EXPECT_THAT(said, testing::ContainsRegex("\nreplay: [^\n]+( \\\\\n  *)?--gtest_filter=Claims"));
}

// A hundred observations have no value of -50 with probability .6. The pilot has some twenty.
TEST(Claims, OfFewObservationsKnowTheSkewnessOfThePilot) {
  const auto rare = [](Stream& random, std::span<double> out) {
    out[0] = random.uniform() < .005 ? -50 : 1 + random.uniform();
  };
  EXPECT_THAT(message("mean(mine) == 1.2425", {secondary("mine", 1, rare), secondaries(100)}),
              HasSubstr("inconclusive: the observations are so skewed"));
}

TEST(Claims, OfPrimariesMayTakeSeveralAnObservation) {
  EXPECT_CLAIM("variance(mine) == 0.080357142857142857", primary("mine", cube), detect("30%"));
}

TEST(Claims, LeaveTheirNumbersInTheTestsProperties) {
  EXPECT_CLAIM("mean(mine) == 0.25", primary("mine", cube));
  EXPECT_FALSE(claim_holds("mean(mine) == 0.3", {primary("mine", cube)}));
  const testing::TestResult& result =
      *testing::UnitTest::GetInstance()->current_test_info()->result();
  std::map<std::string, std::string> properties;
  for (int i = 0; i < result.test_property_count(); ++i) {
    properties[result.GetTestProperty(i).key()] = result.GetTestProperty(i).value();
  }
  EXPECT_EQ(properties["claim_1"], "mean(mine) == 0.25");
  EXPECT_EQ(properties["verdict_1"], "pass");
  EXPECT_EQ(properties["verdict_2"], "fail");
  EXPECT_LT(std::stod(properties["log10_p_2"]), std::log10(1e-5 / 40));
  EXPECT_NEAR(std::stod(properties["estimate_2"]), 0.25 / 0.3 - 1, 0.1);
  EXPECT_EQ(properties["secondaries_1"], "1000");
}

TEST(Claims, ThatCannotBeReadAreFailures) {
  EXPECT_THAT(message("maen(mine) == 0.25", {primary("mine", cube)}), HasSubstr("mean"));
  EXPECT_THAT(message("mean(other) == 0.25", {primary("mine", cube)}),
              HasSubstr("no estimator `other`"));
  EXPECT_THAT(message("mean(mine) == 1", {primary("mine", cube), primary("mine", cube)}),
              HasSubstr("two sources are named `mine`"));
  EXPECT_THAT(message("mean(mine) == 0.25", {primary("mine", cube), detect("0")}),
              HasSubstr("detect"));
}

TEST(Claims, SayTheKeyThatWouldDecide) {
  EXPECT_THAT(message("mean(it) == 0.25", {primary("it", cube), detect("0.1%"), secondaries(200)}),
              testing::ContainsRegex("`secondaries: [0-9]+`"));
  const auto nan = [](Stream&) { return std::nan(""); };
  EXPECT_THAT(message("mean(mine) == 0.25", {primary("mine", nan)}),
              testing::Not(HasSubstr("assay replay")));
}

TEST(Claims, OfACallableThatThrowsAreFailures) {
  const auto broken = [](Stream&) -> double { throw std::runtime_error("no light"); };
  EXPECT_THAT(message("mean(mine) == 0.25", {primary("mine", broken)}), HasSubstr("no light"));
}

TEST(Claims, OfACallableThatIgnoresItsStreamAreErrors) {
  std::atomic<std::uint64_t> calls = 0;
  const auto stray = [&](Stream&) { return Stream({7}, calls++).uniform(); };
  const auto second = [&](Stream& random, std::span<double> out) { out[1] = stray(random); };
  for (const Source& part : {primary("mine", stray), secondary("mine", 2, second)}) {
    EXPECT_THAT(message("mean(mine) <= 0.6", {part}), HasSubstr("when it was drawn again"));
  }
}

TEST(Claims, HaveMatchers) {
  EXPECT_THAT(cube, HasMean("0.25"));
  EXPECT_THAT(cube, testing::Not(HasMean("0.3")));
  EXPECT_THAT(cube, SatisfiesClaim("variance(it) <= 0.09"));
  EXPECT_THAT(cube, SatisfiesClaim("mean(it) >= 0.2"));
}

TEST(Claims, HaveOneBudgetOfSoundNumbers) {
  EXPECT_THROW(DeclaredClaims({.claims = 3}), std::logic_error);
  EXPECT_THROW(DeclaredClaims({.claims = 0}), std::logic_error);
  EXPECT_THROW(DeclaredClaims({.claims = 1, .alpha = 0}), std::logic_error);
}

// The last of this file: it spends what is left.
TEST(Claims, BeyondTheDeclaredNumberAreFailures) {
  std::string said;
  for (int i = 0; i <= 40 && said.find("this is claim 41") == said.npos; ++i) {
    said = message("mean(mine) <= 9", {primary("mine", cube)});
  }
  EXPECT_THAT(said, HasSubstr("this is claim 41 of a binary that declared 40"));
}

}  // namespace
}  // namespace assay::googletest
