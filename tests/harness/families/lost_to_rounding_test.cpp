#include <fmt/format.h>

#include "tests/harness/running.h"
#include "tests/philox.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

using reports::Verdict;

/// A true claim: a fail has probability 1e-6.
reports::Test at_offset(const std::string& mean, const std::string& test) {
  return run_test(
      "suite: offsets\nalpha: 1e-6\nestimators:\n  it: {plugin: analytic/normal, mean: " + mean +
      ", primaries: 1}\n  other: {plugin: analytic/normal, mean: " + mean +
      ", primaries: 1}\ntests: [{claim: " + test + "}]\n");
}

// Doubles near 1e14 are 1/64 apart, and the running mean of 10000 moves by less than that.
TEST(LostToRounding, AMeanThatIsAllRoundingIsInvalid) {
  for (const char* test :
       {"mean(it) == 1e14, secondaries: 10000", "mean(it) == mean(other), secondaries: 10000",
        "mean(it) <= 1e14, test: t, secondaries: 10000"}) {
    const reports::Test told = at_offset("1e14", test);
    EXPECT_EQ(told.verdict, Verdict::invalid) << told.message;
    EXPECT_THAT(told.message, HasSubstr("rounded so coarsely that their mean is off by about"));
  }
}

TEST(LostToRounding, AMeanThatIsFarLargerThanItsSpreadIsTested) {
  const reports::Test told = at_offset("1e10", "mean(it) == 1e10, secondaries: 10000");
  EXPECT_EQ(told.verdict, Verdict::pass) << told.message;
}

// Deviations of .01 vanish in numbers of 1e15, which are 1/8 apart; of zeros nothing is hidden.
TEST(LostToRounding, AVarianceThatRoundingHidesIsNotWithinItsBound) {
  const auto verdict = [](const std::string& parameters, const std::string& bound) {
    return run_test("suite: s\nestimators:\n  it: {plugin: analytic/normal, primaries: 1, " +
                    parameters + "}\ntests: [{claim: variance(it) <= " + bound + "}]\n")
        .verdict;
  };
  EXPECT_EQ(verdict("mean: 1e15, deviation: 0.01", "1e-9"), Verdict::invalid);
  EXPECT_EQ(verdict("mean: 0, deviation: 0", "1e-9"), Verdict::pass);
}

// Doubles near 1e12 are 1/8192 apart. Of sums that drop what they lose this was invalid.
TEST(LostToRounding, TheSumOfManyLosesNothing) {
  const reports::Test told = at_offset("1e12", "mean(it) == 1e12, secondaries: 500000");
  EXPECT_EQ(told.verdict, Verdict::pass) << told.message;
}

// The error of the reference is the comparison's too.
TEST(LostToRounding, OfAnUncertainReferenceTheRoundingMayBeSmall) {
  const reports::Test told = at_offset("1e13", "mean(it) == 1e13 +- 10, secondaries: 100000");
  EXPECT_EQ(told.verdict, Verdict::pass) << told.message;
}

std::string rows_around(double offset, tests::Philox& random) {
  std::string rows;
  for (int i = 0; i < 1500; ++i) rows += fmt::format("{:.17g}\n", offset + random.normal());
  return rows;
}

// The interval of the ratio of their means is narrower than the last digit of 1.
TEST(LostToRounding, RowsAtTheEndOfDoublesAreInvalidAndNoInternalError) {
  const Workplace place;
  tests::Philox random(1718);
  const std::string p = place.write("p.txt", rows_around(1e15, random));
  const std::string q = place.write("q.txt", rows_around(1e15, random));
  const reports::Record record = run_files(
      {place.write("suite.yaml", "suite: rows\nestimators:\n  p: {plugin: recorded, file: " + p +
                                     "}\n  q: {plugin: recorded, file: " + q +
                                     "}\ntests: [{claim: mean(p) == mean(q)}]\n")});
  const reports::Test& test = record.suites[0].tests[0];
  EXPECT_EQ(test.verdict, Verdict::invalid) << test.message;
}

}  // namespace
}  // namespace assay::harness
