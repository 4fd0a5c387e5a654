#include "stats/laws/simultaneous_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "stats/basics/check.h"
#include "stats/tails/special.h"

namespace assay::stats {
namespace {

constexpr double log_of_zero = -std::numeric_limits<double>::infinity();

double real(std::uint64_t n) { return static_cast<double>(n); }

double log_poisson(std::uint64_t k, double mean) {
  if (mean == 0) return k == 0 ? 0 : log_of_zero;
  return real(k) * std::log(mean) - mean - std::lgamma(real(k) + 1);
}

// Weights of the walks that have stayed inside so far, over counts low, low + 1, ...
struct Front {
  std::uint64_t low = 0;
  std::vector<double> weight;

  std::uint64_t high() const { return low + weight.size() - 1; }
};

// The weights w(d) of one step, over d from `first` on.
struct Kernel {
  std::uint64_t first = 0;
  std::vector<double> weight;

  std::uint64_t last() const { return first + weight.size() - 1; }
};

// Sum over the front of weight(x') w(x - x').
double reach(const Front& front, const Kernel& kernel, std::uint64_t x) {
  if (x < front.low + kernel.first) return 0;
  const std::uint64_t from = x > kernel.last() ? std::max(front.low, x - kernel.last()) : front.low;
  const std::uint64_t to = std::min(front.high(), x - kernel.first);
  double sum = 0;
  for (std::uint64_t y = from; y <= to; ++y) {
    sum += front.weight[y - front.low] * kernel.weight[x - y - kernel.first];
  }
  return sum;
}

// The count of n values up to equally spaced quantiles of their law, as a Markov chain. Its
// transition probabilities factor into
//   P(x at i | x' at i-1) = w_i(x - x') c_i(x) / c_{i-1}(x').
// Here w is Poisson and c the Poisson probability of what is left. So the recursion is a
// convolution, and c is applied at its end.
class BandWalk {
 public:
  BandWalk(std::uint64_t n, std::size_t parts) : n_(n) {
    for (std::size_t i = 1; i < parts; ++i) {
      z_.push_back(static_cast<double>(i) / static_cast<double>(parts));
    }
  }

