#include "sky/radiance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "estimators/core/value.h"
#include "estimators/parameters.h"
#include "luminaire/scene_description.h"
#include "render/environment_map.h"
#include "render/quadrature.h"
#include "sky/octahedron.h"

namespace assay::sky {

namespace {

using std::numbers::pi;

double factorial(std::size_t n) { return std::tgamma(static_cast<double>(n) + 1); }

// sqrt((2 l + 1) / (4 pi) (l - m)! / (l + m)!), for m > 0 times sqrt(2).
double normalisation(std::size_t l, std::size_t m) {
  const double twice = m == 0 ? 1 : 2;
  return std::sqrt(twice * static_cast<double>(2 * l + 1) / (4 * pi) * factorial(l - m) /
                   factorial(l + m));
}

std::array<double, most_harmonics> normalisations() {
  std::array<double, most_harmonics> table{};
  for (std::size_t l = 0; l <= highest_band; ++l) {
    for (std::size_t m = 0; m <= l; ++m) {
      table[l * (l + 1) + m] = table[l * (l + 1) - m] = normalisation(l, m);
    }
  }
  return table;
}

class Gradient final : public Radiance {
 public:
  Gradient(double base, const Vector3& slope) : base_(base), slope_(slope) {}

  Rgb operator()(const Vector3& w) const override { return {base_ + dot(slope_, w)}; }
  Rgb mean() const override { return {base_}; }
  double most(std::size_t) const override { return base_ + length(slope_); }
  Known irradiance(const Vector3& normal, std::size_t) const override {
    const double value = pi * base_ + 2 * pi / 3 * dot(slope_, normal);
    return {value, 0x1p-48 * value};
  }

 private:
  double base_;
  Vector3 slope_;
};

class HarmonicSky final : public Radiance {
 public:
  explicit HarmonicSky(const std::array<double, 9>& coefficients) : coefficients_(coefficients) {}

  Rgb operator()(const Vector3& w) const override {
    return {sum(w, [](std::size_t) { return 1.0; })};
  }
  Rgb mean() const override { return {coefficients_[0] / std::sqrt(4 * pi)}; }
  // By the addition theorem no Y_lm is above sqrt((2 l + 1) / (4 pi)).
  double most(std::size_t) const override {
    double sum = 0;
    for (std::size_t i = 0; i < coefficients_.size(); ++i) {
      sum += std::abs(coefficients_[i]) * std::sqrt((i == 0 ? 1 : i < 4 ? 3 : 5) / (4 * pi));
    }
    return sum;
  }
  Known irradiance(const Vector3& normal, std::size_t) const override {
    const double value = sum(normal, cosine_factor);
    double most = 0;
    for (const double c : coefficients_) most += std::abs(c);
    return {value, 0x1p-45 * most};
  }

 private:
  template <class Factor>
  double sum(const Vector3& w, const Factor& factor) const {
    const Harmonics y = harmonics(w);
    double total = 0;
    for (std::size_t i = 0; i < coefficients_.size(); ++i) {
      total += factor(i == 0 ? 0 : i < 4 ? 1 : 2) * coefficients_[i] * y[i];
    }
    return total;
  }

  std::array<double, 9> coefficients_;
};

struct Lobe {
  double base = 0;
  double height = 0;
  double sharpness = 0;
  Vector3 direction;
};

// The integral over azimuth of max(0, a + b cos phi), b >= 0.
double clamped_circle(double a, double b) {
  if (a >= b) return 2 * pi * a;
  if (a <= -b) return 0;
  const double edge = std::acos(-a / b);
  return 2 * (a * edge + b * std::sin(edge));
}

class Peak final : public Radiance {
 public:
  explicit Peak(const Lobe& lobe) : lobe_(lobe) {}

  Rgb operator()(const Vector3& w) const override {
    return {lobe_.base + lobe_.height * std::exp(lobe_.sharpness * (dot(w, lobe_.direction) - 1))};
  }
  // The mean of e^(k (c - 1)) for c uniform in [-1, 1].
  Rgb mean() const override {
    return {lobe_.base - lobe_.height * std::expm1(-2 * lobe_.sharpness) / (2 * lobe_.sharpness)};
  }
  double most(std::size_t) const override { return lobe_.base + std::max(0.0, lobe_.height); }
  // About the peak's axis: over rings at the angle gamma, on which the cosine to the normal is
  // a + b cos phi. Kinks where the horizon begins and ends to cut the rings.
  Known irradiance(const Vector3& normal, std::size_t) const override {
    const double beta = render::angle_between(normal, lobe_.direction);
    const auto ring = [&](double gamma) -> std::array<double, 1> {
      const double a = std::cos(beta) * std::cos(gamma);
      const double b = std::sin(beta) * std::sin(gamma);
      const double half = std::sin(gamma / 2);
      return {std::exp(-2 * lobe_.sharpness * half * half) * std::sin(gamma) *
              clamped_circle(a, b)};
    };
    std::vector<double> breaks = {0, pi, std::abs(pi / 2 - beta), pi - std::abs(pi / 2 - beta)};
    // Ten widths of the lobe, so that a narrow one has a piece of its own.
    breaks.push_back(std::min(pi, 10 / std::sqrt(lobe_.sharpness)));
    const auto integral = render::tanh_sinh_pieces<1>(ring, breaks, 1e-14);
    return {pi * lobe_.base + lobe_.height * integral.value[0],
            lobe_.height * (integral.error[0] + 1e-13 * integral.value[0]) + 0x1p-50 * lobe_.base};
  }

