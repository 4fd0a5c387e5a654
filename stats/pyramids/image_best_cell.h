#pragma once

#include "stats/images/image_family.h"
#include "stats/tails/t_to_z.h"

namespace assay::stats {

// Internal to image_pyramid: the largest |z| of a group of cells so far, and the number of cells it
// was chosen from. Among equals the first by channel, row and column wins, in whichever order they
// come.
struct BestCell {
  ImageFinding finding;
  StudentValue value;
  double windows = 0;
};

// Offers a cell without its z. z is computed from `value` only if it may be the largest.
void offer(BestCell& best, const ImageFinding& candidate, StudentValue value);

// Same result as offering the other's cells here.
void join(BestCell& best, const BestCell& other);

}  // namespace assay::stats
