#pragma once

#include <cstddef>

#include "reports/record/calibration.h"
#include "reports/record/record.h"

namespace assay::reports {

/// Ten suites of as many claims as given. The second suite has eight broken claims that share an
/// estimator; every other claim is as it should be.
Record many_claims(std::size_t count);

/// A pair of pictures of 960 x 540 pixels whose values are alike but for noise. An ellipse is 5 %
/// brighter: its z is 4 standard errors a pixel.
Record planted_ellipse();

/// The same without an ellipse. One pixel is 40 standard errors brighter.
Record hot_pixel();

/// Two methods at two levels; one of the four cells errs too often.
Calibration small_calibration();

}  // namespace assay::reports
