#include "stats/images/image_covariance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace assay::stats {
namespace {

constexpr const char* function_name = "image_covariance";
constexpr std::size_t most_pairs = 128;

// Differences of neighbours over the square root of 2: mean 0 and covariance C.
std::vector<std::vector<float>> differences_of(const ImageStack& stack) {
  check::image_stack(function_name, stack);
  std::vector<std::vector<float>> differences(std::min(stack.images.size() / 2, most_pairs));
  for (std::size_t k = 0; k < differences.size(); ++k) {
    const std::span<const float> first = stack.images[2 * k];
    const std::span<const float> second = stack.images[2 * k + 1];
    differences[k].resize(first.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      const double difference = static_cast<double>(first[i]) - static_cast<double>(second[i]);
      differences[k][i] = static_cast<float>(difference / std::numbers::sqrt2);
    }
  }
  return differences;
}

double trace_of(const std::vector<std::vector<float>>& differences, const ForEach& for_each) {
  std::vector<double> norms(differences.size());
  for_each(norms.size(), [&](std::size_t k) { norms[k] = dot(differences[k], differences[k]); });
  double mean = 0;
  for (const double norm : norms) mean += norm / static_cast<double>(norms.size());
  return mean;
}

double squared_mean_of(const ImageStack& stack, double trace) {
  const auto count = static_cast<double>(stack.images.size());
  double sum = 0;
  for (std::size_t i = 0; i < stack.extent.elements(); ++i) {
    double mean = 0;
    for (const std::span<const float> image : stack.images) mean += static_cast<double>(image[i]);
    sum += mean / count * (mean / count);
  }
  return sum - trace / count;
}

}  // namespace

ImageCovariance image_covariance(const ImageStack& stack, const ForEach& for_each) {
  const std::vector<std::vector<float>> differences = differences_of(stack);
  const std::size_t pairs = differences.size();
  std::vector<std::vector<double>> squares(pairs, std::vector<double>(pairs));
  for_each(pairs, [&](std::size_t k) {
    for (std::size_t l = 0; l < k; ++l) {
      squares[k][l] = std::pow(dot(differences[k], differences[l]), 2);
    }
  });
  std::vector<double> of_pair(pairs);
  double all = 0;
  for (std::size_t k = 0; k < pairs; ++k) {
    for (std::size_t l = 0; l < k; ++l) {
      all += squares[k][l];
      of_pair[k] += squares[k][l];
      of_pair[l] += squares[k][l];
    }
  }
  const auto count = static_cast<double>(pairs);
  ImageCovariance covariance{.trace = trace_of(differences, for_each),
                             .squared_trace = 2 * all / (count * (count - 1))};
  double spread = 0;
  for (const double own : of_pair) {
    const double without = 2 * (all - own) / ((count - 1) * (count - 2));
    spread += std::pow(without - covariance.squared_trace, 2);
  }
  covariance.squared_trace_error = std::sqrt(spread * (count - 1) / count);
  covariance.squared_mean = squared_mean_of(stack, covariance.trace);
  return covariance;
}

double image_squared_mean(const ImageStack& stack) {
  return squared_mean_of(stack, trace_of(differences_of(stack), one_by_one));
}

}  // namespace assay::stats
