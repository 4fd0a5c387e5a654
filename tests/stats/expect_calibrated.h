#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <iostream>

#include "tests/stats/calibration.h"

namespace assay::tests {

// A false alarm has probability 1e-5 (calibration.h).
inline void expect_calibrated(const Experiment& experiment,
                              const std::function<double(Philox&)>& draw) {
  const Calibration calibration = calibrate(experiment, draw);
  EXPECT_TRUE(calibration.ok) << calibration.text();
  std::cout << "  " << experiment.repetitions << " repetitions: " << calibration.text() << "\n";
}

// The calibration must see that this p-value is wrong.
inline void expect_caught(const Experiment& experiment,
                          const std::function<double(Philox&)>& draw) {
  const Calibration calibration = calibrate(experiment, draw);
  EXPECT_FALSE(calibration.ok) << calibration.text();
}

}  // namespace assay::tests
