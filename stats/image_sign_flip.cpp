#include "stats/image_sign_flip.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "stats/check.h"
#include "stats/vector_copies.h"

namespace assay::stats {
namespace {

constexpr std::size_t block_size = 256;
constexpr std::size_t most_enumerated = 25;

// Differences of a block of elements, replicate by replicate, each element divided by its
// root sum of squares. An element that never differs drops out as zeros.
void studentise(std::vector<double>& block, std::size_t replicates, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    double squares = 0;
    for (std::size_t r = 0; r < replicates; ++r) {
      squares += block[r * block_size + i] * block[r * block_size + i];
    }
    if (!std::isfinite(squares)) {
      check::fail({"flip_matrix", "sum of squared differences"}, squares, "finite");
    }
    const double factor = squares > 0 ? 1 / std::sqrt(squares) : 0;
    for (std::size_t r = 0; r < replicates; ++r) block[r * block_size + i] *= factor;
  }
}

void add_products(std::vector<double>& matrix, const std::vector<double>& block,
                  std::size_t replicates, std::size_t size) {
  for (std::size_t r = 0; r < replicates; ++r) {
    for (std::size_t s = 0; s <= r; ++s) {
      double sum = 0;
      for (std::size_t i = 0; i < size; ++i) {
        sum += block[r * block_size + i] * block[s * block_size + i];
      }
      matrix[r * replicates + s] += sum;
    }
  }
}

// second(r, element) is what replicate r is held against.
template <class Real, class Second>
FlipMatrix matrix_of(const ImageStack<Real>& a, const Second& second) {
  const std::size_t replicates = a.images.size();
  std::vector<double> matrix(replicates * replicates);
  std::vector<double> block(replicates * block_size);
  for (std::size_t first = 0; first < a.extent.elements(); first += block_size) {
    const std::size_t size = std::min(block_size, a.extent.elements() - first);
    for (std::size_t r = 0; r < replicates; ++r) {
      for (std::size_t i = 0; i < size; ++i) {
        block[r * block_size + i] =
            static_cast<double>(a.images[r][first + i]) - second(r, first + i);
      }
    }
    studentise(block, replicates, size);
    add_products(matrix, block, replicates, size);
  }
  for (std::size_t r = 0; r < replicates; ++r) {
    for (std::size_t s = r + 1; s < replicates; ++s) {
      matrix[r * replicates + s] = matrix[s * replicates + r];
    }
  }
  return {replicates, std::move(matrix)};
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
FlipMatrix flip_matrix(const ImageStack<Real>& a, const ImageStack<Real>& b) {
  check::image_stack("flip_matrix", a);
  check::image_stack("flip_matrix", b);
  check::same_extent("flip_matrix", a.extent, b.extent);
  if (a.images.size() != b.images.size()) {
    check::fail({"flip_matrix", "replicates of the second stack"}, b.images.size(),
                "as many as of the first, " + std::to_string(a.images.size()));
  }
  return matrix_of(a, [&](std::size_t r, std::size_t element) {
    return static_cast<double>(b.images[r][element]);
  });
}

template <class Real>
FlipMatrix flip_matrix(const ImageStack<Real>& a, const ImageReference& b) {
  check::image_stack("flip_matrix", a);
  check::image_reference("flip_matrix", b);
  check::same_extent("flip_matrix", a.extent, b.extent);
  if (!b.standard_error.empty()) {
    check::fail({"flip_matrix", "size of the standard errors"}, b.standard_error.size(),
                "0: a reference's error is the same in every replicate and does not flip");
  }
  return matrix_of(a, [&](std::size_t, std::size_t element) { return b.value[element]; });
}

template FlipMatrix flip_matrix(const ImageStack<float>&, const ImageStack<float>&);
template FlipMatrix flip_matrix(const ImageStack<double>&, const ImageStack<double>&);
template FlipMatrix flip_matrix(const ImageStack<float>&, const ImageReference&);
template FlipMatrix flip_matrix(const ImageStack<double>&, const ImageReference&);

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

// Sign vectors whose Q equals the observed one but for rounding count as reaching it, which can
// only raise the p-value.
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
