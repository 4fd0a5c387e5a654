#include "render/environment_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace assay::render {

namespace {

using std::numbers::pi;

bool is_radiance(const Rgb& texel) {
  return std::ranges::all_of(texel, [](double x) { return std::isfinite(x) && x >= 0; });
}

// The cell of [0, 1) cut into `count` that x falls in; rounding must not lead outside.
std::size_t cell(double x, std::size_t count) {
  const double scaled = std::max(x, 0.0) * static_cast<double>(count);
  return std::min(static_cast<std::size_t>(scaled), count - 1);
}

}  // namespace

double solid_angle(const Patch& patch) {
  // cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2) does not cancel at the poles.
  const double middle = (patch.theta[0] + patch.theta[1]) / 2;
  const double half = (patch.theta[1] - patch.theta[0]) / 2;
  return (patch.phi[1] - patch.phi[0]) * 2 * std::sin(middle) * std::sin(half);
}

Vector3 direction_in(const Patch& patch, std::array<double, 2> uv) {
  const double top = std::cos(patch.theta[0]);
  const double z = top + uv[0] * (std::cos(patch.theta[1]) - top);
  const double phi = patch.phi[0] + uv[1] * (patch.phi[1] - patch.phi[0]);
  const double sine = std::sqrt((1 - z) * (1 + z));
  return {sine * std::cos(phi), sine * std::sin(phi), z};
}

EnvironmentMap::EnvironmentMap(Resolution resolution, std::vector<Rgb> texels)
    : resolution_(resolution), texels_(std::move(texels)) {
  if (texels_.empty() || texels_.size() != resolution_.width * resolution_.height) {
    throw std::invalid_argument("EnvironmentMap: the number of texels must be width x height > 0");
  }
  if (!std::ranges::all_of(texels_, is_radiance)) {
    throw std::invalid_argument("EnvironmentMap: radiance must be finite and not negative");
  }
}

std::size_t EnvironmentMap::texel(const Vector3& w) const {
  const double theta = std::atan2(std::hypot(w.x, w.y), w.z);
  const double angle = std::atan2(w.y, w.x);
  const double phi = angle < 0 ? angle + 2 * pi : angle;
  return cell(theta / pi, resolution_.height) * resolution_.width +
         cell(phi / (2 * pi), resolution_.width);
}

Patch EnvironmentMap::patch(std::size_t texel) const {
  const auto row = static_cast<double>(texel / resolution_.width);
  const auto column = static_cast<double>(texel % resolution_.width);
  const auto rows = static_cast<double>(resolution_.height);
  const auto columns = static_cast<double>(resolution_.width);
  return {.theta = {pi * row / rows, pi * (row + 1) / rows},
          .phi = {2 * pi * column / columns, 2 * pi * (column + 1) / columns}};
}

}  // namespace assay::render
