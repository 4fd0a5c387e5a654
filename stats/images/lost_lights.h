#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "stats/gates/level_factors.h"
#include "stats/images/image.h"
#include "stats/images/image_moments.h"

namespace assay::stats {

struct CellPilot;

// Internal to cell_tails: an element that varied only among the images that weights come from. That
// is a light lit in one image of thousands. The weighted images' moments say nothing of it. A later
// test meets it dark, with a weight and without its mean. So its numerator takes the cumulants of
// the images that saw it.
struct LostLight {
  std::size_t x = 0;
  std::size_t y = 0;
  std::size_t channel = 0;
  Cumulants cumulants;
};

// The lost lights of one side in these rows. `weights` begin with element `first_weight`.
std::vector<LostLight> lost_lights(const CellPilot& side, EveryImage weighing,
                                   std::span<const double> weights, std::size_t first_weight,
                                   RowRange rows);

}  // namespace assay::stats
