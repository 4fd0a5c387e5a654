#include "harness/run/image_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/plan/critical.h"
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

}  // namespace

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
  const std::string& seen = test.outcome.channels[0].image->seen;
  if (!seen.empty()) {
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