  struct Range {
    std::uint64_t low;
    std::uint64_t high;
  };
  std::size_t points() const { return z_.size(); }
  // The counts whose two tails both exceed e^limit, which must be below ln(1/2).
  Range inside(std::size_t point, double limit) const {
    // Below the rounded mean the upper tail is about half, above it the lower one. Neither is the
    // limit.
    std::uint64_t low = 0;
    std::uint64_t high = median(point);
    while (low < high) {
      const std::uint64_t middle = std::midpoint(low, high);
      if (log_tail(point, middle, false) > limit) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    Range range{low, n_};
    std::uint64_t from = median(point);
    while (from < range.high) {
      const std::uint64_t middle = std::midpoint(from, range.high) + (range.high - from) % 2;
      if (log_tail(point, middle, true) > limit) {
        from = middle;
      } else {
        range.high = middle - 1;
      }
    }
    return range;
  }

  std::vector<Range> inside(double limit) const {
    std::vector<Range> ranges;
    for (std::size_t i = 0; i < points(); ++i) ranges.push_back(inside(i, limit));
    return ranges;
  }

  // Probability that the walk ever leaves the ranges, a sum of positive terms. Steps less likely
  // than `negligible` times the likeliest are left out.
  double exit(const std::vector<Range>& ranges, double negligible) const {
    const double whole = log_whole();
    Front front{0, {1}};
    double left = 0;
    for (std::size_t i = 0; i < points(); ++i) {
      // The kernel where it is not negligible, from its mode outwards in both directions.
      const double mean = real(n_) * increase(i);
      const auto mode = static_cast<std::uint64_t>(mean);
      const double threshold = log_step(i, mode) + std::log(negligible);
      Kernel kernel;
      for (std::uint64_t d = mode; d > 0 && log_step(i, d - 1) > threshold; --d)
        kernel.first = d - 1;
      if (kernel.first == 0 && mode > 0 && !(log_step(i, 0) > threshold)) kernel.first = mode;
      for (std::uint64_t d = kernel.first; d <= n_; ++d) {
        const double log_weight = log_step(i, d);
        if (d > mode && !(log_weight > threshold)) break;
        kernel.weight.push_back(std::exp(log_weight));
      }
      const auto lost = [&](std::uint64_t x) {
        return reach(front, kernel, x) * std::exp(log_rest(i, x) - whole);
      };
      const auto sweep = [&](std::uint64_t start, bool upwards) {
        double largest = 0;
        for (std::uint64_t x = start; x <= n_; upwards ? ++x : --x) {
          const double term = lost(x);
          left += term;
          largest = std::max(largest, term);
          if (term <= 1e-16 * largest || (!upwards && x == 0)) break;
        }
      };
      if (ranges[i].high < n_) sweep(ranges[i].high + 1, true);
      if (ranges[i].low > 0) sweep(ranges[i].low - 1, false);
      Front next{ranges[i].low, {}};
      for (std::uint64_t x = ranges[i].low; x <= ranges[i].high; ++x) {
        next.weight.push_back(reach(front, kernel, x));
      }
      front = std::move(next);
    }
    return std::min(left, 1.0);
  }

 private:
  double increase(std::size_t point) const { return point > 0 ? z_[point] - z_[point - 1] : z_[0]; }

  // ln weight of a step of d, and of the remainder at x.
  double log_step(std::size_t point, std::uint64_t d) const {
    return log_poisson(d, real(n_) * increase(point));
  }
  double log_rest(std::size_t point, std::uint64_t x) const {
    return x > n_ ? log_of_zero : log_poisson(n_ - x, real(n_) * (1 - z_[point]));
  }
  double log_whole() const { return log_poisson(n_, real(n_)); }

  std::uint64_t median(std::size_t point) const {
    return static_cast<std::uint64_t>(std::round(real(n_) * z_[point]));
  }
  // ln P(X <= x) or ln P(X >= x) for the count at one point, x between the median and that end.
  double log_tail(std::size_t point, std::uint64_t x, bool upwards) const {
    const double at = log_poisson(x, real(n_) * z_[point]) + log_rest(point, x) - log_whole();
    return special::log_tail_of_counts(at, x, n_, upwards, [&](std::uint64_t y) {
      return (real(n_) - real(y)) / (real(y) + 1) * z_[point] / (1 - z_[point]);
    });
  }

  std::uint64_t n_;
  std::vector<double> z_;  // Cumulative probabilities of the points.
};

// The largest gamma whose band the path leaves with probability <= 1 - confidence, to 1e-6
// relative. It lies between Bonferroni's and the pointwise one.
double widest(const BandWalk& walk, double confidence) {
  const double error = 1 - confidence;
  const double negligible = 1e-12 * error;
  const auto left = [&](double gamma) {
    return walk.exit(walk.inside(std::log(gamma) - std::numbers::ln2), negligible);
  };
  double kept = error / static_cast<double>(walk.points());
  double lost = std::min(error, 0.999);
  if (left(lost) <= error) return lost;
  while (lost > kept * (1 + 1e-6)) {
    const double middle = std::sqrt(kept * lost);
    (left(middle) <= error ? kept : lost) = middle;
  }
  return kept;
}

}  // namespace

double simultaneous_error(std::uint64_t n, std::size_t points, double confidence) {
  constexpr std::uint64_t most = 1000;
  check::at_least({"simultaneous_error", "n"}, n, 1);
  check::at_least({"simultaneous_error", "points"}, points, 2);
  check::inside_unit({"simultaneous_error", "confidence"}, confidence);
  const auto gamma = [&](std::uint64_t values) {
    return widest(BandWalk(values, points), confidence);
  };
  // 1 / sqrt(most) is twice 1 / sqrt(4 most).
  return n <= most ? gamma(n) : 2 * gamma(4 * most) - gamma(most);
}

}  // namespace assay::stats
