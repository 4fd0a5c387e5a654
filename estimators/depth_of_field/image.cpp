#include "depth_of_field/image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "estimators/core/mapped.h"
#include "estimators/parameters.h"

namespace assay::depth_of_field {

namespace {

std::vector<std::uint64_t> counts(std::span<const double> shares, double scale) {
  return mapped(shares, [scale](double share) {
    return static_cast<std::uint64_t>(std::max(1.0, std::round(scale * share)));
  });
}

std::vector<double> exact_variances(const std::vector<Moments>& moments) {
  // Below, the difference is rounding.
  return mapped(
      moments, [](const Moments& m) { return m.variance() > 1e-10 * m.square ? m.variance() : 0; });
}

// The choices of `allocation` in their order.
constexpr std::array exponents = {0.0, 1.0, 2.0 / 3, 0.5};

}  // namespace

std::vector<std::uint64_t> lens_counts(std::span<const double> variances, const Allocation& plan) {
  const auto shares = mapped(variances, [&](double v) { return std::pow(v, plan.exponent); });
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  if (!(sum > 0)) return counts(shares, 0);
  const double budget = plan.mean_count * static_cast<double>(shares.size());
  double low = 0;
  double high = 2 * budget / sum;  // more than the budget, whatever is rounded down to one
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    const auto all = counts(shares, middle);
    const auto total = std::accumulate(all.begin(), all.end(), std::uint64_t{0});
    (static_cast<double>(total) <= budget ? low : high) = middle;
  }
  return counts(shares, low);
}

std::vector<ParameterInformation> grid_parameters() {
  return {count_parameter("width", "columns of pixels", "32", {2, 1024}),
          count_parameter("height", "rows of pixels", "24", {1, 1024}),
          number_parameter("size", "of the image along the width, on the focal plane", "2",
                           above(0), "scene units")};
}

Grid read_grid(Parameters& given) {
  return {given.count("width"), given.count("height"), given.number("size")};
}

ImagePlan read_image_plan(Parameters& given, const PredictionRules* rules) {
  ImagePlan plan{.setting = read_setting(given), .grid = read_grid(given)};
  plan.exact = mapped_indices(plan.grid.pixels(), [&](std::size_t i) {
    return exact_moments(plan.setting->scene(), plan.grid.pixel(i));
  });
  const Allocation allocation{static_cast<double>(given.count("samples")),
                              exponents[given.choice<std::size_t>("allocation")]};
  const std::string source = given.string("prediction");
  std::vector<double> variances = exact_variances(plan.exact);
  if (rules || (allocation.exponent > 0 && source != "exact")) {
    const PredictionRules own = source == "covariance" ? covariance_rules() : wave_rules();
    Prediction found = predict(*plan.setting, plan.grid, rules ? *rules : own);
    plan.background = std::move(found.background);
    plan.overhead = found.cost;
    if (source != "exact") variances = std::move(found.variance);
  }
  plan.counts = lens_counts(variances, allocation);
  return plan;
}

NoiseExtremes noise_extremes(const ImagePlan& plan) {
  NoiseExtremes out;
  double most = 0;
  double least = std::numeric_limits<double>::infinity();
  const std::vector<double> variances = exact_variances(plan.exact);
  for (std::size_t i = 0; i < variances.size(); ++i) {
    const double noise = variances[i] / static_cast<double>(plan.counts[i]);
    if (noise > most) out.worst = i, most = noise;
    if (noise > 0 && noise < least) out.quietest = i, least = noise;
  }
  return out;
}

std::vector<Channel> pixel_channels(const ImagePlan& plan) {
  return mapped_indices(plan.exact.size(), [&](std::size_t i) {
    return radiance_channel(plan.setting->scene(), plan.exact[i],
                            static_cast<double>(plan.counts[i]));
  });
}

}  // namespace assay::depth_of_field

namespace assay::plugins {

// N depends on no sample that is averaged, so E of every pixel is its lens average.
std::vector<Entry> depth_of_field_image() {
  using namespace depth_of_field;
  return {
      {{.name = "depth_of_field/image",
        .summary = "An image behind a thin lens, lens samples allotted by predicted variance.",
        .description =
            "A primary is an image: one camera ray through the middle of the lens for each pixel "
            "and ten for each edge that neighbours see, for the prediction (none with `uniform` "
            "or `exact`), then N lens samples at each pixel, camera rays all. The prediction "
            "carries the waves of each surface to the lens and takes their power off the axis of "
            "no variation, and for an occluder's edge that hides a part c of the lens c (1 - c) "
            "(difference of the means)^2 (Soler, Subr, Durand, Holzschuch and Sillion 2009). It "
            "sees no edge that the middle of the lens does not see, and looks along rows and "
            "columns. N = max(1, K V^exponent), rounded. Means of all pixels, and variances of "
            "one image, are exact. Channels: the pixels; diagnostic ones `worst` and `quietest`, "
            "the pixels of the largest and the least noise V / N above zero by the closed form.",
        .parameters =
            joined(joined({scene_parameter("strip")}, grid_parameters()),
                   {count_parameter("samples", "lens samples a pixel, the mean over the image",
                                    "16", {1, 1e6}),
                    text_parameter("allocation",
                                   "what the number of lens samples of a pixel goes with: "
                                   "nothing, the variance V, V^(2/3) or sqrt V",
                                   "variance", {"uniform", "variance", "two_thirds", "deviation"}),
                    text_parameter("prediction",
                                   "where V is from: waves or their covariance, carried to the "
                                   "lens, or the closed form (an oracle, without rays)",
                                   "waves", {"waves", "covariance", "exact"})})},
       [](Parameters& given) { return image_setup(read_image_plan(given)); }}};
}

}  // namespace assay::plugins
