#pragma once

#include "stats/images/image_equivalence.h"
#include "stats/images/image_jackknife.h"

namespace assay::stats {

// image_distance of images of which some rows are there at a time, with the same bits.
template <class Real>
class RowDistance {
 public:
  // Rows that follow on those before.
  void take(const ImagePair<Real>& pair, RowRange rows, const ForEach& for_each = one_by_one);
  // After the last rows.
  ImageDistance distance();

 private:
  jackknifed::RunningJackknife<2> sums_;
};

}  // namespace assay::stats
