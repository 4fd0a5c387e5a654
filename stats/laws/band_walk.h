#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace assay::stats {

// Internal: the count of values up to a sequence of points, as a Markov chain. Its transition
// probabilities factor into
//   P(x at i | x' at i-1) = w_i(x - x') c_i(x) / c_{i-1}(x').
// For one sample w is Poisson and c the Poisson probability of what is left. For two samples both
// are binomial. So the recursion is a convolution, and c is applied at its end.
class BandWalk {
 public:
  // Cumulative null probabilities 0 < z_1 < z_2 < ... < 1 of the points.
  static BandWalk one_sample(std::uint64_t n, const std::vector<double>& z);

  struct Pool {
    std::uint64_t counted = 1;  // Size of the sample that is counted.
    std::uint64_t total = 2;    // Size of both together.
  };
  // Numbers of pooled values 0 < r_1 < r_2 < ... < total up to the points.
  static BandWalk two_samples(Pool pool, const std::vector<std::uint64_t>& ranks);

  struct Range {
    std::uint64_t low;
    std::uint64_t high;
  };
  std::size_t points() const { return steps_.size(); }
  // ln P(X <= x) and ln P(X >= x) for the count at one point. A tail above 1/2 is returned as 0.
  double log_lower(std::size_t point, std::uint64_t x) const;
  double log_upper(std::size_t point, std::uint64_t x) const;
  // The counts whose two tails both exceed e^log_tail, which must be below ln(1/2).
  Range inside(std::size_t point, double log_tail) const;
  std::vector<Range> inside(double log_tail) const;
  // Probability that the walk ever leaves the ranges, a sum of positive terms. Steps less likely
  // than `negligible` times the likeliest are left out.
  double exit(const std::vector<Range>& ranges, double negligible) const;

 private:
  struct Step {
    double z;  // One sample: cumulative probability.
    double increase;
    std::uint64_t rank;  // Two samples: pooled values so far.
    std::uint64_t draws;
  };

  // ln weight of a step of d, of a first step from 0 to x, and of the remainder at x.
  double log_step(std::size_t point, std::uint64_t d) const;
  double log_start(std::size_t point, std::uint64_t x) const;
  double log_rest(std::size_t point, std::uint64_t x) const;
  double log_whole() const;
  double log_probability(std::size_t point, std::uint64_t x) const;
  double ratio(std::size_t point, std::uint64_t x) const;
  double log_tail(std::size_t point, std::uint64_t x, bool upwards) const;
  std::uint64_t median(std::size_t point) const;
  double share() const;

  bool two_ = false;
  std::uint64_t n_ = 0;      // Size of the counted sample.
  std::uint64_t total_ = 0;  // Pooled size.
  std::vector<Step> steps_;
};

}  // namespace assay::stats
