#pragma once

// `assay calibrate`: how often the methods err and how much they find, on laws whose truth is
// known.

#include <optional>
#include <string>
#include <vector>

#include "harness/base/progress.h"
#include "harness/record/output.h"
#include "reports/record/calibration.h"

namespace assay::harness {

struct CalibrateArguments {
  std::vector<std::string> methods = {};  ///< none: all
  std::vector<std::string> laws = {};     ///< none: the usual ones
  std::vector<double> alphas = {};        ///< none: .05, .01, .001
  std::uint64_t runs = 1000;
  std::optional<std::uint64_t> samples = {};  ///< of every test, in one look
  std::uint64_t seed = 1;
  unsigned threads = 0;
};

/// InputError for a method or a law there is none of. Cells by alpha, method, question, law.
reports::Calibration calibration(const CalibrateArguments& arguments, Progress& progress);

/// Calibrates and writes the reports. 1 where a cell errs too often.
int calibrate(const CalibrateArguments& arguments, const Output& output);

}  // namespace assay::harness
