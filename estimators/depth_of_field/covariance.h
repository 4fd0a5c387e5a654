#pragma once

// The transport of a light field with a Gaussian power spectrum, by its 2 x 2 covariance. It is
// cheaper than a set of waves, and exact for Gaussians. Operators and signs are those of
// spectrum.h. (After Belcour et al. 2013, "5D covariance tracing".)

#include <cmath>

#include "depth_of_field/thin_lens.h"

namespace assay::depth_of_field {

class Covariance {
 public:
  struct Spread {
    double position = 0;  ///< variance of Wx
    double slope = 0;     ///< variance of Wv
    double both = 0;      ///< covariance
  };

  /// `power`: the variance that the field's waves have over their phases.
  Covariance(double power, Spread spread) : power_(power), spread_(spread) {}

  double power() const { return power_; }
  const Spread& spread() const { return spread_; }

  Covariance& travel(double distance) {
    const Spread s = spread_;
    spread_.slope = s.slope - 2 * distance * s.both + distance * distance * s.position;
    spread_.both = s.both - distance * s.position;
    return *this;
  }
  Covariance& curve(double bend) {
    const Spread s = spread_;
    spread_.position = s.position - 2 * bend * s.both + bend * bend * s.slope;
    spread_.both = s.both - bend * s.slope;
    return *this;
  }
  /// The product of two Gaussians in Wv: the inverse of the covariance grows by 2 spread^2.
  Covariance& reflect(double spread) {
    const Spread s = spread_;
    const double lobe = 2 * spread * spread;
    const double rest = 1 / (1 + lobe * s.slope);
    spread_ = {s.position - s.both * s.both * lobe * rest, s.slope * rest, s.both * rest};
    power_ *= std::sqrt(rest);
    return *this;
  }
  /// Convolution with a mask whose power spectrum has this variance: sums of independent numbers.
  Covariance& occlude(double mask) {
    spread_.position += mask;
    return *this;
  }

  /// Variance of the frequency across the lens, Wx + Wv / focus.
  double lens_spread(const Lens& lens) const {
    return spread_.position + (2 * spread_.both + spread_.slope / lens.focus) / lens.focus;
  }
  /// Variance of the frequency across the image, Wv / focus.
  double image_spread(const Lens& lens) const { return spread_.slope / lens.focus / lens.focus; }

  /// The variance over a lens of Gaussian weights: power (1 - 1 / sqrt(1 + radius^2 lens_spread /
  /// 2)). Its points spread as a disc's do, radius / 2 along an axis. For waves of low frequency it
  /// is the disc's variance, up to the fourth power of the frequency.
  double lens_variance(const Lens& lens) const {
    return power_ * (1 - 1 / std::sqrt(1 + lens.radius * lens.radius * lens_spread(lens) / 2));
  }

 private:
  double power_;
  Spread spread_;
};

}  // namespace assay::depth_of_field
