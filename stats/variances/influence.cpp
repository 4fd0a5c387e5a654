#include "stats/variances/influence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "stats/basics/check.h"
#include "stats/means/skewness_corrected_t.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr std::size_t weight = JointMoments::weight;
constexpr std::size_t powers_of_cost = JointMoments::powers_of_cost;

// A polynomial in d and e, by JointMoments::place.
using Polynomial = std::array<double, JointMoments::count_of_sums>;

Polynomial product(const Polynomial& f, const Polynomial& g) {
  Polynomial result{};
  for (std::size_t j = 0; j <= powers_of_cost; ++j) {
    for (std::size_t i = 0; i + 2 * j <= weight; ++i) {
      const double factor = f[JointMoments::place(i, j)];
      if (factor == 0) continue;
      for (std::size_t l = 0; j + l <= powers_of_cost; ++l) {
        for (std::size_t k = 0; i + k + 2 * (j + l) <= weight; ++k) {
          result[JointMoments::place(i + k, j + l)] += factor * g[JointMoments::place(k, l)];
        }
      }
    }
  }
  return result;
}

double sum_of(const Polynomial& f, const JointMoments& sample) {
  double sum = 0;
  for (std::size_t k = 0; k < f.size(); ++k) sum += f[k] * sample.sums[k];
  return sum;
}

// psi = square d^2 + linear d + cost e, but for a constant.
struct Coefficients {
  double square = 0;
  double linear = 0;
  double cost = 0;
};

// Moments of 1 + psi less its mean. The extremes are bounds.
Moments about_one(const JointMoments& sample, const Coefficients& of) {
  const double n = static_cast<double>(sample.count);
  const double mean = of.square * sample.sum(2, 0) / n;
  Polynomial psi{};
  psi[JointMoments::place(0, 0)] = -mean;
  psi[JointMoments::place(1, 0)] = of.linear;
  psi[JointMoments::place(2, 0)] = of.square;
  psi[JointMoments::place(0, 1)] = of.cost;
  const Polynomial square = product(psi, psi);
  Moments moments{.count = sample.count, .mean = 1};
  moments.m2 = std::max(0.0, sum_of(square, sample));
  if (sample.known == weight) {
    moments.m3 = sum_of(product(square, psi), sample);
    moments.m4 = sum_of(product(square, square), sample);
  }
  const double dearest = of.cost * (sample.of_cost.maximum - sample.of_cost.mean);
  const double cheapest = of.cost * (sample.of_cost.minimum - sample.of_cost.mean);
  const auto square_of = [&](double x) {
    const double d = x - sample.of_x.mean;
    return of.square * d * d + of.linear * d;
  };
  const double largest = std::max(square_of(sample.of_x.maximum), square_of(sample.of_x.minimum));
  // The least square deviation is 0, or that of a truth between the values.
  const double least = of.linear == 0 ? 0 : -of.linear * of.linear / (4 * of.square);
  moments.maximum = 1 - mean + largest + dearest;
  moments.minimum = 1 - mean + least + cheapest;
  return moments;
}

void check_sample(const char* function, const JointMoments& sample) {
  check::at_least({function, "count"}, sample.count, 4);
  constexpr const char* held =
      "within the numbers that a computer holds; give the observations in another unit";
  for (const double sum : sample.sums) {
    if (!std::isfinite(sum)) check::fail({function, "sum of powers"}, sum, held);
  }
  if (sample.sum(2, 0) == 0) throw ZeroVariance(std::string(function) + ": zero variance");
  // Denormal numbers have lost their digits.
  constexpr double least =
      std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();
  const double highest = sample.sum(sample.known, 0);
  if (!(highest > least)) check::fail({function, "sum of the highest powers"}, highest, held);
}

// The variance, whose coefficient of the square makes the mean of the squared deviations 1.
Influence of_variance(const JointMoments& sample, double cost) {
  const double n = static_cast<double>(sample.count);
  const double squares = sample.sum(2, 0);
  const Coefficients of{.square = n / squares, .cost = cost};
  Influence influence{.log_value = std::log(squares / (n - 1)), .relative = about_one(sample, of)};
  // The error of the mean adds to the variance of s2 / sigma^2 its second order, 2 / n^2. The sum
  // of squares of psi moves by -4 S d with the mean, S the sum of psi d over that of d^2.
  influence.relative.m2 += 2;
  if (sample.known < weight) return influence;
  const double products = of.square * sample.sum(3, 0) + of.cost * sample.sum(1, 1);
  influence.relative.m4 += 16 * products * products / squares;
  return influence;
}

TestResult deterministic(double log_ratio) {
  return without_error(std::abs(log_ratio) <= influence_rounding ? 0 : log_ratio, "bound");
}

// e to the distance from the estimate; beyond e^300 nothing changes.
double ratio_of(const char* function, double log_ratio) {
  check::finite({function, "logarithm"}, log_ratio);
  return std::exp(std::clamp(log_ratio, -300.0, 300.0));
}

}  // namespace

