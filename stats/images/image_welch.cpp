#include "stats/images/image_welch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "stats/basics/check.h"
#include "stats/basics/errors.h"
#include "stats/basics/vector_copies.h"
#include "stats/gates/normal_test.h"
#include "stats/images/image_moments.h"
#include "stats/means/student_t.h"
#include "stats/means/welch_t.h"
#include "stats/tails/t_to_z.h"

namespace assay::stats {
namespace {

constexpr std::size_t block_size = 1024;
using Block = std::array<double, block_size>;

// A block of one side: means, squared standard errors, and 1 / degrees (0 when these are given).
struct Side {
  Block mean;
  Block squared_error;
  double inverse_degrees = 0;
};

struct Students {
  Block t;
  Block degrees;
  Block total;  // Squared standard error of the difference.
};

// Shares of the variance, so that tiny variances do not underflow when squared.
ASSAY_VECTOR_COPIES void students_of(const Side& a, const Side& b, Students& out,
                                     std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    const double total = a.squared_error[i] + b.squared_error[i];
    const double share_a = a.squared_error[i] / total;
    const double share_b = b.squared_error[i] / total;
    out.total[i] = total;
    out.t[i] = (a.mean[i] - b.mean[i]) / std::sqrt(total);
    out.degrees[i] =
        1 / (share_a * share_a * a.inverse_degrees + share_b * share_b * b.inverse_degrees);
  }
}

WelchCounts z_of_block(const Side& a, const Side& b, std::size_t first, std::span<double> z) {
  Students students;
  students_of(a, b, students, z.size());
  WelchCounts counts;
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double difference = a.mean[i] - b.mean[i];
    if (!std::isfinite(difference) || !std::isfinite(students.total[i])) {
      check::fail({"welch_z", "element " + std::to_string(first + i)}, difference,
                  "a finite difference with a finite variance");
    }
    if (students.total[i] > 0) {
      z[i] = t_to_z({students.t[i], students.degrees[i]});
      ++counts.tested;
    } else if (difference == 0) {
      z[i] = 0;
      ++counts.equal_constants;
    } else {
      z[i] = std::copysign(std::numeric_limits<double>::infinity(), difference);
      ++counts.different_constants;
    }
  }
  return counts;
}

struct Scaling {
  double count;
  double factor() const { return 1 / (count * (count - 1)); }
  double inverse_degrees() const { return 1 / (count - 1); }
};

void scale(Side& side, Scaling by, std::size_t size) {
  side.inverse_degrees = by.inverse_degrees();
  for (std::size_t i = 0; i < size; ++i) side.squared_error[i] *= by.factor();
}

template <class Real>
void load(const ImageStack<Real>& stack, ElementRange range, Side& side) {
  const std::size_t size = range.last - range.first;
  moments_of_range(stack, range.first,
                   {std::span(side.mean).first(size), std::span(side.squared_error).first(size)});
  scale(side, {static_cast<double>(stack.images.size())}, size);
}

void load(const ImageReference& reference, ElementRange range, Side& side) {
  side.inverse_degrees = 0;
  for (std::size_t i = range.first; i < range.last; ++i) {
    const double error = check::reference_error("welch_z", reference, i);
    side.mean[i - range.first] = reference.value[i];
    side.squared_error[i - range.first] = error * error;
  }
}

template <class First, class Second>
WelchCounts z_of_range(const First& a, const Second& b, std::size_t first, std::span<double> z) {
  WelchCounts counts;
  Side side_a;
  Side side_b;
  for (std::size_t done = 0; done < z.size(); done += block_size) {
    const std::size_t begin = first + done;
    const std::span<double> out = z.subspan(done, std::min(block_size, z.size() - done));
    load(a, {begin, begin + out.size()}, side_a);
    load(b, {begin, begin + out.size()}, side_b);
    counts.merge(z_of_block(side_a, side_b, begin, out));
  }
  return counts;
}

void check_range(std::size_t elements, std::size_t first, std::size_t size) {
  if (first > elements || size > elements - first) {
    check::fail({"welch_z", "end of the range"}, first + size,
                "at most " + std::to_string(elements));
  }
}

template <class Real>
Moments element_moments(const ImageStack<Real>& stack, std::size_t element) {
  Moments moments;
  for (std::size_t r = 0; r < stack.images.size(); ++r) {
    moments.add(static_cast<double>(*stack.at(r, element)));
  }
  return moments;
}

void check_element(const ImageExtent& extent, std::size_t element) {
  if (element >= extent.elements()) {
    check::fail({"welch_element", "element"}, element,
                "below " + std::to_string(extent.elements()));
  }
}

}  // namespace

void WelchCounts::merge(const WelchCounts& other) {
  tested += other.tested;
  equal_constants += other.equal_constants;
  different_constants += other.different_constants;
}

template <class Real>
WelchCounts welch_z(const ImageStack<Real>& a, const ImageStack<Real>& b, std::size_t first,
                    std::span<double> z) {
  check::image_stack("welch_z", a);
  check::image_stack("welch_z", b);
  check::same_extent("welch_z", a.extent, b.extent);
  check_range(a.extent.elements(), first, z.size());
  return z_of_range(a, b, first, z);
}

template <class Real>
WelchCounts welch_z(const ImageStack<Real>& a, const ImageReference& b, std::size_t first,
                    std::span<double> z) {
  check::image_stack("welch_z", a);
  check::image_reference("welch_z", b);
  check::same_extent("welch_z", a.extent, b.extent);
  check_range(a.extent.elements(), first, z.size());
  return z_of_range(a, b, first, z);
}

template <class Real>
TestResult welch_element(const ImageStack<Real>& a, const ImageStack<Real>& b,
                         std::size_t element) {
  check_element(a.extent, element);
  check_element(b.extent, element);
  return welch_t(element_moments(a, element), element_moments(b, element), {});
}

template <class Real>
TestResult welch_element(const ImageStack<Real>& a, const ImageReference& b, std::size_t element) {
  check_element(a.extent, element);
  check_element(b.extent, element);
  const double error = check::reference_error("welch_element", b, element);
  const Moments moments = element_moments(a, element);
  if (moments.m2 > 0 || error == 0) return student_t(moments, {b.value[element], error});
  // Only the reference varies: nothing was estimated, the law is normal.
  return normal_test({moments.mean - b.value[element], error});
}

template WelchCounts welch_z(const ImageStack<float>&, const ImageStack<float>&, std::size_t,
                             std::span<double>);
template WelchCounts welch_z(const ImageStack<double>&, const ImageStack<double>&, std::size_t,
                             std::span<double>);
template WelchCounts welch_z(const ImageStack<float>&, const ImageReference&, std::size_t,
                             std::span<double>);
template WelchCounts welch_z(const ImageStack<double>&, const ImageReference&, std::size_t,
                             std::span<double>);
template TestResult welch_element(const ImageStack<float>&, const ImageStack<float>&, std::size_t);
template TestResult welch_element(const ImageStack<double>&, const ImageStack<double>&,
                                  std::size_t);
template TestResult welch_element(const ImageStack<float>&, const ImageReference&, std::size_t);
template TestResult welch_element(const ImageStack<double>&, const ImageReference&, std::size_t);

}  // namespace assay::stats
