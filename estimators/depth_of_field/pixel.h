#pragma once

// Lens integration at one pixel with a number of lens samples that is known beforehand.

#include "depth_of_field/family.h"

namespace assay::depth_of_field {

/// Static information of depth_of_field/pixel.
Information pixel_information();

/// The mean of `side` x `side` lens samples, one in each cell of a grid over the square that is
/// mapped to the disc. Unbiased for any side; on an edge its variance falls like side^-3.
template <class Disc = UniformDisc>
class JitteredPrimary {
 public:
  JitteredPrimary(LensPrimary<Disc> primary, std::uint64_t side)
      : primary_(std::move(primary)), side_(side) {}

  double operator()(Stream& random, Cost& cost) const {
    const double cell = 1 / static_cast<double>(side_);
    double sum = 0;
    for (std::uint64_t i = 0; i < side_; ++i) {
      for (std::uint64_t j = 0; j < side_; ++j) {
        const double s = (static_cast<double>(i) + random.uniform()) * cell;
        const double t = (static_cast<double>(j) + random.uniform()) * cell;
        sum += primary_.value(Disc{}(s, t), cost);
      }
    }
    return sum * cell * cell;
  }

 private:
  LensPrimary<Disc> primary_;
  std::uint64_t side_;
};

/// The set-up of parameters `scene`, `pixel`, `jitter`. `Disc` maps numbers to the lens.
template <class Disc = UniformDisc>
std::shared_ptr<const Setup> prepare_pixel(Parameters& given) {
  const SharedSetting setting = read_setting(given);
  const PlanePoint pixel = read_pixel(given);
  const std::uint64_t side = given.count("jitter");
  Channel channel = radiance_channel(setting->scene(), exact_moments(setting->scene(), pixel));
  const LensPrimary<Disc> primary{setting, pixel};
  if (side == 1) return averaging(std::move(channel), primary, lens_samplers<Disc>());
  channel.variance.reset();
  return averaging(std::move(channel), JitteredPrimary<Disc>(primary, side), lens_samplers<Disc>());
}

}  // namespace assay::depth_of_field
