#pragma once

namespace assay::stats {

// Values declared to lie in [low, high], low < high. An end may be infinite.
struct Range {
  double low = 0;
  double high = 1;
};

}  // namespace assay::stats
