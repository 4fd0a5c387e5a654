// The short form of the study of false alarms: suites of true claims, run whole, must raise an
// alarm no more often than alpha says. One loop from YAML to verdict, nothing taken apart.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "running.h"
#include "stats/binomial.h"

namespace assay::harness {
namespace {

constexpr double alpha = 0.1;
constexpr std::uint64_t runs = 200;

std::string suite_with(const std::string& first_claim) {
  return R"(suite: level
alpha: 0.1
estimators:
  normal: {plugin: analytic/normal, mean: 2, primaries: 1}
  again: {plugin: analytic/normal, mean: 2, primaries: 1}
  darts: {plugin: analytic/dart_throwing, primaries: 64}
  importance: {plugin: analytic/exponential_importance, primaries: 64}
tests:
  - {claim: )" +
         first_claim + R"(, secondaries: 400}
  - {claim: mean(normal) == mean(again), secondaries: 200}
  - {claim: variance(normal) == analytic, secondaries: 200}
  - {claim: variance(normal) == variance(again), secondaries: 200}
  - {claim: 'distribution(normal) == normal(2, 1)', secondaries: 200}
  - {claim: distribution(importance.x) == density, secondaries: 1280}
  - {claim: mean(darts) <= 3.141592653589793, secondaries: 200}
)";
}

/// Whether so many alarms in `runs` runs are likelier than 1e-4 at a rate of alpha. The seeds are
/// 1, 2, 3, …; a sound engine is called wrong with probability 1e-4 at most.
bool keeps_alpha(const std::string& text) {
  const Workplace place;
  const std::string file = place.write("suite.yaml", text);
  std::uint64_t alarms = 0;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    const reports::Record record = run_files({file}, {.seed = seed, .threads = 1});
    bool failed = false;
    for (const reports::Test& test : record.suites[0].tests) {
      failed = failed || test.verdict == reports::Verdict::fail;
    }
    alarms += failed;
  }
  testing::Test::RecordProperty("alarms", static_cast<int>(alarms));
  return stats::binomial({alarms, runs}, alpha).log_p_upper > std::log(1e-4);
}

TEST(Level, OfATrueSuiteIsAtMostAlpha) {
  EXPECT_TRUE(keeps_alpha(suite_with("mean(normal) == analytic")));
}

// 2.1 is two standard errors of 400 unit normals away: a claim that is wrong fails more often.
TEST(Level, OfASuiteWithOneWrongClaimIsMoreThanAlpha) {
  EXPECT_FALSE(keeps_alpha(suite_with("mean(normal) == 2.1")));
}

}  // namespace
}  // namespace assay::harness
