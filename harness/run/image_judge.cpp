#include "harness/run/image_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimators/ready_made.h"
#include "harness/base/parallel.h"
#include "harness/plan/sizes.h"
#include "harness/sampling/element_sums.h"
#include "harness/sampling/pool.h"
#include "harness/theta/ask.h"
#include "stats/images/image_dependence.h"
#include "stats/images/image_windows.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

/// Indices of a window's elements in a question.
std::vector<std::size_t> elements_of(const stats::ImageFinding& finding, const ImageShape& shape) {
  std::vector<std::size_t> elements;
  const stats::Rectangle& window = finding.window;
  for (std::size_t y = window.y; y < window.y + window.height; ++y) {
    for (std::size_t x = window.x; x < window.x + window.width; ++x) {
      elements.push_back((y * shape.width + x) * shape.components.size() + finding.channel);
    }
  }
  return elements;
}

/// The mean of a subject over elements, by their weights or plain.
double mean_over(const DrawnTest& test, std::size_t subject,
                 const std::vector<std::size_t>& elements, const std::vector<float>& weights) {
  const Question& question = test.outcome.question;
  const bool numbers = subject >= question.subjects.size();
  double sum = 0;
  double weight = 0;
  for (const std::size_t i : elements) {
    const double w = weights.empty() ? 1 : static_cast<double>(weights[i]);
    const double value =
        numbers
            ? question.references[i].value + question.offset
            : test.samples[subject].summary().moments(question.subjects[subject].channels[i]).mean;
    sum += w * value;
    weight += w;
  }
  return sum / weight;
}

/// The mean of what the first image is held against.
double other_mean(const DrawnTest& test, const std::vector<std::size_t>& elements,
                  const std::vector<float>& weights) {
  const Question& question = test.outcome.question;
  const double mean = mean_over(test, 1, elements, weights);
  return question.of_two() ? question.factor * mean + question.offset : mean;
}

/// "`b.exr`", or "image 3 of `b`".
std::string name_of(const DrawnTest& test, const stats::WhichImage& which) {
  const Subject& side = test.outcome.question.subjects[which.side];
  const Pool& pool = test.samples[which.side].pool();
  const std::string place = recorded::observation_place(
      *side.setup, {.index = which.index, .key = pool.key(), .primaries = pool.primaries()});
  if (!place.empty()) return "`" + place + "`";
  return fmt::format("image {} of `{}`", which.index, side.estimator->name);
}

std::string text_of(const DrawnTest& test, const stats::RepeatedTile& repeated) {
  const ImageShape& shape = *test.outcome.question.subjects[0].image;
  const stats::Rectangle& tile = repeated.tile;
  return fmt::format(
      "images depend on each other: {} and {} are the same at x {}-{}, y {}-{}, bit for bit{}; "
      "give "
      "each image a seed of its own, and see that all its bits count",
      name_of(test, repeated.one), name_of(test, repeated.other), shape.left + tile.x,
      shape.left + tile.x + tile.width - 1, shape.top + tile.y,
      shape.top + tile.y + tile.height - 1,
      repeated.tiles > 1 ? fmt::format(", and {} more tiles repeat", repeated.tiles - 1) : "");
}

std::string text_of(const DrawnTest& test, const stats::AlikeImages& alike) {
  const std::string common = fmt::format(
      "share random numbers, as {} and {} (their ranks correlate by {:.2g} on average)",
      name_of(test, {alike.side, 0}),
      name_of(test, alike.across ? stats::WhichImage{1, 0} : stats::WhichImage{alike.side, 1}),
      alike.correlation);
  if (alike.across) {
    return "images of equal number on both sides " + common +
           "; give one side other seeds, or test their differences with " +
           written_key(*test.outcome.question.test, "paired", "true");
  }
  return fmt::format("consecutive images of `{}` {}; give each image a seed of its own",
                     test.outcome.question.subjects[alike.side].estimator->name, common);
}

}  // namespace

