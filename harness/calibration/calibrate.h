#pragma once

// `assay calibrate`: how often the methods err and how much they find, on laws whose truth is
// known. Each case is asked, piloted, planned, sampled in looks and judged as by `assay run`, under
// many seeds.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/base/work.h"
#include "harness/record/record_of.h"
#include "reports/record/calibration.h"

namespace assay::harness {

struct CalibrateArguments {
  std::vector<std::string> methods = {};  ///< None: all.
  std::vector<std::string> laws = {};     ///< None: the usual ones.
  std::vector<double> alphas = {};        ///< None: .05, .01, .001.
  std::uint64_t runs = 1000;
  std::optional<std::uint64_t> samples = {};  ///< Size of every test, in one look.
  std::uint64_t seed = 1;
  unsigned threads = 0;
};

/// The default laws, as `analytic/law` reads them.
const std::vector<std::string>& calibration_laws();

/// Cells by alpha, method, question, law. InputError for an unknown method or law.
reports::Calibration calibration(const CalibrateArguments& arguments, Progress& progress);

/// Calibrates and writes the reports. Returns 1 if a cell errs too often.
int calibrate(const CalibrateArguments& arguments, const Output& output);

}  // namespace assay::harness
