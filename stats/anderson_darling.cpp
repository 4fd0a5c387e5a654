#include "stats/anderson_darling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "stats/check.h"

namespace assay::stats {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double largest_double = std::numeric_limits<double>::max();

// One term of the series times e^x, by Chebyshev's rule: with v = w - 4k = cos(phi) the weight
// 1 / sqrt(1 - v^2) cancels the ends' singularities, and the rule converges geometrically.
double series_term(int k, double x) {
  // The factor e^(-3 x (w - 3) / 4) must be resolved at the edge of the first interval.
  const int nodes = 40 + static_cast<int>(8 * std::sqrt(x));
  double sum = 0;
  for (int i = 1; i <= nodes; ++i) {
    const double phi = (2 * i - 1) * pi / (2 * nodes);
    const double w = 4 * k + std::cos(phi);
    const double y = (w * w - 1) / 4;
    // cos(pi v / 2) = sin(pi (1 - |v|) / 2), 1 - |v| without cancellation.
    const double half = phi < pi / 2 ? std::sin(phi / 2) : std::cos(phi / 2);
    const double edge = std::sin(pi * half * half);
    sum += std::exp(-x * (y / 2 - 1)) * (w / 2) * std::sqrt(pi / y / edge) * std::sin(phi);
  }
  return sum / nodes;
}

double log_limit_upper(double x) {
  // Below this the law has less than 1e-26.
  if (x < 0.02) return 0;
  // Laplace's value of the first term at that edge, off by .2 / x.
  if (x > 1e6) return std::log(1.5) - std::log(0.75 * pi * x) / 2 - x;
  double sum = 0;
  for (int k = 1;; ++k) {
    const double term = series_term(k, x);
    sum += k % 2 == 1 ? term : -term;
    if (term < 1e-17 * sum) break;
  }
  return std::min(0.0, std::log(sum) - x);
}

void check_sorted(const char* function, std::span<const double> sorted) {
  check::finite({function, "smallest value"}, sorted.front());
  check::finite({function, "largest value"}, sorted.back());
  if (!std::is_sorted(sorted.begin(), sorted.end())) {
    check::fail({function, "values"}, sorted.size(), "sorted ascending");
  }
}

// A2 with u_i moved towards (2i - 1) / 2n by `error` at most.
double least_statistic(std::span<const double> given, double error) {
  const std::size_t n = given.size();
  check::at_least({"anderson_darling", "values"}, n, 5);
  const double size = static_cast<double>(n);
  std::vector<double> u;
  u.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    check::unit({"anderson_darling", "cdf"}, given[i]);
    const double bottom = (2 * static_cast<double>(i) + 1) / (2 * size);
    u.push_back(std::clamp(bottom, given[i] - error, given[i] + error));
  }
  const auto [lowest, highest] = std::minmax_element(u.begin(), u.end());
  if (*lowest <= 0 || *highest >= 1) return largest_double;
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    sum += static_cast<double>(2 * i + 1) * (std::log(u[i]) + std::log1p(-u[n - 1 - i]));
  }
  return -size - sum / size;
}

std::vector<double> continuous_probabilities(std::span<const double> sorted,
                                             const ContinuousLaw& law) {
  check::at_least({"anderson_darling", "values"}, sorted.size(), 5);
  check_sorted("anderson_darling", sorted);
  if (law.left_limit) {
    throw std::domain_error("anderson_darling: the law has atoms, must be continuous");
  }
  return probabilities(sorted, law);
}

// The pooled values in order, each with the sample that it came from.
struct Labelled {
  double value;
  std::size_t sample;
};

std::vector<Labelled> pool(const std::vector<std::vector<double>>& samples) {
  check::at_least({"anderson_darling_k", "samples"}, samples.size(), 2);
  std::vector<Labelled> pooled;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    check::at_least({"anderson_darling_k", "values of a sample"}, samples[i].size(), 1);
    check_sorted("anderson_darling_k", samples[i]);
    for (const double value : samples[i]) pooled.push_back({value, i});
  }
  std::stable_sort(pooled.begin(), pooled.end(),
                   [](const Labelled& a, const Labelled& b) { return a.value < b.value; });
  if (pooled.front().value == pooled.back().value) {
    check::fail({"anderson_darling_k", "value of all samples"}, pooled.front().value,
                "different from some other value");
  }
  return pooled;
}

