#pragma once

// Tests the sum of squares of the difference of two images with correlated elements, by sign flips
// (stats/image_sign_flip.h).

#include <cstdint>
#include <functional>
#include <optional>

#include "estimators/stream.h"
#include "harness/theta/decision.h"
#include "stats/images/image_family.h"
#include "stats/images/image_sign_flip.h"

namespace assay::harness {

/// The number of sign vectors to try.
struct FlipSize {
  double share = 0;        ///< of the level
  std::size_t images = 0;  ///< of a side
  std::uint64_t flips = 0;

  bool enumerated() const;
};

/// nullopt if too few images or too small a level leave nothing to reject.
std::optional<FlipSize> flip_size(const ErrorShare& share, std::size_t images);

/// The matrix of flips, from images that come some rows at a time. Many images are first averaged
/// in groups.
template <class Real>
class GroupedFlips {
 public:
  static constexpr std::size_t row_unit = stats::RowFlips<Real>::row_unit;
  void take(const stats::ImagePair<Real>& pair, stats::RowRange rows);
  stats::FlipMatrix matrix() const;

 private:
  stats::RowFlips<Real> single_;
  stats::RowFlips<double> grouped_;
  bool is_grouped_ = false;
};

/// Adds the sum of squares to the family and returns true, unless other sums say more than any
/// flips could. Asks for the matrix only if it is needed.
bool add_flipped_energy(stats::ImageFamily& family, const stats::ImageExtent& extent,
                        const FlipSize& size, Stream signs,
                        const std::function<stats::FlipMatrix()>& matrix);

}  // namespace assay::harness
