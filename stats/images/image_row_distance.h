#pragma once

#include "stats/images/image_equivalence.h"
#include "stats/images/image_jackknife.h"

namespace assay::stats {

// image_distance for images that are read rows after rows, with the same bits.
template <class Real>
class RowDistance {
 public:
  // Takes rows that follow on those before.
  void take(const ImagePair<Real>& pair, RowRange rows, const ForEach& for_each = one_by_one);
  // To be called after the last rows.
  ImageDistance distance();

 private:
  jackknifed::RunningJackknife<2> sums_;
};

}  // namespace assay::stats
