#pragma once

// The sum of squares of the difference of two images whose elements are correlated, judged by flips
// of signs (stats/image_sign_flip.h).

#include <cstdint>
#include <functional>
#include <optional>

#include "estimators/stream.h"
#include "harness/theta/decision.h"
#include "harness/theta/family.h"
#include "stats/images/image_family.h"
#include "stats/images/image_sign_flip.h"

namespace assay::harness {

/// How many sign vectors are looked at.
struct FlipSize {
  double share = 0;        ///< of the level
  std::size_t images = 0;  ///< of a side
  std::uint64_t flips = 0;

  bool enumerated() const;
};

/// nullopt where so few images of a side, or so small a level, leave nothing to reject.
std::optional<FlipSize> flip_size(const ErrorShare& share, std::size_t images);

/// The matrix of flips of images of which some rows are there at a time; of many images that of
/// means over groups of them.
template <class Real>
class GroupedFlips {
 public:
  /// As stats::RowFlips.
  static constexpr std::size_t row_unit = stats::RowFlips<Real>::row_unit;
  void take(const stats::ImagePair<Real>& pair, stats::RowRange rows);
  stats::FlipMatrix matrix() const;

 private:
  stats::RowFlips<Real> single_;
  stats::RowFlips<double> grouped_;
  bool is_grouped_ = false;
};

/// The sum of squares joins the family, and whether it does: not where other sums say more than any
/// flips could. The matrix is asked for where it is needed.
bool add_flipped_energy(stats::ImageFamily& family, const stats::ImageExtent& extent,
                        const FlipSize& size, Stream signs,
                        const std::function<stats::FlipMatrix()>& matrix);

}  // namespace assay::harness
