#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <utility>

#include "harness/run/evaluate.h"
#include "harness/theta/ask.h"
#include "reports/words/number.h"
#include "stats/images/image_dependence.h"
#include "stats/images/image_family.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

/// The mean of a subject over elements, by their weights or plain.
double mean_over(const DrawnTest& test, std::size_t subject, std::span<const std::size_t> elements,
                 std::span<const float> weights) {
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
double other_mean(const DrawnTest& test, std::span<const std::size_t> elements,
                  std::span<const float> weights) {
  const Question& question = test.outcome.question;
  const double mean = mean_over(test, 1, elements, weights);
  return question.of_two() ? question.factor * mean + question.offset : mean;
}

/// The standard error of the plain mean difference over elements that are independent, by the z of
/// each.
double error_over(const DrawnTest& test, const std::vector<std::size_t>& elements) {
  const std::vector<double>& z = test.outcome.channels[0].image->z;
  double squares = 0;
  for (const std::size_t& i : elements) {
    if (z[i] == 0) continue;
    const std::span one(&i, 1);
    squares += std::pow((mean_over(test, 0, one, {}) - other_mean(test, one, {})) / z[i], 2);
  }
  return std::sqrt(squares) / static_cast<double>(elements.size());
}

/// "`b.exr`", or "image 3 of `b`"; of a pair "`b.exr` less `a.exr`".
std::string name_of(const DrawnTest& test, const stats::WhichImage& which) {
  const Question& question = test.outcome.question;
  const Subject& side = question.subjects[which.side];
  const Pool& pool = test.samples[which.side].pool();
  const std::string place = side.setup->place_of(
      {.index = which.index, .key = pool.key(), .primaries = pool.primaries()});
  const std::string name = place.empty()
                               ? fmt::format("image {} of `{}`", which.index, side.estimator->name)
                               : "`" + place + "`";
  const bool has_partner = question.is().of_pairs && which.side == 0;
  return has_partner ? name + " less " + name_of(test, {1, which.index}) : name;
}

/// Says what to do where images depend on each other: those of equal number on both sides, or
/// others.
std::string mend_of(const DrawnTest& test, bool across) {
  const Question& question = test.outcome.question;
  if (!across) {
    return fmt::format("give each {} a seed of its own, and check that all its bits are used",
                       question.is().of_pairs ? "pair" : "image");
  }
  const bool pairs = question.theta->of_pairs(question) != nullptr;
  return "give one side other seeds" + (pairs ? ", or test their differences with " +
                                                    written_key(*question.test, "paired", "true")
                                              : "");
}

std::string text_of(const DrawnTest& test, const stats::RepeatedTile& repeated) {
  const Question& question = test.outcome.question;
  const ImageShape& shape = *question.subjects[0].image;
  const stats::Rectangle& tile = repeated.tile;
  const bool across =
      repeated.one.side != repeated.other.side && repeated.one.index == repeated.other.index;
  return fmt::format(
      "{} depend on each other: {} and {} are the same at x {}-{}, y {}-{}, bit for bit{}; {}",
      question.is().of_pairs ? "differences" : "images", name_of(test, repeated.one),
      name_of(test, repeated.other), shape.left + tile.x, shape.left + tile.x + tile.width - 1,
      shape.top + tile.y, shape.top + tile.y + tile.height - 1,
      repeated.tiles > 1 ? fmt::format(", and {} more tiles repeat", repeated.tiles - 1) : "",
      mend_of(test, across));
}

std::string text_of(const DrawnTest& test, const stats::AlikeImages& alike) {
  const Question& question = test.outcome.question;
  const std::string which = alike.across ? "images of equal number on both sides"
                            : question.is().of_pairs
                                ? "consecutive differences"
                                : fmt::format("consecutive images of `{}`",
                                              question.subjects[alike.side].estimator->name);
  return fmt::format(
      "{} share random numbers, as {} and {} (their ranks correlate by {:.2g} on average); {}",
      which, name_of(test, {alike.side, 0}),
      name_of(test, alike.across ? stats::WhichImage{1, 0} : stats::WhichImage{alike.side, 1}),
      alike.correlation, mend_of(test, alike.across));
}

/// Throws std::domain_error if images of the test depend on each other.
void require_independent(const DrawnTest& test, const stats::ImageDependence& found) {
  // One seed on both sides repeats the tiles that no difference reaches.
  const bool of_one_seed = found.alike && found.alike->across;
  if (found.repeated && !of_one_seed) throw std::domain_error(text_of(test, *found.repeated));
  if (found.alike) throw std::domain_error(text_of(test, *found.alike));
}

}  // namespace

