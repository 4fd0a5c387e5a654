#pragma once

// The cases of a calibration run under many seeds, each as `assay run` runs a suite of one test:
// asked, piloted, planned, sampled in looks, judged.

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "harness/calibration/calibration_cases.h"
#include "reports/record/record.h"

namespace assay::harness {

/// What came of one test over the seeds. Sums of whole numbers: the same for any order of seeds.
struct VerdictCounts {
  std::uint64_t runs = 0;
  std::uint64_t passed = 0;
  std::uint64_t failed = 0;
  std::uint64_t inconclusive = 0;
  std::uint64_t invalid = 0;           ///< or error, or refused before sampling
  std::uint64_t red = 0;               ///< runs with a red gate
  std::uint64_t mistaken_not_red = 0;  ///< mistakes under gates none of which is red
  std::uint64_t observations = 0;      ///< of each subject at the last look taken, summed
  std::map<std::string, std::uint64_t> methods = {};  ///< by how many runs were judged by each

  void add(const VerdictCounts& other);
};

/// The three tests of a case at one alpha.
enum class Trial { true_claim, false_claim, alone };
inline constexpr std::size_t trials_of_a_case = 3;
using CaseCounts = std::array<VerdictCounts, trials_of_a_case>;

struct CalibrationRuns {
  std::vector<double> alphas;
  std::uint64_t runs = 1000;
  std::uint64_t seed = 1;  ///< of the first run, then the numbers after it
  unsigned threads = 0;    ///< 0: all cores
};

/// [alpha][case]; `done` is told, on the calling thread, how many runs are over. Every alpha and
/// case of a run sees the same observations. Stops early when the user interrupts.
std::vector<std::vector<CaseCounts>> run_calibration(
    const CalibrationBench& bench, const CalibrationRuns& options,
    const std::function<void(std::uint64_t)>& done);

}  // namespace assay::harness
