#pragma once

#include <algorithm>
#include <cmath>

#include "depth_of_field/exact.h"
#include "depth_of_field/scene_description.h"

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

/// Mean and variance of numbers as they come. Welford's (1962) recurrence: mean += d / n, squares
/// += d (x - mean), d = x - mean before. The sum of squares is of distances from the mean, so that
/// nothing cancels and it is never negative.
class RunningMoments {
 public:
  void add(double x) {
    ++count_;
    const double before = x - mean_;
    mean_ += before / count_;
    squares_ += before * (x - mean_);
  }
  /// A whole number.
  double count() const { return count_; }
  /// 0 of none.
  double mean() const { return mean_; }
  /// Sample variance, n - 1 in the denominator; NaN of fewer than two.
  double variance() const { return squares_ / (count_ - 1); }

 private:
  double count_ = 0;
  double mean_ = 0;
  double squares_ = 0;
};

/// One lens sample at one pixel: the radiance along the ray from a point of the lens.
template <class Disc = UniformDisc>
struct LensPrimary {
  SharedSetting setting;
  PlanePoint pixel;

  PlanePoint draw(Stream& random) const { return lens_point<Disc>(random); }
  double value(const PlanePoint& u, Cost& cost) const { return setting->radiance(pixel, u, cost); }
};

/// The mean of `side` x `side` lens samples, one in each cell of a grid over the square that is
/// mapped to the disc. Unbiased for any side; on an edge its variance falls like side^-3.
template <class Disc = UniformDisc>
struct JitteredPrimary {
  LensPrimary<Disc> primary;
  std::uint64_t side;

  double operator()(Stream& random, Cost& cost) const {
    const double cell = 1 / static_cast<double>(side);
    double sum = 0;
    for (std::uint64_t i = 0; i < side; ++i) {
      for (std::uint64_t j = 0; j < side; ++j) {
        const double s = (static_cast<double>(i) + random.uniform()) * cell;
        const double t = (static_cast<double>(j) + random.uniform()) * cell;
        sum += primary.value(Disc{}(s, t), cost);
      }
    }
    return sum * cell * cell;
  }
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
  return averaging(std::move(channel), JitteredPrimary<Disc>{primary, side}, lens_samplers<Disc>());
}

/// How many lens samples follow a pilot.
struct StageRule {
  std::uint64_t pilot = 8;    ///< lens samples of the pilot, 2 or more
  double noise = 0.1;         ///< standard error that is wanted
  std::uint64_t most = 4096;  ///< lens samples at the most

  /// max(1, ceil(s^2 / noise^2)), at most `most`, s^2 a sample variance.
  double count(double variance) const {
    const double wanted = std::ceil(variance / (noise * noise));
    return std::clamp(wanted, 1.0, static_cast<double>(most));
  }
};

/// The pilot is thrown away: the number of samples is independent of those that are averaged.
struct FreshSamples {
  template <class Draw>
  double operator()(const StageRule& rule, const Draw& draw) const {
    RunningMoments pilot;
    for (std::uint64_t i = 0; i < rule.pilot; ++i) pilot.add(draw());
    RunningMoments main;
    for (const double n = rule.count(pilot.variance()); main.count() < n;) main.add(draw());
    return main.mean();
  }
};

/// `Stages` makes one estimate from a rule and a callable that draws a lens sample.
template <class Stages = FreshSamples>
std::shared_ptr<const Setup> prepare_two_stage(Parameters& given) {
  const LensPrimary<> primary{read_setting(given), read_pixel(given)};
  const SceneDescription& scene = primary.setting->scene();
  const StageRule rule{given.count("pilot"), given.number("noise"), given.count("most")};
  Channel channel = radiance_channel(scene, exact_moments(scene, primary.pixel));
  channel.variance.reset();
  return averaging(
      std::move(channel),
      [primary, rule](Stream& random, Cost& cost) {
        return Stages{}(rule, [&] { return primary.value(primary.draw(random), cost); });
      },
      lens_samplers<>());
}

}  // namespace assay::depth_of_field
