#include "harness/plan/claim_size.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/draws/sampler_setup.h"
#include "harness/plan/planned_channel.h"
#include "harness/plan/planned_rates.h"
#include "harness/theta/scale.h"
#include "stats/basics/sorted.h"
#include "stats/laws/quantile_test.h"
#include "stats/tails/tails.h"
#include "stats/variances/slope.h"

namespace assay::harness {
namespace {

// Standard errors that the fitted constant must exceed: a fainter power law cannot be planned.
constexpr double least_visibility = 3;

stats::Moments moments_of(const Question& question, std::size_t subject, std::size_t channel,
                          const Pilots& pilots) {
  return pilot_channel(question, subject, channel, pilots).moments;
}

double deviation(const Question& question, std::size_t subject, std::size_t channel,
                 const Pilots& pilots, const Plan& plan) {
  return std::sqrt(moments_of(question, subject, channel, pilots).variance() /
                   question.subjects[subject].averaged(plan.primaries[subject]));
}

/// The distance to find from the claimed region's edge; 0 if there is none.
double distance_of(const Regions& regions) {
  if (regions.relation == Relation::within) return regions.within;
  return regions.detect ? *regions.detect - regions.allow : 0;
}

double normal_density(double z) { return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi); }

/// The variance of b, or of ln b, at size i from one observation.
double point_variance(const Question& question, std::size_t i, std::size_t channel,
                      const Pilots& pilots, const Plan& plan) {
  const stats::Moments& pilot = moments_of(question, i, channel, pilots);
  const double n = question.subjects[i].averaged(plan.primaries[i]);
  if (!(pilot.m2 > 0)) return 0;
  if (question.test->claim.left.name == QuantityName::variance) {
    return 2 + (pilot.kurtosis() - 3) / n;
  }
  return pilot.variance() / n;
}

/// Least-squares C of C M^s at the claimed exponent s, with its standard error.
struct Fit {
  double constant;
  double standard_error;
};

Fit fit_constant(const Question& question, std::size_t channel, const Pilots& pilots,
                 double exponent) {
  double weight = 0;
  double sum = 0;
  for (std::size_t i = 0; i < question.compared(); ++i) {
    const stats::Moments& pilot = moments_of(question, i, channel, pilots);
    const double shape = std::pow(question.sizes[i], exponent);
    double truth = 0;
    if (question.has_reference_subject) {
      truth = moments_of(question, question.compared(), channel, pilots).mean;
    } else if (!question.truths.empty()) {
      truth = question.truths[i][channel].value;
    }
    const double error = pilot.standard_error();
    weight += shape * shape / error / error;
    sum += shape * (pilot.mean - truth) / error / error;
  }
  return {.constant = sum / weight, .standard_error = 1 / std::sqrt(weight)};
}

/// Points of one observation each, expected if the claim held with this exponent.
std::optional<stats::SlopeData> expected_points(const Question& question, std::size_t channel,
                                                const Pilots& pilots, const Plan& plan,
                                                double exponent) {
  const bool logarithms = question.test->claim.left.name == QuantityName::variance;
  stats::SlopeData data{.scale =
                            logarithms ? stats::SlopeScale::logarithms : stats::SlopeScale::values};
  Fit fit{.constant = 1, .standard_error = 0};
  if (!logarithms) {
    fit = fit_constant(question, channel, pilots, question.references[channel].value);
    // NaN, from a point without spread, counts as unseen.
    const bool seen = std::abs(fit.constant) >= least_visibility * fit.standard_error;
    if (!seen) return std::nullopt;
  }
  for (std::size_t i = 0; i < question.compared(); ++i) {
    const double size = question.sizes[i];
    const double variance = point_variance(question, i, channel, pilots, plan);
    if (!(variance > 0)) return std::nullopt;
    data.points.push_back({.size = size,
                           .estimate = logarithms ? exponent * std::log(size)
                                                  : fit.constant * std::pow(size, exponent),
                           .standard_error = std::sqrt(variance)});
  }
  return data;
}

std::optional<std::uint64_t> slope_channel(const Question& question, std::size_t channel,
                                           const ErrorShare& share, const Pilots& pilots,
                                           const Plan& plan) {
  const Regions& regions = plan.regions[channel];
  const double distance = distance_of(regions);
  if (!(distance > 0)) return std::nullopt;
  const double null = question.references[channel].value;
  const stats::ErrorRates rates = planned_rates(share, regions);
  const auto expected = expected_points(question, channel, pilots, plan, null);
  if (!expected) return std::nullopt;
  double most = 0;
  for (const double edge : {null - distance, null + distance}) {
    const auto factor = stats::slope_sample_factor(
        *expected, edge,
        {.alpha = rates.two_sided ? rates.alpha / 2 : rates.alpha, .beta = rates.beta});
    if (!factor) return impossible_secondaries;
    most = std::max(most, *factor);
  }
  const double count = std::ceil(most);
  return count < 0x1p53 ? static_cast<std::uint64_t>(count) : impossible_secondaries;
}

template <class Channel>
std::optional<std::uint64_t> most_of(const Question& question, const Channel& of_channel) {
  std::optional<std::uint64_t> most;
  for (std::size_t channel = 0; channel < question.channel_count(); ++channel) {
    const std::optional<std::uint64_t> count = of_channel(channel);
    if (count) most = std::max(most.value_or(0), *count);
  }
  return most;
}

/// The probability that the claim counts, and its error.
struct CountedProbability {
  double value = 0;
  double error = 0;
};

CountedProbability counted_probability(const Question& question) {
  const double claimed = question.references[0].value;
  if (question.kind == QuestionKind::inconsistency) return {.value = claimed};
  const auto& draws = dynamic_cast<const SamplerSetup&>(*question.subjects[0].setup);
  return {.value = claimed - draws.density_cells().mass.total,
          .error = draws.density_cells().tolerance()};
}

}  // namespace

