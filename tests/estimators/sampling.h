#pragma once

// Runs a plugin and sums up what came out.

#include <cmath>
#include <string>

#include "estimators/catalogue.h"
#include "estimators/core/flow.h"

namespace assay::tests {

/// Two-sided false-alarm rate 1e-4 for a standard normal statistic.
inline constexpr double z_limit = 3.8906;

/// A plugin with one parameter `scene`, as parse_flow() reads it.
inline std::shared_ptr<const Setup> prepared(const std::string& plugin, const std::string& scene) {
  const Entry& entry = find_plugin(plugin, {});
  Parameters parameters(plugin, entry.information.parameters,
                        Value::map({{"scene", parse_flow(scene)}}), "");
  std::shared_ptr<const Setup> setup = entry.prepare(parameters);
  parameters.require_all_read();
  return setup;
}

struct Summary {
  double count = 0;
  double mean = 0;
  double variance = 0;
  double fourth_central = 0;
  double low = 0;
  double high = 0;
  Cost cost;

  double mean_error() const { return std::sqrt(variance / count); }
  double variance_error() const {
    return std::sqrt((fourth_central - variance * variance) / count);
  }
};

/// Primaries of observations 0, 1, … at seed 1, the key that of `family`.
inline Summary summary(const Setup& setup, const std::string& family, std::uint64_t count) {
  const StreamKey key = stream_key(1, family, "", 0);
  const auto estimator = setup.make();
  std::vector<double> values(count);
  Summary out;
  for (std::uint64_t i = 0; i < count; ++i) {
    Stream random(key, i);
    estimator->secondary(random, 1, {&values[i], 1}, out.cost);
  }
  out.count = static_cast<double>(count);
  for (const double v : values) out.mean += v / out.count;
  for (const double v : values) {
    const double square = (v - out.mean) * (v - out.mean);
    out.variance += square / (out.count - 1);
    out.fourth_central += square * square / out.count;
  }
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  out.low = *low;
  out.high = *high;
  return out;
}

/// The built-in rectangle with a receiver that has part of it below its horizon.
inline constexpr const char* horizon_scene =
    "{receiver: {position: [0, 0, 0], normal: [.9, 0, .3]}, light: {polygon: [[-.8, -.6, 1], "
    "[.9, -.6, 1], [.9, .8, 1], [-.8, .8, 1]], radiance: 1}}";

/// The built-in rectangle, hidden where x > t: half-way up, by a wall over x > t / 2.
inline std::string hidden_beyond(double t) {
  const std::string edge = std::to_string(t / 2);
  return "{receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: {polygon: [[-.8, -.6, 1], "
         "[.9, -.6, 1], [.9, .8, 1], [-.8, .8, 1]], radiance: 1}, occluders: [{polygon: [[" +
         edge + ", -9, .5], [9, -9, .5], [9, 9, .5], [" + edge + ", 9, .5]]}]}";
}

}  // namespace assay::tests
