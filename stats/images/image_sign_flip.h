#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "stats/basics/for_each.h"
#include "stats/images/image.h"
#include "stats/tails/test_result.h"

namespace assay::stats {

// The energy of the difference of two images whose elements are correlated. Null hypothesis: the
// differences d_r = a_r - b_r of replicates (or a_r - reference) are independent and symmetric
// about 0, all elements together. That holds exactly if a_r and b_r have one law. As a test of
// equal means it is asymptotic. A whole image flips its sign, so elements may be correlated.
//   Q(s) = sum over elements (sum_r s_r d_r)^2 / sum_r d_r^2,      s_r = +-1.
// The divisor studentises each element and does not change with the signs. Q is s' G s with the
// matrix G below. So a flip costs replicates^2 operations for any image size. The p-value is the
// share of sign vectors with Q(s) >= Q(observed). It is at least 2^(1 - replicates).
class FlipMatrix {
 public:
  FlipMatrix(std::size_t replicates, std::vector<double> values)
      : replicates_(replicates), values_(std::move(values)) {}

  std::size_t replicates() const { return replicates_; }
  double energy(const std::vector<double>& signs) const;

  // Energies of so many sign vectors at a time, with the bits of energy(). The sign of replicate r
  // in vector k is signs[r * together + k]. The sums do not wait for each other.
  static constexpr std::size_t together = 32;
  std::array<double, together> energies(const std::vector<double>& signs) const;

 private:
  std::size_t replicates_;
  // Matrix G_rs = sum over elements d_r d_s / sum_t d_t^2, row by row.
  std::vector<double> values_;
};

// These throw std::domain_error as welch_z does, and for stacks of different counts.
template <class Real>
FlipMatrix flip_matrix(const ImageStack<Real>& a, const ImageStack<Real>& b,
                       const ForEach& for_each = one_by_one);
template <class Real>
FlipMatrix flip_matrix(const ImageStack<Real>& a, const ImageReference& b,
                       const ForEach& for_each = one_by_one);

// The same for images that are read rows after rows, with the same bits.
template <class Real>
class RowFlips {
 public:
  // Takes rows that follow on those before, in multiples of row_unit but for the last.
  static constexpr std::size_t row_unit = 16;
  void take(const ImagePair<Real>& pair, RowRange rows, const ForEach& for_each = one_by_one);
  // To be called after the last rows.
  FlipMatrix matrix() const;

 private:
  std::size_t replicates_ = 0;
  std::vector<double> sums_;
};

enum class FlipMethod { enumerated, monte_carlo };

struct SignFlip {
  double statistic = 0;     // Q(observed).
  double log_p = 0;         // At least -(replicates - 1) ln 2.
  std::uint64_t flips = 0;  // Sign vectors looked at, beside the observed one.
  FlipMethod method = FlipMethod::enumerated;
  Exactness exactness = Exactness::asymptotic;  // Exact only for exchangeable a_r and b_r.
};

// `share` is the level that the p-value is held against. Throws std::domain_error for fewer than 2
// + log2(1 / share) replicates, which could hardly reject. Enumeration takes up to 25 replicates.
SignFlip sign_flip(const FlipMatrix& matrix, double share);

// Monte Carlo (Besag & Clifford 1991). Draws random sign vectors until `enough` of them have
// reached Q, and at most `flips` >= 2 / share - 1. Then p = enough / vectors drawn. If fewer
// reached Q, p = (1 + #{Q(s) >= Q}) / (flips + 1). Exact for any `enough`: among l - 1 vectors and
// the observed one every rank has probability 1 / l. If the images are equal, a p-value far from
// its level takes some hundred vectors. It is known up to 1 / sqrt(enough) of itself.
struct FlipPlan {
  double share = 0;
  std::uint64_t flips = 0;
  std::uint64_t enough = 0;
};

namespace detail {
void check_flip_plan(const FlipMatrix& matrix, const FlipPlan& plan);
double flip_threshold(const FlipMatrix& matrix);

// Number of sign vectors looked at, and of those with an energy of at least the threshold.
struct FlipCount {
  std::uint64_t vectors = 0;
  std::uint64_t reached = 0;
};
SignFlip flip_result(const FlipMatrix& matrix, const FlipPlan& plan, const FlipCount& count);

// Looks at so many sign vectors, or until `enough` have reached the threshold. It asks for sign(k,
// r) in order, all replicates r of one vector k after the other.
template <class Sign>
FlipCount count_reached(const FlipMatrix& matrix, std::uint64_t vectors, std::uint64_t enough,
                        Sign sign) {
  constexpr std::uint64_t together = FlipMatrix::together;
  const double threshold = flip_threshold(matrix);
  std::vector<double> signs(matrix.replicates() * together);
  FlipCount count;
  while (count.vectors < vectors && count.reached < enough) {
    const std::uint64_t first = count.vectors;
    const std::uint64_t size = std::min(together, vectors - first);
    for (std::uint64_t k = 0; k < size; ++k) {
      for (std::size_t r = 0; r < matrix.replicates(); ++r) {
        signs[r * together + k] = sign(first + k, r);
      }
    }
    const auto energies = matrix.energies(signs);
    for (std::uint64_t k = 0; k < size && count.reached < enough; ++k) {
      ++count.vectors;
      count.reached += energies[k] >= threshold;
    }
  }
  return count;
}

// Fair signs, one of each bit of a word.
template <class Generator>
class Coins {
 public:
  // All bits fair: values from 0 to 2^n - 1.
  static_assert(Generator::min() == 0 && (Generator::max() & (Generator::max() + 1)) == 0);

  explicit Coins(Generator& generator) : generator_(&generator) {}

  double operator()() {
    if (left_ == 0) {
      word_ = (*generator_)();
      left_ = std::bit_width(Generator::max());
    }
    // From a table: no processor foresees a branch on a coin.
    constexpr double signs[] = {-1, 1};
    return signs[word_ >> --left_ & 1];
  }

 private:
  Generator* generator_;
  std::uint64_t word_ = 0;
  int left_ = 0;
};
}  // namespace detail

template <std::uniform_random_bit_generator Generator>
SignFlip sign_flip(const FlipMatrix& matrix, const FlipPlan& plan, Generator& generator) {
  detail::check_flip_plan(matrix, plan);
  detail::Coins coins(generator);
  const auto sign = [&](std::uint64_t, std::size_t) { return coins(); };
  return detail::flip_result(matrix, plan,
                             detail::count_reached(matrix, plan.flips, plan.enough, sign));
}

}  // namespace assay::stats