std::optional<std::uint64_t> draws_secondaries(const Question& question, const ErrorShare& share,
                                               const Regions& regions) {
  const double distance = distance_of(regions);
  if (!(distance > 0)) return std::nullopt;
  const CountedProbability counted = counted_probability(question);
  const double room = distance - 2 * counted.error;
  if (!(room > 0)) return impossible_secondaries;
  const stats::ErrorRates rates = planned_rates(share, regions);
  const auto quantile = [](double level) {
    return stats::normal_quantile({stats::Tail::upper, std::log(level)});
  };
  const double z = quantile(rates.two_sided ? rates.alpha / 2 : rates.alpha) + quantile(rates.beta);
  const double p = std::clamp(counted.value, 0.0, 0.5) + distance + regions.allow;
  const double variance = std::min(0.25, p * std::max(0.0, 1 - p));
  const double count = z * z * (variance / (room * room) + 1 / room);
  return count < 0x1p53 ? static_cast<std::uint64_t>(std::ceil(count)) : impossible_secondaries;
}

namespace {

/// Least slope of the distribution function beside a quantile, from sorted distances, less two
/// standard errors of a count. It reaches to `distance`, or as far as 64 values do. Returns 0 if
/// there are fewer.
double slope_beside(std::span<const double> distances, double distance, double total) {
  constexpr std::size_t fewest = 64;
  if (distances.size() < fewest) return 0;
  const auto beyond = std::upper_bound(distances.begin(), distances.end(), distance);
  const auto within = static_cast<std::size_t>(beyond - distances.begin());
  const double count = static_cast<double>(std::max(within, fewest));
  const double reach = std::max(distance, distances[fewest - 1]);
  return (count - 2 * std::sqrt(count)) / total / reach;
}

/// quantile_standard_deviation with the density that the pilot shows over this distance, on the
/// quantile's sparser side. Returns nullopt if the pilot does not show it.
std::optional<double> observed_deviation(std::span<const double> pilot, double probability,
                                         double distance) {
  std::vector<double> values(pilot.begin(), pilot.end());
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return std::nullopt;
  values = stats::sorted(std::move(values));
  const double total = static_cast<double>(values.size());
  const std::size_t rank = stats::sample_quantile_rank(values.size(), probability);
  const double middle = values[rank];
  std::vector<double> below;
  for (std::size_t i = rank; i-- > 0;) below.push_back(middle - values[i]);
  std::vector<double> above;
  for (std::size_t i = rank + 1; i < values.size(); ++i) above.push_back(values[i] - middle);
  const double slope =
      std::min(slope_beside(below, distance, total), slope_beside(above, distance, total));
  if (!(slope > 0) || !std::isfinite(slope)) return std::nullopt;
  return stats::quantile_standard_deviation(probability, slope);
}

/// Deviation of one secondary; means of several primaries count as normal.
double quantile_deviation(const Question& question, std::size_t subject, std::size_t channel,
                          double distance, const Pilots& pilots, const Plan& plan) {
  const double probability = question.test->claim.left.arguments[0];
  const PilotChannel pilot = pilot_channel(question, subject, channel, pilots);
  if (question.subjects[subject].averaged(plan.primaries[subject]) == 1) {
    const auto observed = observed_deviation(pilot.values, probability, distance);
    if (observed) return *observed;
  }
  const double z = stats::normal_quantile({stats::Tail::lower, std::log(probability)});
  return stats::quantile_standard_deviation(probability, normal_density(z)) *
         deviation(question, subject, channel, pilots, plan);
}

}  // namespace

std::optional<std::uint64_t> quantile_secondaries(const Question& question, const ErrorShare& share,
                                                  const Pilots& pilots, const Plan& plan) {
  return most_of(question, [&](std::size_t channel) -> std::optional<std::uint64_t> {
    const double unit =
        is_relative(question, channel) ? std::abs(question.references[channel].value) : 1;
    const double distance = distance_of(plan.regions[channel]) * unit;
    if (!(distance > 0)) return std::nullopt;
    double sd = quantile_deviation(question, 0, channel, distance, pilots, plan);
    if (question.of_two()) {
      const double factor = std::abs(question.factor);
      const double other =
          quantile_deviation(question, 1, channel, distance / factor, pilots, plan);
      sd = std::hypot(sd, factor * other);
    }
    if (!(sd > 0)) return std::nullopt;
    const double count = std::ceil(stats::normal_sample_size(
        sd, {.allow = 0, .detect = distance}, planned_rates(share, plan.regions[channel])));
    return count < 0x1p53 ? static_cast<std::uint64_t>(count) : impossible_secondaries;
  });
}

std::optional<std::uint64_t> slope_secondaries(const Question& question, const ErrorShare& share,
                                               const Pilots& pilots, const Plan& plan) {
  if (question.test->claim.left.name == QuantityName::cost) return std::nullopt;
  return most_of(question, [&](std::size_t channel) {
    return slope_channel(question, channel, share, pilots, plan);
  });
}

}  // namespace assay::harness
