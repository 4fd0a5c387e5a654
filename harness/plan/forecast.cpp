#include "harness/plan/forecast.h"

#include <algorithm>
#include <cmath>

#include "harness/plan/independence.h"
#include "harness/plan/sizes.h"
#include "harness/theta/theta.h"

namespace assay::harness {
namespace {

/// Data that the pilots predict for a channel at this many secondaries: moments scaled to the
/// plan's primaries, with what rows are allowed. Returns nullopt if an estimator has no pilot, or
/// no spread in it.
std::optional<std::vector<ChannelData>> expected_data(const TestOutcome& test, std::size_t channel,
                                                      const Pilots& pilots,
                                                      std::uint64_t secondaries) {
  const Question& question = test.question;
  // An estimator's pilot says nothing of a sampler's draws.
  if (!question.is().of_moments || test.plan.method.is.of_batches) return std::nullopt;
  std::vector<ChannelData> data(question.subjects.size());
  for (std::size_t i = 0; i < data.size(); ++i) {
    const Subject& side = question.subjects[i];
    const Pilot* const pilot = pilot_of(side, pilots);
    if (pilot == nullptr) return std::nullopt;
    const PilotChannel seen = pilot_channel(side, *pilot, channel);
    if (is_constant(question, i, channel, seen.moments)) return std::nullopt;
    const double averaged = side.averaged(test.plan.primaries[i]);
    const stats::Moments moments =
        stats::moments_of_means(seen.moments, averaged, side.secondaries(secondaries));
    data[i] = {.primaries = test.plan.primaries[i],
               .moments = as_tested(test.plan, i, channel, seen.values, moments)};
    if (!std::isfinite(data[i].moments.m2)) return std::nullopt;
    if (averaged == 1) data[i].values = seen.values;
  }
  return data;
}

using StoppingLooks = std::vector<stats::StoppingLook>;

std::optional<StoppingLooks> stopping_looks(const TestOutcome& test, std::size_t channel,
                                            const Pilots& pilots) {
  StoppingLooks looks;
  for (std::size_t k = 0; k < test.plan.looks.count(); ++k) {
    const auto data = expected_data(test, channel, pilots, test.plan.looks.sizes[k]);
    if (!data) return std::nullopt;
    const auto error = test.question.theta->error({test.question, channel, *data});
    const double size = error ? std::hypot(error->drawn, error->fixed) : 0;
    if (!(size > 0)) return std::nullopt;
    const Regions& regions = test.plan.regions[channel];
    const auto [alpha, beta] = test.share_at(k);
    looks.push_back(stats::stopping_look({.claimed = regions.claimed_edge(),
                                          .forbidden = regions.forbidden_edge(),
                                          .two_sided = regions.two_sided()},
                                         size, alpha, beta));
  }
  return looks;
}

/// Adds the outlooks, where the pilots give every channel a standard error.
void foresee(const TestOutcome& test, const Pilots& pilots, Forecast& found) {
  if (test.plan.looks.law == stats::LookLaw::anytime_valid) return;
  std::vector<stats::Outlook> if_true;
  std::optional<stats::Outlook> if_off;
  for (std::size_t channel = 0; channel < test.question.channel_count(); ++channel) {
    const auto looks = stopping_looks(test, channel, pilots);
    if (!looks) return;
    const Regions& regions = test.plan.regions[channel];
    const bool one_sided_proof = regions.proof() && !regions.two_sided();
    if (!one_sided_proof || regions.detect) {
      if_true.push_back(
          stats::outlook_at(*looks, one_sided_proof ? -*regions.detect : 0, test.plan.looks.sizes));
    }
    if (const std::optional<double> edge = regions.forbidden_edge()) {
      const stats::Outlook off = stats::outlook_at(*looks, *edge, test.plan.looks.sizes);
      if (!if_off || off.pass > if_off->pass) if_off = off;
    }
  }
  if (!if_true.empty()) found.if_true = stats::together(if_true);
  found.if_off = if_off;
}

/// The expected channel; nullopt if the pilots say nothing of it.
std::optional<PlannedChannel> expected_channel(const TestOutcome& test, std::size_t channel,
                                               const Pilots& pilots, std::uint64_t secondaries) {
  const Question& question = test.question;
  const Regions& regions = test.plan.regions[channel];
  if (!question.is().of_moments) {
    return question.theta->planned(test, regions, pilots);
  }
  const auto data = expected_data(test, channel, pilots, secondaries);
  if (!data) return std::nullopt;
  return question.theta->observed({question, channel, *data}, regions);
}

std::optional<double> detectable_of(const TestOutcome& test, const Pilots& pilots) {
  const TestSize size{.share = test.share_at(test.plan.looks.count() - 1),
                      .secondaries = test.plan.most_secondaries()};
  std::optional<double> largest;
  for (std::size_t channel = 0; channel < test.question.channel_count(); ++channel) {
    const auto planned = expected_channel(test, channel, pilots, size.secondaries);
    if (!planned) return std::nullopt;
    const auto found = detectable_effect({test, size, *planned});
    if (found) largest = std::max(*found, largest.value_or(0));
  }
  return largest;
}

}  // namespace

Forecast forecast(const TestOutcome& test, const Pilots& pilots) {
  if (!test.plan.error.empty() || !test.plan.pilot_error.empty()) return {};
  if (!test.plan.invalid.empty()) return {.if_true = stats::Outlook{}, .if_off = stats::Outlook{}};
  Forecast found{.detectable = detectable_of(test, pilots)};
  foresee(test, pilots, found);
  return found;
}

std::optional<PilotedCost> observation_cost(const Subject& subject, std::uint64_t primaries,
                                            const Pilots& pilots) {
  const Pilot* pilot = averaged_pilot_of(subject, pilots);
  if (pilot == nullptr) pilot = pilot_of(subject, pilots);
  const bool is_draw = pilot == nullptr;
  if (is_draw) pilot = pilots.find(subject.estimator->name);
  if (pilot == nullptr || pilot->sums == nullptr || pilot->sums->count == 0) return {};
  const Summary& sums = *pilot->sums;
  const double part =
      static_cast<double>(primaries) / static_cast<double>(sums.count * pilot->primaries);
  return PilotedCost{.rays = is_draw ? 0 : part * static_cast<double>(sums.cost.rays()),
                     .samples = part * static_cast<double>(sums.cost.samples),
                     .seconds = part * sums.seconds};
}

std::uint64_t expected_secondaries(const TestOutcome& test, const Pilots& pilots) {
  Forecast found;
  if (test.plan.invalid.empty()) foresee(test, pilots, found);
  const double drawn = found.if_true ? found.if_true->drawn : 1;
  return static_cast<std::uint64_t>(
      std::ceil(drawn * static_cast<double>(test.plan.most_secondaries())));
}

}  // namespace assay::harness
