#pragma once

#include <cstddef>
#include <vector>

#include "stats/images/image_windows.h"
#include "stats/pyramids/image_best_cell.h"
#include "stats/pyramids/image_fine_cells.h"

namespace assay::stats {

// Internal to image_pyramid. Offers one channel's coarse cells and alternating sums to the best of
// their groups, from the sums over blocks.
void offer_coarse_cells(const CoarseImages& coarse, const std::vector<WindowGroup>& groups,
                        std::size_t channel, const NoisePyramid& noise,
                        std::vector<BestCell>& best);

}  // namespace assay::stats