ImageTest image_test(const DrawnTest& test) {
  return {.share = test.outcome.share(),
          .look = test.samples[0].summary().look(),
          .labels = stream_key(test.samples[0].pool().key().bits, "labels", "", 0),
          .require_independent = [&](const auto& found) { require_independent(test, found); }};
}

bool is_told_by_place(const TestOutcome& outcome, const ChannelOutcome& channel) {
  return channel.image && channel.image->family.log_p <= std::log(outcome.place.share.alpha);
}

std::optional<PlaceEffect> effect_at_place(const DrawnTest& test) {
  const TestOutcome& outcome = test.outcome;
  const Question& question = outcome.question;
  if (outcome.channels.empty() || !outcome.channels[0].image) return {};
  if (!outcome.channels[0].image->seen.empty()) return {};
  const stats::ImageFamily& family = outcome.channels[0].image->family;
  const stats::ImageFinding& winner = family.winner;
  if (winner.alternation || winner.window.width == 0) return {};
  std::vector<std::size_t> elements = elements_of(winner, *question.subjects[0].image);
  const stats::ImageEffect& effect = winner.effect;
  if (!(effect.standard_error > 0)) {
    const std::vector<double>& z = outcome.channels[0].image->z;
    const double least = std::min(std::abs(winner.z), stats::certain_z);
    std::erase_if(elements,
                  [&](std::size_t i) { return std::copysign(1.0, winner.z) * z[i] < least; });
    const double base = other_mean(test, elements, {});
    const double difference = mean_over(test, 0, elements, {}) - base;
    return PlaceEffect{difference, {difference, difference, 1}, base, std::move(elements)};
  }
  // At a larger level than usual a fail would meet an interval that holds 0.
  const double error = std::max(1 - stats::confidence_at_place, outcome.place.share.alpha);
  const double log_level = stats::unadjusted(std::log(error), winner.group);
  const double half = effect.standard_error *
                      stats::student_t_quantile({stats::Tail::upper, log_level - std::numbers::ln2},
                                                effect.degrees);
  const double base = other_mean(test, elements, family.weights);
  return PlaceEffect{.estimate = effect.estimate,
                     .interval = {effect.estimate - half, effect.estimate + half, 1 - error},
                     .other = base,
                     .elements = std::move(elements)};
}

std::string others_at(const DrawnTest& test, const PlaceEffect& place) {
  constexpr std::size_t most = 3;
  constexpr double clear = 3;
  const std::vector<std::string>& names = test.outcome.question.subjects[0].image->components;
  const std::vector<double>& z = test.outcome.channels[0].image->z;
  const std::size_t mine = place.elements[0] % names.size();
  std::vector<std::string> texts;
  for (std::size_t c = 0; c < names.size() && texts.size() < most; ++c) {
    std::vector<std::size_t> elements = place.elements;
    double sum = 0;
    for (std::size_t& i : elements) {
      i = i - mine + c;
      sum += z[i];
    }
    const double base = other_mean(test, elements, {});
    const double difference = mean_over(test, 0, elements, {}) - base;
    const auto error = [&] { return clear * error_over(test, elements); };
    // Pixels count as independent, each as clear as the others or as noisy as it is.
    const double root = std::sqrt(static_cast<double>(elements.size()));
    const bool by_each = std::abs(sum) > clear * root && difference * sum > 0;
    const auto& [low, high, confidence] = place.interval;
    const bool is_clear = c == mine ? std::max(low - difference, difference - high) > error()
                                    : by_each || std::abs(difference) > error();
    if (!is_clear) continue;
    const reports::Effect effect{.relative = base != 0};
    const double unit = effect.relative ? std::abs(base) : 1;
    texts.push_back(names[c] + (texts.empty() ? " differs by " : " by ") +
                    reports::theta_text(difference / unit, effect));
  }
  return texts.empty() ? "" : fmt::format("{} (plain means)", fmt::join(texts, ", "));
}

