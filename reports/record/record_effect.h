#pragma once

// Numbers with their intervals.

#include <string>

#include "reports/record/optional_number.h"

namespace assay::reports {

/// A number with its interval at `confidence`.
struct Estimate {
  Number value, low, high;
  bool operator==(const Estimate&) const = default;
};

/// theta of the claim: its estimate, and the interval that the verdict rests on. A fail, and a pass
/// that excludes nothing, have the confidence 1 - the share of alpha. It is 1 - 2 x the share of
/// beta where a region is excluded, or should have been.
struct Effect {
  std::string quantity;  ///< "relative difference of means", "ln variance ratio", …
  Number estimate, low, high;
  double confidence = 0;
  bool relative = false;  ///< in units of the reference: shown in per cent
  bool operator==(const Effect&) const = default;
};

}  // namespace assay::reports
