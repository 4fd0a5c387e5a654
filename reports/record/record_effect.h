#pragma once

// Numbers that may not exist, and their intervals.

#include <optional>
#include <string>

#include "reports/record/fields.h"

namespace assay::reports {

/// A number of the record that may not exist: JSON null.
using Number = std::optional<double>;

/// A number with its interval at `confidence`.
struct Estimate {
  Number value, low, high;
  ASSAY_FIELDS(Estimate, value, low, high)
};

/// theta of the claim: its estimate, and the interval that the verdict rests on. A fail, and a pass
/// that excludes nothing, have the confidence 1 - the share of alpha. It is 1 - 2 x the share of
/// beta where a region is excluded, or should have been.
struct Effect {
  std::string quantity;  ///< "relative difference of means", "ln variance ratio", …
  Number estimate, low, high;
  double confidence = 0;
  bool relative = false;  ///< in units of the reference: shown in per cent
  ASSAY_FIELDS(Effect, quantity, estimate, low, high, confidence, relative)
};

}  // namespace assay::reports
