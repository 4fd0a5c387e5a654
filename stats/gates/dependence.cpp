#include "stats/gates/dependence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "stats/basics/check.h"
#include "stats/basics/scores.h"
#include "stats/basics/vector_copies.h"
#include "stats/gates/copies.h"
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

// The Z of the same sign whose tail has this probability.
double lag_one_critical(const TestResult& test, double probability) {
  const auto shape = shape_of(test.distribution.parameters[0]);
  if (test.statistic < 0) return -upper_normal_quantile(probability);
  if (!shape) return upper_normal_quantile(probability);
  const double at = chi_square_quantile({Tail::upper, std::log(probability)}, 2 * *shape) / 2;
  return (at - *shape) / std::sqrt(*shape);
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

namespace {

bool are_equal(std::span<const double> values) {
  return std::ranges::adjacent_find(values, std::ranges::not_equal_to{}) == values.end();
}

std::vector<LaggedCorrelation> correlations_of_ranks(std::span<const double> ranks,
                                                     std::size_t first, std::size_t last) {
  const std::size_t n = ranks.size();
  const double squares = sum_of_products(ranks, ranks);
  const std::size_t farthest = std::min({last, n / 4, most_lags, most_products / n});
  const double count = static_cast<double>(n);
  std::vector<LaggedCorrelation> all;
  for (std::size_t lag = first; lag <= farthest; ++lag) {
    const double r = sum_of_products(ranks.subspan(lag), ranks) / squares;
    const double z = (r + 1 / count) * count / std::sqrt(count - static_cast<double>(lag));
    all.push_back({.lag = lag, .correlation = r, .z = z});
  }
  return all;
}

}  // namespace

std::vector<LaggedCorrelation> lagged_correlations(std::span<const double> values,
                                                   std::size_t first, std::size_t last) {
  if (values.size() < 8 || are_equal(values)) return {};
  return correlations_of_ranks(centred_ranks(values), first, last);
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

namespace {

constexpr double false_red_of_dependence = 5e-5;
// A suite has many tests of many looks, and hardly one whose estimator forgets to be independent.
constexpr double false_red_of_draws = 1e-7;
constexpr double false_amber = 0.01;
constexpr double false_allowance = 0.05;
// Correlations cost up to the square of this number.
constexpr std::size_t most_correlated = 8192;
constexpr std::size_t most_lagged = 2048;
constexpr std::size_t most_short = 16;
constexpr std::size_t shortest_rank_batch = 8;
constexpr std::size_t fewest_rank_batches = 8;

GateState state_at(double value, double green_up_to, double limit) {
  if (value > limit) return GateState::red;
  return value > green_up_to ? GateState::amber : GateState::green;
}

// The farthest lag with a correlation beyond chance, 0 if there is none. An autocorrelation time
// widens the spread of the correlations by its root.
std::size_t farthest_correlated(std::span<const double> values, double time) {
  const std::vector<LaggedCorrelation> all = lagged_correlations(values);
  if (all.empty()) return 0;
  const double limit =
      upper_normal_quantile(false_red_of_dependence / static_cast<double>(all.size()));
  const double beyond_chance = limit * std::sqrt(std::max(1.0, time));
  std::size_t farthest = 0;
  for (const LaggedCorrelation& each : all) {
    if (each.z > beyond_chance) farthest = each.lag;
  }
  return farthest;
}

struct BatchRatio {
  double value;
  FDegrees degrees;

  double quantile(double p) const { return f_quantile({Tail::upper, std::log(p)}, degrees); }
};

BatchRatio batch_ratio(const char* caller, std::span<const double> values, std::size_t length) {
  check::at_least({caller, "count"}, values.size(), 9);
  const Moments means = batch_means(values, length);
  const std::size_t used = length * means.count;
  Moments all;
  for (const double value : values.first(used)) all.add(value);
  const double b = static_cast<double>(length);
  const double within = all.m2 - b * means.m2;
  const FDegrees plain{.numerator = static_cast<double>(means.count - 1),
                       .denominator = static_cast<double>(used - means.count)};
  if (all.m2 == 0) {
    if (std::ranges::count(values, values[0]) == std::ssize(values))
      throw ZeroVariance(std::string(caller) + ": zero variance");
    // Batches without any spread, beside values after the last one, tell nothing.
    return {.value = 1, .degrees = plain};
  }
  // A sum of squares has fewer degrees where the values' excess kurtosis is positive (Box 1953).
  const double excess = std::max(0.0, all.kurtosis() - 3);
  const FDegrees degrees{.numerator = plain.numerator / (1 + excess / b / 2),
                         .denominator = plain.denominator / (1 + excess / 2)};
  // Batches that are constant within themselves leave nothing to divide by. They are as dependent
  // as can be.
  const double ratio = within > 0 ? b * means.variance() / (within / plain.denominator)
                                  : std::numeric_limits<double>::infinity();
  return {.value = ratio, .degrees = degrees};
}

Gate gate_of_lags(const std::vector<LaggedCorrelation>& all, const char* name, double chance) {
  Gate gate{.name = name};
  if (all.empty()) return gate;
  const LaggedCorrelation worst = worst_of(all);
  const auto limit = [&](double probability) {
    return upper_normal_quantile(probability / (2 * static_cast<double>(all.size())));
  };
  gate.value = worst.correlation;
  gate.low = worst.correlation;
  gate.limit = worst.z == 0 ? 0 : worst.correlation * limit(chance) / std::abs(worst.z);
  gate.state = state_at(std::abs(worst.z), limit(false_amber), limit(chance));
  return gate;
}

// H of dependence.h.
double rank_batch_statistic(std::span<const double> ranks, std::size_t length) {
  double sum = 0;
  for (std::size_t end = length; end <= ranks.size(); end += length) {
    const auto batch = ranks.subspan(end - length, length);
    const double ranks_of_batch = std::accumulate(batch.begin(), batch.end(), 0.0);
    sum += ranks_of_batch * ranks_of_batch;
  }
  const auto n = static_cast<double>(ranks.size());
  return 12 * sum / (static_cast<double>(length) * n * (n + 1));
}

Gate gate_of_rank_batches(std::span<const double> ranks) {
  Gate gate{.name = "variance of batch ranks of drawn observations", .value = 1, .low = 1};
  std::vector<std::size_t> lengths;
  for (std::size_t length = shortest_rank_batch; length * fewest_rank_batches <= ranks.size();
       length *= 2) {
    lengths.push_back(length);
  }
  const double tests = static_cast<double>(lengths.size());
  double least = 0;
  for (const std::size_t length : lengths) {
    const auto batches = static_cast<double>(ranks.size() / length);
    const double statistic = rank_batch_statistic(ranks, length);
    const double log_p = chi_square_tails(statistic, batches).upper + std::log(tests);
    if (log_p >= least) continue;
    least = log_p;
    gate.value = statistic / batches;
    gate.low = gate.value;
    gate.limit =
        chi_square_quantile({Tail::upper, std::log(false_red_of_draws / tests)}, batches) / batches;
  }
  gate.state = state_at(-least, -std::log(false_amber), -std::log(false_red_of_draws));
  return gate;
}

}  // namespace

Gate lag_one_gate(std::span<const double> values) {
  const TestResult test = lag_one_test(values, "lag_one_gate");
  const double z = test.statistic;
  const double r = autocorrelation(values, 1);
  const double n = static_cast<double>(values.size());
  // z = (r + 1/n) / deviation.
  const double deviation = z == 0 ? 1 / std::sqrt(n) : (r + 1 / n) / z;
  const auto critical = [&](double error) { return lag_one_critical(test, error / 2); };
  Gate gate{.name = "correlation of successive values", .value = r, .low = r};
  gate.limit = critical(false_red_of_dependence) * deviation - 1 / n;
  gate.state = state_at(std::abs(z), std::abs(critical(false_amber)),
                        std::abs(critical(false_red_of_dependence)));
  return gate;
}

Gate batch_gate(std::span<const double> values) {
  const BatchRatio batches = batch_ratio("batch_gate", values, default_batch(values.size()));
  return judged({.name = "variance of batch means",
                 .value = batches.value,
                 .low = batches.value,
                 .limit = batches.quantile(false_red_of_dependence)},
                batches.quantile(false_amber));
}

Gate lagged_gate(std::span<const double> values) {
  return gate_of_lags(lagged_correlations(values), "correlation of values some steps apart",
                      false_red_of_dependence);
}

std::vector<Gate> drawn_order_gates(std::span<const double> values) {
  if (values.size() < 8) return {};
  const std::vector<double> ranks = centred_ranks(values);
  std::vector<LaggedCorrelation> lags;
  if (!are_equal(values)) lags = correlations_of_ranks(ranks, 1, most_short);
  const auto first = values.first(std::min(values.size(), most_lagged));
  std::ranges::copy(lagged_correlations(first, most_short + 1), std::back_inserter(lags));
  std::vector<Gate> gates{
      gate_of_lags(lags, "rank correlation of drawn observations", false_red_of_draws),
      gate_of_rank_batches(ranks)};
  if (const auto again = repeated_run(values)) {
    const auto length = static_cast<double>(again->length);
    gates.push_back(
        {.name = "longest repetition", .value = length, .low = length, .state = GateState::red});
  }
  return gates;
}

double autocorrelation_time(std::span<const double> values) {
  check::at_least({"autocorrelation_time", "count"}, values.size(), 4);
  const std::size_t length = 1 + (values.size() - 1) / most_correlated;
  const auto time = [](std::span<const double> sequence) {
    return static_cast<double>(sequence.size()) / effective_sample_size(sequence);
  };
  if (length == 1) return time(values);
  std::vector<double> averaged;
  Moments all;
  for (std::size_t first = 0; first + length <= values.size(); first += length) {
    Moments batch;
    for (const double value : values.subspan(first, length)) batch.add(value);
    averaged.push_back(batch.mean);
    all.merge(batch);
  }
  const double variance = static_cast<double>(length) * batch_means(values, length).variance();
  return time(averaged) * variance / all.variance();
}

double allowance_for_dependence(std::span<const double> values) {
  const std::size_t n = values.size();
  bool doubtful =
      lag_one_test(values, "allowance_for_dependence").log_p_upper < std::log(false_allowance);
  double factor = 1;
  for (const std::size_t length : {default_batch(n), n / 10}) {
    if (length < default_batch(n)) continue;
    const BatchRatio batches = batch_ratio("allowance_for_dependence", values, length);
    if (batches.value <= batches.quantile(false_allowance)) continue;
    doubtful = true;
    factor = std::max(factor, batches.value);
  }
  return doubtful ? std::max(factor, autocorrelation_time(values)) : 1;
}

std::size_t sufficient_batch(std::span<const double> values) {
  const double time = autocorrelation_time(values);
  const std::size_t length =
      std::max({default_batch(values.size()), static_cast<std::size_t>(std::ceil(10 * time)),
                5 * farthest_correlated(values, time)});
  const std::size_t batches = std::max<std::size_t>(1, values.size() / length);
  return values.size() / batches;
}

}  // namespace assay::stats
