#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "estimators/ready_made.h"
#include "harness/families/families.h"
#include "harness/plan/image_plan.h"
#include "harness/question/question_sources.h"
#include "harness/run/image_judge.h"
#include "harness/theta/ask.h"

namespace assay::harness {
namespace {

// ---- Binding

[[noreturn]] void refuse(const Question& question, const std::string& why) {
  throw InputError(question.test->claim.left.where, why);
}

std::string size_text(const Subject& subject) {
  if (!subject.image) return fmt::format("`{}` is no image", subject.estimator->name);
  return fmt::format("`{}` has {} x {} pixels of {}", subject.estimator->name, subject.image->width,
                     subject.image->height, fmt::join(subject.image->components, ", "));
}

void require_one_size(const Question& question) {
  const Subject& first = question.subjects[0];
  for (const Subject& other : question.subjects) {
    const bool same = first.image && other.image && first.image->width == other.image->width &&
                      first.image->height == other.image->height &&
                      first.image->components.size() == other.image->components.size();
    if (same) continue;
    refuse(question, fmt::format("{}, and {}: only images of one size and as many channels can be "
                                 "compared, element by element",
                                 size_text(first), size_text(other)));
  }
}

void require_tested_relation(const Question& question) {
  const Relation relation = question.test->claim.relation;
  if (relation == Relation::equal || relation == Relation::within) return;
  refuse(question,
         fmt::format("images are claimed to be equal (`==`) or `within` a margin of each other; "
                     "for `{}` name one pixel, as in `{}.{}`",
                     to_string(relation), question.subjects[0].estimator->name,
                     element_name(*question.subjects[0].image, 0)));
}

/// A number's error is common to all pixels, but the methods need independent ones.
void require_exact_number(const Question& question) {
  const auto* number = std::get_if<Constant>(&question.test->claim.right);
  if ((number != nullptr && number->standard_error > 0) ||
      (question.test->reference_number && question.test->reference_number->standard_error > 0)) {
    refuse(question,
           "the error of one number is common to all pixels: `+-` has no method for images");
  }
}

void require_something(const Question& question) {
  if (question.of_two()) return;
  const bool dark = std::all_of(question.references.begin(), question.references.end(),
                                [](const Constant& reference) { return reference.value == 0; });
  if (!dark) return;
  const TestEntry& test = *question.test;
  const bool relative = has_relative_margin(test);
  if (relative) {
    throw InputError(test.where,
                     "a margin in per cent has no meaning here: the reference is zero in every "
                     "pixel; give an absolute number");
  }
}

// ---- Pairs

std::string counts_text(const Question& question) {
  std::string words;
  for (const Subject& side : question.subjects) {
    const auto count = side.setup->observations();
    words += fmt::format("{}`{}` {}", words.empty() ? "" : ", ", side.estimator->name,
                         count ? fmt::format("has {} pictures", *count) : "is drawn");
  }
  return words + ": each picture needs a partner of the same seed on the other side";
}

/// The number in a file's name that partners have in common, without leading zeros.
std::string last_number(const std::string& file) {
  const std::size_t end = file.find_last_of("0123456789");
  if (end == std::string::npos) return "";
  const std::size_t before = file.find_last_not_of("0123456789", end);
  const std::string digits = file.substr(before + 1, end - before);
  return digits.substr(std::min(digits.find_first_not_of('0'), digits.size() - 1));
}

bool are_partners(const std::string& one, const std::string& other) {
  const std::filesystem::path first(one);
  const std::filesystem::path second(other);
  if (first.filename() == second.filename()) return true;
  const std::string number = last_number(first.stem().string());
  return !number.empty() && number == last_number(second.stem().string());
}

void require_partners(const Question& question) {
  const Setup& first = *question.subjects[0].setup;
  const Setup& second = *question.subjects[1].setup;
  for (std::uint64_t i = 0; i < *first.observations(); ++i) {
    const std::string one = recorded::observation_place(first, {.index = i});
    const std::string other = recorded::observation_place(second, {.index = i});
    if (are_partners(one, other)) continue;
    refuse(question, fmt::format("`{}` and `{}` have neither name nor number in common: a pair of "
                                 "one seed has the same file name, or the same last number in it",
                                 one, other));
  }
}

/// Theta is the size of the difference of two images' means over all elements, or of one image and
/// numbers (image_evidence.h).
class ImageTheta : public Theta {
 public:
  ImageTheta() : ImageTheta({.joins_channels = true, .of_images = true}) {}
  explicit ImageTheta(const ThetaTraits& traits) : Theta(traits) {}

  const std::vector<MethodRow>& methods() const override {
    static const std::vector<MethodRow> table{{"image",
                                               "cells of every size, and alternating sums: images",
                                               any_question,
                                               Keeps::images,
                                               nullptr,
                                               {}}};
    return table;
  }

  const Theta* of_images() const override { return this; }
  const Theta* of_pairs() const override;
  /// InputError for inequalities, images of unequal sizes, an image against something else, a
  /// number with an error, and a relative margin of a zero image.
  void check(const Question& question) const override {
    require_one_size(question);
    require_tested_relation(question);
    require_exact_number(question);
    require_something(question);
  }
  void check_margin(const Question&, const Margin&) const override {}

