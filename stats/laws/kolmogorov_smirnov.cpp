#include "stats/laws/kolmogorov_smirnov.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "stats/basics/check.h"
#include "stats/basics/scores.h"
#include "stats/tails/kolmogorov.h"
#include "stats/tails/special.h"

namespace assay::stats {
namespace {

// The distance from a law with these probabilities up to each value.
OneSampleDistance largest_gap(std::span<const double> sorted, std::span<const double> at) {
  const double n = static_cast<double>(sorted.size());
  OneSampleDistance result{0, sorted.size()};
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double x = sorted[i];
    const double above = static_cast<double>(i + 1) / n - at[i];
    const double below = at[i] - static_cast<double>(i) / n;
    // Within a run of equal values only the last step of F_n counts above, only the first below.
    const bool last = i + 1 == sorted.size() || sorted[i + 1] != x;
    const bool first = i == 0 || sorted[i - 1] != x;
    result.distance = std::max({result.distance, last ? above : 0, first ? below : 0});
  }
  result.distance = std::min(result.distance, 1.0);
  return result;
}

void add_run(double value, TiedRun run, TwoSampleDistance& result) {
  if (run.size < 2) return;
  result.ties.push_back(run);
  if (run.size > result.most_frequent.count) result.most_frequent = {value, run.size};
}

// The runs of equal values after `before` others.
void add_runs(std::span<const double> sorted, std::uint64_t before, TwoSampleDistance& result) {
  for_each_tie(sorted, [&](std::size_t first, std::size_t end) {
    add_run(sorted[first], {before + first, end - first}, result);
  });
}

// ln of Hoeffding's bound on the probability of a deviation `gap` of a mean (or of a difference).
double log_hoeffding(double gap, double effective_size) {
  return gap > 0 ? special::clamp_log(-2 * effective_size * gap * gap) : 0;
}

double effective_size(const LatticeDistance& lattice) {
  const double m = static_cast<double>(lattice.m);
  const double n = static_cast<double>(lattice.n);
  return m / (m + n) * n;
}

void check_null(double null_distance) {
  if (!(null_distance >= 0 && null_distance < 1)) {
    check::fail({"ks_margin", "null_distance"}, null_distance, "in [0, 1)");
  }
}

// ---- Two samples with a frequent value

struct Parts {
  std::uint64_t common;
  std::vector<double> rest;

  std::uint64_t size() const { return common + rest.size(); }
  double share() const { return static_cast<double>(common) / static_cast<double>(size()); }
};

Parts split(std::span<const double> sorted, double value) {
  const auto [begin, end] = std::equal_range(sorted.begin(), sorted.end(), value);
  Parts parts{static_cast<std::uint64_t>(end - begin), {sorted.begin(), begin}};
  parts.rest.insert(parts.rest.end(), end, sorted.end());
  return parts;
}

double log_binomial(double k, double trials, double probability) {
  const double rest = trials - k;
  if (rest < 0) return -std::numeric_limits<double>::infinity();
  return std::lgamma(trials + 1) - std::lgamma(k + 1) - std::lgamma(rest + 1) +
         k * std::log(probability) + rest * std::log1p(-probability);
}

// ln of the sum of a law's probabilities of the counts up to n from x outwards, which fall from
// there on. Given are ln P(X = x) and ratio(x) = P(X = x + 1) / P(X = x).
template <class Ratio>
double log_tail_of_counts(double log_probability, std::uint64_t x, std::uint64_t n, bool upwards,
                          const Ratio& ratio) {
  if (std::isinf(log_probability)) return log_probability;
  double sum = 1;
  double term = 1;
  for (std::uint64_t y = x; (upwards ? y < n : y > 0) && term > 1e-17 * sum;) {
    term = upwards ? term * ratio(y) : term / ratio(y - 1);
    y = upwards ? y + 1 : y - 1;
    sum += term;
  }
  return std::min(0.0, log_probability + std::log(sum));
}

// Two-sided: x has so many of the values that both have in common. The law is hypergeometric, as
// the binomial counts of both samples are given their sum.
double log_p_of_counts(const Parts& x, const Parts& y) {
  const double m = static_cast<double>(x.size());
  const double total = static_cast<double>(x.size() + y.size());
  const double common = static_cast<double>(x.common + y.common);
  if (common == total) return 0;
  const double share = m / total;
  const double seen = static_cast<double>(x.common);
  const double at = log_binomial(seen, common, share) +
                    log_binomial(m - seen, total - common, share) - log_binomial(m, total, share);
  const auto ratio = [&](std::uint64_t count) {
    const double k = static_cast<double>(count);
    return (common - k) / (k + 1) * (m - k) / (total - common - (m - k) + 1);
  };
  const double median = std::round(m * (common / total));
  double tail = 0;
  for (const bool upwards : {false, true}) {
    if (upwards ? seen < median : seen > median) continue;
    tail = std::min(tail, log_tail_of_counts(at, x.common, x.size(), upwards, ratio));
  }
  return std::min(0.0, std::numbers::ln2 + tail);
}

}  // namespace

