#include "stats/images/image_covariance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace assay::stats {
namespace {

constexpr const char* function_name = "image_covariance";
constexpr std::size_t most_pairs = 128;

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  }
  return sum;
}

// Differences of neighbours over the square root of 2: mean 0 and covariance C.
template <class Real>
std::vector<std::vector<float>> differences_of(const ImageStack<Real>& stack, std::size_t pairs) {
  std::vector<std::vector<float>> differences(pairs);
  for (std::size_t k = 0; k < pairs; ++k) {
    const std::span<const Real> first = stack.images[2 * k];
    const std::span<const Real> second = stack.images[2 * k + 1];
    differences[k].resize(first.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      const double difference = static_cast<double>(first[i]) - static_cast<double>(second[i]);
      differences[k][i] = static_cast<float>(difference / std::numbers::sqrt2);
    }
  }
  return differences;
}

template <class Real>
double squared_norm_of_mean(const ImageStack<Real>& stack) {
  const auto count = static_cast<double>(stack.images.size());
  double sum = 0;
  for (std::size_t i = 0; i < stack.extent.elements(); ++i) {
    double mean = 0;
    for (const std::span<const Real> image : stack.images) mean += static_cast<double>(image[i]);
    sum += mean / count * (mean / count);
  }
  return sum;
}

}  // namespace

template <class Real>
ImageCovariance image_covariance(const ImageStack<Real>& stack, const ForEach& for_each) {
  check::image_stack(function_name, stack);
  const std::size_t pairs = std::min(stack.images.size() / 2, most_pairs);
  const std::vector<std::vector<float>> differences = differences_of(stack, pairs);
  std::vector<std::vector<double>> squares(pairs, std::vector<double>(pairs));
  std::vector<double> norms(pairs);
  for_each(pairs, [&](std::size_t k) {
    norms[k] = dot(differences[k], differences[k]);
    for (std::size_t l = 0; l < k; ++l) {
      squares[k][l] = std::pow(dot(differences[k], differences[l]), 2);
    }
  });
  const auto count = static_cast<double>(pairs);
  ImageCovariance covariance;
  std::vector<double> of_pair(pairs);
  double all = 0;
  for (std::size_t k = 0; k < pairs; ++k) {
    covariance.trace += norms[k] / count;
    for (std::size_t l = 0; l < k; ++l) {
      all += squares[k][l];
      of_pair[k] += squares[k][l];
      of_pair[l] += squares[k][l];
    }
  }
  covariance.squared_trace = 2 * all / (count * (count - 1));
  double spread = 0;
  for (const double own : of_pair) {
    const double without = 2 * (all - own) / ((count - 1) * (count - 2));
    spread += std::pow(without - covariance.squared_trace, 2);
  }
  covariance.squared_trace_error = std::sqrt(spread * (count - 1) / count);
  covariance.squared_mean =
      squared_norm_of_mean(stack) - covariance.trace / static_cast<double>(stack.images.size());
  return covariance;
}

template ImageCovariance image_covariance(const ImageStack<float>&, const ForEach&);
template ImageCovariance image_covariance(const ImageStack<double>&, const ForEach&);

}  // namespace assay::stats
