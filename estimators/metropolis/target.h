#pragma once

// The integrand of a chain, and targets as a suite states them.

#include <memory>
#include <variant>
#include <vector>

#include "estimators/cost.h"
#include "estimators/estimator.h"
#include "estimators/parameters.h"
#include "metropolis/coordinates.h"
#include "paths/surface.h"

namespace assay::metropolis {

using render::Rgb;

/// The light of one point of the primary sample space.
struct Contribution {
  std::size_t pixel = 0;
  Rgb value;              ///< F, not negative; of a grey target all three are alike
  double importance = 0;  ///< I, the luminance of F: what chains follow
};

/// An image as integrals over the primary sample space. The element of pixel p is the number of
/// pixels times the integral of F(u) [p(u) = p]. So an image is the mean of its points'
/// contributions.
class Target {
 public:
  virtual ~Target() = default;
  virtual ImageShape shape() const = 0;
  /// F at a point whose coordinates are looked at as they are needed. A function of them alone.
  virtual Contribution at(Coordinates& point, Cost& cost) const = 0;
  /// The exact elements of the image, in its order.
  virtual std::vector<double> means() const = 0;
};

using SharedTarget = std::shared_ptr<const Target>;

/// a + b u.
struct Linear {
  double constant = 1;
  double slope = 0;
};
/// e^(-(u - centre)^2 / (2 width^2)).
struct Gaussian {
  double centre;
  double width;
};
/// e^(-rate u), rate above 0.
struct Decay {
  double rate;
};
/// A function of one coordinate, not negative on [0, 1].
using Factor = std::variant<Linear, Gaussian, Decay>;

double value(const Factor& factor, double u);
/// Over [low, high].
double integral(const Factor& factor, double low, double high);

/// The most products of a sum, and the most factors of a product.
inline constexpr std::size_t most_terms = 32;

/// height x the product of the factors of all coordinates.
struct Product {
  double height;
  std::vector<Factor> factors;
};

/// A sum F of products, without units. All have as many factors. The first coordinate runs along a
/// row of pixels. With `coloured` pixel p of n has the colour (1 - 0.8 t, 0.5, 0.2 + 0.8 t), t = p
/// / (n - 1). Throws std::invalid_argument for none, more than most_terms of either, and different
/// numbers of factors.
class ProductTarget final : public Target {
 public:
  ProductTarget(std::vector<Product> sum, std::size_t width, bool coloured);

  ImageShape shape() const override;
  Contribution at(Coordinates& point, Cost& cost) const override;
  std::vector<double> means() const override;

 private:
  std::vector<Product> sum_;
  std::size_t dimensions_;
  std::vector<Rgb> colours_;  ///< of the pixels
  bool coloured_;
};

/// `target` and `pixels`.
std::vector<ParameterInformation> target_parameters();

/// Reads them. A target is a name or a map with one key; all have exact means.
///  `constant        1
///   peak            0.05 + 0.5 u + 40 e^(-((u - 0.3)^2 + (v - 0.7)^2) / (2 x 0.02^2))
///   coloured_peak   the same; each pixel has a colour of its own, red to blue
///   boundary        0.02 + e^(-20 u)
///   mixture, {mixture: {dimensions: D, base: b, lobes: [{height: h, centre: c, width: s}]}}
///                   Gaussian lobes on a base, in D dimensions
///   branches        32 stripes a pixel: 1 in even pixels, a narrow lobe of a second coordinate in
///                   odd ones
///   sphere, coloured_sphere, {sphere: {zones: [...], survival: q}}
///                   radiance of bands of a sphere's wall; zones as in paths/scene_description.h`
///
/// InputError at the offending node: unknown names and keys, missing keys, numbers that are not
/// finite. Also an integrand that is negative or zero everywhere, widths that are not positive,
/// more than 32 coordinates or lobes. Also a survival outside (0, 1), and whatever scenes of paths
/// refuse.
SharedTarget read_target(Parameters& given);

}  // namespace assay::metropolis
