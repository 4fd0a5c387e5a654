#include "stats/gates/assumption_gates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "stats/basics/check.h"
#include "stats/basics/scores.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr double false_red = 1e-4;
constexpr double green_factor = 1.25;
constexpr double red_factor = 2;
constexpr double kurtosis_limit = 0.2;
constexpr double red_share = 0.5;
constexpr double green_share = 0.25;

// ---- Normal-data quantiles of g1 and b2

// The b2 - 3 that normal samples of n exceed with probability 1e-4: Anscombe & Glynn (1983), n
// >= 20.
double normal_kurtosis_quantile(double n) {
  if (n < 20) return std::numeric_limits<double>::infinity();
  const double mean = 3 * (n - 1) / (n + 1);
  const double variance = 24 * n * (n - 2) * (n - 3) / ((n + 1) * (n + 1) * (n + 3) * (n + 5));
  const double skewness = 6 * (n * n - 5 * n + 2) / ((n + 7) * (n + 9)) *
                          std::sqrt(6 * (n + 3) * (n + 5) / (n * (n - 2) * (n - 3)));
  const double a = 6 + 8 / skewness * (2 / skewness + std::sqrt(1 + 4 / (skewness * skewness)));
  const double c = 1 - 2 / (9 * a) - upper_normal_quantile(false_red) * std::sqrt(2 / (9 * a));
  if (c <= 0) return std::numeric_limits<double>::infinity();
  const double x = ((1 - 2 / a) / (c * c * c) - 1) / std::sqrt(2 / (a - 4));
  return mean + x * std::sqrt(variance) - 3;
}

// ---- Spread of g1 and b2 for a gamma law of given shape

// Standardised moments 3 to 8 of a gamma law, from its cumulants kappa_r = (r - 1)! (g / 2)^(r -
// 2).
std::array<double, 9> gamma_moments(double skewness) {
  std::array<double, 9> kappa{};
  std::array<double, 9> mu{};
  double factorial = 1;
  for (std::size_t r = 2; r <= 8; ++r) {
    factorial *= r > 2 ? static_cast<double>(r - 1) : 1;
    kappa[r] = factorial * std::pow(skewness / 2, static_cast<double>(r) - 2);
  }
  // mu_r = sum_j C(r - 1, j - 1) kappa_j mu_(r - j), with mu_0 = 1 and mu_1 = kappa_1 = 0.
  mu[0] = 1;
  for (std::size_t r = 2; r <= 8; ++r) {
    double binomial = static_cast<double>(r - 1);  // C(r - 1, 1) for j = 2
    for (std::size_t j = 2; j <= r; ++j) {
      mu[r] += binomial * kappa[j] * mu[r - j];
      binomial *= static_cast<double>(r - j) / static_cast<double>(j);
    }
  }
  return mu;
}

// sqrt(n Var(g1) / 6) by the delta method; 6 is the normal law's.
double skewness_widening(double skewness) {
  const auto mu = gamma_moments(skewness);
  const double g = mu[3];
  const double variance = mu[6] - 6 * mu[4] + 9 + g * g * (9 * mu[4] + 35) / 4 - 3 * g * mu[5];
  return std::sqrt(variance / 6);
}

// sqrt(n Var(b2) / 24) likewise. The gamma law of excess kurtosis k has skewness sqrt(2 k / 3).
double kurtosis_widening(double excess) {
  const auto mu = gamma_moments(std::sqrt(2 * excess / 3));
  const double variance = mu[8] - mu[4] * mu[4] + 16 * mu[3] * mu[3] * (1 + mu[4]) +
                          4 * mu[4] * mu[4] * (mu[4] - 1) - 8 * mu[3] * mu[5] -
                          4 * mu[4] * (mu[6] - mu[4]);
  return std::sqrt(variance / 24);
}

// ---- Skewness of a contrast

// One sample's share in 2a = (1/3) sum psi^3 / (sum psi^2)^1.5, and the share that normal data
// would have.
struct SkewnessPart {
  double value = 0;
  double allowance = 0;
};

SkewnessPart skewness_part(const Moments& x, double variance_share, double cube) {
  if (x.m2 == 0) return {};
  const double n = static_cast<double>(x.count);
  const double weight = variance_share * std::sqrt(variance_share) / (3 * std::sqrt(n));
  const double boundary = 3 * std::sqrt(n) * std::log(red_factor) / cube;
  const double allowance = normal_skewness_quantile(n, false_red) * skewness_widening(boundary);
  return {weight * x.skewness(), weight * allowance};
}

