#pragma once

// Radiance from all directions, as a latitude-longitude picture.

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "render/rgb.h"
#include "render/vector.h"

namespace assay::render {

/// Directions with polar angle in [theta[0], theta[1]] and azimuth in [phi[0], phi[1]], radians.
struct Patch {
  std::array<double, 2> theta;
  std::array<double, 2> phi;
};

/// Solid angle (phi1 - phi0)(cos theta0 - cos theta1).
double solid_angle(const Patch&);

/// The direction of a patch at (u, v) in [0, 1)^2; uniform in solid angle if (u, v) is uniform.
Vector3 direction_in(const Patch&, std::array<double, 2> uv);

/// Columns and rows.
struct Resolution {
  std::size_t width = 0;
  std::size_t height = 0;
};

/// Radiance that is constant over each texel, w = (sin theta cos phi, sin theta sin phi, cos
/// theta). Row r of H holds the polar angles pi r / H to pi (r + 1) / H. The pole +z is in the
/// first row. Column c of W holds the azimuths 2 pi c / W to 2 pi (c + 1) / W.
class EnvironmentMap {
 public:
  /// Texels row after row. std::invalid_argument unless there are width * height > 0 of them, all
  /// finite and not negative.
  EnvironmentMap(Resolution, std::vector<Rgb> texels);

  const Resolution& resolution() const { return resolution_; }
  std::size_t size() const { return texels_.size(); }
  const Rgb& radiance(std::size_t texel) const { return texels_[texel]; }
  const Rgb& radiance(const Vector3& direction) const { return texels_[texel(direction)]; }
  /// The texel that a direction, not necessarily of unit length, falls in.
  std::size_t texel(const Vector3& direction) const;
  Patch patch(std::size_t texel) const;

 private:
  Resolution resolution_;
  std::vector<Rgb> texels_;
};

/// Reads a picture with the channels R, G and B, or Y for grey (open_picture). InputError at
/// `file`, without a line, if it has not these channels or is cropped: its data window is not the
/// display window. The same for a texel that is negative or not finite.
EnvironmentMap read_environment(const std::string& file);

/// Integrals of max(0, n . w)^k over a patch, k = 1 and 2.
struct CosineMoments {
  double first = 0;
  double second = 0;
  double error = 0;  ///< bound of the error of either
};

/// The moments in closed form if the patch is wholly above or below the horizon of the unit vector
/// `normal`. If the horizon may cross it, they have a closed form along each meridian. Quadrature
/// over the azimuth runs between the points where the horizon enters and leaves.
CosineMoments cosine_moments(const Patch&, const Vector3& normal);

}  // namespace assay::render
