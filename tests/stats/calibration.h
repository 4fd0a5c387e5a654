#pragma once

#include "tests/philox.h"
#include "tests/prelude.h"

namespace assay::tests {

// True if long calibrations take all their repetitions: with ASSAY_LONG in the environment, as
// `bash tests/run.sh --all` sets it.
inline bool is_long() { return std::getenv("ASSAY_LONG") != nullptr; }

// The repetitions of a long calibration: all, or an eighth in its short form. Bounds follow from
// the number.
inline std::size_t repetitions(std::size_t all) { return is_long() ? all : (all + 7) / 8; }

// The calibration of a p-value under its null hypothesis. Elementary probability bounds judge it,
// which share nothing with the code under test. All three together raise a false alarm with
// probability <= 1e-5.
struct Calibration {
  double distance = 0;   // Sup |F_R(p) - p|, or sup (F_R(p) - p) for a discrete p-value.
  double threshold = 0;  // Massart's bound on it at 5e-6.
  double rate_01 = 0;    // Observed P(p <= .01), P(p <= .001).
  double rate_001 = 0;
  bool ok = false;

  std::string text() const {
    return "distance " + std::to_string(distance) + " (threshold " + std::to_string(threshold) +
           "), P(p<=.01) = " + std::to_string(rate_01) +
           ", P(p<=.001) = " + std::to_string(rate_001);
  }
};

enum class Shape { uniform, at_most_uniform };

// Chernoff: P(Binomial(n, p) >= k) <= exp(-n KL(k/n || p)).
inline bool too_many(double rate, double p, double n) {
  if (rate <= p) return false;
  const double rest = rate < 1 ? (1 - rate) * std::log((1 - rate) / (1 - p)) : 0;
  return -n * (rate * std::log(rate / p) + rest) < std::log(2.5e-6);
}

inline Calibration calibrate(std::vector<double> log_p, Shape shape) {
  std::sort(log_p.begin(), log_p.end());
  const double n = static_cast<double>(log_p.size());
  Calibration result;
  for (std::size_t i = 0; i < log_p.size(); ++i) {
    const double p = std::exp(log_p[i]);
    result.distance = std::max(result.distance, static_cast<double>(i + 1) / n - p);
    if (shape == Shape::uniform) {
      result.distance = std::max(result.distance, p - static_cast<double>(i) / n);
    }
  }
  const auto rate = [&](double level) {
    const auto end = std::upper_bound(log_p.begin(), log_p.end(), std::log(level));
    return static_cast<double>(end - log_p.begin()) / n;
  };
  result.threshold = std::sqrt(std::log(2 / 5e-6) / (2 * n));
  result.rate_01 = rate(0.01);
  result.rate_001 = rate(0.001);
  result.ok = result.distance <= result.threshold && !too_many(result.rate_01, 0.01, n) &&
              !too_many(result.rate_001, 0.001, n);
  return result;
}

// Log p-values of a true null hypothesis, each of one data set from the stream of the test case.
struct Experiment {
  std::uint32_t test_case = 0;
  std::size_t repetitions = 20000;
  Shape shape = Shape::uniform;
};

}  // namespace assay::tests