 private:
  Lobe lobe_;
};

void require_not_negative(const Value& at, double least) {
  at.require(least >= 0, "parameter `sky`: the radiance falls to " + std::to_string(least) +
                             "; it must not be negative in any direction");
}

SharedRadiance read_gradient(const Value& value) {
  require_keys(value, "`gradient`", {"base", "slope"});
  const double base = finite_number(required_key(value, "`gradient`", "base"), "`base`");
  const Vector3 slope =
      luminaire::read_vector(required_key(value, "`gradient`", "slope"), "`slope`");
  require_not_negative(value, base - length(slope));
  return std::make_shared<Gradient>(base, slope);
}

SharedRadiance read_harmonics(const Value& value) {
  std::array<double, 9> coefficients{};
  value.require(value.items().size() == coefficients.size(),
                "`harmonics` must be a list of nine coefficients");
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    coefficients[i] = finite_number(value.items()[i], "a coefficient of `harmonics`");
  }
  const auto sky = std::make_shared<HarmonicSky>(coefficients);
  const Octahedron grid(6);
  double least = 0;
  for (const Vector3& w : grid.vertices()) least = std::min(least, (*sky)(w)[0]);
  require_not_negative(value, least);
  return sky;
}

SharedRadiance read_peak(const Value& value) {
  require_keys(value, "`peak`", {"base", "height", "sharpness", "direction"});
  const auto at = [&](const char* key) -> const Value& {
    return required_key(value, "`peak`", key);
  };
  const Lobe lobe{.base = finite_number(at("base"), "`base`"),
                  .height = finite_number(at("height"), "`height`"),
                  .sharpness = above_zero(at("sharpness"), "`sharpness`"),
                  .direction = luminaire::read_unit_vector(at("direction"), "`direction`")};
  const double least =
      lobe.base + std::min(lobe.height, lobe.height * std::exp(-2 * lobe.sharpness));
  require_not_negative(value, least);
  return std::make_shared<Peak>(lobe);
}

SharedRadiance read_picture(const Value& value, const Parameters& given) {
  const std::string& name = value.string("`map`");
  const std::string file =
      name.starts_with('/') || given.folder().empty() ? name : given.folder() + "/" + name;
  try {
    return std::make_shared<Picture>(render::read_environment(file));
  } catch (const InputError& error) {
    throw InputError(value.where(), "parameter `sky`: `" + file + "`: " + error.message());
  }
}

}  // namespace

Harmonics harmonics(const Vector3& w) {
  static const auto scale = normalisations();
  Harmonics y{};
  double cosine = 1;    // sin^m theta cos(m phi)
  double sine = 0;      // sin^m theta sin(m phi)
  double diagonal = 1;  // P_mm / sin^m theta = (2 m - 1)!!
  for (std::size_t m = 0; m <= highest_band; ++m) {
    double before = 0;
    double legendre = diagonal;
    for (std::size_t l = m; l <= highest_band; ++l) {
      const std::size_t middle = l * (l + 1);
      y[middle + m] = scale[middle + m] * legendre * cosine;
      if (m > 0) y[middle - m] = scale[middle - m] * legendre * sine;
      const double next =
          (static_cast<double>(2 * l + 1) * w.z * legendre - static_cast<double>(l + m) * before) /
          static_cast<double>(l + 1 - m);
      before = legendre;
      legendre = next;
    }
    diagonal *= static_cast<double>(2 * m + 1);
    const double turned = cosine * w.x - sine * w.y;
    sine = cosine * w.y + sine * w.x;
    cosine = turned;
  }
  return y;
}

double cosine_factor(std::size_t band) {
  constexpr std::array<double, highest_band + 1> factors = {pi, 2 * pi / 3, pi / 4, 0, -pi / 24};
  return factors.at(band);
}

Picture::Picture(render::EnvironmentMap map) : map_(std::move(map)) {
  double area = 0;
  for (std::size_t t = 0; t < map_.size(); ++t) {
    const double part = solid_angle(map_.patch(t));
    area += part;
    mean_ += part * map_.radiance(t);
  }
  mean_ = mean_ / area;
}

double Picture::most(std::size_t colour) const {
  double most = 0;
  for (std::size_t t = 0; t < map_.size(); ++t) most = std::max(most, map_.radiance(t)[colour]);
  return most;
}

Known Picture::irradiance(const Vector3& normal, std::size_t colour) const {
  Known sum;
  for (std::size_t t = 0; t < map_.size(); ++t) {
    const render::CosineMoments moments = cosine_moments(map_.patch(t), normal);
    sum.value += map_.radiance(t)[colour] * moments.first;
    sum.error += map_.radiance(t)[colour] * moments.error;
  }
  // The rounding of a sum of n terms that are not negative is at most n 2^-53 of it.
  sum.error += static_cast<double>(map_.size()) * 0x1p-53 * sum.value;
  return sum;
}

ParameterInformation sky_parameter() {
  return structure_parameter("sky", "the sky: one of uniform, gradient, harmonics, peak, map",
                             "{uniform: 1}");
}

SharedRadiance read_radiance(Parameters& given) {
  const Value& sky = given.structure("sky");
  given.require(sky.members().size() == 1, "sky",
                "must be a map with one key: uniform, gradient, harmonics, peak or map");
  require_keys(sky, "the sky", {"uniform", "gradient", "harmonics", "peak", "map"});
  const auto& [kind, value] = sky.members()[0];
  if (kind == "uniform") {
    const double level = finite_number(value, "`uniform`");
    require_not_negative(value, level);
    return std::make_shared<Gradient>(level, Vector3{});
  }
  if (kind == "gradient") return read_gradient(value);
  if (kind == "harmonics") return read_harmonics(value);
  if (kind == "peak") return read_peak(value);
  return read_picture(value, given);
}

}  // namespace assay::sky
