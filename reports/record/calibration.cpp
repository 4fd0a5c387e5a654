#include "reports/record/calibration.h"

#include <fmt/format.h>

#include <algorithm>

namespace assay::reports {

bool above(const Calibration& calibration, const CalibrationCell& cell) {
  return cell.mistaken().low > calibration.tolerance * cell.alpha;
}

bool unflagged(const Calibration& calibration, const CalibrationCell& cell) {
  return cell.alone_not_red.low > calibration.tolerance * cell.alpha;
}

std::size_t defects(const Calibration& calibration) {
  return static_cast<std::size_t>(std::count_if(
      calibration.cells.begin(), calibration.cells.end(),
      [&](const auto& cell) { return above(calibration, cell) || unflagged(calibration, cell); }));
}

std::string verdict_sentence(const Calibration& calibration) {
  const std::size_t bad = defects(calibration);
  if (bad == 0)
    return fmt::format("no cell of {} is found to err too often", calibration.cells.size());
  return fmt::format("{} of {} cells err too often", bad, calibration.cells.size());
}

}  // namespace assay::reports
