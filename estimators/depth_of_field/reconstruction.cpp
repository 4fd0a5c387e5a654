#include "depth_of_field/reconstruction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "depth_of_field/image.h"
#include "estimators/core/mapped.h"
#include "estimators/parameters.h"

namespace assay::depth_of_field {

namespace {

/// Calls `visit(x, y)` for pixels of the tile that begins at `first`, so far apart.
void visit_tile(const Grid& grid, const ImageSample& first, const auto& visit) {
  for (std::size_t y = first.y; y < std::min(first.y + tile_side, grid.height);
       y += first.spacing) {
    for (std::size_t x = first.x; x < std::min(first.x + tile_side, grid.width);
         x += first.spacing) {
      visit(x, y);
    }
  }
}

/// `spacing` gives that of a tile by its first pixel.
std::vector<ImageSample> tiles(const Grid& grid, const auto& spacing) {
  std::vector<ImageSample> out;
  for (std::size_t y = 0; y < grid.height; y += tile_side) {
    for (std::size_t x = 0; x < grid.width; x += tile_side) {
      const ImageSample first{x, y, spacing(ImageSample{x, y})};
      visit_tile(grid, first, [&](std::size_t u, std::size_t v) {
        out.push_back({u, v, first.spacing});
      });
    }
  }
  return out;
}

double tent(std::size_t a, std::size_t b, std::size_t reach) {
  const double distance = static_cast<double>(a > b ? a - b : b - a);
  return std::max(0.0, 1 - distance / static_cast<double>(reach));
}

}  // namespace

std::vector<ImageSample> regular_samples(const Grid& grid, std::size_t spacing) {
  return tiles(grid, [&](const ImageSample&) { return spacing; });
}

std::vector<ImageSample> samples_by_bandwidth(const Grid& grid, std::span<const double> bandwidth) {
  return tiles(grid, [&](const ImageSample& first) {
    double most = 0;
    visit_tile(grid, first, [&](std::size_t x, std::size_t y) {
      most = std::max(most, bandwidth[y * grid.width + x]);
    });
    std::size_t spacing = tile_side;
    while (spacing > 1 && static_cast<double>(spacing) * grid.pitch() * most > std::numbers::pi) {
      spacing /= 2;
    }
    return spacing;
  });
}

Splats tents(const Grid& grid, std::span<const ImageSample> samples) {
  Splats out(grid.pixels());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const ImageSample& s = samples[i];
    const std::size_t x0 = s.x < s.spacing ? 0 : s.x - s.spacing;
    const std::size_t y0 = s.y < s.spacing ? 0 : s.y - s.spacing;
    for (std::size_t y = y0; y < std::min(s.y + s.spacing, grid.height); ++y) {
      for (std::size_t x = x0; x < std::min(s.x + s.spacing, grid.width); ++x) {
        const double weight = tent(x, s.x, s.spacing) * tent(y, s.y, s.spacing);
        if (weight > 0) out[y * grid.width + x].push_back({i, weight});
      }
    }
  }
  return out;
}

Splats normalised(Splats splats) {
  for (std::vector<Share>& shares : splats) {
    double sum = 0;
    for (const Share& share : shares) sum += share.weight;
    for (Share& share : shares) share.weight /= sum;
  }
  return splats;
}

ReconstructionPlan read_reconstruction_plan(Parameters& given, const ReconstructionRules& rules) {
  const std::uint64_t spacing = given.count("spacing");
  given.require(spacing <= tile_side && (spacing & (spacing - 1)) == 0, "spacing",
                "must be 0 (by the predicted bandwidth), 1, 2, 4 or 8 pixels");
  ReconstructionPlan plan{.setting = read_setting(given), .grid = read_grid(given)};
  const Prediction found = predict(*plan.setting, plan.grid, rules.prediction);
  plan.overhead = found.cost;
  plan.samples = spacing > 0 ? regular_samples(plan.grid, spacing)
                             : samples_by_bandwidth(plan.grid, found.bandwidth);
  std::vector<double> variances;
  for (const ImageSample& s : plan.samples) variances.push_back(found.variance[plan.pixel_of(s)]);
  plan.counts = lens_counts(variances, {static_cast<double>(given.count("samples"))});
  plan.splats = rules.weights(tents(plan.grid, plan.samples));
  plan.exact = mapped_indices(plan.grid.pixels(), [&](std::size_t p) {
    return exact_moments(plan.setting->scene(), plan.grid.pixel(p));
  });
  return plan;
}

