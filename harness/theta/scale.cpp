#include "harness/theta/scale.h"

#include <cmath>

#include "harness/theta/theta.h"

namespace assay::harness {

double unit_of_theta(const Question& question, std::size_t channel, double other_mean) {
  if (!question.theta->is_relative(question, channel)) return 1;
  return std::abs(question.of_two() ? question.factor * other_mean
                                    : question.references[channel].value);
}

double margin_on_theta(const Question& question, std::size_t channel, const Margin& margin) {
  if (!question.is().logarithm) return margin.value;
  if (margin.relative) return std::log1p(margin.value);
  return std::log1p(margin.value / question.references[channel].value);
}

bool has_relative_margin(const TestEntry& test) {
  return (test.detect && test.detect->relative) ||
         (test.allow && test.allow->relative && test.allow->value > 0) ||
         (test.claim.relation == Relation::within && test.claim.margin.relative);
}

bool has_absolute_margin(const TestEntry& test) {
  return (test.detect && !test.detect->relative) ||
         (test.allow && !test.allow->relative && test.allow->value > 0) ||
         (test.claim.relation == Relation::within && !test.claim.margin.relative);
}

}  // namespace assay::harness
