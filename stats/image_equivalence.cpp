#include "stats/image_equivalence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "stats/check.h"
#include "stats/errors.h"
#include "stats/image_moments.h"
#include "stats/tails.h"
#include "stats/vector_copies.h"

namespace assay::stats {
namespace {

constexpr std::size_t block_size = 512;
using Block = std::array<double, block_size>;

// Means and squared errors of the elements of a block.
struct Estimates {
  Block mean{};
  Block squared_error{};
};

struct LeftOut {
  const Block& mean;
  const Block& m2;
  double count;
};

// Without one replicate: its value leaves mean and m2 by Welford's step backwards.
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

// An image's block with and without one replicate.
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
    leave_out(stack_.images[r].data() + first_, {all_.mean, m2_, count()}, out, size_);
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

// Sums over elements of one or more terms.
template <std::size_t count>
using Sums = std::array<double, count>;

// The terms of a block, the first kind of all its elements, then the second.
template <std::size_t count>
using Terms = std::array<Block, count>;

// Covariance of two jackknifed sums: (n - 1) / n times the sum of products about the means.
template <std::size_t count>
double jackknife_covariance(const std::vector<Sums<count>>& values, std::size_t i, std::size_t j) {
  if (values.empty()) return 0;
  const double n = static_cast<double>(values.size());
  Sums<count> mean{};
  for (const Sums<count>& value : values) {
    for (std::size_t k = 0; k < count; ++k) mean[k] += value[k] / n;
  }
  double products = 0;
  for (const Sums<count>& value : values) products += (value[i] - mean[i]) * (value[j] - mean[j]);
  return products * (n - 1) / n;
}

// The sums over elements of the terms of (estimate of a, estimate of b), and without each
// replicate.
template <std::size_t count>
struct Jackknife {
  Sums<count> whole{};
  std::vector<Sums<count>> without_a;
  std::vector<Sums<count>> without_b;

  double covariance(std::size_t i, std::size_t j) const {
    return jackknife_covariance(without_a, i, j) + jackknife_covariance(without_b, i, j);
  }
  double degrees() const {
    const std::size_t fewest =
        without_b.empty() ? without_a.size() : std::min(without_a.size(), without_b.size());
    return static_cast<double>(fewest - 1);
  }
};

// Sums of several replicates take their terms in step: each in the order of the elements, but none
// waits for the other's addition.
constexpr std::size_t in_step = 8;

template <std::size_t count>
using Step = std::array<Terms<count>, in_step>;

template <std::size_t count>
void add_in_step(std::span<Sums<count>> sums, const Step<count>& terms, std::size_t kind,
                 std::size_t size) {
  std::array<double, in_step> sum{};
  for (std::size_t k = 0; k < sums.size(); ++k) sum[k] = sums[k][kind];
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t k = 0; k < in_step; ++k) sum[k] += terms[k][kind][i];
  }
  for (std::size_t k = 0; k < sums.size(); ++k) sums[k][kind] = sum[k];
}

// What adds up without each replicate in turn, of as many kinds of terms. `terms_without` fills in
// the terms without replicate r.
template <std::size_t count, class TermsWithout>
void add_without(std::vector<Sums<count>>& sums, std::size_t kinds, std::size_t size,
                 Step<count>& step, const TermsWithout& terms_without) {
  for (std::size_t r = 0; r < sums.size(); r += in_step) {
    const auto some = std::span(sums).subspan(r, std::min(in_step, sums.size() - r));
    for (std::size_t k = 0; k < some.size(); ++k) terms_without(r + k, step[k]);
    for (std::size_t kind = 0; kind < kinds; ++kind) add_in_step(some, step, kind, size);
  }
}

template <std::size_t count, class First, class Second, class Term>
Jackknife<count> jackknife(std::size_t elements, First a, Second b, const Term& term) {
  Jackknife<count> sums;
  sums.without_a.resize(a.left_out());
  sums.without_b.resize(b.left_out());
  const auto step = std::make_unique<Step<count>>();
  const auto one = std::make_unique<Estimates>();
  for (std::size_t first = 0; first < elements; first += block_size) {
    const std::size_t size = std::min(block_size, elements - first);
    a.load(first, size);
    b.load(first, size);
    term(a.all(), b.all(), (*step)[0], size);
    for (std::size_t kind = 0; kind < count; ++kind) {
      add_in_step(std::span(&sums.whole, 1), *step, kind, size);
    }
    add_without(sums.without_a, Term::kinds_of_a, size, *step,
                [&](std::size_t r, Terms<count>& terms) {
                  a.without(r, *one);
                  term(*one, b.all(), terms, size);
                });
    add_without(sums.without_b, count, size, *step, [&](std::size_t r, Terms<count>& terms) {
      b.without(r, *one);
      term(a.all(), *one, terms, size);
    });
  }
  for (Sums<count>& without : sums.without_a) {
    std::copy(sums.whole.begin() + Term::kinds_of_a, sums.whole.end(),
              without.begin() + Term::kinds_of_a);
  }
  for (const double sum : sums.whole) {
    if (!std::isfinite(sum)) check::fail({"squared_bias", "sum over the image"}, sum, "finite");
  }
  return sums;
}

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

// Each fills in its terms of a block. Terms of the first `kinds_of_a` kinds depend on a.
struct Absolute {
  static constexpr std::size_t kinds_of_a = 1;
  void operator()(const Estimates& a, const Estimates& b, Terms<1>& out, std::size_t size) const {
    squared_differences(a, b, out[0], size);
  }
};

