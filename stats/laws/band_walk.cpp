#include "stats/laws/band_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace assay::stats {
namespace {

constexpr double log_of_zero = -std::numeric_limits<double>::infinity();

double real(std::uint64_t n) { return static_cast<double>(n); }

double log_poisson(std::uint64_t k, double mean) {
  if (mean == 0) return k == 0 ? 0 : log_of_zero;
  return real(k) * std::log(mean) - mean - std::lgamma(real(k) + 1);
}

struct Binomial {
  std::uint64_t trials;
  double probability;
};

double log_binomial(std::uint64_t k, Binomial law) {
  if (k > law.trials) return log_of_zero;
  const double rest = real(law.trials - k);
  return std::lgamma(real(law.trials) + 1) - std::lgamma(real(k) + 1) - std::lgamma(rest + 1) +
         real(k) * std::log(law.probability) + rest * std::log1p(-law.probability);
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

}  // namespace

BandWalk BandWalk::one_sample(std::uint64_t n, const std::vector<double>& z) {
  BandWalk walk;
  walk.n_ = walk.total_ = n;
  double before = 0;
  for (const double value : z) {
    walk.steps_.push_back({value, value - before, 0, 0});
    before = value;
  }
  return walk;
}

BandWalk BandWalk::two_samples(Pool pool, const std::vector<std::uint64_t>& ranks) {
  BandWalk walk;
  walk.two_ = true;
  walk.n_ = pool.counted;
  walk.total_ = pool.total;
  std::uint64_t before = 0;
  for (const std::uint64_t rank : ranks) {
    walk.steps_.push_back({real(rank) / real(pool.total), 0, rank, rank - before});
    before = rank;
  }
  return walk;
}

double BandWalk::share() const { return real(n_) / real(total_); }

double BandWalk::log_step(std::size_t point, std::uint64_t d) const {
  const Step& step = steps_[point];
  if (two_) return log_binomial(d, {step.draws, share()});
  return log_poisson(d, real(n_) * step.increase);
}

double BandWalk::log_start(std::size_t point, std::uint64_t x) const {
  const Step& step = steps_[point];
  if (two_) return log_binomial(x, {step.rank, share()});
  return log_poisson(x, real(n_) * step.z);
}

double BandWalk::log_rest(std::size_t point, std::uint64_t x) const {
  if (x > n_) return log_of_zero;
  const Step& step = steps_[point];
  if (two_) return log_binomial(n_ - x, {total_ - step.rank, share()});
  return log_poisson(n_ - x, real(n_) * (1 - step.z));
}

double BandWalk::log_whole() const {
  return two_ ? log_binomial(n_, {total_, share()}) : log_poisson(n_, real(n_));
}

double BandWalk::log_probability(std::size_t point, std::uint64_t x) const {
  return log_start(point, x) + log_rest(point, x) - log_whole();
}

std::uint64_t BandWalk::median(std::size_t point) const {
  return static_cast<std::uint64_t>(std::round(real(n_) * steps_[point].z));
}

// P(X = x + 1) / P(X = x): of the binomial or the hypergeometric law.
double BandWalk::ratio(std::size_t point, std::uint64_t x) const {
  const Step& step = steps_[point];
  const double left = real(n_) - real(x);
  if (!two_) return left / (real(x) + 1) * step.z / (1 - step.z);
  // Left over in the other sample.
  const double others = real(total_) - real(step.rank) - left + 1;
  return (real(step.rank) - real(x)) / (real(x) + 1) * left / others;
}

// The sum of the probabilities from x outwards, relative to that of x. They fall from the median
// on.
double BandWalk::log_tail(std::size_t point, std::uint64_t x, bool upwards) const {
  const double at = log_probability(point, x);
  if (at == log_of_zero) return at;
  double sum = 1;
  double term = 1;
  for (std::uint64_t y = x; (upwards ? y < n_ : y > 0) && term > 1e-17 * sum;) {
    term = upwards ? term * ratio(point, y) : term / ratio(point, y - 1);
    y = upwards ? y + 1 : y - 1;
    sum += term;
  }
  return std::min(0.0, at + std::log(sum));
}

double BandWalk::log_lower(std::size_t point, std::uint64_t x) const {
  return x > median(point) ? 0 : log_tail(point, x, false);
}

double BandWalk::log_upper(std::size_t point, std::uint64_t x) const {
  return x < median(point) ? 0 : log_tail(point, x, true);
}

BandWalk::Range BandWalk::inside(std::size_t point, double log_tail) const {
  // Below the rounded mean the upper tail is about half, above it the lower one. Neither is the
  // limit.
  std::uint64_t low = 0;
  std::uint64_t high = median(point);
  while (low < high) {
    const std::uint64_t middle = std::midpoint(low, high);
    if (log_lower(point, middle) > log_tail) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  Range range{low, n_};
  std::uint64_t from = median(point);
  while (from < range.high) {
    const std::uint64_t middle = std::midpoint(from, range.high) + (range.high - from) % 2;
    if (log_upper(point, middle) > log_tail) {
      from = middle;
    } else {
      range.high = middle - 1;
    }
  }
  return range;
}

std::vector<BandWalk::Range> BandWalk::inside(double log_tail) const {
  std::vector<Range> ranges;
  for (std::size_t i = 0; i < points(); ++i) ranges.push_back(inside(i, log_tail));
  return ranges;
}

double BandWalk::exit(const std::vector<Range>& ranges, double negligible) const {
  const double whole = log_whole();
  Front front{0, {1}};
  double left = 0;
  for (std::size_t i = 0; i < points(); ++i) {
    // The kernel where it is not negligible, from its mode outwards in both directions.
    const double mean = two_ ? real(steps_[i].draws) * share() : real(n_) * steps_[i].increase;
    const auto mode = static_cast<std::uint64_t>(mean);
    const double threshold = log_step(i, mode) + std::log(negligible);
    Kernel kernel;
    for (std::uint64_t d = mode; d > 0 && log_step(i, d - 1) > threshold; --d) kernel.first = d - 1;
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

}  // namespace assay::stats
