#include "stats/means/theta_of_means.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "stats/means/binomial.h"
#include "stats/means/skewness_corrected_t.h"
#include "stats/means/uncertain_reference.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

// An exact test of "E x = value" where the value is known up to an error.
TestResult over_reference(const Reference& null, const std::function<TestResult(double)>& at) {
  const std::array<UncertainReference, 1> references{{{null, null.value}}};
  return test_over_references([&](auto values) { return at(values[0]); }, references);
}

TestResult within_rounding(const std::function<TestResult(double)>& at, double rounding) {
  TestResult result = at(rounding);
  result.statistic += rounding;
  if (rounding > 0) result.log_p_lower = at(-rounding).log_p_lower;
  return result;
}

TestResult bets_of_one(const MeanSample& x, const Reference& null) {
  return over_reference(null, [&](double value) {
    const auto at = [&](double shift) { return betting_mean(*x.cells, x.range, value + shift); };
    return within_rounding(at, x.rounding);
  });
}

TestResult bets_of_two(const MeanSample& x, const MeanSample& y, const Contrast& null) {
  const auto at = [&](double shift) {
    return betting_contrast(*x.cells, x.range, *y.cells, y.range,
                            {null.scale, null.offset + shift});
  };
  return within_rounding(at, x.rounding + std::abs(null.scale) * y.rounding);
}

// A first step from an estimate of theta. Without a spread it is what one more value could add.
double step_of(const MeanSample& sample, double factor) {
  const Moments& x = sample.moments;
  const double count = static_cast<double>(x.count);
  double step = std::sqrt(x.variance() / count);
  for (const double end : {sample.range.low, sample.range.high}) {
    if (!(x.m2 > 0) && std::isfinite(end)) step = std::max(step, std::abs(end - x.mean) / count);
  }
  return std::abs(factor) * step;
}

// Natural logarithm of the p-value of "E y = 0"; a constant y shows its sign.
double log_p_of_no_sign(const MeanSample& y, const MeanTest& test) {
  if (y.moments.m2 == 0) {
    return y.moments.mean == 0 ? 0 : -unbounded;
  }
  return log_p_two_sided(test.of_one(y, {.value = 0}));
}

}  // namespace

const MeanTest mean_by_t{
    .of_one = [](const MeanSample& x, const Reference& null) { return student_t(x.moments, null); },
    .of_two = [](const MeanSample& x, const MeanSample& y,
                 const Contrast& null) { return welch_t(x.moments, y.moments, null); }};
const MeanTest mean_by_corrected_t{
    .of_one = [](const MeanSample& x,
                 const Reference& null) { return skewness_corrected_t(x.moments, null); },
    .of_two =
        [](const MeanSample& x, const MeanSample& y, const Contrast& null) {
          return skewness_corrected_welch(x.moments, y.moments, null);
        }};
const MeanTest mean_by_counts{
    .of_one =
        [](const MeanSample& x, const Reference& null) {
          const TwoValued counts = two_valued(x.moments, x.range);
          return over_reference(null, [&](double value) { return two_valued_mean(counts, value); });
        },
    .of_two =
        [](const MeanSample& x, const MeanSample& y, const Contrast& null) {
          return two_valued_contrast(two_valued(x.moments, x.range), two_valued(y.moments, y.range),
                                     null);
        }};
const MeanTest mean_by_bets{.of_one = bets_of_one, .of_two = bets_of_two, .bets = true};

double ThetaOfMeans::unit() const {
  if (!relative) return 1;
  return std::abs(y ? contrast.scale * y->moments.mean : reference.value);
}

double ThetaOfMeans::estimate() const {
  for (const Moments* each : {&x.moments, y ? &y->moments : &x.moments}) each->variance();
  if (y) return contrast_of_means(x.moments, y->moments, contrast) / unit();
  return x.moments.mean_less(reference.value + contrast.offset) / unit();
}

TestResult ThetaOfMeans::at(double theta) const {
  const auto [factor, offset] = contrast;
  if (!y) {
    const double slope = relative ? std::copysign(1, reference.value) : 0;
    return test.of_one(x,
                       {.value = reference.value + offset + theta * unit(),
                        .standard_error = reference.standard_error * std::abs(1 + slope * theta)});
  }
  if (!relative) return test.of_two(x, *y, {.scale = factor, .offset = offset + theta});
  const double sign = std::copysign(1, factor * y->moments.mean);
  const double scale = factor * (1 + sign * theta);
  // Without y a constant x is held against the offset alone.
  TestResult result = scale == 0 && x.moments.m2 == 0
                          ? without_error(x.moments.mean - offset, "exact")
                          : test.of_two(x, *y, {.scale = scale, .offset = offset});
  if (theta == 0) return result;
  const double log_p_sign = log_p_of_no_sign(*y, test);
  result.log_p_lower = std::max(result.log_p_lower, log_p_sign);
  result.log_p_upper = std::max(result.log_p_upper, log_p_sign);
  return result;
}

Interval ThetaOfMeans::interval(double confidence) const {
  if (unit() == 0) return {-unbounded, unbounded, confidence};
  const double error = y ? step_of(*y, contrast.scale) : reference.standard_error;
  return interval_by_inversion(
      [&](double theta) { return at(theta); },
      {.estimate = estimate(), .step = std::hypot(step_of(x, 1), error) / unit()}, confidence);
}

Evidence ThetaOfMeans::evidence() const {
  return {.estimate = estimate(),
          .at = [theta = *this](double value) { return theta.at(value); },
          .interval = [theta = *this](double confidence) { return theta.interval(confidence); },
          .relative = relative};
}

}  // namespace assay::stats
