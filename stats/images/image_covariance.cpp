#include "stats/images/image_covariance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "stats/images/image_moments.h"
#include "stats/tails/tails.h"

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

void ImageNoise::add(const ImageNoise& side, double square, double averaged) {
  trace += square * side.trace / averaged;
  root += square * side.root / averaged;
  of_mean += square * side.of_mean / averaged;
  squared_norm = square * side.squared_norm;
}

ImageNoise noise_of_pilot(const ImageStack& pilot, const ForEach& for_each) {
  constexpr double errors_above = 2;
  const ImageCovariance found = image_covariance(pilot, for_each);
  const double square = found.squared_trace + errors_above * found.squared_trace_error;
  const auto images = static_cast<double>(pilot.images.size());
  const auto places = static_cast<double>(pilot.extent.width * pilot.extent.height);
  double error = 0;
  for (const Reference& mean : channel_means(pilot, for_each)) {
    error = std::max(error, mean.standard_error);
  }
  return {
      .trace = found.trace,
      .root = std::min(found.trace, std::sqrt(square)),
      .of_mean = error * error * images * places * (1 + errors_above * std::sqrt(2 / (images - 1))),
      .squared_norm = found.squared_mean};
}

std::uint64_t image_sample_size(const ImageNoise& noise, const ImageMargins& margins, double beta,
                                std::uint64_t most) {
  const auto [allow, detect, unit] = margins;
  const double room = (detect * detect - allow * allow) * unit;
  const double room_of_mean = (detect - allow) * std::sqrt(unit);
  if (!(room > 0)) return most;
  const bool noisy = noise.root > 0;
  const double degrees = noisy ? std::pow(noise.trace / noise.root, 2) : 1;
  const double square = chi_square_quantile({Tail::upper, std::log(beta)}, degrees);
  const double z = upper_normal_quantile(beta / 2);
  std::uint64_t count = least_replicates;
  while (count < most) {
    const auto n = static_cast<double>(count);
    const double t = -student_t_quantile({Tail::lower, std::log(beta)}, n - 1);
    // The squared distance that n images exclude, and the distance between whole images' means.
    const double excluded =
        noise.root / std::sqrt(degrees) / n * (square - degrees + 2 * t * std::sqrt(square));
    const double of_mean = (t + z) * std::sqrt(noise.of_mean / n);
    if ((!noisy || excluded <= room) && of_mean <= room_of_mean) break;
    count += count / 8 + 1;
  }
  return std::min(count, most);
}

}  // namespace assay::stats
