#include "stats/images/image_equivalence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "stats/basics/check.h"
#include "stats/basics/errors.h"
#include "stats/basics/vector_copies.h"
#include "stats/images/image_jackknife.h"
#include "stats/images/image_moments.h"
#include "stats/images/image_row_distance.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

using namespace jackknifed;

struct LeftOut {
  const Block& mean;
  const Block& m2;
  double count;
};

// Leaves one replicate out of mean and m2, by Welford's step backwards.
template <class Real>
inline void step_back(const Real* values, const LeftOut& of, Estimates& out, std::size_t size) {
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
ASSAY_VECTOR_COPIES void leave_out(const float* values, const LeftOut& of, Estimates& out,
                                   std::size_t size) {
  step_back(values, of, out, size);
}
ASSAY_VECTOR_COPIES void leave_out(const double* values, const LeftOut& of, Estimates& out,
                                   std::size_t size) {
  step_back(values, of, out, size);
}

template <class Real>
class StackBlock {
 public:
  StackBlock(const char* function, const ImageStack<Real>& stack) : stack_(stack) {
    check::image_stack(function, stack);
  }

  std::size_t left_out() const { return stack_.images.size(); }
  void load(std::size_t first, std::size_t size) {
    first_ = first;
    size_ = size;
    moments_of_range(stack_, first, {std::span(all_.mean).first(size), std::span(m2_).first(size)});
    for (std::size_t i = 0; i < size; ++i) {
      all_.squared_error[i] = m2_[i] / (count() * (count() - 1));
    }
  }
  const Estimates& all() const { return all_; }
  void without(std::size_t r, Estimates& out) const {
    leave_out(stack_.at(r, first_), {all_.mean, m2_, count()}, out, size_);
  }

 private:
  double count() const { return static_cast<double>(stack_.images.size()); }

  const ImageStack<Real>& stack_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  Estimates all_;
  Block m2_{};
};

class ReferenceBlock {
 public:
  ReferenceBlock(const char* function, const ImageReference& reference)
      : function_(function), reference_(reference) {
    check::image_reference(function, reference);
  }

  std::size_t left_out() const { return 0; }
  void load(std::size_t first, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      const double error = check::reference_error(function_, reference_, first + i);
      all_.mean[i] = reference_.value[first + i];
      all_.squared_error[i] = error * error;
    }
  }
  const Estimates& all() const { return all_; }
  void without(std::size_t, Estimates& out) const { out = all_; }

 private:
  const char* function_;
  const ImageReference& reference_;
  Estimates all_;
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

// The terms of a block. Those of the first `kinds_of_a` kinds depend on a.
struct BiasAndNorm {
  static constexpr std::size_t kinds_of_a = 1;
  void operator()(const Estimates& a, const Estimates& b, Terms<2>& out, std::size_t size) const {
    squared_differences(a, b, out[0], size);
    squared_norms(b, out[1], size);
  }
};

template <class Real>
StackBlock<Real> block_of(const char* function, const ImageStack<Real>& stack) {
  return {function, stack};
}
ReferenceBlock block_of(const char* function, const ImageReference& reference) {
  return {function, reference};
}

ImageDistance distance_of(const Jackknife<2>& sums) {
  return {.squared_bias = sums.whole[0],
          .squared_norm = sums.whole[1],
          .bias_variance = sums.covariance(0, 0),
          .norm_variance = sums.covariance(1, 1),
          .covariance = sums.covariance(0, 1),
          .degrees = sums.degrees()};
}

template <class Real, class Second>
ImageDistance distance_of(const ImageStack<Real>& a, const Second& b, const ForEach& for_each) {
  constexpr const char* function = "image_distance";
  check::same_extent(function, a.extent, b.extent);
  RunningJackknife<2> sums;
  sums.add({0, a.extent.elements()}, block_of(function, a), block_of(function, b), BiasAndNorm{},
           for_each);
  return distance_of(sums.finish(BiasAndNorm::kinds_of_a));
}

}  // namespace

template <class Real>
ImageDistance image_distance(const ImageStack<Real>& a, const ImageStack<Real>& b,
                             const ForEach& for_each) {
  return distance_of(a, b, for_each);
}
template <class Real>
ImageDistance image_distance(const ImageStack<Real>& a, const ImageReference& b,
                             const ForEach& for_each) {
  return distance_of(a, b, for_each);
}

template <class Real>
void RowDistance<Real>::take(const ImagePair<Real>& pair, RowRange rows, const ForEach& for_each) {
  constexpr const char* function = "image_distance";
  const auto add = [&](const auto& second) {
    check::same_extent(function, pair.a.extent, second.extent);
    sums_.add(rows.elements(pair.a.extent), block_of(function, pair.a), block_of(function, second),
              BiasAndNorm{}, for_each);
  };
  if (pair.b != nullptr) {
    add(*pair.b);
  } else {
    add(*pair.reference);
  }
}

template <class Real>
ImageDistance RowDistance<Real>::distance() {
  return distance_of(sums_.finish(BiasAndNorm::kinds_of_a));
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

TestResult squared_margin_test(const ImageDistance& distance, double squared_margin) {
  const double variance = distance.bias_variance - 2 * squared_margin * distance.covariance +
                          squared_margin * squared_margin * distance.norm_variance;
  if (!(variance > 0)) throw ZeroVariance("image_equivalence: zero standard error");
  const double t =
      (distance.squared_bias - squared_margin * distance.squared_norm) / std::sqrt(variance);
  const LogTails tails = student_t_tails(t, distance.degrees);
  return {t, {"student-t", {distance.degrees}}, tails.lower, tails.upper, Exactness::asymptotic};
}

#define ASSAY_FOR_REAL(Real)                                                              \
  template ImageDistance image_distance(const ImageStack<Real>&, const ImageStack<Real>&, \
                                        const ForEach&);                                  \
  template ImageDistance image_distance(const ImageStack<Real>&, const ImageReference&,   \
                                        const ForEach&)
ASSAY_FOR_REAL(float);
ASSAY_FOR_REAL(double);
#undef ASSAY_FOR_REAL
template class RowDistance<float>;
template class RowDistance<double>;

}  // namespace assay::stats