OneSampleDistance ks_distance(std::span<const double> sorted, const ContinuousLaw& law) {
  check::sorted("ks_distance", sorted);
  std::vector<double> at(sorted.size());
  std::ranges::transform(sorted, at.begin(), law);
  for (const double value : at) check::unit({"ks_distance", "cdf"}, value);
  return largest_gap(sorted, at);
}

TwoSampleDistance ks_distance(std::span<const double> sorted_x, std::span<const double> sorted_y) {
  check::sorted("ks_distance", sorted_x);
  check::sorted("ks_distance", sorted_y);
  const std::uint64_t m = sorted_x.size();
  const std::uint64_t n = sorted_y.size();
  const std::uint64_t common = std::gcd(m, n);
  const auto up = static_cast<std::int64_t>(n / common);
  const auto down = static_cast<std::int64_t>(m / common);
  if (static_cast<double>(up) * static_cast<double>(m) > 0x1p62) {
    check::fail({"ks_distance", "size of y"}, n, "so small that the sizes' lcm is <= 2^62");
  }
  std::size_t i = 0;
  std::size_t j = 0;
  std::int64_t gap = 0;
  std::int64_t largest = 0;
  TwoSampleDistance result{.lattice = {0, m, n}};
  while (i < m && j < n) {
    const double x = sorted_x[i];
    const double y = sorted_y[j];
    const double value = std::min(x, y);
    const std::uint64_t before = i + j;
    // Without ties one of the two advances by one. Branch-free, because the order is unpredictable.
    const bool take_x = x <= y;
    const bool take_y = y <= x;
    i += take_x;
    j += take_y;
    gap += (take_x ? up : 0) - (take_y ? down : 0);
    while (i < m && sorted_x[i] == value) ++i, gap += up;
    while (j < n && sorted_y[j] == value) ++j, gap -= down;
    if (i + j > before + 1) add_run(value, {before, i + j - before}, result);
    const std::int64_t size = gap < 0 ? -gap : gap;
    largest = std::max(largest, size);
  }
  // Beyond the end of one sample the gap only shrinks to zero. Its largest size was just seen.
  add_runs(i < m ? sorted_x.subspan(i) : sorted_y.subspan(j), i + j, result);
  result.lattice.steps = static_cast<std::uint64_t>(largest);
  return result;
}

TestResult kolmogorov_smirnov(const OneSampleDistance& distance) {
  return {distance.distance,
          {"kolmogorov", {static_cast<double>(distance.n)}},
          0,
          kolmogorov_tails(distance.distance, distance.n).upper};
}

TestResult kolmogorov_smirnov(const TwoSampleDistance& distance) {
  const auto& [steps, m, n] = distance.lattice;
  return {distance.distance(),
          {"smirnov", {static_cast<double>(m), static_cast<double>(n)}},
          0,
          smirnov_upper_tail(distance.lattice, distance.ties)};
}

TestResult ks_margin(const OneSampleDistance& distance, double null_distance) {
  check_null(null_distance);
  const double excess = std::max(0.0, distance.distance - null_distance);
  const double size = static_cast<double>(distance.n);
  return {distance.distance,
          {"bound", {}},
          log_hoeffding(null_distance - distance.distance, size),
          kolmogorov_tails(excess, distance.n).upper};
}

TestResult ks_margin(const TwoSampleDistance& distance, double null_distance) {
  check_null(null_distance);
  const double observed = distance.distance();
  const auto& lattice = distance.lattice;
  const double upper = log_two_suprema_bound(observed - null_distance, {lattice.m, lattice.n});
  return {observed,
          {"bound", {}},
          log_hoeffding(null_distance - observed, effective_size(lattice)),
          upper};
}

TwoLawsTest two_part_ks(std::span<const double> sorted_x, std::span<const double> sorted_y,
                        const TwoSampleDistance& distance) {
  const std::uint64_t total = sorted_x.size() + sorted_y.size();
  const std::uint64_t common = distance.most_frequent.count;
  if (static_cast<double>(common) < least_common_share * static_cast<double>(total) || common < 2) {
    return {.result = kolmogorov_smirnov(distance)};
  }
  const double value = distance.most_frequent.value;
  const Parts x = split(sorted_x, value);
  const Parts y = split(sorted_y, value);
  const double of_counts = log_p_of_counts(x, y);
  TestResult rest{.statistic = 0, .distribution = {"bound", {}}};
  if (!x.rest.empty() && !y.rest.empty()) rest = kolmogorov_smirnov(ks_distance(x.rest, y.rest));
  const bool decides = of_counts < rest.log_p_upper;
  const double smaller = std::min(of_counts, rest.log_p_upper);
  return {.result = {.statistic = distance.distance(),
                     .distribution = {"bound", {}},
                     .log_p_lower = 0,
                     .log_p_upper = std::min(0.0, std::numbers::ln2 + smaller)},
          .common = CommonValue{
              .value = value, .difference = std::abs(x.share() - y.share()), .decides = decides}};
}

}  // namespace assay::stats
