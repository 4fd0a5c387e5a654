#include "correlated/parameters.h"

#include <utility>

namespace assay::correlated {

namespace {

std::vector<ParameterInformation> joined(std::vector<ParameterInformation> all,
                                         std::vector<ParameterInformation> more) {
  for (ParameterInformation& p : more) all.push_back(std::move(p));
  return all;
}

Entry fixed_entry(const Family& family) {
  return {{.name = family.name,
           .summary = family.integral + " with a control of known integral, lambda given.",
           .description = family.description +
                          " Estimates I = the integral of f by f/p + lambda (J - g/p) (Szecsi, "
                          "Sbert and Szirmay-Kalos 2004): lambda = 0 is importance sampling, 1 "
                          "correlated sampling. Unbiased for every lambda; the variance Var(f/p) + "
                          "lambda^2 Var(g/p) - 2 lambda Cov(f/p, g/p) is least at lambda* = "
                          "Cov(f/p, g/p) / Var(g/p), which may lie outside [0, 1].",
           .parameters = joined(family.parameters, {lambda_parameter()})},
          [read = family.read](Parameters& given) {
            return fixed(read(given), given.number("lambda"));
          }};
}

Entry same_samples_entry(const Family& family) {
  return {
      {.name = family.name + "_same_samples",
       .summary = family.integral + " with a control, lambda from the same samples.",
       .description =
           family.description +
           " Estimates I by the mean of f/p + lambda (J - g/p) over M primaries with lambda = "
           "sum d (mean f/p - f/p) / sum d^2, d = J - g/p, from the same primaries. Consistent, "
           "not unbiased: the bias times M tends to -E[(f - I - lambda* (g - J)) (g - J)^2] / "
           "Var g (f, g over p). With `centre: mean` the spread in the denominator is taken "
           "about the samples' mean, as by least squares; where f = g this gives I exactly, "
           "`centre: integral` does not. With one primary, and where g/p does not vary (to "
           "2^-40 of J), lambda is 0.",
       .parameters = joined(family.parameters, rule_parameters()),
       .bias = BiasClass::inverse_primaries,
       .averages = false},
      [read = family.read](Parameters& given) {
        return same_samples(read(given), read_rule(given));
      }};
}

Entry cross_fitted_entry(const Family& family) {
  return {{.name = family.name + "_cross_fitted",
           .summary = family.integral + " with a control, lambda from the other half.",
           .description =
               family.description +
               " Estimates I by the mean of f/p + lambda (J - g/p) over M primaries in two halves, "
               "each with the lambda that the other half gives (see the estimator of the same "
               "samples): lambda is independent of what it multiplies, so the estimate is "
               "unbiased. Fewer than two samples in a half give lambda = 0.",
           .parameters = joined(family.parameters, rule_parameters()),
           .averages = false},
          [read = family.read](Parameters& given) {
            return cross_fitted(read(given), read_rule(given));
          }};
}

Entry ratio_entry(const Family& family) {
  return {{.name = family.name + "_ratio",
           .summary = family.integral + " by weighted importance sampling.",
           .description = family.description +
                          " Estimates I by J sum(f/p) / sum(g/p) over M primaries: the same two "
                          "sums put to use as a ratio. Consistent; biased like 1/M.",
           .parameters = family.parameters,
           .bias = BiasClass::inverse_primaries,
           .averages = false},
          [read = family.read](Parameters& given) { return ratio(read(given)); }};
}

}  // namespace

ParameterInformation lambda_parameter() {
  return {.name = "lambda",
          .summary = "weight of the control: 0 importance sampling, 1 correlated sampling",
          .fallback = "1"};
}

std::vector<ParameterInformation> rule_parameters() {
  return {{.name = "centre",
           .type = ParameterType::string,
           .summary = "what the spread of g/p is measured about: its integral J or its mean",
           .fallback = "integral",
           .choices = {"integral", "mean"}},
          {.name = "clamped",
           .type = ParameterType::boolean,
           .summary = "whether lambda is moved into [0, 1]",
           .fallback = "false"}};
}

LambdaRule read_rule(Parameters& given) {
  const Centre centre = given.string("centre") == "mean" ? Centre::mean : Centre::integral;
  return given.boolean("clamped") ? clamped_lambda(centre) : estimated_lambda(centre);
}

std::vector<Entry> entries(const Family& family) {
  return {fixed_entry(family), same_samples_entry(family), cross_fitted_entry(family),
          ratio_entry(family)};
}

}  // namespace assay::correlated
