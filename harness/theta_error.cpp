#include "harness/theta_error.h"

#include <cmath>
#include <optional>

#include "harness/constant.h"
#include "harness/method.h"
#include "stats/log_variance.h"

namespace assay::harness {
namespace {

/// Of one side's share in theta, before its unit.
double side_error(const Question& question, std::size_t subject, const ChannelData& data) {
  if (question.of_variances()) return stats::log_variance_standard_error(data.moments);
  return (subject == 0 ? 1 : std::abs(question.factor)) * data.moments.standard_error();
}

/// As if `count` means of `averaged` primaries each had been drawn.
stats::Moments scaled(const stats::Moments& pilot, double averaged, std::uint64_t count) {
  const double n = static_cast<double>(count);
  stats::Moments moments = pilot;
  const double spread = pilot.variance() / averaged;
  const double kurtosis = 3 + (pilot.kurtosis() - 3) / averaged;
  const double skewness = pilot.skewness() / std::sqrt(averaged);
  moments.count = count;
  moments.m2 = spread * (n - 1);
  moments.m3 = skewness * n * std::pow(moments.m2 / n, 1.5);
  moments.m4 = kurtosis * moments.m2 * moments.m2 / n;
  return moments;
}

}  // namespace

std::optional<ThetaError> theta_error(const Question& question, std::size_t channel,
                                      std::span<const ChannelData> data) {
  if (!question.of_means() && !question.of_variances()) return std::nullopt;
  const double unit =
      unit_of_theta(question, channel, question.of_two() ? data[1].moments.mean : 0);
  ThetaError error;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const double side = side_error(question, i, data[i]) / unit;
    double& part = question.subjects[i].setup->observations() ? error.fixed : error.drawn;
    part = std::hypot(part, side);
  }
  if (!question.references.empty()) {
    error.fixed = std::hypot(error.fixed, question.references[channel].standard_error / unit);
  }
  return error;
}

std::optional<std::vector<ChannelData>> expected_data(const TestOutcome& test, std::size_t channel,
                                                      const Pilots& pilots,
                                                      std::uint64_t secondaries) {
  const Question& question = test.question;
  // A sampler's draws are not what its estimator's pilot is of.
  if (!question.of_means() && !question.of_variances()) return std::nullopt;
  std::vector<ChannelData> data(question.subjects.size());
  std::optional<std::size_t> known;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const Subject& side = question.subjects[i];
    if (side.setup->observations()) continue;
    const Pilot* const known_pilot = pilot_of(question, i, pilots);
    if (known_pilot == nullptr) return std::nullopt;
    const stats::Moments pilot = known_pilot->moments(side.channels[channel]);
    if (is_constant(question, i, channel, pilot)) return std::nullopt;
    const double averaged = side.averaged(test.plan.primaries[i]);
    data[i] = {.primaries = test.plan.primaries[i],
               .moments = scaled(pilot, averaged, secondaries)};
    known = i;
  }
  if (!known) return std::nullopt;
  for (std::size_t i = 0; i < data.size(); ++i) {
    if (!question.subjects[i].setup->observations()) continue;
    data[i].primaries = data[*known].primaries;
    data[i].moments = data[*known].moments;
  }
  return data;
}

}  // namespace assay::harness