Gate skewness_gate_of(SkewnessPart first, SkewnessPart second, double cube) {
  const double size = std::abs(first.value - second.value);
  const double low = std::max(0.0, size - std::hypot(first.allowance, second.allowance));
  return judged({"level factor by skewness", std::exp(std::min(size * cube, 700.0)),
                 std::exp(std::min(low * cube, 700.0)), red_factor},
                green_factor);
}

double checked_cube(double critical_value) {
  check::positive({"skewness_gate", "critical_value"}, critical_value);
  return critical_value * critical_value * critical_value;
}

// Largest deviation over s that a sample of n shows at `probability`: n times the tail of one
// residual.
double grubbs(double n, double probability) {
  const double t = student_t_quantile({Tail::upper, std::log(probability / (2 * n))}, n - 2);
  return (n - 1) / std::sqrt(n) / std::sqrt(1 + (n - 2) / t / t);
}

// ---- Rounding

constexpr double rounding_limit = 0.05;
constexpr double most_steps = 0x1p20;
// In steps. Values written with a fixed number of decimals are off their lattice by rounding.
constexpr double tolerance = 0.01;

bool is_lattice(std::span<const double> sorted) {
  double gap = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] > sorted[i - 1]) gap = std::min(gap, sorted[i] - sorted[i - 1]);
  }
  const double range = sorted.back() - sorted.front();
  if (!(range / gap <= most_steps)) return false;
  // The mean step, because one gap alone is known to rounding only.
  const double steps = std::round(range / gap);
  return std::ranges::all_of(sorted, [&](double value) {
    const double position = (value - sorted.front()) / range * steps;
    return !(std::abs(position - std::round(position)) > tolerance);
  });
}

double tie_probability(std::span<const double> sorted) {
  const double n = static_cast<double>(sorted.size());
  double pairs = 0;
  for_each_tie(sorted, [&](std::size_t first, std::size_t end) {
    const double count = static_cast<double>(end - first);
    pairs += count * (count - 1);
  });
  return pairs / (n * (n - 1));
}

// ---- Means of primaries

constexpr double false_red_of_averages = 1e-7;
constexpr double false_amber_of_averages = 0.01;
constexpr std::size_t fewest_means = 16;

// Means of values that stand apart, so that neighbours that depend on each other do not meet.
std::vector<double> means_of(std::span<const double> values, std::size_t each) {
  const std::size_t groups = values.size() / each;
  std::vector<double> means;
  for (std::size_t group = 0; group < groups; ++group) {
    double sum = 0;
    for (std::size_t k = 0; k < each; ++k) sum += values[group + k * groups];
    means.push_back(sum / static_cast<double>(each));
  }
  return means;
}

// Makes values equal that differ by less than a sum of so many loses in single precision. From the
// least on, each takes those within that distance.
void join_rounded(std::vector<double>& values, std::size_t each) {
  const double relative = 0x1p-24 * static_cast<double>(each);
  std::vector<double*> order;
  for (double& value : values) order.push_back(&value);
  std::ranges::sort(order, {}, [](const double* value) { return *value; });
  double least = *order.front();
  for (double* const value : order) {
    if (*value - least > relative * std::max(std::abs(least), std::abs(*value))) least = *value;
    *value = least;
  }
}

// Phi^-1 of the ranks, the mean rank for equal values.
std::vector<double> normal_scores(std::span<const double> values) {
  std::vector<Placed<double>> order;
  std::vector<double> scores;
  midranks(values, order, scores);
  for (double& score : scores) {
    const double rank = (score + 0.5) / static_cast<double>(values.size());
    score = normal_quantile({Tail::lower, std::log(rank)});
  }
  return scores;
}

// |z| of the sum of the first scores, in a random order of all.
double deviation_of_sum(std::span<const double> scores, std::size_t first) {
  Moments all;
  for (const double score : scores) all.add(score);
  double sum = 0;
  for (const double score : scores.first(first)) sum += score - all.mean;
  const auto n = static_cast<double>(scores.size());
  const auto k = static_cast<double>(first);
  const double variance = k * (n - k) / (n * (n - 1)) * all.m2;
  return variance > 0 ? std::abs(sum) / std::sqrt(variance) : 0;
}

