#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "harness/families/families.h"
#include "harness/plan/image_plan.h"
#include "harness/question/question_sources.h"
#include "harness/run/image_judge.h"
#include "harness/theta/scale.h"

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

/// Theta is the size of the difference of two images' means over all elements, or of one image and
/// numbers (image_evidence.h).
class ImageTheta : public Theta {
 public:
  ImageTheta() : Theta({.joins_channels = true, .of_images = true}) {}

  const std::vector<MethodRow>& methods() const override {
    static const std::vector<MethodRow> table{
        {"image",
         "cells of every size, and alternating sums: images",
         any_question, Keeps::images, nullptr, {}}};
    return table;
  }

  const Theta* of_images() const override { return this; }
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
                                           const Pilots& pilots, const Plan& plan) const override {
    return image_secondaries(question, share, pilots, plan);
  }
  std::uint64_t usual_size() const override { return classical_replicates; }
  std::string too_few(const Question& question, const Plan& plan) const override {
    return too_few_replicates(question, plan);
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

const ImageTheta image_theta;
const BiasImageTheta bias_image_theta;

}  // namespace

const Theta& theta_of_images() { return image_theta; }
const Theta& theta_of_bias_images() { return bias_image_theta; }

}  // namespace assay::harness
