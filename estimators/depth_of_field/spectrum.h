#pragma once

// Frequencies of the local light field around a ray, carried to the lens (Durand et al. 2005, "A
// frequency analysis of light transport"; Soler et al. 2009).
//
// l(x, v) is the radiance at the transverse position x along the slope v in the light's direction.
// A frequency (Wx, Wv) is a wave cos(Wx x + Wv v + phase). The field is real: one of each pair of
// opposite frequencies is kept. If light moves by (x, v) -> M (x, v), frequencies move by the
// inverse transpose of M:
//  `travel over d          x += d v             Wv -= d Wx
//   reflection, curvature  v += c x             Wx -= c Wv
//   reflection, lobe       average over slopes  power exp(-(s Wv)^2), s the lobe's deviation
//   occlusion              times a mask of x    Wx becomes Wx + W and Wx - W for each of its W`.
// A mirror of curvature k has c = 2 k, with k > 0 if it scatters.
//
// The lens is focused at depth f. A pixel sees the point X of the focal plane. It gathers the
// slopes v = (u - X) / f from the lens points u. A frequency is Wx + Wv / f across the lens and -Wv
// / f across the image.

#include <cmath>
#include <span>
#include <vector>

#include "depth_of_field/scene_description.h"

namespace assay::depth_of_field {

struct Frequency {
  double position = 0;  ///< Wx, radians per unit length
  double slope = 0;     ///< Wv, radians per unit slope
  double power = 0;     ///< variance that the wave has over its phase: amplitude^2 / 2
};

/// A wave as the camera has it.
struct CameraFrequency {
  double lens = 0;   ///< radians per unit length across the lens
  double image = 0;  ///< the same across the focal plane
  double power = 0;
};

/// A wave of a mask: its frequency and a quarter of the square of its amplitude. A wave of power 1
/// becomes two waves of this power.
struct MaskWave {
  double frequency = 0;
  double power = 0;
};

/// A light field as a set of waves.
class Spectrum {
 public:
  explicit Spectrum(std::vector<Frequency> waves) : waves_(std::move(waves)) {}

  Spectrum& travel(double distance);
  /// The slope of a surface changes by `bend` / 2 for each unit of length.
  Spectrum& curve(double bend);
  /// A lobe of Gaussian slopes of standard deviation `spread`.
  Spectrum& reflect(double spread);
  /// Times 1 + sum over the mask's waves of its cosines: what there was stays.
  Spectrum& occlude(std::span<const MaskWave> mask);

  const std::vector<Frequency>& waves() const { return waves_; }
  std::vector<CameraFrequency> at_camera(const Lens& lens) const;

 private:
  std::vector<Frequency> waves_;
};

/// The variance of the radiance over the lens, averaged over the waves' phases. By Parseval it is
/// the sum of power (1 - j(radius W)^2), with j the disc's transform.
double lens_variance(std::span<const CameraFrequency> waves, const Lens& lens);

/// True if the lens lets a wave through: it has power, and radius |W| is below the first zero of
/// the disc's transform. Beyond that less than 0.133 of an amplitude is left, and is neglected.
bool passes(const CameraFrequency& wave, const Lens& lens);

/// The highest frequency across the image, in size, of the waves that the lens lets through; 0 of
/// none.
double image_bandwidth(std::span<const CameraFrequency> waves, const Lens& lens);

// The transport of a light field with a Gaussian power spectrum, by its 2 x 2 covariance. It is
// cheaper than a set of waves, and exact for Gaussians. Operators and signs are those of Spectrum.
// (After Belcour et al. 2013, "5D covariance tracing".)

class Covariance {
 public:
  struct Spread {
    double position = 0;  ///< variance of Wx
    double slope = 0;     ///< variance of Wv
    double both = 0;      ///< covariance
  };

  /// `power`: the variance that the field's waves have over their phases.
  Covariance(double power, Spread spread) : power_(power), spread_(spread) {}

  Covariance& travel(double distance) {
    const Spread s = spread_;
    spread_.slope = s.slope - 2 * distance * s.both + distance * distance * s.position;
    spread_.both = s.both - distance * s.position;
    return *this;
  }
  /// The variance over a lens of Gaussian weights: power (1 - 1 / sqrt(1 + radius^2 spread / 2)).
  /// The spread is that of Wx + Wv / focus. The lens's points spread as a disc's do, radius / 2
  /// along an axis. For waves of low frequency it is the disc's variance, up to the fourth power of
  /// the frequency.
  double lens_variance(const Lens& lens) const {
    const double spread =
        spread_.position + (2 * spread_.both + spread_.slope / lens.focus) / lens.focus;
    return power_ * (1 - 1 / std::sqrt(1 + lens.radius * lens.radius * spread / 2));
  }

 private:
  double power_;
  Spread spread_;
};

}  // namespace assay::depth_of_field
