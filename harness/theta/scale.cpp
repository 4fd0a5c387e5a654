#include "harness/theta/scale.h"

#include <cmath>

namespace assay::harness {

bool is_relative(const Question& question, std::size_t channel) {
  const TestEntry& test = *question.test;
  const bool quantile = question.kind == QuestionKind::quantile && !question.of_two();
  const bool image = question.kind == QuestionKind::image;
  if (!question.of_means() && !quantile && !image) return false;
  const bool within = test.claim.relation == Relation::within;
  if (quantile || test.claim.left.name == QuantityName::bias) {
    return (test.detect && test.detect->relative) ||
           (test.allow && test.allow->relative && test.allow->value > 0) ||
           (within && test.claim.margin.relative);
  }
  const bool absolute = (test.detect && !test.detect->relative) ||
                        (test.allow && !test.allow->relative && test.allow->value > 0) ||
                        (within && !test.claim.margin.relative);
  if (image) {
    const auto lit = [](const Constant& reference) { return reference.value != 0; };
    return !absolute && (question.of_two() ||
                         std::any_of(question.references.begin(), question.references.end(), lit));
  }
  return !absolute &&
         (question.kind == QuestionKind::mean_of_two || question.references[channel].value != 0);
}

double unit_of_theta(const Question& question, std::size_t channel, double other_mean) {
  if (!is_relative(question, channel)) return 1;
  return std::abs(question.of_two() ? question.factor * other_mean
                                    : question.references[channel].value);
}

double margin_on_theta(const Question& question, std::size_t channel, const Margin& margin) {
  if (!question.on_log_scale()) return margin.value;
  if (margin.relative) return std::log1p(margin.value);
  return std::log1p(margin.value / question.references[channel].value);
}

}  // namespace assay::harness