struct Relative {
  static constexpr std::size_t kinds_of_a = 1;
  double constant;
  double elements;
  void operator()(const Estimates& a, const Estimates& b, Terms<1>& out, std::size_t size) const {
    squared_differences(a, b, out[0], size);
    for (std::size_t i = 0; i < size; ++i) {
      out[0][i] /= elements * (b.mean[i] * b.mean[i] + constant);
    }
  }
};

struct BiasAndNorm {
  static constexpr std::size_t kinds_of_a = 1;
  void operator()(const Estimates& a, const Estimates& b, Terms<2>& out, std::size_t size) const {
    squared_differences(a, b, out[0], size);
    squared_norms(b, out[1], size);
  }
};

Relative relative_term(const ImageExtent& extent, double constant) {
  check::positive({"relative_bias", "constant"}, constant);
  return {constant, static_cast<double>(extent.elements())};
}

template <class Real>
StackBlock<Real> block_of(const char* function, const ImageStack<Real>& stack) {
  return {function, stack};
}
ReferenceBlock block_of(const char* function, const ImageReference& reference) {
  return {function, reference};
}

template <std::size_t count, class Real, class Second, class Term>
Jackknife<count> jackknife_of(const char* function, const ImageStack<Real>& a, const Second& b,
                              const Term& term) {
  check::same_extent(function, a.extent, b.extent);
  return jackknife<count>(a.extent.elements(), block_of(function, a), block_of(function, b), term);
}

template <class Real, class Second, class Term>
SquaredBias bias_of(const char* function, const ImageStack<Real>& a, const Second& b,
                    const Term& term) {
  const auto sums = jackknife_of<1>(function, a, b, term);
  return {sums.whole[0], std::sqrt(sums.covariance(0, 0)), sums.degrees()};
}

template <class Real, class Second>
ImageDistance distance_of(const ImageStack<Real>& a, const Second& b) {
  const auto sums = jackknife_of<2>("image_distance", a, b, BiasAndNorm{});
  return {.squared_bias = sums.whole[0],
          .squared_norm = sums.whole[1],
          .bias_variance = sums.covariance(0, 0),
          .norm_variance = sums.covariance(1, 1),
          .covariance = sums.covariance(0, 1),
          .degrees = sums.degrees()};
}

template <class Real, class Second>
TestResult equivalence_of(const ImageStack<Real>& a, const Second& b, double margin) {
  check::positive({"image_equivalence", "margin"}, margin);
  return squared_margin_test(distance_of(a, b), margin * margin);
}

}  // namespace

template <class Real>
SquaredBias squared_bias(const ImageStack<Real>& a, const ImageStack<Real>& b) {
  return bias_of("squared_bias", a, b, Absolute{});
}
template <class Real>
SquaredBias squared_bias(const ImageStack<Real>& a, const ImageReference& b) {
  return bias_of("squared_bias", a, b, Absolute{});
}

template <class Real>
SquaredBias relative_bias(const ImageStack<Real>& a, const ImageStack<Real>& b, double constant) {
  return bias_of("relative_bias", a, b, relative_term(a.extent, constant));
}
template <class Real>
SquaredBias relative_bias(const ImageStack<Real>& a, const ImageReference& b, double constant) {
  return bias_of("relative_bias", a, b, relative_term(a.extent, constant));
}

Interval squared_bias_interval(const SquaredBias& bias, double confidence) {
  check::inside_unit({"squared_bias_interval", "confidence"}, confidence);
  const double half =
      student_t_quantile({Tail::upper, std::log((1 - confidence) / 2)}, bias.degrees) *
      bias.standard_error;
  return {bias.estimate - half, bias.estimate + half, confidence};
}

template <class Real>
ImageDistance image_distance(const ImageStack<Real>& a, const ImageStack<Real>& b) {
  return distance_of(a, b);
}
template <class Real>
ImageDistance image_distance(const ImageStack<Real>& a, const ImageReference& b) {
  return distance_of(a, b);
}

ImageDistance with_norm(ImageDistance distance, double squared_norm) {
  check::positive({"with_norm", "squared norm"}, squared_norm);
  distance.squared_norm = squared_norm;
  distance.norm_variance = 0;
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

template <class Real>
TestResult image_equivalence(const ImageStack<Real>& a, const ImageStack<Real>& b, double margin) {
  return equivalence_of(a, b, margin);
}
template <class Real>
TestResult image_equivalence(const ImageStack<Real>& a, const ImageReference& b, double margin) {
  return equivalence_of(a, b, margin);
}

#define ASSAY_FOR_REAL(Real)                                                                       \
  template SquaredBias squared_bias(const ImageStack<Real>&, const ImageStack<Real>&);             \
  template SquaredBias squared_bias(const ImageStack<Real>&, const ImageReference&);               \
  template SquaredBias relative_bias(const ImageStack<Real>&, const ImageStack<Real>&, double);    \
  template SquaredBias relative_bias(const ImageStack<Real>&, const ImageReference&, double);      \
  template ImageDistance image_distance(const ImageStack<Real>&, const ImageStack<Real>&);         \
  template ImageDistance image_distance(const ImageStack<Real>&, const ImageReference&);           \
  template TestResult image_equivalence(const ImageStack<Real>&, const ImageStack<Real>&, double); \
  template TestResult image_equivalence(const ImageStack<Real>&, const ImageReference&, double)
ASSAY_FOR_REAL(float);
ASSAY_FOR_REAL(double);
#undef ASSAY_FOR_REAL

}  // namespace assay::stats
