#include "harness/families/mean_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "harness/question/question_sources.h"
#include "harness/theta/evidence.h"
#include "harness/theta/theta.h"
#include "stats/basics/moments.h"
#include "stats/means/betting_mean.h"
#include "stats/means/binomial.h"
#include "stats/means/skewness_corrected_t.h"
#include "stats/means/student_t.h"
#include "stats/means/uncertain_reference.h"

namespace assay::harness {
namespace {

using stats::Interval;
using stats::Moments;
using stats::TestResult;

/// Tests "E x = value".
using OneMeanTest = std::function<TestResult(const stats::Reference&)>;
/// Tests "E x - scale E y = offset".
using ContrastTest = std::function<TestResult(const stats::Contrast&)>;

/// One subject's data of a channel, with its declared range and rounding.
struct Side {
  const ChannelData& data;
  stats::Range range;
  double rounding = 0;
};

/// A test of one mean and of two. Without closed intervals, `at` is inverted.
struct MeanTest {
  OneMeanTest (*of_one)(const Side& x);
  ContrastTest (*of_two)(const Side& x, const Side& y);
  bool closed_interval = false;
};

OneMeanTest t_of_one(const Side& x) {
  return [x = x.data.moments](const stats::Reference& null) { return stats::student_t(x, null); };
}

ContrastTest t_of_two(const Side& x, const Side& y) {
  return [x = x.data.moments, y = y.data.moments](const stats::Contrast& null) {
    return stats::welch_t(x, y, null);
  };
}

OneMeanTest corrected_of_one(const Side& x) {
  return [x = x.data.moments](const stats::Reference& null) {
    return stats::skewness_corrected_t(x, null);
  };
}

ContrastTest corrected_of_two(const Side& x, const Side& y) {
  return [x = x.data.moments, y = y.data.moments](const stats::Contrast& null) {
    return stats::skewness_corrected_welch(x, y, null);
  };
}

/// An exact test of "E x = value" where the value is known up to an error.
OneMeanTest over_reference(std::function<TestResult(double)> at) {
  return [at = std::move(at)](const stats::Reference& null) {
    TestResult result = at(null.value);
    const std::array<stats::UncertainReference, 1> references{{{null, null.value}}};
    result.log_p_lower = stats::log_p_over_references(
        [&](auto values) { return at(values[0]).log_p_lower; }, references);
    result.log_p_upper = stats::log_p_over_references(
        [&](auto values) { return at(values[0]).log_p_upper; }, references);
    return result;
  };
}

OneMeanTest binomial_of_one(const Side& x) {
  return over_reference([x = stats::two_valued(x.data.moments, x.range)](double value) {
    return stats::two_valued_mean(x, value);
  });
}

ContrastTest binomial_of_two(const Side& x, const Side& y) {
  return [x = stats::two_valued(x.data.moments, x.range),
          y = stats::two_valued(y.data.moments, y.range)](const stats::Contrast& null) {
    return stats::two_valued_contrast(x, y, null);
  };
}

using Cells = std::shared_ptr<const stats::ValueCells>;

Cells cells_of(const Side& side) {
  return std::make_shared<const stats::ValueCells>(side.data.values);
}

/// Values are exact to `rounding`: each tail is that of the nearest null.
TestResult within_rounding(const std::function<TestResult(double)>& at, double rounding) {
  if (rounding == 0) return at(0);
  TestResult result = at(0);
  result.log_p_upper = at(rounding).log_p_upper;
  result.log_p_lower = at(-rounding).log_p_lower;
  return result;
}

OneMeanTest bets_of_one(const Side& x) {
  return over_reference([cells = cells_of(x), range = x.range,
                         rounding = x.rounding](double value) {
    return within_rounding(
        [&](double shift) { return stats::betting_mean(*cells, range, value + shift); }, rounding);
  });
}

ContrastTest bets_of_two(const Side& x, const Side& y) {
  return [cells_of_x = cells_of(x), cells_of_y = cells_of(y), of_x = x.range, of_y = y.range,
          rounding = x.rounding, other = y.rounding](const stats::Contrast& null) {
    const auto at = [&](double shift) {
      return stats::betting_contrast(*cells_of_x, of_x, *cells_of_y, of_y,
                                     {null.scale, null.offset + shift});
    };
    return within_rounding(at, rounding + std::abs(null.scale) * other);
  };
}

constexpr MeanTest student{t_of_one, t_of_two, true};
constexpr MeanTest corrected{corrected_of_one, corrected_of_two};
constexpr MeanTest binomial{binomial_of_one, binomial_of_two};
constexpr MeanTest bets{bets_of_one, bets_of_two};

Side side_of(const Question& question, std::size_t channel, std::span<const ChannelData> data,
             std::size_t subject) {
  return {data[subject], range_of(question, subject, channel, data[subject].moments),
          rounding_of(question, subject, channel)};
}

/// A first step from an estimate of theta. Without a spread it is what one more value could add.
double step_of(const Side& side, double factor) {
  const Moments& x = side.data.moments;
  const double count = static_cast<double>(x.count);
  double step = std::sqrt(x.variance() / count);
  for (const double end : {side.range.low, side.range.high}) {
    if (!(x.m2 > 0) && std::isfinite(end)) step = std::max(step, std::abs(end - x.mean) / count);
  }
  return std::abs(factor) * step;
}

/// Natural logarithm of the p-value of "E y = 0"; a constant y shows its sign.
double log_p_of_no_sign(const Moments& y, const OneMeanTest& test) {
  if (y.m2 == 0) return y.mean == 0 ? 0 : -std::numeric_limits<double>::infinity();
  return stats::log_p_two_sided(test({.value = 0}));
}

Evidence difference_of_means(bool closed_interval, const Question& question, const Side& first,
                             const Side& second, const ContrastTest& test) {
  const Moments x = first.data.moments;
  const Moments y = second.data.moments;
  const double factor = question.factor;
  const double offset = question.offset;
  const double estimate = stats::contrast_of_means(x, y, {.scale = factor, .offset = offset});
  const auto at = [=](double theta) { return test({.scale = factor, .offset = offset + theta}); };
  const double step = std::hypot(step_of(first, 1), step_of(second, factor));
  const auto interval = [=](double confidence) {
    if (!closed_interval) {
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

Evidence ratio_of_means(bool closed_interval, const Question& question, const Side& first,
                        const Side& second, const ContrastTest& test,
                        const OneMeanTest& test_of_y) {
  const Moments x = first.data.moments;
  const Moments y = second.data.moments;
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
  const double step = std::hypot(step_of(first, 1), step_of(second, factor)) / std::abs(other);
  const auto interval = [=](double confidence) {
    if (!closed_interval || offset != 0) {
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

Evidence mean_against_number(const MeanTest& mean, const Question& question, std::size_t channel,
                             const Side& side) {
  const Moments x = side.data.moments;
  const Constant& reference = question.references[channel];
  const bool relative = question.theta->is_relative(question, channel);
  const double unit = relative ? std::abs(reference.value) : 1;
  const double slope = relative ? std::copysign(1, reference.value) : 0;
  const double null = reference.value + question.offset;
  const double estimate = x.mean_less(null) / unit;
  const OneMeanTest test = mean.of_one(side);
  const auto at = [=](double theta) {
    return test({.value = null + theta * unit,
                 .standard_error = reference.standard_error * std::abs(1 + slope * theta)});
  };
  const double step = std::hypot(step_of(side, 1), reference.standard_error) / unit;
  const auto interval = [=](double confidence) {
    // Theta also scales the reference's error, so `at` is inverted.
    if ((relative && reference.standard_error > 0) || !mean.closed_interval) {
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

Evidence of_means(const MeanTest& mean, const Question& question, std::size_t channel,
                  std::span<const ChannelData> data) {
  const Side x = side_of(question, channel, data, 0);
  if (!question.of_two()) return mean_against_number(mean, question, channel, x);
  const Side y = side_of(question, channel, data, 1);
  const ContrastTest test = mean.of_two(x, y);
  if (!question.theta->is_relative(question, channel)) {
    return difference_of_means(mean.closed_interval, question, x, y, test);
  }
  return ratio_of_means(mean.closed_interval, question, x, y, test, mean.of_one(y));
}

// Part of the standard error that rounding may reach: a 1 % tail then moves by a third at most.
constexpr double tolerated = 0.1;

/// Errors of one side, on the scale of the first mean.
struct RoundedPart {
  double rounding = 0;
  double standard_error = 0;
};

RoundedPart part_of(const Question& question, std::size_t subject, const ChannelData& data) {
  if (data.moments.count < 2) return {};
  const double factor = subject == 0 ? 1 : std::abs(question.factor);
  return {.rounding = factor * stats::rounding_of_mean(data.moments),
          .standard_error = factor * data.moments.standard_error()};
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

Evidence mean_by_bets(const Method&, const Question& question, std::size_t channel,
                      std::span<const ChannelData> data) {
  return of_means(bets, question, channel, data);
}

std::string lost_to_rounding(const Question& question, std::size_t channel,
                             std::span<const ChannelData> data) {
  std::size_t worst = 0;
  double most = 0;
  double rounding = 0;
  double error = question.of_two() ? 0 : question.references[channel].standard_error;
  for (std::size_t subject = 0; subject < data.size(); ++subject) {
    const RoundedPart part = part_of(question, subject, data[subject]);
    if (part.rounding > most) worst = subject;
    most = std::max(most, part.rounding);
    rounding = std::hypot(rounding, part.rounding);
    error = std::hypot(error, part.standard_error);
  }
  if (!(rounding > tolerated * error)) return "";
  return fmt::format(
      "the mean of `{}` is {:.6g}: numbers of that size are rounded so coarsely that their mean is "
      "off by about {:.2g} where the standard error is {:.2g}; take a constant near the mean off "
      "the observations",
      question.subjects[worst].estimator->name, data[worst].moments.mean, rounding, error);
}

}  // namespace assay::harness
