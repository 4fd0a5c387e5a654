#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <iostream>

#include "stats/tails/test_result.h"
#include "tests/stats/calibration.h"

namespace assay::tests {

// A false alarm has probability 1e-5 (calibration.h). Without ASSAY_LONG a quarter of 8000 and more
// repetitions.
inline void expect_calibrated(Experiment experiment, const std::function<double(Philox&)>& draw) {
  if (experiment.repetitions >= 8000) experiment.repetitions = repetitions(experiment.repetitions);
  const Calibration calibration = calibrate(experiment, draw);
  EXPECT_TRUE(calibration.ok) << calibration.text();
  std::cout << "  " << experiment.repetitions << " repetitions: " << calibration.text() << "\n";
}

// The same of both tails of a result.
inline void expect_tails_calibrated(Experiment experiment,
                                    const std::function<stats::TestResult(Philox&)>& draw) {
  const auto tail = [&](double stats::TestResult::*log_p) {
    expect_calibrated(experiment, [&](Philox& random) { return draw(random).*log_p; });
  };
  tail(&stats::TestResult::log_p_lower);
  tail(&stats::TestResult::log_p_upper);
}

// The calibration must see that this p-value is wrong, by all repetitions at the latest: mostly an
// eighth or a quarter of them is enough.
inline void expect_caught(const Experiment& experiment,
                          const std::function<double(Philox&)>& draw) {
  Philox random(experiment.test_case);
  std::vector<double> log_p;
  Calibration calibration;
  for (const std::size_t part : {8U, 4U, 2U, 1U}) {
    while (log_p.size() < experiment.repetitions / part) log_p.push_back(draw(random));
    calibration = calibrate(log_p, experiment.shape);
    std::cout << "  1/" << part << ": " << calibration.text() << "\n";
    if (!calibration.ok) return;
  }
  ADD_FAILURE() << calibration.text();
}

}  // namespace assay::tests

// A test of ln p of one experiment: its body draws `random` and returns ln p, or for both tails the
// result. What follows the name is the experiment: test case, repetitions, shape.
#define CALIBRATED(suite, name, ...) \
  ASSAY_EXPERIMENT(expect_calibrated, double, suite, name, __VA_ARGS__)
#define TAILS_CALIBRATED(suite, name, ...) \
  ASSAY_EXPERIMENT(expect_tails_calibrated, TestResult, suite, name, __VA_ARGS__)
#define CAUGHT(suite, name, ...) ASSAY_EXPERIMENT(expect_caught, double, suite, name, __VA_ARGS__)
#define ASSAY_EXPERIMENT(expect, result, suite, name, ...)            \
  result suite##_##name(tests::Philox& random);                       \
  TEST(suite, name) { tests::expect({__VA_ARGS__}, suite##_##name); } \
  result suite##_##name(tests::Philox& random)
