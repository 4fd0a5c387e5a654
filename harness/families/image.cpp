#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "harness/base/work.h"
#include "harness/families/families.h"
#include "harness/run/evaluate.h"
#include "harness/sampling/image_views.h"
#include "harness/theta/ask.h"
#include "stats/images/image_covariance.h"

namespace assay::harness {
namespace {

const Location& place_of(const Question& question) { return question.test->claim.left.where; }

bool is_against_darkness(const Question& question) {
  return !question.of_two() &&
         std::ranges::all_of(question.references,
                             [](const Constant& reference) { return reference.value == 0; });
}

/// Only images of as many primaries have one law, or share their random numbers.
void require_equal_primaries(const Question& question) {
  std::vector<std::string> words;
  for (const Subject& side : question.subjects) {
    if (is_recorded(side)) return;  // files do not tell
    const auto& given = side.estimator->primaries;
    const bool one = question.is().of_single_values && !given;
    words.push_back(given || one ? fmt::format("{}", given.value_or(1)) : "auto");
  }
  if (words[0] == words[1]) return;
  refuse(place_of(question),
         "`{}` has `primaries: {}` and `{}` has `primaries: {}`; give both the same",
         question.subjects[0].estimator->name, words[0], question.subjects[1].estimator->name,
         words[1]);
}

std::string counts_text(const Question& question) {
  std::string words;
  for (const Subject& side : question.subjects) {
    const auto count = side.setup->observations();
    words += fmt::format("{}`{}` {}", words.empty() ? "" : ", ", side.estimator->name,
                         count ? fmt::format("has {} pictures", *count) : "is drawn");
  }
  return words + ": each picture needs a partner of the same seed on the other side";
}

bool is_digit(char c) { return '0' <= c && c <= '9'; }

/// Takes off what all names begin with, without part of a number, and turns them around.
void remove_beginnings(std::vector<std::string>& names) {
  const auto [first, last] = std::ranges::minmax(names);
  auto length = static_cast<std::size_t>(std::ranges::mismatch(first, last).in1 - first.begin());
  const bool in_number = std::ranges::any_of(names, [&](const std::string& name) {
    return length < name.size() && is_digit(name[length]);
  });
  while (in_number && length > 0 && is_digit(names[0][length - 1])) --length;
  for (std::string& name : names) {
    name.erase(0, length);
    std::ranges::reverse(name);
  }
}

/// Keys tell a side's pictures apart: their names without the beginning and the end that all have
/// in common.
std::vector<std::string> keys_of(const Setup& side) {
  std::vector<std::string> names = mapped_indices(
      *side.observations(), [&](std::size_t i) { return side.place_of({.index = i}); });
  remove_beginnings(names);
  remove_beginnings(names);  // which are the ends now
  static const std::regex leading_zeros("(^|[^0-9])0+(?=[0-9])");
  for (std::string& name : names) name = std::regex_replace(name, leading_zeros, "$1");
  return names;
}

void require_partners(const Question& question) {
  const Setup& first = *question.subjects[0].setup;
  const Setup& second = *question.subjects[1].setup;
  const std::vector<std::string> keys = keys_of(first);
  const std::vector<std::string> others = keys_of(second);
  for (std::uint64_t i = 0; i < keys.size(); ++i) {
    if (keys[i] == others[i] && std::ranges::count(keys, keys[i]) == 1) continue;
    refuse(place_of(question),
           "`{}` and `{}` are not a pair of one seed: their names say `{}` and `{}`; name both "
           "pictures of a seed alike, and pictures of two seeds differently",
           first.place_of({.index = i}), second.place_of({.index = i}), keys[i], others[i]);
  }
}

bool all_pictured(const Question& question, const Pilots& pilots) {
  return std::ranges::all_of(question.subjects, [&](const Subject& side) {
    const Pilot* pilot = pilot_of(side, pilots);
    return pilot != nullptr && pilot->image_count() >= stats::least_replicates;
  });
}

ImageViews pilot_views(const Subject& side, const Pilots& pilots) {
  return {pilot_of(side, pilots)->images, side.channels};
}

/// The noise of an observation, and the brightness that margins are relative to: of pairs that of
/// what is subtracted.
stats::ImageNoise planned_noise(const TestOutcome& test, const Pilots& pilots) {
  const Question& question = test.question;
  const std::vector<std::uint64_t>& primaries = test.plan.primaries;
  stats::ImageNoise all;
  if (question.is().of_pairs) {
    const std::vector<ChannelData> data = mapped(question.subjects, [&](const Subject& side) {
      return ChannelData{.images = pilot_views(side, pilots)};
    });
    const ImagePair pair({question, 0, data});
    stats::ImageNoise noise = stats::noise_of_pilot(pair.first, on_all_threads);
    noise.squared_norm = stats::image_squared_mean(*pair.subtracted);
    all.add(noise, 1, question.subjects[0].averaged(primaries[0]));
    return all;
  }
  for (std::size_t s = 0; s < question.subjects.size(); ++s) {
    const Subject& side = question.subjects[s];
    const ImageViews views = pilot_views(side, pilots);
    const stats::ImageNoise noise =
        stats::noise_of_pilot({extent_of(*side.image), views.images()}, on_all_threads);
    all.add(noise, s == 0 ? 1 : question.factor * question.factor, side.averaged(primaries[s]));
  }
  return all;
}

double squared_unit(const Question& question, const stats::ImageNoise& last) {
  if (!question.theta->is_relative(question, 0)) {
    return static_cast<double>(question.subjects[0].channels.size());
  }
  if (question.of_two()) return last.squared_norm;
  double sum = 0;
  for (const Constant& reference : question.references) {
    const double value = reference.value + question.offset;
    sum += value * value;
  }
  return sum;
}

/// Theta is the size of the difference of two images' means over all elements, or of one image and
/// numbers (image_evidence.h).
class ImageTheta : public Theta {
 public:
  explicit ImageTheta(
      const ThetaTraits& traits = {.joins_channels = true, .of_images = true},
      const Method& row = {"image", "cells of every size, and alternating sums, of two images",
                           any_question, Keeps::images, nullptr})
      : Theta(traits, {row}) {}

