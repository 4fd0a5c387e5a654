#include "harness/question/question_image.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace assay::harness {
namespace {

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
  const bool relative = (test.detect && test.detect->relative) ||
                        (test.allow && test.allow->relative && test.allow->value > 0) ||
                        (test.claim.relation == Relation::within && test.claim.margin.relative);
  if (relative) {
    throw InputError(test.where,
                     "a margin in per cent has no meaning here: the reference is zero in every "
                     "pixel; give an absolute number");
  }
}

}  // namespace

bool has_image(const Question& question) {
  return std::any_of(question.subjects.begin(), question.subjects.end(),
                     [](const Subject& subject) { return subject.image.has_value(); });
}

void ask_of_images(Question& question) {
  if (question.kind == QuestionKind::cost || question.kind == QuestionKind::total_variance) return;
  if (!question.of_means()) {
    const Subject& image =
        question.subjects[0].image ? question.subjects[0] : question.subjects.back();
    refuse(question,
           fmt::format("`{}` has no method for an image; there is mean, bias, total_variance and "
                       "cost; or name one pixel, as in `{}.{}`",
                       to_string(question.test->claim.left.name), image.estimator->name,
                       element_name(*image.image, 0)));
  }
  require_one_size(question);
  require_tested_relation(question);
  require_exact_number(question);
  require_something(question);
  question.kind = QuestionKind::image;
}

std::string image_name(const ImageShape& shape) {
  return fmt::format("{} x {} {}", shape.width, shape.height, fmt::join(shape.components, ", "));
}

}  // namespace assay::harness
