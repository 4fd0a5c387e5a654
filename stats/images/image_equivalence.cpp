#include "stats/images/image_equivalence.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "stats/basics/check.h"
#include "stats/basics/moments.h"
#include "stats/basics/vector_copies.h"
#include "stats/images/image_moments.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr const char* function_name = "image_distance";

using Terms = DistanceSums::Terms;

constexpr std::size_t block_size = 512;
// Elements that a thread takes at a time.
constexpr std::size_t range_size = 64 * block_size;
using Block = std::array<double, block_size>;

// ---- A block of elements

// Means and squared errors.
struct Estimates {
  Block mean{};
  Block squared_error{};
};

struct LeftOut {
  const Block& mean;
  const Block& m2;
  double count;
};

// Leaves one replicate out of mean and m2, by Welford's step backwards.
template <class Real>
ASSAY_VECTOR_COPIES void leave_out(const Real* values, const LeftOut& of, Estimates& out,
                                   std::size_t size) {
  const double rest = of.count - 1;
  const double scale = rest * (rest - 1);
  const double count = of.count;
  const double* const mean = of.mean.data();
  const double* const m2 = of.m2.data();
  double* const __restrict mean_out = out.mean.data();
  double* const __restrict squared_error = out.squared_error.data();
  for (std::size_t i = 0; i < size; ++i) {
    const double delta = static_cast<double>(values[i]) - mean[i];
    const double left = m2[i] - delta * delta * count / rest;
    mean_out[i] = mean[i] - delta / rest;
    squared_error[i] = (left < 0 ? 0.0 : left) / scale;
  }
}

// One side: a stack, or a reference, of which nothing is left out.
template <class Real>
class Side {
 public:
  Side(const ImageStack<Real>* stack, const ImageReference* reference)
      : stack_(stack), reference_(reference) {}

  std::size_t left_out() const { return stack_ != nullptr ? stack_->images.size() : 0; }
  void load(std::size_t first, std::size_t size) {
    first_ = first;
    size_ = size;
    if (stack_ == nullptr) return load_reference();
    moments_of_range(*stack_, first,
                     {std::span(all_.mean).first(size), std::span(m2_).first(size)});
    for (std::size_t i = 0; i < size; ++i) {
      all_.squared_error[i] = m2_[i] / (count() * (count() - 1));
    }
  }
  const Estimates& all() const { return all_; }
  void without(std::size_t r, Estimates& out) const {
    leave_out(stack_->at(r, first_), {all_.mean, m2_, count()}, out, size_);
  }

 private:
  double count() const { return static_cast<double>(left_out()); }
  void load_reference() {
    for (std::size_t i = 0; i < size_; ++i) {
      const double error = check::reference_error(function_name, *reference_, first_ + i);
      all_.mean[i] = reference_->value[first_ + i];
      all_.squared_error[i] = error * error;
    }
  }

  const ImageStack<Real>* stack_;
  const ImageReference* reference_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  Estimates all_;
  Block m2_{};
};

ASSAY_VECTOR_COPIES void squared_differences(const Estimates& a, const Estimates& b, Block& out,
                                             std::size_t size) {
  double* const __restrict term = out.data();
  for (std::size_t i = 0; i < size; ++i) {
    const double difference = a.mean[i] - b.mean[i];
    term[i] = difference * difference - a.squared_error[i] - b.squared_error[i];
  }
}
ASSAY_VECTOR_COPIES void squared_norms(const Estimates& b, Block& out, std::size_t size) {
  double* const __restrict term = out.data();
  for (std::size_t i = 0; i < size; ++i) term[i] = b.mean[i] * b.mean[i] - b.squared_error[i];
}

// The terms of a block: those of U for all its elements, and those of N, which do not depend on a.
using BlockTerms = std::array<Block, std::tuple_size_v<Terms>>;
constexpr std::size_t kinds_of_a = 1;

void find_terms(const Estimates& a, const Estimates& b, BlockTerms& out, std::size_t size) {
  squared_differences(a, b, out[0], size);
  squared_norms(b, out[1], size);
}

// ---- DistanceSums over blocks

// DistanceSums of several replicates take their terms in step. Each keeps the order of the
// elements, but none waits for the other's addition.
constexpr std::size_t in_step = 8;
using Step = std::array<BlockTerms, in_step>;

void add_in_step(std::span<Terms> sums, const Step& terms, std::size_t kind, std::size_t size) {
  std::array<double, in_step> sum{};
  for (std::size_t k = 0; k < sums.size(); ++k) sum[k] = sums[k][kind];
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t k = 0; k < in_step; ++k) sum[k] += terms[k][kind][i];
  }
  for (std::size_t k = 0; k < sums.size(); ++k) sums[k][kind] = sum[k];
}

