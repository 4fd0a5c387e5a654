#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// What an image test looked at, and where the images differ most; empty where there is no image.
std::string image_fact(const Test&);

/// "z", "adjusted p", "mean of luminaire/floor": a map for people.
std::string map_title(const Map&);

}  // namespace assay::reports
