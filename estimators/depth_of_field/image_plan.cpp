#include <limits>

#include "depth_of_field/image.h"

namespace assay::depth_of_field {

namespace {

std::vector<double> exact_variances(const std::vector<Moments>& moments) {
  std::vector<double> out;
  // Below, the difference is rounding.
  for (const Moments& m : moments) {
    out.push_back(m.variance() > 1e-10 * m.square ? m.variance() : 0);
  }
  return out;
}

double exponent(const std::string& allocation) {
  if (allocation == "variance") return 1;
  if (allocation == "two_thirds") return 2.0 / 3;
  return allocation == "deviation" ? 0.5 : 0;
}

}  // namespace

std::vector<ParameterInformation> grid_parameters() {
  return {{.name = "width",
           .type = ParameterType::count,
           .summary = "columns of pixels",
           .fallback = "32",
           .low = 2,
           .high = 1024},
          {.name = "height",
           .type = ParameterType::count,
           .summary = "rows of pixels",
           .fallback = "24",
           .low = 1,
           .high = 1024},
          {.name = "size",
           .summary = "of the image along the width, on the focal plane",
           .unit = "scene units",
           .fallback = "2",
           .low = 0,
           .low_excluded = true}};
}

Grid read_grid(Parameters& given) {
  return {given.count("width"), given.count("height"), given.number("size")};
}

ImagePlan read_image_plan(Parameters& given, const PredictionRules* rules) {
  ImagePlan plan{.setting = read_setting(given), .grid = read_grid(given)};
  for (std::size_t i = 0; i < plan.grid.pixels(); ++i) {
    plan.exact.push_back(exact_moments(plan.setting->scene(), plan.grid.pixel(i)));
  }
  const Allocation allocation{static_cast<double>(given.count("samples")),
                              exponent(given.string("allocation"))};
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

std::vector<Channel> image_channels(const ImagePlan& plan) {
  std::vector<Channel> out;
  const ImageShape shape{plan.grid.width, plan.grid.height, {"radiance"}};
  for (std::size_t i = 0; i < plan.exact.size(); ++i) {
    out.push_back(radiance_channel(plan.setting->scene(), plan.exact[i],
                                   static_cast<double>(plan.counts[i])));
    out.back().name = element_name(shape, i);
  }
  const NoiseExtremes ends = noise_extremes(plan);
  const auto repeat = [&](std::size_t pixel, const char* name) {
    out.push_back(out[pixel]);
    out.back().name = name;
    out.back().diagnostic = true;
  };
  repeat(ends.worst, "worst");
  repeat(ends.quietest, "quietest");
  return out;
}

}  // namespace assay::depth_of_field
