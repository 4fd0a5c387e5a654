#include "stats/image_equivalence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "stats/check.h"
#include "stats/errors.h"
#include "stats/image_moments.h"
#include "stats/tails.h"

namespace assay::stats {
namespace {

constexpr std::size_t block_size = 1024;
using Block = std::array<double, block_size>;

// Mean and squared error of one element of one image.
struct Estimate {
  double mean = 0;
  double squared_error = 0;
};

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
    moments_of_range(stack_, first, {std::span(mean_).first(size), std::span(m2_).first(size)});
  }
  Estimate all(std::size_t i) const { return {mean_[i], m2_[i] / (count() * (count() - 1))}; }
  // Without replicate r: the value leaves mean and m2 by Welford's step backwards.
  Estimate without(std::size_t r, std::size_t i) const {
    const double rest = count() - 1;
    const double delta = static_cast<double>(stack_.images[r][first_ + i]) - mean_[i];
    const double m2 = std::max(m2_[i] - delta * delta * count() / rest, 0.0);
    return {mean_[i] - delta / rest, m2 / (rest * (rest - 1))};
  }

 private:
  double count() const { return static_cast<double>(stack_.images.size()); }

  const ImageStack<Real>& stack_;
  std::size_t first_ = 0;
  Block mean_{};
  Block m2_{};
};

class ReferenceBlock {
 public:
  ReferenceBlock(const char* function, const ImageReference& reference)
      : function_(function), reference_(reference) {
    check::image_reference(function, reference);
  }

  std::size_t left_out() const { return 0; }
  void load(std::size_t first, std::size_t) { first_ = first; }
  Estimate all(std::size_t i) const {
    const double error = check::reference_error(function_, reference_, first_ + i);
    return {reference_.value[first_ + i], error * error};
  }
  Estimate without(std::size_t, std::size_t i) const { return all(i); }

 private:
  const char* function_;
  const ImageReference& reference_;
  std::size_t first_ = 0;
};

// Sums over elements of one or more terms.
template <std::size_t count>
using Sums = std::array<double, count>;

template <std::size_t count>
void add(Sums<count>& sums, const Sums<count>& terms) {
  for (std::size_t k = 0; k < count; ++k) sums[k] += terms[k];
}

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

// The sums over elements of term(estimate of a, estimate of b), and without each replicate.
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

template <std::size_t count, class First, class Second, class Term>
Jackknife<count> jackknife(std::size_t elements, First a, Second b, const Term& term) {
  Jackknife<count> sums;
  sums.without_a.resize(a.left_out());
  sums.without_b.resize(b.left_out());
  for (std::size_t first = 0; first < elements; first += block_size) {
    const std::size_t size = std::min(block_size, elements - first);
    a.load(first, size);
    b.load(first, size);
    for (std::size_t i = 0; i < size; ++i) add(sums.whole, term(a.all(i), b.all(i)));
    for (std::size_t r = 0; r < sums.without_a.size(); ++r) {
      for (std::size_t i = 0; i < size; ++i)
        add(sums.without_a[r], term(a.without(r, i), b.all(i)));
    }
    for (std::size_t r = 0; r < sums.without_b.size(); ++r) {
      for (std::size_t i = 0; i < size; ++i)
        add(sums.without_b[r], term(a.all(i), b.without(r, i)));
    }
  }
  for (const double sum : sums.whole) {
    if (!std::isfinite(sum)) check::fail({"squared_bias", "sum over the image"}, sum, "finite");
  }
  return sums;
}

double squared_difference(const Estimate& a, const Estimate& b) {
  const double difference = a.mean - b.mean;
  return difference * difference - a.squared_error - b.squared_error;
}

struct Absolute {
  Sums<1> operator()(const Estimate& a, const Estimate& b) const {
    return {squared_difference(a, b)};
  }
};

struct Relative {
  double constant;
  double elements;
  Sums<1> operator()(const Estimate& a, const Estimate& b) const {
    return {squared_difference(a, b) / (elements * (b.mean * b.mean + constant))};
  }
};

struct BiasAndNorm {
  Sums<2> operator()(const Estimate& a, const Estimate& b) const {
    return {squared_difference(a, b), b.mean * b.mean - b.squared_error};
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