// DistanceSums without each replicate in turn, of `kinds` kinds of terms. `terms_without` fills in
// the terms without replicate r.
template <class TermsWithout>
void add_without(std::vector<Terms>& sums, std::size_t kinds, std::size_t size, Step& step,
                 const TermsWithout& terms_without) {
  for (std::size_t r = 0; r < sums.size(); r += in_step) {
    const auto some = std::span(sums).subspan(r, std::min(in_step, sums.size() - r));
    for (std::size_t k = 0; k < some.size(); ++k) terms_without(r + k, step[k]);
    for (std::size_t kind = 0; kind < kinds; ++kind) add_in_step(some, step, kind, size);
  }
}

// Adds up a range of elements that follows on those before.
template <class Real>
void add_range(DistanceSums& sums, ElementRange range, Side<Real> a, Side<Real> b) {
  sums.without_a.resize(a.left_out());
  sums.without_b.resize(b.left_out());
  const auto step = std::make_unique<Step>();
  const auto one = std::make_unique<Estimates>();
  for (std::size_t first = range.first; first < range.last; first += block_size) {
    const std::size_t size = std::min(block_size, range.last - first);
    a.load(first, size);
    b.load(first, size);
    find_terms(a.all(), b.all(), (*step)[0], size);
    for (std::size_t kind = 0; kind < sums.whole.size(); ++kind) {
      add_in_step(std::span(&sums.whole, 1), *step, kind, size);
    }
    add_without(sums.without_a, kinds_of_a, size, *step, [&](std::size_t r, BlockTerms& terms) {
      a.without(r, *one);
      find_terms(*one, b.all(), terms, size);
    });
    add_without(sums.without_b, sums.whole.size(), size, *step,
                [&](std::size_t r, BlockTerms& terms) {
                  b.without(r, *one);
                  find_terms(a.all(), *one, terms, size);
                });
  }
}

void add(Terms& to, const Terms& other) {
  for (std::size_t kind = 0; kind < to.size(); ++kind) to[kind] += other[kind];
}
void add(std::vector<Terms>& to, const std::vector<Terms>& others) {
  to.resize(others.size());
  for (std::size_t i = 0; i < to.size(); ++i) add(to[i], others[i]);
}
void add(DistanceSums& to, const DistanceSums& other) {
  add(to.whole, other.whole);
  add(to.without_a, other.without_a);
  add(to.without_b, other.without_b);
}

// Covariance of two jackknifed sums: (n - 1) / n times the sum of products about the means.
double covariance(const std::vector<Terms>& values, std::size_t i, std::size_t j) {
  if (values.empty()) return 0;
  const double n = static_cast<double>(values.size());
  Terms mean{};
  for (const Terms& value : values) {
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += value[k] / n;
  }
  double products = 0;
  for (const Terms& value : values) products += (value[i] - mean[i]) * (value[j] - mean[j]);
  return products * (n - 1) / n;
}

ImageDistance distance_of(const DistanceSums& sums) {
  const auto both = [&](std::size_t i, std::size_t j) {
    return covariance(sums.without_a, i, j) + covariance(sums.without_b, i, j);
  };
  const std::size_t fewest = sums.without_b.empty()
                                 ? sums.without_a.size()
                                 : std::min(sums.without_a.size(), sums.without_b.size());
  return {.squared_bias = sums.whole[0],
          .squared_norm = sums.whole[1],
          .bias_variance = both(0, 0),
          .norm_variance = both(1, 1),
          .covariance = both(0, 1),
          .degrees = static_cast<double>(fewest - 1)};
}

// ---- A reference's own error

// In standard errors. One error common to all elements moves all differences alike, and with them
// its own estimated variance.
constexpr double reach = 2;

// The parts that errors of elements add to the variances of U and N.
struct Added {
  double bias = 0;
  double norm = 0;
  double covariance = 0;
};

struct Element {
  double mean;           // Mean of the stack.
  double squared_error;  // Its squared error.
  double reference;
  double reference_error;
};

Added added_by(const Element& x, ElementErrors errors) {
  const double squared = x.reference_error * x.reference_error;
  const double difference = x.mean - x.reference;
  const double noise = x.squared_error + squared;
  const double bias = errors == ElementErrors::independent
                          ? std::max(0.0, difference * difference - noise)
                          : std::pow(std::abs(difference) + reach * std::sqrt(noise), 2);
  const double norm = std::max(0.0, x.reference * x.reference - squared);
  const double second_order = 2 * squared * squared;
  return {.bias = 4 * (bias + x.squared_error) * squared + second_order,
          .norm = 4 * norm * squared + second_order,
          .covariance = -4 * difference * x.reference * squared - second_order};
}

}  // namespace