std::string dependence_of_images(const DrawnTest& test, std::span<const ChannelData> data) {
  const std::shared_ptr<const PictureLook>& look = test.outcome.plan.look;
  const stats::ImageDependence found =
      look ? look->dependence : with_pair(test.outcome.question, data, [](const auto& pair) {
        return pair.with([](const auto& first, const auto& second) {
          return stats::image_dependence(stats::pair_of(first, second), on_all_threads);
        });
      });
  // One seed on both sides repeats the tiles that no difference reaches.
  const bool of_one_seed = found.alike && found.alike->across;
  if (found.repeated && !of_one_seed) return text_of(test, *found.repeated);
  return found.alike ? text_of(test, *found.alike) : "";
}

ImageTest image_test(const DrawnTest& test) {
  const TestOutcome& outcome = test.outcome;
  const std::vector<Subject>& subjects = outcome.question.subjects;
  return {.share = outcome.share(),
          .independent = std::all_of(subjects.begin(), subjects.end(),
                                     [](const Subject& s) { return s.image->independent; }),
          .look = outcome.plan.look.get()};
}

ImageViews images_of(const DrawnTest& test, std::size_t subject) {
  return {test.samples[subject].observations(), test.outcome.question.subjects[subject].channels};
}

std::optional<PlaceEffect> effect_at_place(const DrawnTest& test) {
  const TestOutcome& outcome = test.outcome;
  const Question& question = outcome.question;
  if (outcome.channels.empty() || !outcome.channels[0].image) return {};
  if (!outcome.channels[0].image->seen.empty()) return {};
  const stats::ImageFamily& family = outcome.channels[0].image->family;
  const stats::ImageFinding& winner = family.winner;
  if (winner.statistic != stats::ImageStatistic::window || winner.window.width == 0) return {};
  const std::vector<std::size_t> elements = elements_of(winner, *question.subjects[0].image);
  const stats::ImageEffect& effect = winner.effect;
  if (!(effect.standard_error > 0)) {
    const double base = other_mean(test, elements, {});
    const double difference = mean_over(test, 0, elements, {}) - base;
    return PlaceEffect{difference, {difference, difference, 1}, base};
  }
  const double half =
      effect.margin +
      effect.standard_error *
          stats::student_t_quantile({stats::Tail::upper, std::log((1 - confidence_at_place) / 2)},
                                    effect.degrees);
  return PlaceEffect{
      .estimate = effect.estimate,
      .interval = {effect.estimate - half, effect.estimate + half, confidence_at_place},
      .other = other_mean(test, elements, family.weights)};
}

std::string means_where_it_differs(const DrawnTest& test) {
  if (test.outcome.verdict != reports::Verdict::fail) return "";
  const std::vector<ChannelOutcome>& channels = test.outcome.channels;
  if (channels.empty() || !channels[0].image) return "";
  if (const std::string& seen = channels[0].image->seen; !seen.empty()) {
    return fmt::format("; there {} in `{}`", seen,
                       test.outcome.question.subjects[0].estimator->name);
  }
  const std::optional<PlaceEffect> effect = effect_at_place(test);
  if (!effect) return "";
  const bool relative = effect->other != 0;
  const double unit = relative ? std::abs(effect->other) / 100 : 1;
  const char* const per_cent = relative ? " %" : "";
  return fmt::format("; there it is {:.3g}{} too {} ({:.3g} to {:.3g}{}): {:.5g} against {:.5g}",
                     std::abs(effect->estimate) / unit, per_cent,
                     effect->estimate < 0 ? "dark" : "bright",
                     (effect->estimate < 0 ? -effect->interval.high : effect->interval.low) / unit,
                     (effect->estimate < 0 ? -effect->interval.low : effect->interval.high) / unit,
                     per_cent, effect->other + effect->estimate, effect->other);
}

std::optional<double> detectable_uniformly(const TestOutcome& outcome, const TestSize& size,
                                           const ChannelOutcome& channel) {
  if (channel.regions.relation == Relation::within || channel.regions.allow > 0) return {};
  const double part = stats::whole_image_share /
                      static_cast<double>(outcome.question.subjects[0].image->components.size());
  const double z =
      critical_value(size.share.alpha * part, true) + critical_value(size.share.beta, false);
  const double shrunk =
      std::sqrt(static_cast<double>(outcome.secondaries()) / static_cast<double>(size.secondaries));
  const double found = z * channel.image->uniform_error * shrunk;
  if (!std::isfinite(found) || !(found > 0)) return {};
  return found;
}

}  // namespace assay::harness
