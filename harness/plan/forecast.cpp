#include "harness/plan/forecast.h"

#include <algorithm>
#include <cmath>

#include "harness/plan/sample_size.h"
#include "harness/theta/constant.h"
#include "harness/theta/theta.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

/// Edge of the forbidden region, if theta = 0 is claimed and lies outside it.
std::optional<double> margin_of(const Regions& regions) {
  if (regions.relation == Relation::within) return regions.within;
  if (regions.proof()) return std::nullopt;
  return regions.detect;
}

/// P(look `k` does not pass this channel) where theta = 0.
std::optional<double> not_passed(const TestOutcome& test, std::size_t channel, std::size_t k,
                                 const Pilots& pilots) {
  const Regions& regions = test.plan.regions[channel];
  const std::optional<double> margin = margin_of(regions);
  if (!margin) return std::nullopt;
  const auto data = expected_data(test, channel, pilots, test.plan.looks.sizes[k]);
  if (!data) return std::nullopt;
  const std::optional<ThetaError> error = test.question.theta->error(test.question, channel, *data);
  if (!error) return std::nullopt;
  const double beta = test.plan.looks.beta[k];
  const double z = stats::normal_quantile({stats::Tail::upper, std::log(beta)});
  const double room = *margin / std::hypot(error->drawn, error->fixed) - z;
  const double tail = std::exp(stats::normal_tails(room).upper);
  return std::min(1.0, regions.two_sided() ? 2 * tail : tail);
}

/// P(still open after look k), at most.
std::optional<double> open_after(const TestOutcome& test, std::size_t k, const Pilots& pilots) {
  double sum = 0;
  for (std::size_t channel = 0; channel < test.question.channel_count(); ++channel) {
    const std::optional<double> share = not_passed(test, channel, k, pilots);
    if (!share) return std::nullopt;
    sum += *share;
  }
  return std::min(1.0, sum);
}

std::optional<double> share_of(const TestOutcome& test, const Pilots& pilots) {
  const std::vector<std::uint64_t>& sizes = test.plan.looks.sizes;
  if (sizes.size() < 2) return std::nullopt;
  double open = 1;
  double drawn = static_cast<double>(sizes[0]);
  for (std::size_t k = 1; k < sizes.size(); ++k) {
    const std::optional<double> left = open_after(test, k - 1, pilots);
    if (!left) return std::nullopt;
    open = std::min(open, *left);
    drawn += open * static_cast<double>(sizes[k] - sizes[k - 1]);
  }
  return drawn / static_cast<double>(sizes.back());
}

/// The expected channel; nullopt if the pilots say nothing of it.
std::optional<PlannedChannel> expected_channel(const TestOutcome& test, std::size_t channel,
                                               const Pilots& pilots, std::uint64_t secondaries) {
  const Question& question = test.question;
  const Regions& regions = test.plan.regions[channel];
  if (!question.is().of_moments) {
    return question.theta->planned(question, regions, pilots, test.plan);
  }
  for (const Subject& side : question.subjects) {
    if (side.setup->observations()) return std::nullopt;
  }
  const auto data = expected_data(test, channel, pilots, secondaries);
  if (!data) return std::nullopt;
  return question.theta->observed(question, regions, channel, *data);
}

/// The least margin that a claim of that size proves with probability 1 - beta if theta is 0, by
/// bisection to a thousandth. Returns nullopt if no formula tells, or none is.
std::optional<double> margin_shown(const Question& question, const TestSize& size, const Plan& plan,
                                   PlannedChannel channel) {
  constexpr double farthest = 0x1p100;
  const auto shows = [&](double margin) {
    channel.regions.within = margin;
    return power_at(question, size, plan, channel, 0).value_or(0) >= 1 - size.share.beta;
  };
  double above = channel.regions.within;
  if (!(above > 0)) return std::nullopt;
  constexpr double factor = 2;
  while (above > 1 / farthest && shows(above / factor)) above /= factor;
  while (!shows(above)) {
    if (above > farthest) return std::nullopt;
    above *= factor;
  }
  double below = above / factor;
  while (above > below * 1.001) {
    const double middle = std::sqrt(below * above);
    (shows(middle) ? above : below) = middle;
  }
  return above;
}

std::optional<double> shown_or_found(const Question& question, const TestSize& size,
                                     const Plan& plan, const PlannedChannel& channel) {
  const bool shows = channel.regions.relation == Relation::within;
  return shows ? margin_shown(question, size, plan, channel)
               : detectable_effect(question, size, plan, channel);
}

std::optional<double> detectable_of(const TestOutcome& test, const Pilots& pilots) {
  const Plan& plan = test.plan;
  const TestSize size{.share = test.share_at(plan.looks.count() - 1),
                      .secondaries = plan.most_secondaries()};
  std::optional<double> largest;
  for (std::size_t channel = 0; channel < test.question.channel_count(); ++channel) {
    const auto planned = expected_channel(test, channel, pilots, size.secondaries);
    if (!planned) return std::nullopt;
    const auto found = shown_or_found(test.question, size, plan, *planned);
    if (found) largest = std::max(*found, largest.value_or(0));
  }
  return largest;
}

/// Moments as if `count` means of `averaged` primaries each had been drawn.
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

Forecast forecast(const TestOutcome& test, const Pilots& pilots) {
  if (!test.plan.invalid.empty() || !test.plan.error.empty()) return {};
  return {.detectable = detectable_of(test, pilots), .share = share_of(test, pilots)};
}

std::uint64_t expected_secondaries(const TestOutcome& test, const Pilots& pilots) {
  const double share = share_of(test, pilots).value_or(1);
  return static_cast<std::uint64_t>(
      std::ceil(share * static_cast<double>(test.plan.most_secondaries())));
}

std::optional<std::vector<ChannelData>> expected_data(const TestOutcome& test, std::size_t channel,
                                                      const Pilots& pilots,
                                                      std::uint64_t secondaries) {
  const Question& question = test.question;
  // An estimator's pilot says nothing of a sampler's draws.
  if (!question.is().of_moments) return std::nullopt;
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
    if (averaged == 1) data[i].values = pilot_channel(question, i, channel, pilots).values;
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
