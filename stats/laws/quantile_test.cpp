#include "stats/laws/quantile_test.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <vector>

#include "stats/basics/check.h"
#include "stats/basics/scores.h"
#include "stats/basics/search.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The smallest k with P(K <= k) > e^log_level, the lower critical count.
std::uint64_t smallest_kept(Trials trials, double log_level) {
  return smallest_whole(0, trials.trials, [&](std::uint64_t count) {
    return binomial_lower(count, trials) > log_level;
  });
}

std::uint64_t largest_kept(Trials trials, double log_level) {
  return trials.trials - smallest_kept({trials.trials, 1 - trials.probability}, log_level);
}

using Sorted = std::span<const double>;

double sample_quantile(Sorted sorted, double probability) {
  return sorted[sample_quantile_rank(sorted.size(), probability)];
}

// ln of Fisher's combination of two independent p-values: c (1 - ln c).
double log_fisher(double log_product) {
  constexpr double lowest = std::numeric_limits<double>::lowest();
  if (log_product <= lowest) return lowest;
  return std::min(0.0, log_product + std::log1p(-log_product));
}

std::vector<double> moved(Sorted sorted, double offset) {
  std::vector<double> all(sorted.begin(), sorted.end());
  for (double& value : all) value += offset;
  return all;
}

// The largest product over v of two probabilities. P(so many of `lower` below v) falls with v, and
// P(so few of `upper` up to v) rises. The counts change only at observations, so the largest is
// taken at one. A range of observations cannot exceed the first factor at its start times the
// second at its end. That prunes the search.
class LargestProduct {
 public:
  LargestProduct(Sorted lower, Sorted upper, double probability)
      : lower_(lower), upper_(upper), probability_(probability) {
    std::ranges::merge(lower, upper, std::back_inserter(splits_));
  }

  double logarithm() {
    search(0, splits_.size() - 1);
    return largest_;
  }

 private:
  double first(std::size_t i) const {
    return binomial_upper(count_below(lower_, splits_[i]), {lower_.size(), probability_});
  }
  double second(std::size_t i) const {
    return binomial_lower(count_up_to(upper_, splits_[i]), {upper_.size(), probability_});
  }
  void search(std::size_t begin, std::size_t end) {
    if (first(begin) + second(end) <= largest_) return;
    const std::size_t middle = std::midpoint(begin, end);
    largest_ = std::max(largest_, first(middle) + second(middle));
    if (middle > begin) search(begin, middle - 1);
    if (middle < end) search(middle + 1, end);
  }

  Sorted lower_;
  Sorted upper_;
  double probability_;
  std::vector<double> splits_;
  double largest_ = -infinity;
};

double log_p_below(Sorted lower, Sorted upper, double probability) {
  return log_fisher(LargestProduct(lower, upper, probability).logarithm());
}

}  // namespace

QuantileCounts count_around(std::span<const double> sorted, double value) {
  check::sorted("count_around", sorted);
  check::finite({"count_around", "value"}, value);
  return {count_below(sorted, value), count_up_to(sorted, value), sorted.size()};
}

TestResult quantile_test(const QuantileCounts& counts, double probability) {
  check::at_least({"quantile_test", "n"}, counts.n, 1);
  check::inside_unit({"quantile_test", "probability"}, probability);
  check::at_least({"quantile_test", "values up to v"}, counts.at_most, counts.below);
  check::at_least({"quantile_test", "n"}, counts.n, counts.at_most);
  const double n = static_cast<double>(counts.n);
  const Trials trials{counts.n, probability};
  const double share = static_cast<double>(counts.below + counts.at_most) / 2 / n;
  return {probability - share,
          {"binomial", {n, probability}},
          binomial_upper(counts.below, trials),
          binomial_lower(counts.at_most, trials)};
}

Interval quantile_interval(std::span<const double> sorted, double probability, double confidence) {
  check::sorted("quantile_interval", sorted);
  check::inside_unit({"quantile_interval", "probability"}, probability);
  check::inside_unit({"quantile_interval", "confidence"}, confidence);
  const Trials trials{sorted.size(), probability};
  const double log_level = std::log((1 - confidence) / 2);
  const std::uint64_t fewest = smallest_kept(trials, log_level);
  const std::uint64_t most = largest_kept(trials, log_level);
  return {fewest == 0 ? -infinity : sorted[fewest - 1],
          most == trials.trials ? infinity : sorted[most], confidence};
}

TestResult quantile_compare(std::span<const double> sorted_x, std::span<const double> sorted_y,
                            double probability, double offset) {
  check::sorted("quantile_compare", sorted_x);
  check::sorted("quantile_compare", sorted_y);
  check::inside_unit({"quantile_compare", "probability"}, probability);
  check::finite({"quantile_compare", "offset"}, offset);
  const std::vector<double> y = moved(sorted_y, offset);
  return {sample_quantile(sorted_x, probability) - sample_quantile(y, probability),
          {"bound", {}},
          log_p_below(sorted_x, y, probability),
          log_p_below(y, sorted_x, probability)};
}

Interval quantile_difference_interval(std::span<const double> sorted_x,
                                      std::span<const double> sorted_y, double probability,
                                      double confidence) {
  check::inside_unit({"quantile_difference_interval", "confidence"}, confidence);
  const double log_level = std::log((1 - confidence) / 2);
  check::inside_unit({"quantile_difference_interval", "probability"}, probability);
  check::sorted("quantile_difference_interval", sorted_x);
  check::sorted("quantile_difference_interval", sorted_y);
  const auto rejected_above = [&](double offset) {
    return log_p_below(sorted_x, moved(sorted_y, offset), probability) <= log_level;
  };
  const auto rejected_below = [&](double offset) {
    return log_p_below(moved(sorted_y, offset), sorted_x, probability) <= log_level;
  };
  const double middle =
      sample_quantile(sorted_x, probability) - sample_quantile(sorted_y, probability);
  // Further apart than any two values, so nothing can be more extreme.
  const double reach = sorted_x.back() - sorted_x.front() + sorted_y.back() - sorted_y.front() + 1;
  const auto end = [&](const auto& rejected, double outside) {
    if (!rejected(outside)) return std::copysign(infinity, outside - middle);
    return halved_between(middle, outside, rejected).inside;
  };
  return {end(rejected_below, middle - reach), end(rejected_above, middle + reach), confidence};
}

double quantile_standard_deviation(double probability, double density) {
  check::inside_unit({"quantile_standard_deviation", "probability"}, probability);
  check::positive({"quantile_standard_deviation", "density"}, density);
  return std::sqrt(probability * (1 - probability)) / density;
}

std::size_t sample_quantile_rank(std::size_t count, double probability) {
  check::at_least({"sample_quantile_rank", "count"}, count, 1);
  const double n = static_cast<double>(count);
  // .29 * 100 is 28.999999999999996.
  return static_cast<std::size_t>(std::min(n - 1, std::floor(probability * n * (1 + 1e-14))));
}

}  // namespace assay::stats