// DistanceSums over equal ranges are added up in order.
template <class Real>
void RowDistance<Real>::take(const ImagePair<Real>& pair, RowRange rows, const ForEach& for_each) {
  check::image_pair(function_name, pair);
  const ElementRange elements = rows.elements(pair.a.extent);
  const Side<Real> a(&pair.a, nullptr);
  const Side<Real> b(pair.b, pair.reference);
  const std::size_t begin = elements.first / range_size;
  std::vector<DistanceSums> parts((elements.last - 1) / range_size + 1 - begin);
  if (elements.first % range_size != 0) parts[0] = std::move(open_);
  for_each(parts.size(), [&](std::size_t i) {
    const std::size_t first = (begin + i) * range_size;
    add_range(parts[i],
              {std::max(first, elements.first), std::min(first + range_size, elements.last)}, a, b);
  });
  open_ = {};
  if (elements.last % range_size != 0) {
    open_ = std::move(parts.back());
    parts.pop_back();
  }
  for (const DistanceSums& part : parts) add(sums_, part);
}

template <class Real>
ImageDistance RowDistance<Real>::distance() {
  if (!open_.without_a.empty()) add(sums_, open_);
  for (Terms& without : sums_.without_a) {
    std::copy(sums_.whole.begin() + kinds_of_a, sums_.whole.end(), without.begin() + kinds_of_a);
  }
  for (const double sum : sums_.whole) {
    if (!std::isfinite(sum)) check::fail({function_name, "sum over the image"}, sum, "finite");
  }
  return distance_of(sums_);
}

ImageDistance with_norm(ImageDistance distance, double squared_norm) {
  check::positive({"with_norm", "squared norm"}, squared_norm);
  distance.squared_norm = squared_norm;
  distance.norm_variance = 0;
  distance.covariance = 0;
  return distance;
}

ImageDistance relative_to(ImageDistance distance, const ImageDistance& norm) {
  distance.squared_norm = norm.squared_bias;
  distance.norm_variance = norm.bias_variance;
  distance.covariance = 0;
  return distance;
}

template <class Real>
ImageDistance with_reference_error(ImageDistance distance, const ImageStack<Real>& a,
                                   const ImageReference& b, ElementErrors errors) {
  constexpr const char* function = "with_reference_error";
  check::image_pair(function, pair_of(a, b));
  if (b.standard_error.empty()) return distance;
  std::vector<double> mean(a.extent.elements());
  std::vector<double> m2(mean.size());
  moments_of_range(a, 0, {mean, m2});
  const double count = static_cast<double>(a.images.size());
  Added sum;
  Added roots;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    const Element element{.mean = mean[i],
                          .squared_error = m2[i] / (count * (count - 1)),
                          .reference = b.value[i],
                          .reference_error = check::reference_error(function, b, i)};
    const Added added = added_by(element, errors);
    sum.bias += added.bias;
    sum.norm += added.norm;
    sum.covariance += added.covariance;
    roots.bias += std::sqrt(added.bias);
    roots.norm += std::sqrt(added.norm);
  }
  if (errors == ElementErrors::unknown) {
    sum = {.bias = roots.bias * roots.bias,
           .norm = roots.norm * roots.norm,
           .covariance = -roots.bias * roots.norm};
  }
  distance.bias_variance += sum.bias;
  distance.norm_variance += sum.norm;
  distance.covariance += sum.covariance;
  return distance;
}

TestResult squared_margin_test(const ImageDistance& distance, double squared_margin) {
  const double variance = distance.bias_variance - 2 * squared_margin * distance.covariance +
                          squared_margin * squared_margin * distance.norm_variance;
  if (!(variance > 0)) throw ZeroVariance("image_equivalence: zero standard error");
  const double t =
      (distance.squared_bias - squared_margin * distance.squared_norm) / std::sqrt(variance);
  const LogTails tails = student_t_tails(t, distance.degrees);
  return {t, {"student-t", {distance.degrees}}, tails.lower, tails.upper, Exactness::asymptotic};
}

template class RowDistance<float>;
template class RowDistance<double>;
template ImageDistance with_reference_error(ImageDistance, const ImageStack<float>&,
                                            const ImageReference&, ElementErrors);
template ImageDistance with_reference_error(ImageDistance, const ImageStack<double>&,
                                            const ImageReference&, ElementErrors);

}  // namespace assay::stats
