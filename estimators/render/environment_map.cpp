#include "render/environment_map.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "estimators/core/value.h"
#include "estimators/picture_file.h"
#include "render/quadrature.h"

namespace assay::render {

namespace {

using std::numbers::pi;
using Pair = std::array<double, 2>;

bool is_radiance(const Rgb& texel) {
  return std::ranges::all_of(texel.values, [](double x) { return std::isfinite(x) && x >= 0; });
}

// The cell of [0, 1) cut into `count` that x falls in; rounding must not lead outside.
std::size_t cell(double x, std::size_t count) {
  const double scaled = std::max(x, 0.0) * static_cast<double>(count);
  return std::min(static_cast<std::size_t>(scaled), count - 1);
}

double cubed(double x) { return x * x * x; }

// Integrals over theta of sin^2, sin cos, sin^3, sin^2 cos and sin cos^2.
struct PolarIntegrals {
  double ss, sc, sss, ssc, scc;

  explicit PolarIntegrals(Pair theta) {
    const auto [a, b] = theta;
    const double sine_a = std::sin(a), sine_b = std::sin(b);
    const double cosine_a = std::cos(a), cosine_b = std::cos(b);
    ss = (b - a) / 2 - std::cos(a + b) * std::sin(b - a) / 2;
    sc = std::sin(a + b) * std::sin(b - a) / 2;
    scc = (cubed(cosine_a) - cubed(cosine_b)) / 3;
    sss = cosine_a - cosine_b - scc;
    ssc = (cubed(sine_b) - cubed(sine_a)) / 3;
  }
};

// n . w = P sin theta + Q cos theta along a meridian: P = nx cos phi + ny sin phi, Q = nz.
Pair whole_patch(const Patch& patch, const Vector3& n) {
  const PolarIntegrals polar(patch.theta);
  const auto [c, d] = patch.phi;
  const double width = d - c;
  const double of_p = n.x * (std::sin(d) - std::sin(c)) + n.y * (std::cos(c) - std::cos(d));
  const double twice = (std::sin(2 * d) - std::sin(2 * c)) / 4;
  const double product = std::sin(d + c) * std::sin(d - c);
  const double of_pp =
      n.x * n.x * (width / 2 + twice) + n.y * n.y * (width / 2 - twice) + n.x * n.y * product;
  return {of_p * polar.ss + n.z * width * polar.sc,
          of_pp * polar.sss + 2 * of_p * n.z * polar.ssc + n.z * n.z * width * polar.scc};
}

// Both moments along the meridian at phi. In (0, pi) P sin + Q cos has one zero, at (sin, cos) ~
// (|Q|, -P sign Q). It is positive before the zero if Q > 0, after it if Q < 0.
Pair along_meridian(Pair theta, const Vector3& n, double phi) {
  const double p = n.x * std::cos(phi) + n.y * std::sin(phi);
  const double q = n.z;
  if (q == 0 && p <= 0) return {0, 0};
  if (q != 0) {
    const double zero = std::atan2(std::abs(q), q > 0 ? -p : p);
    double& end = q > 0 ? theta[1] : theta[0];
    end = std::clamp(zero, theta[0], theta[1]);
  }
  const PolarIntegrals polar(theta);
  return {p * polar.ss + q * polar.sc,
          p * p * polar.sss + 2 * p * q * polar.ssc + q * q * polar.scc};
}

// The ends of the patch in azimuth, and the azimuths between them at which the horizon meets one of
// its parallels. Also those at which it is steepest: a near-vertical horizon runs from pole to pole
// there.
std::vector<double> breaks(const Patch& patch, const Vector3& n) {
  const auto [c, d] = patch.phi;
  std::vector<double> all{c, d};
  const double radius = std::hypot(n.x, n.y);
  const double towards = std::atan2(n.y, n.x);
  const auto add = [&](double cosine) {
    if (!(std::abs(cosine) <= 1)) return;
    for (const double offset : {std::acos(cosine), -std::acos(cosine)}) {
      const double phi = towards + offset;
      const double turned = phi - 2 * pi * std::floor((phi - c) / (2 * pi));
      if (turned < d) all.push_back(turned);
    }
  };
  // radius cos(phi - towards) sin theta + nz cos theta = 0
  for (const double theta : patch.theta) {
    add(-n.z * std::cos(theta) / (radius * std::sin(theta)));
  }
  add(0);
  return all;
}

CosineMoments crossed(const Patch& patch, const Vector3& n) {
  std::vector<double> ends = breaks(patch, n);
  const auto meridian = [&](double phi) { return along_meridian(patch.theta, n, phi); };
  const Integrals<2> total = tanh_sinh_pieces<2>(meridian, ends, 1e-12);
  return {.first = total.value[0],
          .second = total.value[1],
          .error = std::max(total.error[0], total.error[1])};
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

CosineMoments cosine_moments(const Patch& patch, const Vector3& normal) {
  // No point of the patch is farther from its middle than its height plus half its widest parallel.
  const Vector3 middle = direction_in(patch, {0.5, 0.5});
  const double radius = patch.theta[1] - patch.theta[0] + (patch.phi[1] - patch.phi[0]) / 2;
  const double height = std::asin(std::clamp(dot(normal, middle), -1.0, 1.0));
  if (height < -radius) return {};
  if (height <= radius) return crossed(patch, normal);
  const Pair exact = whole_patch(patch, normal);
  return {.first = exact[0], .second = exact[1]};
}

EnvironmentMap read_environment(const std::string& file) {
  const std::unique_ptr<const PictureFile> picture = open_picture(file);
  std::vector<std::string> names{"Y"};
  if (picture->has({"R", "G", "B"})) names = {"R", "G", "B"};
  picture->require(picture->has(names), "the picture needs the channels R, G and B, or Y; it has " +
                                            listed(picture->channel_names()));
  const PictureWindow window = picture->window(names);
  picture->require(window == picture->canvas(),
                   "the picture is cropped: its data window must be its display window");
  std::vector<float> read(window.width * window.height * names.size());
  picture->read(names, read);
  std::vector<Rgb> texels(window.width * window.height);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      texels[i][c] = read[i * names.size() + std::min(c, names.size() - 1)];
      if (std::isfinite(texels[i][c]) && texels[i][c] >= 0) continue;
      std::ostringstream why;
      why << "the texel in row " << i / window.width << ", column " << i % window.width << " is "
          << texels[i][c] << "; radiance must be finite and not negative";
      picture->refuse(why.str());
    }
  }
  return {{window.width, window.height}, std::move(texels)};
}

}  // namespace assay::render