std::vector<double> sizes_of(const std::vector<std::vector<double>>& samples) {
  std::vector<double> sizes;
  for (const auto& sample : samples) sizes.push_back(static_cast<double>(sample.size()));
  return sizes;
}

// (N-1)/N sum_i 1/n_i sum_j l_j/N (N M_aij - n_i B_aj)^2 / (B_aj (N - B_aj) - N l_j / 4), over the
// distinct values j, with midranks M_a and B_a inside the groups of ties l_j.
double k_statistic(const std::vector<Labelled>& pooled, const std::vector<double>& sizes) {
  const double total = static_cast<double>(pooled.size());
  std::vector<double> before(sizes.size(), 0);
  std::vector<double> here(sizes.size());
  double sum = 0;
  double behind = 0;
  for (std::size_t start = 0; start < pooled.size();) {
    std::fill(here.begin(), here.end(), 0);
    std::size_t end = start;
    while (end < pooled.size() && pooled[end].value == pooled[start].value) {
      ++here[pooled[end++].sample];
    }
    const double ties = static_cast<double>(end - start);
    const double middle = behind + ties / 2;
    double squares = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const double deviation = total * (before[i] + here[i] / 2) - sizes[i] * middle;
      squares += deviation * deviation / sizes[i];
      before[i] += here[i];
    }
    const double scale = middle * (total - middle) - total * ties / 4;
    if (scale > 0) sum += ties / total * squares / scale;
    behind += ties;
    start = end;
  }
  return (total - 1) / total * sum;
}

}  // namespace

double log_anderson_darling_upper(double x, std::uint64_t n) {
  check::at_least({"log_anderson_darling_upper", "n"}, n, 5);
  check::finite({"log_anderson_darling_upper", "x"}, x);
  const double correction = std::max(0.0, (x - 1) / 5) / static_cast<double>(n);
  return std::max(std::min(0.0, log_limit_upper(x) + std::log1p(correction)),
                  std::numeric_limits<double>::lowest());
}

double anderson_darling_statistic(std::span<const double> sorted, const ContinuousLaw& law) {
  return least_statistic(continuous_probabilities(sorted, law), 0);
}

TestResult anderson_darling(std::span<const double> sorted, const ContinuousLaw& law) {
  return anderson_darling(sorted, law, 0);
}

TestResult anderson_darling(std::span<const double> sorted, const ContinuousLaw& law,
                            double error) {
  return anderson_darling(Probabilities{continuous_probabilities(sorted, law)}, error);
}

TestResult anderson_darling(Probabilities at, double error) {
  check::non_negative({"anderson_darling", "error"}, error);
  const double statistic = least_statistic(at.of_values, error);
  return {statistic,
          {"bound", {}},
          0,
          log_anderson_darling_upper(statistic, at.of_values.size()),
          Exactness::asymptotic};
}

double anderson_darling_k_statistic(const std::vector<std::vector<double>>& sorted_samples) {
  return k_statistic(pool(sorted_samples), sizes_of(sorted_samples));
}

TestResult anderson_darling_k(const std::vector<std::vector<double>>& sorted_samples,
                              const PermutationPlan& plan) {
  check::at_least({"anderson_darling_k", "permutations"}, plan.permutations, 1);
  std::vector<Labelled> pooled = pool(sorted_samples);
  const std::vector<double> sizes = sizes_of(sorted_samples);
  const double observed = k_statistic(pooled, sizes);
  // Equal arrangements may differ by rounding: they count as equal.
  const double reached = observed * (1 - 1e-12);
  std::uint64_t as_large = 0;
  for (std::uint64_t b = 0; b < plan.permutations; ++b) {
    for (std::size_t i = pooled.size() - 1; i > 0; --i) {
      std::swap(pooled[i].sample, pooled[plan.random_below(i + 1)].sample);
    }
    as_large += k_statistic(pooled, sizes) >= reached;
  }
  const double log_p = std::log(static_cast<double>(as_large + 1)) -
                       std::log(static_cast<double>(plan.permutations) + 1);
  return {observed, {"bound", {}}, 0, log_p, Exactness::exact};
}

}  // namespace assay::stats
