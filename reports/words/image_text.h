#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// The sums that an image test looked at, and the place that differs most. Empty if the claim is
/// not on an image.
std::string image_fact(const Test&);

/// "z", "adjusted p", "mean of luminaire/floor": a map for people.
std::string map_title(const Map&);

}  // namespace assay::reports
