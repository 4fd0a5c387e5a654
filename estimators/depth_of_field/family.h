#pragma once

// The common parts of the family: parameters, channels, and the primary at one pixel.

#include "depth_of_field/disc_sampler.h"
#include "depth_of_field/exact.h"
#include "depth_of_field/setting.h"

namespace assay::depth_of_field {

ParameterInformation scene_parameter(const char* fallback);
SharedSetting read_setting(Parameters&);

/// `pixel`: the point of the focal plane.
ParameterInformation pixel_parameter();
PlanePoint read_pixel(Parameters&);

/// Average radiance over the lens at one pixel: mean with its error, and range. The variance is
/// that of one lens sample divided by `samples`. It is stated only if quadrature and rounding leave
/// it eight digits.
Channel radiance_channel(const SceneDescription& scene, const Moments& moments, double samples = 1);

/// One lens sample at one pixel: the radiance along the ray from a point of the lens.
template <class Disc = UniformDisc>
struct LensPrimary {
  SharedSetting setting;
  PlanePoint pixel;

  PlanePoint draw(Stream& random) const {
    const double s = random.uniform();
    return Disc{}(s, random.uniform());
  }
  double value(const PlanePoint& u, Cost& cost) const { return setting->radiance(pixel, u, cost); }
};

}  // namespace assay::depth_of_field
