#include "stats/images/image_sign_flip.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include "stats/basics/check.h"
#include "stats/basics/vector_copies.h"

namespace assay::stats {
namespace {

constexpr std::size_t block_size = 256;
constexpr std::size_t most_enumerated = 25;

// Differences of a block of elements, replicate by replicate, then element by element. Each element
// has enough numbers that the replicates fill whole pieces.
constexpr std::size_t piece = 16;
struct FlipBlock {
  explicit FlipBlock(std::size_t count)
      : replicates(count),
        stride((count + piece - 1) / piece * piece),
        difference(count * block_size),
        element(stride * block_size) {}

  std::size_t replicates;
  std::size_t stride;
  std::vector<double> difference;
  std::vector<double> element;
  std::array<double, block_size> factor{};
};

template <class Real, class Other>
inline void subtract(const Real* a, const Other* b, double* out, std::size_t size) {
  double* const __restrict difference = out;
  for (std::size_t i = 0; i < size; ++i) {
    difference[i] = static_cast<double>(a[i]) - static_cast<double>(b[i]);
  }
}

// Each element is to be divided by its root sum of squares. One that never differs becomes zeros.
ASSAY_VECTOR_COPIES void add_squares(const double* difference, double* sum, std::size_t size) {
  double* const __restrict squares = sum;
  for (std::size_t i = 0; i < size; ++i) squares[i] += difference[i] * difference[i];
}

void studentise(FlipBlock& block, std::size_t size) {
  block.factor.fill(0);
  for (std::size_t r = 0; r < block.replicates; ++r) {
    add_squares(block.difference.data() + r * block_size, block.factor.data(), size);
  }
  for (double& squares : std::span(block.factor).first(size)) {
    if (!std::isfinite(squares)) {
      check::fail({"flip_matrix", "sum of squared differences"}, squares, "finite");
    }
    squares = squares > 0 ? 1 / std::sqrt(squares) : 0;
  }
  for (std::size_t r = 0; r < block.replicates; ++r) {
    const double* const difference = block.difference.data() + r * block_size;
    for (std::size_t i = 0; i < size; ++i) {
      block.element[i * block.stride + r] = difference[i] * block.factor[i];
    }
  }
}

// Four replicates side by side, against the first `count` of all of them in whole pieces. The sums
// are over the block's elements.
struct FourRows {
  const double* replicates;
  double* sums;  // Four rows of `count`.
  std::size_t count;
};
ASSAY_VECTOR_COPIES void add_products(const FlipBlock& block, const FourRows& four,
                                      std::size_t size) {
  const std::size_t count = four.count;
  double* const __restrict first = four.sums;
  double* const __restrict second = first + count;
  double* const __restrict third = second + count;
  double* const __restrict fourth = third + count;
  for (std::size_t i = 0; i < size; ++i) {
    const double* const all = block.element.data() + i * block.stride;
    const double* const row = four.replicates + i * block.stride;
    const double p = row[0];
    const double q = row[1];
    const double r = row[2];
    const double t = row[3];
    for (std::size_t s = 0; s < count; ++s) {
      first[s] += p * all[s];
      second[s] += q * all[s];
      third[s] += r * all[s];
      fourth[s] += t * all[s];
    }
  }
}

// The matrix has rows of `stride`. Entries up to the diagonal count.
void add_block(std::vector<double>& matrix, const FlipBlock& block, std::size_t size) {
  std::vector<double> sums(4 * block.stride);
  for (std::size_t r = 0; r < block.stride; r += 4) {
    const std::size_t count = r / piece * piece + piece;
    std::ranges::fill(sums, 0.0);
    add_products(block, {block.element.data() + r, sums.data(), count}, size);
    for (std::size_t i = 0; i < 4 * count; ++i) {
      matrix[(r + i / count) * block.stride + i % count] += sums[i];
    }
  }
}

template <class Real>
void load(const ImagePair<Real>& pair, std::size_t first, FlipBlock& block, std::size_t size) {
  for (std::size_t r = 0; r < block.replicates; ++r) {
    double* const out = block.difference.data() + r * block_size;
    if (pair.b != nullptr) {
      subtract(pair.a.at(r, first), pair.b->at(r, first), out, size);
    } else {
      subtract(pair.a.at(r, first), pair.reference->value.data() + first, out, size);
    }
  }
}

template <class Real>
std::vector<double> products_of(const ImagePair<Real>& pair, ElementRange range) {
  FlipBlock block(pair.a.images.size());
  std::vector<double> matrix(block.stride * block.stride);
  for (std::size_t first = range.first; first < range.last; first += block_size) {
    const std::size_t size = std::min(block_size, range.last - first);
    load(pair, first, block, size);
    studentise(block, size);
    add_block(matrix, block, size);
  }
  return matrix;
}

template <class Real>
FlipMatrix matrix_of(const ImagePair<Real>& pair, const ForEach& for_each) {
  RowFlips<Real> flips;
  flips.take(pair, {0, pair.a.extent.height}, for_each);
  return flips.matrix();
}

using Energies = std::array<double, FlipMatrix::together>;

ASSAY_VECTOR_COPIES Energies energies_of(const double* matrix, const double* signs,
                                         std::size_t replicates) {
  constexpr std::size_t together = FlipMatrix::together;
  Energies sums{};
  for (std::size_t r = 0; r < replicates; ++r) {
    Energies row{};
    for (std::size_t s = 0; s < r; ++s) {
      const double value = matrix[r * replicates + s];
      for (std::size_t k = 0; k < together; ++k) row[k] += signs[s * together + k] * value;
    }
    const double diagonal = matrix[r * replicates + r];
    for (std::size_t k = 0; k < together; ++k) {
      sums[k] += 2 * signs[r * together + k] * row[k] + diagonal;
    }
  }
  return sums;
}

void check_replicates(const FlipMatrix& matrix, double share) {
  check::inside_unit({"sign_flip", "share"}, share);
  const double needed = 2 - std::log2(share);
  if (static_cast<double>(matrix.replicates()) < needed) {
    check::fail({"sign_flip", "replicates"}, matrix.replicates(),
                "at least 2 + log2(1 / share) = " + std::to_string(needed) +
                    ": no p-value is below 2^(1 - replicates)");
  }
}

}  // namespace

double FlipMatrix::energy(const std::vector<double>& signs) const {
  double sum = 0;
  for (std::size_t r = 0; r < replicates_; ++r) {
    double row = 0;
    for (std::size_t s = 0; s < r; ++s) row += signs[s] * values_[r * replicates_ + s];
    sum += 2 * signs[r] * row + values_[r * replicates_ + r];
  }
  return sum;
}

std::array<double, FlipMatrix::together> FlipMatrix::energies(
    const std::vector<double>& signs) const {
  return energies_of(values_.data(), signs.data(), replicates_);
}

template <class Real>
void RowFlips<Real>::take(const ImagePair<Real>& pair, RowRange rows, const ForEach& for_each) {
  if (pair.b != nullptr && pair.b->images.size() != pair.a.images.size()) {
    check::fail({"flip_matrix", "replicates of the second stack"}, pair.b->images.size(),
                "as many as of the first, " + std::to_string(pair.a.images.size()));
  }
  std::vector<std::vector<double>> parts((rows.last - rows.first + row_unit - 1) / row_unit);
  for_each(parts.size(), [&](std::size_t i) {
    const std::size_t first = rows.first + i * row_unit;
    const RowRange some{first, std::min(first + row_unit, rows.last)};
    parts[i] = products_of(pair, some.elements(pair.a.extent));
  });
  replicates_ = pair.a.images.size();
  sums_.resize(parts.at(0).size());
  for (const std::vector<double>& part : parts) {
    for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += part[i];
  }
}

template <class Real>
FlipMatrix RowFlips<Real>::matrix() const {
  const std::size_t stride = FlipBlock(replicates_).stride;
  std::vector<double> matrix(replicates_ * replicates_);
  for (std::size_t r = 0; r < replicates_; ++r) {
    for (std::size_t s = 0; s < replicates_; ++s) {
      matrix[r * replicates_ + s] = sums_[std::max(r, s) * stride + std::min(r, s)];
    }
  }
  return {replicates_, std::move(matrix)};
}

template <class Real>
FlipMatrix flip_matrix(const ImageStack<Real>& a, const ImageStack<Real>& b,
                       const ForEach& for_each) {
  check::image_stack("flip_matrix", a);
  check::image_stack("flip_matrix", b);
  check::same_extent("flip_matrix", a.extent, b.extent);
  return matrix_of<Real>({a, &b, nullptr}, for_each);
}

template <class Real>
FlipMatrix flip_matrix(const ImageStack<Real>& a, const ImageReference& b,
                       const ForEach& for_each) {
  check::image_stack("flip_matrix", a);
  check::image_reference("flip_matrix", b);
  check::same_extent("flip_matrix", a.extent, b.extent);
  if (!b.standard_error.empty()) {
    check::fail({"flip_matrix", "size of the standard errors"}, b.standard_error.size(),
                "0: a reference's error is the same in every replicate and does not flip");
  }
  return matrix_of<Real>({a, nullptr, &b}, for_each);
}

template class RowFlips<float>;
template class RowFlips<double>;
template FlipMatrix flip_matrix(const ImageStack<float>&, const ImageStack<float>&, const ForEach&);
template FlipMatrix flip_matrix(const ImageStack<double>&, const ImageStack<double>&,
                                const ForEach&);
template FlipMatrix flip_matrix(const ImageStack<float>&, const ImageReference&, const ForEach&);
template FlipMatrix flip_matrix(const ImageStack<double>&, const ImageReference&, const ForEach&);

// The first sign stays: Q(s) = Q(-s).
SignFlip sign_flip(const FlipMatrix& matrix, double share) {
  check_replicates(matrix, share);
  const std::size_t replicates = matrix.replicates();
  if (replicates > most_enumerated) {
    check::fail({"sign_flip", "replicates to enumerate"}, replicates,
                "at most " + std::to_string(most_enumerated) + "; use a generator");
  }
  const std::uint64_t vectors = std::uint64_t{1} << (replicates - 1);
  // The observed signs, all positive, are vector 0 and reach their own energy.
  const auto sign = [](std::uint64_t before, std::size_t r) {
    return r == 0 || ((before + 1) >> (r - 1)) % 2 == 0 ? 1.0 : -1.0;
  };
  const std::uint64_t reached =
      1 + detail::count_reached(matrix, vectors - 1, vectors, sign).reached;
  const double log_p = std::log(static_cast<double>(reached)) -
                       static_cast<double>(replicates - 1) * std::numbers::ln2;
  return {matrix.energy(std::vector<double>(replicates, 1)), log_p, vectors - 1,
          FlipMethod::enumerated, Exactness::asymptotic};
}

namespace detail {

void check_flip_plan(const FlipMatrix& matrix, const FlipPlan& plan) {
  check_replicates(matrix, plan.share);
  if (static_cast<double>(plan.flips) + 1 < 2 / plan.share) {
    check::fail({"sign_flip", "flips"}, plan.flips, "at least 2 / share - 1");
  }
  check::at_least({"sign_flip", "enough"}, plan.enough, 1);
}

// A Q that equals the observed one but for rounding counts as reaching it. That can only raise the
// p-value.
double flip_threshold(const FlipMatrix& matrix) {
  return matrix.energy(std::vector<double>(matrix.replicates(), 1)) * (1 - 1e-12);
}

SignFlip flip_result(const FlipMatrix& matrix, const FlipPlan& plan, const FlipCount& count) {
  const double vectors = static_cast<double>(count.vectors);
  const double reached = static_cast<double>(count.reached);
  const double p = count.reached == plan.enough ? reached / vectors : (reached + 1) / (vectors + 1);
  return {matrix.energy(std::vector<double>(matrix.replicates(), 1)), std::log(p), count.vectors,
          FlipMethod::monte_carlo, Exactness::asymptotic};
}

}  // namespace detail
}  // namespace assay::stats
