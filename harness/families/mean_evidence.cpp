#include "harness/families/mean_evidence.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "harness/question/declared_range.h"
#include "harness/theta/inversion.h"
#include "harness/theta/theta.h"
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

/// A test of one mean and of two. Without closed intervals, `at` is inverted.
struct MeanTest {
  OneMeanTest (*of_one)(const Moments& x, const stats::Range& range);
  ContrastTest (*of_two)(const Moments& x, const Moments& y, const stats::Range& of_x,
                         const stats::Range& of_y);
  bool closed_interval = false;
};

OneMeanTest t_of_one(const Moments& x, const stats::Range&) {
  return [x](const stats::Reference& null) { return stats::student_t(x, null); };
}

ContrastTest t_of_two(const Moments& x, const Moments& y, const stats::Range&,
                      const stats::Range&) {
  return [=](const stats::Contrast& null) { return stats::welch_t(x, y, null); };
}

OneMeanTest corrected_of_one(const Moments& x, const stats::Range&) {
  return [x](const stats::Reference& null) { return stats::skewness_corrected_t(x, null); };
}

ContrastTest corrected_of_two(const Moments& x, const Moments& y, const stats::Range&,
                              const stats::Range&) {
  return [=](const stats::Contrast& null) { return stats::skewness_corrected_welch(x, y, null); };
}

OneMeanTest binomial_of_one(const Moments& x, const stats::Range& range) {
  return [x, range](const stats::Reference& null) {
    return stats::two_valued_mean(stats::two_valued(x, range), null.value);
  };
}

ContrastTest binomial_of_two(const Moments& x, const Moments& y, const stats::Range& of_x,
                             const stats::Range& of_y) {
  return [=](const stats::Contrast& null) {
    return stats::two_valued_contrast(stats::two_valued(x, of_x), stats::two_valued(y, of_y), null);
  };
}

OneMeanTest bounded_of_one(const Moments& x, const stats::Range& range) {
  return [x, range](const stats::Reference& null) {
    return stats::bounded_mean(x, range, null.value);
  };
}

constexpr MeanTest student{t_of_one, t_of_two, true};
constexpr MeanTest corrected{corrected_of_one, corrected_of_two};
constexpr MeanTest binomial{binomial_of_one, binomial_of_two};
constexpr MeanTest bounded{bounded_of_one, nullptr};

/// Natural logarithm of the p-value of "E y = 0"; a constant y shows its sign.
double log_p_of_no_sign(const Moments& y, const OneMeanTest& test) {
  if (y.m2 == 0) return y.mean == 0 ? 0 : -std::numeric_limits<double>::infinity();
  return stats::log_p_two_sided(test({.value = 0}));
}

double spread_of(const Moments& x, double factor) {
  return std::abs(factor) * std::sqrt(x.variance() / static_cast<double>(x.count));
}

Evidence difference_of_means(bool closed_interval, const Question& question, const Moments& x,
                             const Moments& y, const ContrastTest& test) {
  const double factor = question.factor;
  const double offset = question.offset;
  const double estimate = stats::contrast_of_means(x, y, {.scale = factor, .offset = offset});
  const auto at = [=](double theta) { return test({.scale = factor, .offset = offset + theta}); };
  const auto interval = [=](double confidence) {
    if (!closed_interval) {
      const double step = std::hypot(spread_of(x, 1), spread_of(y, factor));
      return interval_by_inversion(at, {.estimate = estimate, .step = step}, confidence);
    }
    // Only count, mean and m2 enter. The difference stands for x, with y's mean at 0.
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

Evidence ratio_of_means(bool closed_interval, const Question& question, const Moments& x,
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
    // The sign of E y decides which contrast a relative margin is, so y must show it too.
    const double log_p_sign = log_p_of_no_sign(y, test_of_y);
    result.log_p_lower = std::max(result.log_p_lower, log_p_sign);
    result.log_p_upper = std::max(result.log_p_upper, log_p_sign);
    return result;
  };
  const auto interval = [=](double confidence) {
    if (!closed_interval || offset != 0) {
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

}  // namespace

namespace {

Evidence mean_against_number(const MeanTest& mean, const Question& question, std::size_t channel,
                             const stats::Moments& x) {
  const Constant& reference = question.references[channel];
  const bool relative = question.theta->is_relative(question, channel);
  const double unit = relative ? std::abs(reference.value) : 1;
  const double slope = relative ? std::copysign(1, reference.value) : 0;
  const double null = reference.value + question.offset;
  const double estimate = x.mean_less(null) / unit;
  const OneMeanTest test = mean.of_one(x, range_of(question, 0, channel, x));
  const auto at = [=](double theta) {
    return test({.value = null + theta * unit,
                 .standard_error = reference.standard_error * std::abs(1 + slope * theta)});
  };
  const auto interval = [=](double confidence) {
    // Theta also scales the reference's error, so `at` is inverted.
    if ((relative && reference.standard_error > 0) || !mean.closed_interval) {
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

Evidence mean_against_mean(const MeanTest& mean, const Question& question, std::size_t channel,
                           std::span<const ChannelData> data) {
  const Moments& x = data[0].moments;
  const Moments& y = data[1].moments;
  const ContrastTest test =
      mean.of_two(x, y, range_of(question, 0, channel, x), range_of(question, 1, channel, y));
  if (!question.theta->is_relative(question, channel))
    return difference_of_means(mean.closed_interval, question, x, y, test);
  return ratio_of_means(mean.closed_interval, question, x, y, test,
                        mean.of_one(y, range_of(question, 1, channel, y)));
}

Evidence of_means(const MeanTest& mean, const Question& question, std::size_t channel,
                  std::span<const ChannelData> data) {
  if (question.of_two()) return mean_against_mean(mean, question, channel, data);
  return mean_against_number(mean, question, channel, data[0].moments);
}

}  // namespace

Evidence mean_by_t(const Method&, const Question& question, std::size_t channel,
                   std::span<const ChannelData> data) {
  return of_means(student, question, channel, data);
}

Evidence mean_by_corrected_t(const Method&, const Question& question, std::size_t channel,
                             std::span<const ChannelData> data) {
  return of_means(corrected, question, channel, data);
}

Evidence mean_of_two_values(const Method&, const Question& question, std::size_t channel,
                            std::span<const ChannelData> data) {
  return of_means(binomial, question, channel, data);
}

Evidence mean_in_a_range(const Method&, const Question& question, std::size_t channel,
                         std::span<const ChannelData> data) {
  return of_means(bounded, question, channel, data);
}

Evidence mean_by_bets(const Method&, const Question& question, std::size_t channel,
                      std::span<const ChannelData> data) {
  const Moments& x = data[0].moments;
  const std::span<const double> values = data[0].values;
  const Constant& reference = question.references[channel];
  const bool relative = question.theta->is_relative(question, channel);
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

}  // namespace assay::harness
