#pragma once

// The radiance of a sky as a function of direction, in closed form or from a picture.

#include <array>
#include <cstddef>
#include <memory>

#include "estimators/parameters.h"
#include "render/environment_map.h"

namespace assay::sky {

using render::Rgb;
using render::Vector3;

// Real spherical harmonics.

inline constexpr std::size_t highest_band = 4;
inline constexpr std::size_t most_harmonics = (highest_band + 1) * (highest_band + 1);

/// Y_00, Y_1-1, Y_10, Y_11, Y_2-2, ...: Y_lm at l (l + 1) + m, up to l = 4.
using Harmonics = std::array<double, most_harmonics>;

/// The orthonormal real harmonics at a unit vector, without the phase (-1)^m: Y_1 is
/// sqrt(3 / 4 pi) (y, z, x), as in Ramamoorthi and Hanrahan (2001), "An efficient representation
/// for irradiance environment maps", equation 3.
Harmonics harmonics(const Vector3& w);

/// A_l, the factor of band l in a convolution with the clamped cosine (the same, equation 8). They
/// are pi, 2 pi / 3, pi / 4, 0, -pi / 24; l at most 4.
double cosine_factor(std::size_t band);

/// A number and a bound of its error.
struct Known {
  double value = 0;
  double error = 0;
};

/// Radiance from all directions. Grey skies have one colour and give it in the first component.
class Radiance {
 public:
  virtual ~Radiance() = default;
  /// 1 or 3.
  virtual std::size_t colours() const { return 1; }
  /// Along a unit vector.
  virtual Rgb operator()(const Vector3& w) const = 0;
  /// The mean over the sphere.
  virtual Rgb mean() const = 0;
  /// The mean of the colours of a value: what samplers of directions follow.
  double grey(const Rgb& rgb) const { return colours() == 1 ? rgb[0] : render::mean(rgb); }
  /// No radiance is above.
  virtual double most(std::size_t colour) const = 0;
  /// The integral of L(w) max(0, n . w) over the sphere, n a unit vector.
  virtual Known irradiance(const Vector3& normal, std::size_t colour) const = 0;
};

using SharedRadiance = std::shared_ptr<const Radiance>;

/// A picture's, constant over each texel.
class Picture final : public Radiance {
 public:
  explicit Picture(render::EnvironmentMap map);

  const render::EnvironmentMap& map() const { return map_; }
  std::size_t colours() const override { return 3; }
  Rgb operator()(const Vector3& w) const override { return map_.radiance(w); }
  Rgb mean() const override { return mean_; }
  double most(std::size_t colour) const override;
  Known irradiance(const Vector3& normal, std::size_t colour) const override;

 private:
  render::EnvironmentMap map_;
  Rgb mean_;
};

/// The parameter `sky`: a map with one of the keys
///   uniform: L
///   gradient: {base: 1, slope: [x, y, z]}       L = base + slope . w
///   harmonics: [nine coefficients of Y_00 ... Y_22]
///   peak: {base: b, height: h, sharpness: k, direction: [x, y, z]}   L = b + h e^(k (cos - 1))
///   map: file.exr
ParameterInformation sky_parameter();

/// Reads it. InputError at the offending place for an unknown or missing key, a number that is not
/// finite, and a picture that render::read_environment() refuses. The same for a radiance that is
/// negative somewhere (of harmonics: at a vertex of the octahedron subdivided six times).
SharedRadiance read_radiance(Parameters&);

}  // namespace assay::sky
