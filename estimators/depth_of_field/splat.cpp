#include "depth_of_field/splat.h"

#include <algorithm>
#include <numbers>

namespace assay::depth_of_field {

namespace {

/// The samples of one tile whose first pixel is (x0, y0).
void add_tile(std::vector<ImageSample>& out, const Grid& grid, const ImageSample& first) {
  const std::size_t x_end = std::min(first.x + tile_side, grid.width);
  const std::size_t y_end = std::min(first.y + tile_side, grid.height);
  for (std::size_t y = first.y; y < y_end; y += first.spacing) {
    for (std::size_t x = first.x; x < x_end; x += first.spacing) {
      out.push_back({x, y, first.spacing});
    }
  }
}

double highest(const Grid& grid, std::span<const double> bandwidth, const ImageSample& first) {
  double most = 0;
  for (std::size_t y = first.y; y < std::min(first.y + tile_side, grid.height); ++y) {
    for (std::size_t x = first.x; x < std::min(first.x + tile_side, grid.width); ++x) {
      most = std::max(most, bandwidth[y * grid.width + x]);
    }
  }
  return most;
}

template <class Spacing>
std::vector<ImageSample> tiles(const Grid& grid, const Spacing& spacing) {
  std::vector<ImageSample> out;
  for (std::size_t y = 0; y < grid.height; y += tile_side) {
    for (std::size_t x = 0; x < grid.width; x += tile_side) {
      add_tile(out, grid, {x, y, spacing(ImageSample{x, y})});
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
    const double most = highest(grid, bandwidth, first);
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

}  // namespace assay::depth_of_field
