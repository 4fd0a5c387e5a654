#pragma once

// Runs the cases of a calibration under many seeds. Each is asked, piloted, planned, sampled in
// looks and judged as by `assay run`.

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "harness/calibration/calibration_cases.h"
#include "reports/record/record.h"

namespace assay::harness {

/// Outcomes of one test over the seeds. They are sums of whole numbers, so the order of seeds does
/// not matter.
struct VerdictCounts {
  std::uint64_t runs = 0;
  std::uint64_t passed = 0;
  std::uint64_t failed = 0;
  std::uint64_t inconclusive = 0;
  std::uint64_t invalid = 0;  ///< Or error, or refused before sampling.
  std::uint64_t red = 0;
  std::uint64_t mistaken_not_red = 0;  ///< Mistakes in runs without a red gate.
  std::uint64_t observations = 0;      ///< Sum of each subject's at the last look taken.
  std::map<std::string, std::uint64_t> methods = {};  ///< Number of runs that each method judged.

  void add(const VerdictCounts& other);
};

/// The three tests of a case at one alpha.
enum class Trial { holds, off, alone };
inline constexpr std::size_t trials_of_a_case = 3;
using CaseCounts = std::array<VerdictCounts, trials_of_a_case>;

struct CalibrationRuns {
  std::vector<double> alphas;
  std::uint64_t runs = 1000;
  std::uint64_t seed = 1;  ///< The first run's; others follow.
  unsigned threads = 0;    ///< 0: all cores.
};

/// Counts by [alpha][case]. `done` gets the number of finished runs, on the calling thread. All
/// alphas and cases of a run see the same observations. Stops early when the user interrupts.
std::vector<std::vector<CaseCounts>> run_calibration(
    const CalibrationBench& bench, const CalibrationRuns& options,
    const std::function<void(std::uint64_t)>& done);

}  // namespace assay::harness