  const Theta* of_images() const override { return this; }
  const Theta* of_pairs(const Question& question) const override;
  void check(const Question& question) const override {
    require_one_size(question);
    const TestEntry& test = *question.test;
    const Subject& first = question.subjects[0];
    if (!is_two_sided(test.claim.relation)) {
      refuse(place_of(question),
             "images are claimed to be equal (`==`) or `within` a margin of each other; for `{}` "
             "name one pixel, as in `{}.{}`",
             to_string(test.claim.relation), first.estimator->name, element_name(*first.image, 0));
    }
    // A number's error is common to all pixels, but the methods need independent ones.
    const auto* number = std::get_if<Constant>(&test.claim.right);
    if ((number != nullptr && number->standard_error > 0) ||
        (test.reference_number && test.reference_number->standard_error > 0)) {
      refuse(place_of(question),
             "the error of one number is common to all pixels: no method takes `+-` for images");
    }
    if (number != nullptr && !is_against_darkness(question) && first.image->left_out) {
      refuse(place_of(question),
             "`{}` leaves out pixels, but a number is claimed of all pixels: use a `crop` instead "
             "of the `mask`",
             first.estimator->name);
    }
  }
  void check_margin(const Question& question, const Margin& margin) const override {
    if (!is_against_darkness(question)) return;
    require_absolute(margin, "the reference is zero in every pixel");
  }

  std::string channel_name(const Question& question, std::size_t) const override {
    return image_name(*question.subjects[0].image);
  }
  std::string claimed_value(const Question& question, std::size_t channel) const override {
    const bool analytic = std::holds_alternative<Analytic>(question.test->claim.right);
    return analytic ? "analytic" : Theta::claimed_value(question, channel);
  }
  std::string circumstances(const Question&) const override { return " in every pixel"; }

  bool is_relative(const Question& question, std::size_t) const override {
    const bool of_a_bias = question.test->claim.left.row->relative_to_0;
    if (of_a_bias) return has_margin(*question.test, true);
    return !has_margin(*question.test, false) && !is_against_darkness(question);
  }

  std::uint64_t choose(TestOutcome& test, const Pilots& pilots) const override {
    const Question& question = test.question;
    const bool in_looks = has_planned_size(question) && !question.test->secondaries;
    // Rows have one look, whose size nothing plans.
    if (in_looks && all_pictured(question, pilots) && !has_rows(question)) {
      test.plan.image = planned_noise(test, pilots);
    }
    return stats::least_replicates;
  }
  /// Replicates that exclude `detect` or prove `within` if the images are equal.
  std::optional<std::uint64_t> secondaries(const TestOutcome& test, const ErrorShare& share,
                                           const Pilots&) const override {
    const std::optional<stats::ImageNoise>& noise = test.plan.image;
    if (!noise) return std::nullopt;
    const Regions& regions = test.plan.regions[0];
    return stats::image_sample_size(*noise,
                                    {.allow = regions.allow,
                                     .detect = *regions.detect,
                                     .squared_unit = squared_unit(test.question, *noise)},
                                    share.beta, impossible_secondaries);
  }
  /// The root mean square of an element.
  double known_size(const Question& question, const Pilots* pilots) const override {
    if (!question.of_two() || pilots == nullptr || !all_pictured(question, *pilots)) {
      return Theta::known_size(question, pilots);
    }
    const Subject& second = question.subjects[1];
    const ImageViews views = pilot_views(second, *pilots);
    const PictureLook* const look = pilot_of(second, *pilots)->sums->look();
    const stats::ImageStack stack{extent_of(*second.image), views.images()};
    const stats::ChannelMeans means =
        look != nullptr ? look->means[1] : stats::channel_means(stack, on_all_threads);
    const bool is_known = std::ranges::any_of(means, [](const Constant& mean) {
      return size_beyond_error(mean.value, mean.standard_error) > 0;
    });
    if (!is_known) return 0;
    const double sum =
        look != nullptr ? look->distance.squared_norm : stats::image_squared_mean(stack);
    const auto elements = static_cast<double>(second.channels.size());
    return std::abs(question.factor) * std::sqrt(std::max(0.0, sum) / elements);
  }
  std::string too_few(const TestOutcome& test) const override {
    const Question& question = test.question;
    std::uint64_t fewest = test.plan.most_secondaries();
    for (const Subject& side : question.subjects) fewest = side.secondaries(fewest);
    if (fewest >= stats::least_replicates) return "";
    return fmt::format(
        "{0} images are too few: each pixel's variance comes from them alone, and {1} are needed "
        "to tell one pixel of {2} from its reference; {3}",
        fewest, stats::least_replicates, question.subjects[0].channels.size(),
        question.test->budget
            ? "give a larger `budget`, which pays `primaries` for every pixel and component, or "
              "fewer `primaries`"
            : fmt::format(fmt::runtime(question.test->secondaries ? "take {} `secondaries` or more"
                                                                  : "give {} or more"),
                          stats::least_replicates));
  }

