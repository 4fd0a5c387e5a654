#pragma once

#include "stats/tails/test_result.h"
#include "tests/stats/calibration.h"

namespace assay::tests {

inline void expect_calibrated(const std::vector<double>& log_p, Shape shape) {
  const Calibration calibration = calibrate(log_p, shape);
  EXPECT_TRUE(calibration.ok) << calibration.text();
  std::cout << "  " << log_p.size() << " repetitions: " << calibration.text() << "\n";
}

// Both tails of a result. A false alarm of each has probability 1e-5 (calibration.h). Without
// ASSAY_LONG an eighth of 4000 and more repetitions.
inline void expect_tails_calibrated(const Experiment& experiment,
                                    const std::function<stats::TestResult(Philox&)>& draw) {
  const std::size_t all = experiment.repetitions;
  Philox random(experiment.test_case);
  std::vector<double> lower, upper;
  while (lower.size() < (all >= 4000 ? repetitions(all) : all)) {
    const stats::TestResult result = draw(random);
    lower.push_back(result.log_p_lower);
    upper.push_back(result.log_p_upper);
  }
  expect_calibrated(lower, experiment.shape);
  expect_calibrated(upper, experiment.shape);
}

inline void expect_calibrated(const Experiment& experiment,
                              const std::function<double(Philox&)>& draw) {
  const std::size_t all = experiment.repetitions;
  Philox random(experiment.test_case);
  std::vector<double> log_p(all >= 4000 ? repetitions(all) : all);
  for (double& value : log_p) value = draw(random);
  expect_calibrated(log_p, experiment.shape);
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