std::string where_it_differs(const DrawnTest& test) {
  const bool fails = test.outcome.verdict == reports::Verdict::fail;
  const std::vector<ChannelOutcome>& channels = test.outcome.channels;
  if (channels.empty() || !channels[0].image) return "";
  const std::string& seen = channels[0].image->seen;
  if (fails && !seen.empty()) return "; there " + seen;
  std::string constants;
  const std::vector<stats::UnseenElement>& unseen = channels[0].image->family.unseen;
  const auto is_open = std::not_fn(&stats::UnseenElement::certain);
  if (const auto first = std::ranges::find_if(unseen, is_open); first != unseen.end()) {
    const Question& question = test.outcome.question;
    const auto count = std::count_if(first, unseen.end(), is_open);
    constants = fmt::format("; {}{} value{} from {}, {} {}: rare light may be unseen there", count,
                            fails ? " other" : "",
                            count == 1 ? " never varies and differs" : "s never vary and differ",
                            question.of_two() ? "the other side's" : "the reference",
                            count == 1 ? "at" : "the first at",
                            element_place(*question.subjects[0].image, first->element));
  }
  if (!fails || !is_told_by_place(test.outcome, channels[0])) return constants;
  const std::optional<PlaceEffect> effect = effect_at_place(test);
  if (!effect) return constants;
  const bool relative = effect->other != 0;
  const double unit = relative ? std::abs(effect->other) / 100 : 1;
  const char* const per_cent = relative ? " %" : "";
  const char* const weighted =
      effect->elements.size() == 1 ? "" : ", pixels weighted by their noise";
  const auto shown = [&](double value) { return reports::human(value / unit, 3); };
  return fmt::format(
             "; at that place it is {}{} too {} ({} to {}{}): {:.5g} against {:.5g}{}",
             shown(std::abs(effect->estimate)), per_cent, effect->estimate < 0 ? "dark" : "bright",
             shown(effect->estimate < 0 ? -effect->interval.high : effect->interval.low),
             shown(effect->estimate < 0 ? -effect->interval.low : effect->interval.high), per_cent,
             effect->other + effect->estimate, effect->other,
             effect->interval.low < effect->interval.high
                 ? weighted
                 : ", without noise; if it should vary, give each image a seed of its own") +
         constants;
}

void note_detectable(const TestOutcome& outcome, std::size_t look, ChannelOutcome& channel) {
  if (channel.regions.relation == Relation::within || channel.regions.allow > 0) return;
  const ErrorShare share = outcome.share_at(look);
  const double shrunk = std::sqrt(static_cast<double>(outcome.secondaries()) /
                                  static_cast<double>(outcome.plan.looks.sizes[look]));
  const double alpha = (1 - share_of_distance(outcome.question)) * share.alpha;
  const auto found = [&](double part, double error) -> std::optional<double> {
    const double z = critical_value(alpha * part, true) + critical_value(share.beta, false);
    const double least = z * error * shrunk;
    if (!std::isfinite(least) || !(least > 0)) return {};
    return least;
  };
  ImageOutcome& image = *channel.image;
  const auto channels = static_cast<double>(outcome.question.subjects[0].image->components.size());
  const stats::GroupSize& cells = image.family.typical.group;
  channel.detectable = found(stats::whole_image_share / channels, image.uniform_error);
  image.detectable_in_cell = found(cells.share / cells.count, image.cell_error);
}

}  // namespace assay::harness
