#include "stats/images/image_reference_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stats/images/image_moments.h"

namespace assay::stats {
namespace {

// In standard errors. One error common to all elements moves all differences alike, and with them
// its own estimated variance.
constexpr double reach = 2;

/// The parts that errors of elements add to the variances of U and N.
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

template <class Real>
ImageDistance with_reference_error(ImageDistance distance, const ImageStack<Real>& a,
                                   const ImageReference& b, ElementErrors errors) {
  constexpr const char* function = "with_reference_error";
  check::image_stack(function, a);
  check::image_reference(function, b);
  check::same_extent(function, a.extent, b.extent);
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

template ImageDistance with_reference_error(ImageDistance, const ImageStack<float>&,
                                            const ImageReference&, ElementErrors);
template ImageDistance with_reference_error(ImageDistance, const ImageStack<double>&,
                                            const ImageReference&, ElementErrors);

}  // namespace assay::stats