  std::string channel_name(const Question& question, std::size_t) const override {
    return image_name(*question.subjects[0].image);
  }
  std::string claimed_value(const Question& question, std::size_t channel) const override {
    const Claim& claim = question.test->claim;
    if (other_side(claim) != nullptr) return Theta::claimed_value(question, channel);
    const auto* const number = std::get_if<Constant>(&claim.right);
    return number != nullptr ? fmt::format("{}", number->value) : "analytic";
  }
  std::string circumstances(const Question&) const override { return " in every pixel"; }

  bool is_relative(const Question& question, std::size_t) const override {
    const TestEntry& test = *question.test;
    const auto lit = [](const Constant& reference) { return reference.value != 0; };
    return !has_absolute_margin(test) &&
           (question.of_two() || std::ranges::any_of(question.references, lit));
  }

  std::uint64_t choose(const Question& question, const FamilyPlace&, const Pilots& pilots,
                       std::uint64_t most, Plan& plan) const override {
    return choose_for_image(question, pilots, most, plan);
  }
  std::optional<std::uint64_t> secondaries(const Question& question, const ErrorShare& share,
                                           const Pilots&, const Plan& plan) const override {
    return image_secondaries(question, share, plan);
  }
  std::uint64_t usual_size() const override { return classical_replicates; }
  std::string too_few(const Question& question, const Plan& plan) const override {
    return too_few_replicates(question, plan);
  }

  std::string lack_of_numbers(const DrawnTest& test, std::size_t channel,
                              std::span<const ChannelData> data) const override {
    const std::string reason = Theta::lack_of_numbers(test, channel, data);
    return reason.empty() ? dependence_of_images(test, data) : reason;
  }
  ChannelEvidence evidence(const DrawnTest& test, std::size_t,
                           std::span<const ChannelData> data) const override {
    ImageEvidence found = evidence_of_images(test.outcome.question, image_test(test), data);
    return {.evidence = std::move(found.evidence), .image = std::move(found.outcome)};
  }

  /// Other cells see the same difference in a few pixels, or of both signs, from other sizes on.
  const char* detectable_text() const override { return " that is the same all over the image"; }
  std::string where_it_differs(const DrawnTest& test) const override {
    return means_where_it_differs(test);
  }
  std::string taken_as_exact(const Question& question) const override {
    const ScaledQuantity* const other = other_side(question.test->claim);
    if (question.of_two() || other == nullptr) return "";
    const bool exact = std::ranges::all_of(
        question.references, [](const Constant& each) { return each.standard_error == 0; });
    if (!exact) return "";
    return fmt::format(
        "; `{}` is one picture, taken as exact: noise of its own would count as a "
        "difference",
        other->quantity.source.estimator);
  }
};

class BiasImageTheta final : public ImageTheta {
 public:
  const Theta* of_pairs() const override { return nullptr; }
  std::string claimed_value(const Question& question, std::size_t) const override {
    return fmt::format("{}", question.offset);
  }
  std::string circumstances(const Question& question) const override {
    return reference_text(question) + ImageTheta::circumstances(question);
  }
  bool is_relative(const Question& question, std::size_t) const override {
    return has_relative_margin(*question.test);
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
    if (first.observations() != second.observations()) refuse(question, counts_text(question));
    if (first.observations()) require_partners(question);
    if (question.subjects[0].estimator->primaries != question.subjects[1].estimator->primaries) {
      refuse(question,
             "a pair shares its random numbers only with as many `primaries` on both "
             "sides");
    }
  }
};

/// Theta is 0 if both images have one law. It has no size.
class ImageLawTheta final : public ImageTheta {
 public:
  ImageLawTheta()
      : ImageTheta({.joins_channels = true, .of_single_values = true, .of_a_law = true}) {}

  const std::vector<MethodRow>& methods() const override {
    static const std::vector<MethodRow> table{{"permutation",
                                               "permutation of labels: laws of two images",
                                               any_question,
                                               Keeps::images,
                                               nullptr,
                                               {.exact = true}}};
    return table;
  }
  const Theta* of_pairs() const override { return nullptr; }
  void check(const Question& question) const override {
    if (!question.of_two()) {
      refuse(question,
             "the law of an image is compared with that of another image, as in "
             "`distribution(new) == distribution(old)`");
    }
    ImageTheta::check(question);
  }
  void check_margin(const Question&, const Margin& margin) const override {
    throw InputError(margin.where,
                     "laws of images are the same or not: no margin has a meaning here; leave it "
                     "out");
  }
  ChannelEvidence evidence(const DrawnTest& test, std::size_t,
                           std::span<const ChannelData> data) const override {
    ImageEvidence found =
        evidence_of_image_laws(test.outcome.question, {.share = test.outcome.share()}, data);
    return {.evidence = std::move(found.evidence), .image = std::move(found.outcome)};
  }
};

const ImageLawTheta image_law_theta;
const PairedImageTheta paired_image_theta;
const ImageTheta image_theta;
const BiasImageTheta bias_image_theta;

}  // namespace

const Theta* ImageTheta::of_pairs() const { return &paired_image_theta; }

const Theta& theta_of_images() { return image_theta; }
const Theta& theta_of_image_laws() { return image_law_theta; }
const Theta& theta_of_bias_images() { return bias_image_theta; }

}  // namespace assay::harness