Influence influence_of_mean(const Moments& positive) {
  check::at_least({"influence_of_mean", "count"}, positive.count, 2);
  check::positive({"influence_of_mean", "mean"}, positive.mean);
  const double scale = 1 / positive.mean;
  const double square = scale * scale;
  return {.log_value = std::log(positive.mean),
          .relative = {.count = positive.count,
                       .mean = 1,
                       .m2 = positive.m2 * square,
                       .m3 = positive.m3 * square * scale,
                       .m4 = positive.m4 * square * square,
                       .minimum = positive.minimum * scale,
                       .maximum = positive.maximum * scale}};
}

Influence influence_of_variance(const JointMoments& sample) {
  check_sample("influence_of_variance", sample);
  return of_variance(sample, 0);
}

Influence influence_of_variance_and_cost(const JointMoments& sample) {
  check_sample("influence_of_variance_and_cost", sample);
  check::positive({"influence_of_variance_and_cost", "mean cost"}, sample.of_cost.mean);
  Influence influence = of_variance(sample, 1 / sample.of_cost.mean);
  influence.log_value += std::log(sample.of_cost.mean);
  return influence;
}

Influence influence_of_error_and_cost(const JointMoments& sample, double truth) {
  check_sample("influence_of_error_and_cost", sample);
  check::positive({"influence_of_error_and_cost", "mean cost"}, sample.of_cost.mean);
  check::finite({"influence_of_error_and_cost", "truth"}, truth);
  const double n = static_cast<double>(sample.count);
  const double bias = sample.x().mean_less(truth);
  const double error = sample.sum(2, 0) / n + bias * bias;
  const Influence influence{.log_value = std::log(error) + std::log(sample.of_cost.mean),
                            .relative = about_one(sample, {.square = 1 / error,
                                                           .linear = 2 * bias / error,
                                                           .cost = 1 / sample.of_cost.mean})};
  if (!(influence.relative.m2 > 0)) {
    throw ZeroVariance("influence_of_error_and_cost: the mean squared error has no spread");
  }
  return influence;
}

TestResult influence_t(const Influence& x, double log_value) {
  const double null = ratio_of("influence_t", log_value - x.log_value);
  if (x.relative.m2 == 0) return deterministic(x.log_value - log_value);
  return skewness_corrected_t(x.relative, {.value = null}, "influence_t");
}

TestResult influence_t(const Influence& x, const Influence& y, double log_ratio) {
  const double distance = log_ratio - (x.log_value - y.log_value);
  const double null = ratio_of("influence_t", distance);
  if (x.relative.m2 == 0 && y.relative.m2 == 0) return deterministic(-distance);
  return skewness_corrected_welch(x.relative, y.relative, {.scale = null}, "influence_t");
}

namespace {

// The estimate with its standard error, at the truths as they are known.
Reference log_ratio_estimate(const LogRatio& ratio) {
  double variance = 0;
  std::vector<double> logs;
  for (const RatioSide& side : ratio.sides) {
    const Influence influence = side.influence(side.truth.known.value);
    logs.push_back(influence.log_value);
    variance += std::pow(influence.relative.standard_error(), 2);
  }
  const double second = logs.size() == 1 ? 0 : logs[1];
  return {ratio.sign * (logs[0] - second) - ratio.log_null, std::sqrt(variance)};
}

// Null hypothesis: theta = this value. Two equal truths are one, with one error.
TestResult log_ratio_test(const LogRatio& ratio, double theta) {
  std::vector<UncertainReference> truths;
  for (const RatioSide& side : ratio.sides) {
    const auto [value, error] = side.truth.known;
    const bool shared = !truths.empty() && truths[0].known.value == value &&
                        truths[0].known.standard_error == error;
    if (!shared) truths.push_back(side.truth);
  }
  const double log_ratio = ratio.sign * (theta + ratio.log_null);
  const auto at = [&](std::span<const double> each) {
    const auto influence = [&](std::size_t i) {
      return ratio.sides[i].influence(each.size() > i ? each[i] : each[0]);
    };
    const Influence first = influence(0);
    TestResult result = ratio.sides.size() == 1 ? influence_t(first, log_ratio)
                                                : influence_t(first, influence(1), log_ratio);
    if (ratio.sign > 0) return result;
    result.statistic = -result.statistic;
    std::swap(result.log_p_lower, result.log_p_upper);
    return result;
  };
  return test_over_references(at, truths);
}

}  // namespace

Evidence log_ratio_evidence(const LogRatio& ratio) {
  const Reference known = log_ratio_estimate(ratio);
  const auto at = [=](double theta) { return log_ratio_test(ratio, theta); };
  const auto interval = [=](double confidence) -> Interval {
    if (known.standard_error == 0) return {known.value, known.value, confidence};
    return interval_by_inversion(at, {.estimate = known.value, .step = known.standard_error},
                                 confidence);
  };
  return {
      .estimate = known.value, .at = at, .interval = interval, .exact = known.standard_error == 0};
}

}  // namespace assay::stats