// It is never red: another method takes the place of the one it would allow.
Gate of_choice(const char* name, double value, double limit) {
  const GateState state = value <= limit ? GateState::green : GateState::amber;
  return {.name = name, .value = value, .low = value, .limit = limit, .state = state};
}

}  // namespace

double normal_skewness_quantile(double n, double probability) {
  if (n < 8) return std::numeric_limits<double>::infinity();
  const double beta2 =
      3 * (n * n + 27 * n - 70) * (n + 1) * (n + 3) / ((n - 2) * (n + 5) * (n + 7) * (n + 9));
  const double w2 = std::sqrt(2 * (beta2 - 1)) - 1;
  const double delta = 1 / std::sqrt(0.5 * std::log(w2));
  const double alpha = std::sqrt(2 / (w2 - 1));
  const double y = alpha * std::sinh(upper_normal_quantile(probability / 2) / delta);
  return y * std::sqrt(6 * (n - 2) / ((n + 1) * (n + 3)));
}

std::uint64_t primaries_for_variance(double excess_kurtosis, double limit) {
  constexpr const char* function = "primaries_for_variance";
  check::finite({function, "excess_kurtosis"}, excess_kurtosis);
  check::positive({function, "limit"}, limit);
  const double needed = excess_kurtosis / limit;
  if (!(needed < 0x1p53)) check::fail({function, "primaries needed"}, needed, "below 2^53");
  return static_cast<std::uint64_t>(std::max(1.0, std::ceil(needed)));
}

Gate near_normal_gate(const Moments& pilot, double averaged) {
  constexpr double near_normal = 0.3;
  constexpr double unlikely = 0.01;
  const double root = std::sqrt(averaged);
  const double value = std::abs(pilot.skewness()) / root;
  const double allowance =
      normal_skewness_quantile(static_cast<double>(pilot.count), unlikely) / root;
  return of_choice("skewness of an observation", value, std::max(near_normal, allowance));
}

Gate small_kurtosis_gate(const Moments& pilot, double averaged, double limit) {
  constexpr std::uint64_t fewest_with_kurtosis = 4;
  const double upper = pilot.count >= fewest_with_kurtosis
                           ? kurtosis_upper_limit(pilot) / averaged
                           : std::numeric_limits<double>::infinity();
  return of_choice("upper limit of the excess kurtosis", upper, limit);
}

double kurtosis_limit_at(double critical_value) {
  constexpr double level_factor = 1.25;
  const double log_tail = normal_tails(critical_value).upper;
  const double nearer = normal_quantile({Tail::upper, log_tail + std::log(level_factor)});
  const double inflation = critical_value / nearer;
  return std::min(kurtosis_limit, 2 * (inflation * inflation - 1));
}

Gate skewness_gate(const Moments& x, double critical_value) {
  check::at_least({"skewness_gate", "count"}, x.count, 2);
  if (x.m2 == 0) throw ZeroVariance("skewness_gate: zero variance");
  const double cube = checked_cube(critical_value);
  return skewness_gate_of(skewness_part(x, 1, cube), {}, cube);
}

Gate skewness_gate(const Moments& x, const Moments& y, double scale, double critical_value) {
  check::finite({"skewness_gate", "scale"}, scale);
  check::at_least({"skewness_gate", "count of x"}, x.count, 2);
  check::at_least({"skewness_gate", "count of y"}, y.count, 2);
  const double cube = checked_cube(critical_value);
  const double vx = x.variance() / static_cast<double>(x.count);
  const double vy = scale * scale * y.variance() / static_cast<double>(y.count);
  if (vx + vy == 0) throw ZeroVariance("skewness_gate: zero variance in both samples");
  SkewnessPart of_y = skewness_part(y, vy / (vx + vy), cube);
  of_y.value = std::copysign(1, scale) * of_y.value;
  return skewness_gate_of(skewness_part(x, vx / (vx + vy), cube), of_y, cube);
}

