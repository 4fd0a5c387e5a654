#include "harness/families/mean_evidence.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "harness/theta/inversion.h"
#include "harness/theta/scale.h"
#include "stats/means/nonnegative_mean.h"
#include "stats/means/skewness_corrected_t.h"
#include "stats/means/student_t.h"
#include "stats/means/two_valued.h"
#include "stats/means/welch_t.h"

namespace assay::harness {
namespace {

using stats::Interval;
using stats::Moments;
using stats::TestResult;

/// Tests "E x = value".
using OneMeanTest = std::function<TestResult(const stats::Reference&)>;
/// Tests "E x - scale E y = offset".
using ContrastTest = std::function<TestResult(const stats::Contrast&)>;

OneMeanTest one_mean_test(const Method& method, const Moments& x, const stats::Range& range) {
  if (method.name == "binomial") {
    return [x, range](const stats::Reference& null) {
      return stats::two_valued_mean(stats::two_valued(x, range), null.value);
    };
  }
  if (method.name == "bounded") {
    return [x, range](const stats::Reference& null) {
      return stats::bounded_mean(x, range, null.value);
    };
  }
  if (method.name == "skewness-corrected-t") {
    return [x](const stats::Reference& null) { return stats::skewness_corrected_t(x, null); };
  }
  return [x](const stats::Reference& null) { return stats::student_t(x, null); };
}

ContrastTest contrast_test(const Method& method, const Moments& x, const Moments& y,
                           const stats::Range& of_x, const stats::Range& of_y) {
  if (method.name == "binomial") {
    return [=](const stats::Contrast& null) {
      return stats::two_valued_contrast(stats::two_valued(x, of_x), stats::two_valued(y, of_y),
                                        null);
    };
  }
  if (method.name == "skewness-corrected-t") {
    return [=](const stats::Contrast& null) { return stats::skewness_corrected_welch(x, y, null); };
  }
  return [=](const stats::Contrast& null) { return stats::welch_t(x, y, null); };
}

Interval map_ends(const Interval& interval, const std::function<double(double)>& map) {
  const double one = map(interval.low);
  const double other = map(interval.high);
  return {std::min(one, other), std::max(one, other), interval.confidence};
}

/// Natural logarithm of the p-value of "E y = 0"; a constant y shows its sign.
double log_p_of_no_sign(const Moments& y, const OneMeanTest& test) {
  if (y.m2 == 0) return y.mean == 0 ? 0 : -std::numeric_limits<double>::infinity();
  return stats::log_p_two_sided(test({.value = 0}));
}

/// Closed forms for Student's and Welch's t; every other method is inverted.
bool has_closed_interval(const Method& method) {
  return method.name == "t" || method.name == "welch" || method.name == "tost" ||
         method.name == "batch-means";
}

double spread_of(const Moments& x, double factor) {
  return std::abs(factor) * std::sqrt(x.variance() / static_cast<double>(x.count));
}

Evidence difference_of_means(const Method& method, const Question& question, const Moments& x,
                             const Moments& y, const ContrastTest& test) {
  const double factor = question.factor;
  const double offset = question.offset;
  const double estimate = stats::contrast_of_means(x, y, {.scale = factor, .offset = offset});
  const auto at = [=](double theta) { return test({.scale = factor, .offset = offset + theta}); };
  const auto interval = [=](double confidence) {
    if (!has_closed_interval(method)) {
      const double step = std::hypot(spread_of(x, 1), spread_of(y, factor));
      return interval_by_inversion(at, {.estimate = estimate, .step = step}, confidence);
    }
    // Only count, mean and m2 enter: of factor * y, and the difference as if y's mean were 0.
    Moments moved = x;
    moved.mean = estimate;
    Moments scaled = y;
    scaled.mean = 0;
    scaled.m2 *= factor * factor;
    moved.rest = scaled.rest = 0;
    return stats::welch_t_interval(moved, scaled, confidence);
  };
  return {.estimate = estimate, .at = at, .interval = interval, .quantity = "difference of means"};
}

Evidence ratio_of_means(const Method& method, const Question& question, const Moments& x,
                        const Moments& y, const ContrastTest& test, const OneMeanTest& test_of_y) {
  const double factor = question.factor;
  const double offset = question.offset;
  const double other = factor * y.mean;
  const double sign = std::copysign(1, other);
  const double estimate =
      stats::contrast_of_means(x, y, {.scale = factor, .offset = offset}) / std::abs(other);
  const auto contrast = [=](double theta) {
    return test({.scale = factor * (1 + sign * theta), .offset = offset});
  };
  const auto at = [=](double theta) {
    TestResult result = contrast(theta);
    if (theta == 0) return result;
    // Which contrast a relative margin is depends on the sign of E y, which y must show as well.
    const double log_p_sign = log_p_of_no_sign(y, test_of_y);
    result.log_p_lower = std::max(result.log_p_lower, log_p_sign);
    result.log_p_upper = std::max(result.log_p_upper, log_p_sign);
    return result;
  };
  const auto interval = [=](double confidence) {
    if (!has_closed_interval(method) || offset != 0) {
      const double step = std::hypot(spread_of(x, 1), spread_of(y, factor)) / std::abs(other);
      return interval_by_inversion(at, {.estimate = estimate, .step = step}, confidence);
    }
    return map_ends(stats::welch_ratio_interval(x, y, confidence),
                    [=](double ratio) { return sign * ((1 + ratio) / factor - 1); });
  };
  return {.estimate = estimate,
          .at = at,
          .interval = interval,
          .quantity = "relative difference of means",
          .relative = true};
}

/// "E x <= value" by bets on what lies above the declared lower bound; nothing refutes the
/// contrary.
Evidence bets_against_number(const Question& question, std::size_t channel, const Moments& x,
                             std::span<const double> values) {
  const Constant& reference = question.references[channel];
  const bool relative = is_relative(question, channel);
  const double unit = relative ? std::abs(reference.value) : 1;
  const double null = reference.value + question.offset;
  const double bound = range_of(question, 0, channel, x).low;
  auto above = std::make_shared<std::vector<double>>();
  for (const double value : values) above->push_back(value - bound);
  const auto at = [=](double theta) {
    return stats::nonnegative_mean(*above, null + theta * unit - bound);
  };
  const auto interval = [=](double confidence) {
    const double low = stats::nonnegative_mean_lower_limit(*above, (1 + confidence) / 2) + bound;
    return Interval{(low - null) / unit, std::numeric_limits<double>::infinity(), confidence};
  };
  return {.estimate = (x.mean - null) / unit,
          .at = at,
          .interval = interval,
          .quantity =
              relative ? "relative difference from the reference" : "difference from the reference",
          .relative = relative};
}

}  // namespace

stats::Range range_of(const Question& question, std::size_t subject, std::size_t channel,
                      const stats::Moments& moments) {
  const Subject& side = question.subjects[subject];
  if (side.setup->observations()) return {moments.minimum, moments.maximum};
  const Channel declared = side.setup->channels()[side.channels[channel]];
  return {declared.low, declared.high};
}

Evidence mean_against_number(const Method& method, const Question& question, std::size_t channel,
                             const stats::Moments& x, std::span<const double> values) {
  if (method.name == "betting") return bets_against_number(question, channel, x, values);
  const Constant& reference = question.references[channel];
  const bool relative = is_relative(question, channel);
  const double unit = relative ? std::abs(reference.value) : 1;
  const double slope = relative ? std::copysign(1, reference.value) : 0;
  const double null = reference.value + question.offset;
  const double estimate = x.mean_less(null) / unit;
  const OneMeanTest test = one_mean_test(method, x, range_of(question, 0, channel, x));
  const auto at = [=](double theta) {
    return test({.value = null + theta * unit,
                 .standard_error = reference.standard_error * std::abs(1 + slope * theta)});
  };
  const auto interval = [=](double confidence) {
    // Theta scales the reference's own error too: the interval is what `at` does not reject.
    if ((relative && reference.standard_error > 0) || !has_closed_interval(method)) {
      const double step = std::hypot(spread_of(x, 1), reference.standard_error) / unit;
      return interval_by_inversion(at, {.estimate = estimate, .step = step}, confidence);
    }
    return map_ends(stats::student_t_interval(x, {null, reference.standard_error}, confidence),
                    [=](double d) { return d / unit; });
  };
  return {.estimate = estimate,
          .at = at,
          .interval = interval,
          .quantity =
              relative ? "relative difference from the reference" : "difference from the reference",
          .relative = relative};
}

Evidence mean_against_mean(const Method& method, const Question& question, std::size_t channel,
                           std::span<const ChannelData> data) {
  const Moments& x = data[0].moments;
  const Moments& y = data[1].moments;
  const ContrastTest test = contrast_test(method, x, y, range_of(question, 0, channel, x),
                                          range_of(question, 1, channel, y));
  if (!is_relative(question, channel)) return difference_of_means(method, question, x, y, test);
  return ratio_of_means(method, question, x, y, test,
                        one_mean_test(method, y, range_of(question, 1, channel, y)));
}

}  // namespace assay::harness
