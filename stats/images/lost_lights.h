#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "stats/gates/level_factors.h"
#include "stats/images/image.h"
#include "stats/images/image_moments.h"

namespace assay::stats {

struct CellPilot;

// Internal to cell_tails: an element that varied among the images that weights come from and in
// none of those that they are given to, as one does that is lit in one image of thousands. The
// others' moments say nothing of it, and a later test meets it dark, with a weight and without its
// mean. Its numerator's cumulants are those of the images that saw it.
struct LostLight {
  std::size_t x = 0;
  std::size_t y = 0;
  std::size_t channel = 0;
  Cumulants cumulants;
};

// Those of one side in these rows. `weights` begin with element `first_weight`.
std::vector<LostLight> lost_lights(const CellPilot& side, EveryImage weighing,
                                   std::span<const double> weights, std::size_t first_weight,
                                   RowRange rows);

}  // namespace assay::stats
