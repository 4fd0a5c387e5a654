#pragma once

// Lens integration at one pixel with a number of lens samples that a pilot decides.

#include <algorithm>
#include <cmath>

#include "depth_of_field/family.h"
#include "estimators/core/running_moments.h"

namespace assay::depth_of_field {

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

Information two_stage_information();
StageRule read_stage_rule(Parameters&);

/// `Stages` makes one estimate from a rule and a callable that draws a lens sample.
template <class Stages = FreshSamples>
std::shared_ptr<const Setup> prepare_two_stage(Parameters& given) {
  const LensPrimary<> primary{read_setting(given), read_pixel(given)};
  const SceneDescription& scene = primary.setting->scene();
  const StageRule rule = read_stage_rule(given);
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