std::vector<double> ReconstructionPlan::bias() const {
  return mapped_indices(splats.size(), [&](std::size_t p) {
    double sum = -exact[p].mean;
    for (const Share& share : splats[p]) {
      sum += share.weight * exact[pixel_of(samples[share.sample])].mean;
    }
    return sum;
  });
}

std::shared_ptr<const Setup> prepare_reconstruction(Parameters& given,
                                                    const ReconstructionRules& rules) {
  const auto plan =
      std::make_shared<const ReconstructionPlan>(read_reconstruction_plan(given, rules));
  const std::vector<double> bias = plan->bias();
  const auto size = [](double x) { return std::abs(x); };
  const auto worst =
      static_cast<std::size_t>(std::ranges::max_element(bias, {}, size) - bias.begin());
  const auto estimate = [plan, worst, values = std::vector<double>(plan->samples.size())](
                            Stream& random, std::uint64_t primaries, std::span<double> out,
                            Cost& cost) mutable {
    for (std::size_t i = 0; i < values.size(); ++i) {
      Stream mine = random.substream(static_cast<std::uint32_t>(i));
      const PlanePoint pixel = plan->grid.pixel(plan->pixel_of(plan->samples[i]));
      const std::uint64_t count = primaries * plan->counts[i];
      double sum = 0;
      for (std::uint64_t k = 0; k < count; ++k) {
        sum += plan->setting->radiance(pixel, lens_point(mine), cost);
      }
      values[i] = sum / static_cast<double>(count);
    }
    for (std::size_t p = 0; p < plan->splats.size(); ++p) {
      double sum = 0;
      for (const Share& share : plan->splats[p]) sum += share.weight * values[share.sample];
      out[p] = sum;
    }
    out[plan->splats.size()] = out[worst];
    cost.camera_rays += primaries * plan->overhead.camera_rays;
    cost.samples += primaries;
  };
  const std::vector<Channel> pixels = mapped(plan->exact, [&](const Moments& exact) {
    Channel channel = radiance_channel(plan->setting->scene(), exact);
    channel.variance.reset();
    return channel;
  });
  return setup_of({.channels = {repeated(pixels[worst], "worst")},
                   .make = estimating(estimate),
                   .samplers = lens_samplers<>(),
                   .image = ImageShape{plan->grid.width, plan->grid.height, {"radiance"}, false},
                   .elements = pixels});
}

}  // namespace assay::depth_of_field

namespace assay::plugins {

// The lens averages are unbiased: E of a pixel is the interpolant of the exact means.
std::vector<Entry> depth_of_field_reconstruction() {
  using namespace depth_of_field;
  return {
      {{.name = "depth_of_field/reconstruction",
        .summary =
            "An image behind a thin lens, sampled sparsely where it is blurred, and splatted.",
        .description =
            "The prediction of depth_of_field/image gives each pixel the highest frequency B that "
            "the image has there: of the waves of textures and edges those that the lens lets "
            "through, radius |W| below the first zero 3.83 of 2 J1(z) / z. Tiles of 8 x 8 pixels "
            "get samples 1, 2, 4 or 8 pixels apart, the most that leaves two a period, pi / B "
            "(Soler, Subr, Durand, Holzschuch and Sillion 2009, whose samples are scattered). Each "
            "sample is the mean of N lens samples, N = max(1, K V); each pixel the mean of samples "
            "weighted by tents as wide as their spacing, divided by the sum of weights. Channels: "
            "the pixels, with their lens averages as means, which the reconstruction approaches "
            "like spacing^2 where the image is smooth; diagnostic: `worst`, the pixel that it is "
            "farthest off from.",
        .parameters = joined(
            joined({scene_parameter("portrait")}, grid_parameters()),
            {count_parameter("samples", "lens samples an image sample, the mean over the image",
                             "16", {1, 1e6}),
             count_parameter("spacing",
                             "of image samples: 1, 2, 4 or 8, or 0 for what the prediction says",
                             "0", {0, 8}, "pixels")}),
        .bias = BiasClass::reconstruction},
       [](Parameters& given) { return prepare_reconstruction(given); }}};
}

}  // namespace assay::plugins
