#include "stats/images/image_planning.h"

#include <algorithm>
#include <cmath>

#include "stats/images/image_covariance.h"
#include "stats/images/image_means.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

// Standard errors above estimates of the noise.
constexpr double errors_above = 2;

// The squared distance that `n` images exclude.
double excluded_square(const ImageNoise& noise, double beta, double n) {
  if (!(noise.root > 0)) return 0;
  const double degrees = std::pow(noise.trace / noise.root, 2);
  const double t = -student_t_quantile({Tail::lower, std::log(beta)}, n - 1);
  const double square = chi_square_quantile({Tail::upper, std::log(beta)}, degrees);
  return noise.root / std::sqrt(degrees) / n * (square - degrees + 2 * t * std::sqrt(square));
}

// The same of a distance between the whole images' means.
double excluded_distance(const ImageNoise& noise, double beta, double n) {
  const double t = -student_t_quantile({Tail::lower, std::log(beta)}, n - 1);
  return (t + upper_normal_quantile(beta / 2)) * std::sqrt(noise.of_mean / n);
}

}  // namespace

void ImageNoise::add(const ImageNoise& side, double square, double averaged) {
  trace += square * side.trace / averaged;
  root += square * side.root / averaged;
  of_mean += square * side.of_mean / averaged;
  squared_norm = square * side.squared_norm;
}

ImageNoise noise_of_pilot(const ImageStack& pilot, const ForEach& for_each) {
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
  std::uint64_t count = least_replicates;
  while (count < most) {
    const auto n = static_cast<double>(count);
    if (excluded_square(noise, beta, n) <= room &&
        excluded_distance(noise, beta, n) <= room_of_mean) {
      break;
    }
    count += count / 8 + 1;
  }
  return std::min(count, most);
}

}  // namespace assay::stats
