#include "stats/planning/looks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <vector>

#include "stats/means/student_t.h"
#include "stats/tails/tails.h"
#include "tests/stats/calibration.h"
#include "tests/stats/samples.h"

namespace assay::stats {
namespace {

using tests::calibrate;
using tests::draw_moments;
using tests::Experiment;
using tests::Philox;
using tests::Shape;

TEST(Looks, TenDoublingsAreElevenLooks) {
  const LookSchedule schedule = geometric_looks({100, 102400}, 2);
  ASSERT_EQ(schedule.sizes.size(), 11U);
  for (std::size_t k = 0; k < 11; ++k) EXPECT_EQ(schedule.sizes[k], 100U << k);
  for (const double weight : schedule.weights) EXPECT_DOUBLE_EQ(weight, 1 / 11.0);
}

TEST(Looks, TheRatioIsEvenedOutAndTheLastLookIsTheLargestSample) {
  const LookSchedule schedule = geometric_looks({1000, 30000}, 4);
  EXPECT_EQ(schedule.sizes, (std::vector<std::uint64_t>{1000, 3107, 9655, 30000}));
}

TEST(Looks, SmallSizesThatRoundTogetherAreOneLook) {
  const LookSchedule schedule = geometric_looks({1, 4}, 1.1);
  EXPECT_EQ(schedule.sizes, (std::vector<std::uint64_t>{1, 2, 3, 4}));
  EXPECT_DOUBLE_EQ(schedule.weights.front(), .25);
  EXPECT_EQ(geometric_looks({7, 7}, 2).sizes, (std::vector<std::uint64_t>{7}));
}

TEST(Looks, TheCombinedPIsTheSmallestOfTheLooksTakenEachOverItsWeight) {
  const LookSchedule schedule{.sizes = {1, 2, 4}, .weights = {.25, .25, .5}};
  const double p = std::exp(log_p_over_looks(
      schedule, std::vector<double>{std::log(.02), std::log(.005), std::log(.008)}));
  EXPECT_NEAR(p, .016, 1e-15);
  EXPECT_NEAR(std::exp(log_p_over_looks(schedule, std::vector<double>{std::log(.02)})), .08, 1e-15);
  EXPECT_EQ(log_p_over_looks(schedule, std::vector<double>{0, std::log(.5)}), 0);
}

TEST(Looks, AProbabilityOfZeroStaysFinite) {
  const auto schedule = geometric_looks({1, 4}, 2);
  const double lowest = std::numeric_limits<double>::lowest();
  EXPECT_EQ(log_p_over_looks(schedule, std::vector<double>{lowest}), lowest);
}

TEST(Looks, RefuseWhatCannotKeepTheLevel) {
  EXPECT_THROW(geometric_looks({0, 4}, 2), std::domain_error);
  EXPECT_THROW(geometric_looks({5, 4}, 2), std::domain_error);
  EXPECT_THROW(geometric_looks({1, 4}, 1), std::domain_error);
  EXPECT_THROW(geometric_looks({1, 4}, std::nan("")), std::domain_error);
  const std::vector<double> one{-1};
  EXPECT_THROW(log_p_over_looks({{1, 2}, {.6, .6}}, one), std::domain_error);
  EXPECT_THROW(log_p_over_looks({{2, 1}, {.5, .5}}, one), std::domain_error);
  EXPECT_THROW(log_p_over_looks({{1}, {0}}, one), std::domain_error);
  EXPECT_THROW(log_p_over_looks({{1}, {1}}, {}), std::domain_error);
  EXPECT_THROW(log_p_over_looks({{1}, {1}}, std::vector<double>{-1, -1}), std::domain_error);
  EXPECT_THROW(log_p_over_looks({{1}, {1}}, std::vector<double>{.1}), std::domain_error);
  EXPECT_THROW(log_p_over_looks({{1}, {1}}, std::vector<double>{std::nan("")}), std::domain_error);
}

// One normal sample looked at after each doubling; `combine` sees ln p of all looks.
template <class Combine>
double looked_at(Philox& random, const LookSchedule& schedule, Combine&& combine) {
  Moments x;
  std::vector<TestResult> results;
  for (const auto size : schedule.sizes) {
    while (x.count < size) x.add(random.normal());
    results.push_back(student_t(x, {0}));
  }
  return combine(results);
}

// False alarm 1e-5 (tests/stats/calibration.h).
TEST(Looks, KeepTheLevelOverTenDoublings) {
  const auto schedule = geometric_looks({4, 1024}, 2);
  const auto calibration =
      calibrate(Experiment{301, 10000, Shape::at_most_uniform}, [&](Philox& random) {
        return looked_at(random, schedule, [&](const auto& results) {
          std::vector<double> log_p;
          for (const TestResult& result : results) log_p.push_back(log_p_two_sided(result));
          return log_p_over_looks(schedule, log_p);
        });
      });
  EXPECT_TRUE(calibration.ok) << calibration.text();
  std::cout << "  10000 repetitions: " << calibration.text() << "\n";
}

TEST(Looks, TheSmallestOfTheLooksWithoutWeightsIsCaught) {
  const auto schedule = geometric_looks({4, 1024}, 2);
  const auto calibration =
      calibrate(Experiment{302, 10000, Shape::at_most_uniform}, [&](Philox& random) {
        return looked_at(random, schedule, [](const auto& results) {
          double smallest = 0;
          for (const TestResult& result : results) {
            smallest = std::min(smallest, log_p_two_sided(result));
          }
          return smallest;
        });
      });
  EXPECT_FALSE(calibration.ok) << calibration.text();
}

}  // namespace
}  // namespace assay::stats
