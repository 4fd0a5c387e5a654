#pragma once

#include "stats/images/image_family.h"
#include "stats/tails/t_to_z.h"

namespace assay::stats {

// Internal to image_pyramid: the largest |z| of a group of cells so far, and
// how many cells it was chosen from. Of equal ones the first by channel, row
// and column, in whichever order they come.
struct BestCell {
  ImageFinding finding;
  StudentValue value;
  double windows = 0;
};

// A cell's candidate without its z, which is worked out from `value` where it
// can be the largest.
void offer(BestCell& best, const ImageFinding& candidate, StudentValue value);

// As if the other's cells had been offered here.
void join(BestCell& best, const BestCell& other);

}  // namespace assay::stats