  ChannelEvidence evidence(const DrawnTest& test, const Seen& seen) const override {
    return evidence_of_images(seen, image_test(test));
  }

  std::string caveat(const DrawnTest& test) const override {
    const Question& question = test.outcome.question;
    const ScaledQuantity* const other = other_side(question.test->claim);
    if (question.of_two() || other == nullptr) return "";
    const bool exact = std::ranges::all_of(
        question.references, [](const Constant& each) { return each.standard_error == 0; });
    if (!exact) return "";
    return fmt::format(
        "`{}` is one picture, taken as exact; if it was rendered, its noise counts as a "
        "difference: render it 16 times or more",
        other->quantity.source.estimator);
  }
};

/// Theta is the size of the mean of differences of images that share their random numbers.
class PairedImageTheta final : public ImageTheta {
 public:
  PairedImageTheta() : ImageTheta({.joins_channels = true, .of_images = true, .of_pairs = true}) {}
  std::string circumstances(const Question& question) const override {
    return ImageTheta::circumstances(question) + ", in pairs of equal random numbers";
  }
  void check(const Question& question) const override {
    ImageTheta::check(question);
    const Setup& first = *question.subjects[0].setup;
    const Setup& second = *question.subjects[1].setup;
    if (first.observations() != second.observations())
      refuse(place_of(question), counts_text(question));
    if (first.observations()) require_partners(question);
    require_equal_primaries(question);
    if (question.subjects[0].estimator == question.subjects[1].estimator) {
      refuse(place_of(question),
             "both sides of the pairs are `{}`; name another estimator, or leave `paired` out",
             question.subjects[0].estimator->name);
    }
  }
};

/// Theta is 0 if both images have one law. It has no size.
class ImageLawTheta final : public ImageTheta {
  static constexpr double least_alpha = 1e-5;

 public:
  ImageLawTheta()
      : ImageTheta({.joins_channels = true, .of_single_values = true, .of_a_law = true},
                   {"permutation", "permutation of labels: laws of two images", any_question,
                    Keeps::images, nullptr, exact_at_any_size}) {}

  const Theta* of_pairs(const Question&) const override { return nullptr; }
  void check(const Question& question) const override {
    if (!question.of_two()) {
      refuse(place_of(question),
             "the law of an image is compared with that of another image, as in `distribution(new) "
             "== distribution(old)`");
    }
    ImageTheta::check(question);
    require_equal_primaries(question);
  }
  std::uint64_t choose(TestOutcome& test, const Pilots& pilots) const override {
    const double alpha = test.place.share.alpha;
    if (alpha < least_alpha && test.plan.invalid.empty()) {
      test.plan.invalid = fmt::format(
          "its share of alpha is {:.2g}, and a test of laws needs {:g} or more, as it draws 1 / "
          "alpha permutations: give it more `weight`, or the suite a larger `alpha`",
          alpha, least_alpha);
    }
    return ImageTheta::choose(test, pilots);
  }
  void check_margin(const Question&, const Margin& margin) const override {
    refuse(margin.where,
           "laws of images are the same or not, so a margin has no meaning here; leave it out");
  }
  ChannelEvidence evidence(const DrawnTest& test, const Seen& seen) const override {
    return evidence_of_image_laws(seen, image_test(test));
  }
};

const Theta* ImageTheta::of_pairs(const Question& question) const {
  const bool of_bias = question.test->claim.left.row->relative_to_0;
  return question.of_two() && !of_bias ? &one<PairedImageTheta>() : nullptr;
}

}  // namespace

const Theta& theta_of_images() { return one<ImageTheta>(); }
const Theta& theta_of_image_laws() { return one<ImageLawTheta>(); }

}  // namespace assay::harness