Gate dominance_gate(const Moments& x) {
  check::at_least({"dominance_gate", "count"}, x.count, 3);
  if (x.m2 == 0) throw ZeroVariance("dominance_gate: zero variance");
  const double largest = std::max(x.maximum - x.mean, x.mean - x.minimum);
  const double value = largest / x.m2 * largest;
  const auto critical = [n = static_cast<double>(x.count)](double probability) {
    const double deviation = grubbs(n, probability);
    return deviation / (n - 1) * deviation;
  };
  const double limit = std::max(red_share, critical(false_red));
  return judged({"share of one observation", value, value, limit},
                std::max(green_share, critical(0.05)));
}

Gate effective_observations_gate(std::span<const Moments> samples) {
  double sum = 0;
  double sum_of_squares = 0;
  for (const Moments& x : samples) {
    check::at_least({"effective_observations_gate", "count"}, x.count, 2);
    const double n = static_cast<double>(x.count);
    const double largest = std::max(x.maximum - x.mean, x.mean - x.minimum);
    const double fourth = x.m4 > 0 ? x.m4 : x.m2 * largest * largest;
    sum += x.m2 / n / n;
    sum_of_squares += fourth / n / n / n / n;
  }
  if (sum == 0) throw ZeroVariance("effective_observations_gate: zero variance");
  const double value = sum / sum_of_squares * sum;
  const GateState state = value < fewest_effective_observations       ? GateState::red
                          : value < 2 * fewest_effective_observations ? GateState::amber
                                                                      : GateState::green;
  return {"effective observations", value, value, fewest_effective_observations, state};
}

Gate kurtosis_gate(const Moments& x) {
  check::at_least({"kurtosis_gate", "count"}, x.count, 4);
  if (x.m2 == 0) throw ZeroVariance("kurtosis_gate: zero variance");
  const double value = x.kurtosis() - 3;
  const double allowance =
      normal_kurtosis_quantile(static_cast<double>(x.count)) * kurtosis_widening(kurtosis_limit);
  return judged({"excess kurtosis", value, std::max(value - allowance, -2.0), kurtosis_limit},
                kurtosis_limit);
}

double kurtosis_upper_limit(const Moments& x) {
  check::at_least({"kurtosis_upper_limit", "count"}, x.count, 4);
  if (x.m2 == 0) throw ZeroVariance("kurtosis_upper_limit: zero variance");
  constexpr double z = 1.6448536269514722;  // The normal law's upper quantile at .05.
  const double excess = x.kurtosis() - 3;
  const double error = std::sqrt(24 / static_cast<double>(x.count));
  return std::max(0.0, excess + z * error * kurtosis_widening(std::max(0.0, excess)));
}

Gate quantisation_gate(std::span<const double> sorted, double level) {
  check::at_least({"quantisation_gate", "count"}, sorted.size(), 2);
  check::inside_unit({"quantisation_gate", "level"}, level);
  check::finite({"quantisation_gate", "smallest value"}, sorted.front());
  check::finite({"quantisation_gate", "largest value"}, sorted.back());
  const double rejected = std::sqrt(std::log(2 / level) / (2 * static_cast<double>(sorted.size())));
  const double ties = is_lattice(sorted) ? tie_probability(sorted) : 0;
  const double value = ties / (2 * rejected);
  return judged({"rounding", value, value, rounding_limit}, rounding_limit);
}

Gate averages_gate(std::span<const double> values, std::span<const double> means,
                   std::size_t each) {
  check::at_least({"averages_gate", "each"}, each, 1);
  for (const double value : values) check::finite({"averages_gate", "value"}, value);
  for (const double mean : means) check::finite({"averages_gate", "mean"}, mean);
  std::vector<double> pooled = means_of(values, each);
  const std::size_t groups = pooled.size();
  const auto limit = [](double chance) { return upper_normal_quantile(chance / 4); };
  Gate gate{.name = "place and spread of means against those of primaries",
            .limit = limit(false_red_of_averages)};
  if (std::min(groups, means.size()) < fewest_means) return gate;
  pooled.insert(pooled.end(), means.begin(), means.end());
  join_rounded(pooled, each);
  std::vector<double> scores = normal_scores(pooled);
  gate.value = deviation_of_sum(scores, groups);
  for (double& score : scores) score *= score;
  gate.value = std::max(gate.value, deviation_of_sum(scores, groups));
  gate.low = gate.value;
  return judged(gate, limit(false_amber_of_averages));
}

}  // namespace assay::stats
