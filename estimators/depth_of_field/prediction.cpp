#include "depth_of_field/prediction.h"

#include <algorithm>
#include <cmath>

#include "depth_of_field/exact.h"
#include "depth_of_field/spectrum.h"

namespace assay::depth_of_field {

namespace {

// Bisections of an edge between two pixels: it is known to a thousandth of their distance.
constexpr int bisections = 10;

/// A place where a line of pixels passes from one surface to another.
struct Edge {
  double at = 0;  ///< coordinate along the line, on the focal plane
  const Plane* front = nullptr;
  const Plane* back = nullptr;  ///< none is the background
  bool front_is_below = false;  ///< the front lies on the side of smaller coordinates
};

Frequency texture_wave(const Plane& plane) {
  const Texture& t = plane.texture;
  return {t.frequency, 0, t.amplitude * t.amplitude / 2};
}

std::vector<CameraFrequency> texture_waves(const Plane& plane, const Lens& lens) {
  return Spectrum({texture_wave(plane)}).travel(plane.depth).at_camera(lens);
}

/// The light that an edge sends to the camera, as frequencies there. The constant and the wave of
/// the surface behind are carried to the occluder. They and the occluder's own are multiplied by
/// the waves of a step up to `highest`.
std::vector<CameraFrequency> edge_waves(const Edge& edge, const Lens& lens, double highest) {
  std::vector<Frequency> waves;
  if (edge.back) {
    waves =
        Spectrum({texture_wave(*edge.back)}).travel(edge.back->depth - edge.front->depth).waves();
  }
  waves.push_back(texture_wave(*edge.front));
  waves.push_back({0, 0, 1});
  // A step has waves of every length, here a few an octave. How much of each is not asked for.
  std::vector<MaskWave> step;
  for (double k = highest; k > highest / 4096; k *= 0.84) step.push_back({k, 1});
  return Spectrum(std::move(waves)).occlude(step).travel(edge.front->depth).at_camera(lens);
}

/// Traces the pass and looks at its lines.
class Pass {
 public:
  Pass(const Setting& setting, const Grid& grid, const PredictionRules& rules)
      : setting_(setting), grid_(grid), rules_(rules), lens_(setting.scene().lens) {
    for (std::size_t i = 0; i < grid.pixels(); ++i) {
      surface_.push_back(setting.first_hit(grid.pixel(i), {}, out_.cost));
      const Plane* const plane = surface_.back();
      out_.variance.push_back(plane ? rules.texture_variance(*plane, lens_) : 0);
      out_.bandwidth.push_back(plane ? rules.bandwidth(texture_waves(*plane, lens_), lens_) : 0);
      out_.background.push_back(!plane);
    }
  }

  Prediction lines() {
    for (std::size_t y = 0; y < grid_.height; ++y) line(y * grid_.width, 1, grid_.width);
    for (std::size_t x = 0; x < grid_.width; ++x) line(x, grid_.width, grid_.height);
    return std::move(out_);
  }

 private:
  // The edge between a pixel and the next one of a line.
  Edge edge(std::size_t pixel, std::size_t next, bool along_x) {
    const auto coordinate = [&](std::size_t i) {
      return along_x ? grid_.pixel(i).x : grid_.pixel(i).y;
    };
    double low = coordinate(pixel);
    double high = coordinate(next);
    const Plane* const below = surface_[pixel];
    const Plane* above = surface_[next];
    for (int i = 0; i < bisections; ++i) {
      const double middle = (low + high) / 2;
      PlanePoint place = grid_.pixel(pixel);
      (along_x ? place.x : place.y) = middle;
      const Plane* const hit = setting_.first_hit(place, {}, out_.cost);
      (hit == below ? low : high) = middle;
      if (hit != below) above = hit;
    }
    const bool front_is_below = below && (!above || below->depth < above->depth);
    return {(low + high) / 2, front_is_below ? below : above, front_is_below ? above : below,
            front_is_below};
  }

  void line(std::size_t first, std::size_t stride, std::size_t count) {
    const bool along_x = stride == 1;
    std::vector<Edge> edges;
    for (std::size_t i = 0; i + 1 < count; ++i) {
      const std::size_t pixel = first + i * stride;
      if (surface_[pixel] == surface_[pixel + stride]) continue;
      const Edge found = edge(pixel, pixel + stride, along_x);
      if (rules_.occludes(*found.front, lens_)) edges.push_back(found);
    }
    for (const Edge& edge : edges) {
      const double highest = std::numbers::pi / grid_.pitch() * lens_.focus / edge.front->depth;
      const double bandwidth = rules_.bandwidth(edge_waves(edge, lens_, highest), lens_);
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t pixel = first + i * stride;
        const PlanePoint p = grid_.pixel(pixel);
        look(pixel, edge, along_x ? p.x : p.y, bandwidth);
      }
    }
  }

  void look(std::size_t pixel, const Edge& edge, double coordinate, double bandwidth) {
    const Footprint map = footprint(lens_, {}, edge.front->depth);
    // From the pixel to the edge, on the occluder.
    const double distance = (edge.at - coordinate) * edge.front->depth / lens_.focus;
    const double reach = std::abs(map.scale);
    const double pixel_there = grid_.pitch() * edge.front->depth / lens_.focus;
    if (std::abs(distance) < reach + pixel_there) {
      out_.bandwidth[pixel] = std::max(out_.bandwidth[pixel], bandwidth);
    }
    if (std::abs(distance) >= reach) return;
    const double covered =
        half_plane_coverage((edge.front_is_below ? distance : -distance) / reach);
    out_.variance[pixel] = std::max(out_.variance[pixel], total_variance(edge, covered));
  }

  double total_variance(const Edge& edge, double covered) const {
    const double front = rules_.texture_variance(*edge.front, lens_);
    const double back = edge.back ? rules_.texture_variance(*edge.back, lens_) : 0;
    const double mean_back = edge.back ? edge.back->texture.mean : setting_.scene().background;
    const double step = mean_back - edge.front->texture.mean;
    return (1 - covered) * back + covered * front + covered * (1 - covered) * step * step;
  }

  const Setting& setting_;
  const Grid& grid_;
  const PredictionRules& rules_;
  const Lens& lens_;
  std::vector<const Plane*> surface_;
  Prediction out_;
};

}  // namespace

PlanePoint Grid::pixel(std::size_t index) const {
  const auto middle = [&](std::size_t i, std::size_t count) {
    return (static_cast<double>(i) + 0.5 - static_cast<double>(count) / 2) * pitch();
  };
  return {middle(index % width, width), middle(index / width, height)};
}

PredictionRules wave_rules() {
  return {[](const Plane& plane, const Lens& lens) {
    return lens_variance(texture_waves(plane, lens), lens);
  }};
}

PredictionRules covariance_rules() {
  return {[](const Plane& plane, const Lens& lens) {
    const Texture& t = plane.texture;
    return Covariance(t.amplitude * t.amplitude / 2, {.position = t.frequency * t.frequency})
        .travel(plane.depth)
        .lens_variance(lens);
  }};
}

Prediction predict(const Setting& setting, const Grid& grid, const PredictionRules& rules) {
  return Pass(setting, grid, rules).lines();
}

}  // namespace assay::depth_of_field
