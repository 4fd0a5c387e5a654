#include "stats/gates/dependence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "stats/basics/check.h"
#include "stats/basics/scores.h"
#include "stats/basics/vector_copies.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

class Sequence {
 public:
  Sequence(const char* function, std::span<const double> values, std::size_t fewest)
      : values_(values) {
    check::at_least({function, "count"}, values.size(), fewest);
    for (const double value : values) {
      check::finite({function, "value"}, value);
      moments_.add(value);
    }
    if (moments_.m2 == 0) throw ZeroVariance(std::string(function) + ": zero variance");
  }

  double skewness() const { return moments_.skewness(); }

  double correlation(std::size_t lag) const {
    double sum = 0;
    for (std::size_t t = lag; t < values_.size(); ++t) {
      sum += (values_[t] - moments_.mean) * (values_[t - lag] - moments_.mean);
    }
    return sum / moments_.m2;
  }

 private:
  std::span<const double> values_;
  Moments moments_;
};

// Half the degrees of the chi-square law whose skewness is s; none if it is as good as normal.
std::optional<double> shape_of(double s) {
  return s > 1e-4 ? std::optional(4 / (s * s)) : std::nullopt;
}

constexpr std::size_t most_lags = 1000;
constexpr std::size_t most_products = 200'000'000;

// The sum of a_i b_i, in a fixed order whatever the machine. `b` is at least as long as `a`.
ASSAY_VECTOR_COPIES double sum_of_products(std::span<const double> a, std::span<const double> b) {
  constexpr std::size_t lanes = 16;  // products that are added side by side
  std::array<double, lanes> parts{};
  std::size_t i = 0;
  for (; i + lanes <= a.size(); i += lanes) {
    for (std::size_t l = 0; l < lanes; ++l) parts[l] += a[i + l] * b[i + l];
  }
  for (std::size_t l = 0; i < a.size(); ++i, ++l) parts[l] += a[i] * b[i];
  return std::accumulate(parts.begin(), parts.end(), 0.0);
}

}  // namespace

double autocorrelation(std::span<const double> values, std::size_t lag) {
  return Sequence("autocorrelation", values, std::max<std::size_t>(2, lag + 1)).correlation(lag);
}

TestResult lag_one_test(std::span<const double> values, const char* caller) {
  const Sequence sequence(caller, values, 4);
  const double r = sequence.correlation(1);
  const double n = static_cast<double>(values.size());
  const double variance = (n * n * n * n - 4 * n * n * n + 3 * n * n + 4 * n - 4) /
                          ((n + 1) * n * n * (n - 1) * (n - 1));
  const double z = (r + 1 / n) / std::sqrt(variance);
  const double s = sequence.skewness() * sequence.skewness() / std::sqrt(n);
  LogTails tails = normal_tails(z);
  if (const auto shape = shape_of(s); shape && z > 0) {
    tails.upper = chi_square_tails(2 * (*shape + z * std::sqrt(*shape)), 2 * *shape).upper;
  }
  return by_tails(z, {"pearson-iii", {s}}, tails);
}

double lag_one_critical(const TestResult& test, double probability) {
  const auto shape = shape_of(test.distribution.parameters[0]);
  if (test.statistic < 0) return -upper_normal_quantile(probability);
  if (!shape) return upper_normal_quantile(probability);
  const double at = chi_square_quantile({Tail::upper, std::log(probability)}, 2 * *shape) / 2;
  return (at - *shape) / std::sqrt(*shape);
}

double effective_sample_size(std::span<const double> values) {
  const Sequence sequence("effective_sample_size", values, 4);
  const double n = static_cast<double>(values.size());
  double sum = 0;
  double previous = 2;  // No pair of correlations is larger.
  for (std::size_t m = 0; 2 * m + 1 < values.size(); ++m) {
    const double pair = sequence.correlation(2 * m) + sequence.correlation(2 * m + 1);
    if (pair <= 0) break;
    previous = std::min(previous, pair);
    sum += previous;
  }
  return std::min(n / std::max(2 * sum - 1, 1 / n), n * std::log10(n));
}

std::size_t default_batch(std::size_t n) {
  auto root = static_cast<std::size_t>(std::sqrt(static_cast<double>(n)));
  while (root * root > n) --root;
  return root;
}

Moments batch_means(std::span<const double> values, std::size_t length) {
  check::at_least({"batch_means", "length"}, length, 1);
  const std::size_t batches = values.size() / length;
  check::at_least({"batch_means", "batches"}, batches, 2);
  Moments means;
  for (std::size_t b = 0; b < batches; ++b) {
    Moments batch;
    for (const double value : values.subspan(b * length, length)) {
      check::finite({"batch_means", "value"}, value);
      batch.add(value);
    }
    means.add(batch.mean);
  }
  return means;
}

std::vector<LaggedCorrelation> lagged_correlations(std::span<const double> values,
                                                   std::size_t first) {
  const std::size_t n = values.size();
  const bool constant =
      std::ranges::adjacent_find(values, std::ranges::not_equal_to{}) == values.end();
  if (n < 8 || constant) return {};
  const std::vector<double> ranks = centred_ranks(values);
  const double squares = sum_of_products(ranks, ranks);
  const std::size_t farthest = std::min({n / 4, most_lags, most_products / n});
  const double count = static_cast<double>(n);
  std::vector<LaggedCorrelation> all;
  for (std::size_t lag = first; lag <= farthest; ++lag) {
    const double r = sum_of_products(std::span(ranks).subspan(lag), ranks) / squares;
    const double z = (r + 1 / count) * count / std::sqrt(count - static_cast<double>(lag));
    all.push_back({.lag = lag, .correlation = r, .z = z});
  }
  return all;
}

double rank_correlation(std::span<const double> x, std::span<const double> y) {
  std::vector<Placed<double>> order;
  std::array<std::vector<double>, 2> ranks;
  midranks(x, order, ranks[0]);
  midranks(y, order, ranks[1]);
  for (std::vector<double>& each : ranks) {
    if (!standardise(each)) return 0;
  }
  return sum_of_products(ranks[0], ranks[1]) / static_cast<double>(x.size());
}

std::optional<double> correlation_of_pairs(std::span<const double> x, std::span<const double> y) {
  constexpr double most_errors = 6;
  constexpr double clear = 0.2;
  if (x.size() != y.size()) return std::nullopt;
  const double r = rank_correlation(x, y);
  const double errors = std::abs(r) * std::sqrt(static_cast<double>(x.size()));
  if (errors < most_errors) return std::nullopt;
  const auto squares = [](std::span<const double> values) {
    double sum = 1, last = 0;
    for (const LaggedCorrelation& each : lagged_correlations(values, 1)) {
      last = each.correlation;
      sum += 2 * last * last;
    }
    return std::abs(last) > clear ? HUGE_VAL : sum;
  };
  if (errors < most_errors * std::pow(squares(x) * squares(y), 0.25)) return std::nullopt;
  return r;
}

LaggedCorrelation worst_of(std::span<const LaggedCorrelation> all) {
  LaggedCorrelation worst;
  for (const LaggedCorrelation& each : all) {
    if (std::abs(each.z) > std::abs(worst.z)) worst = each;
  }
  return worst;
}

}  // namespace assay::stats
