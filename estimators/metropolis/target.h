#pragma once

// The integrand of a chain.

#include <memory>
#include <vector>

#include "estimators/cost.h"
#include "estimators/image.h"
#include "metropolis/coordinates.h"
#include "paths/spectrum.h"

namespace assay::metropolis {

using paths::Spectrum;

/// The light of one point of the primary sample space.
struct Contribution {
  std::size_t pixel = 0;
  Spectrum value;         ///< F, not negative; of a grey target all three are alike
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
  /// The exact elements of the image, in its order, as far as they are known.
  virtual std::vector<double> means() const { return {}; }
};

using SharedTarget = std::shared_ptr<const Target>;

/// The colour of an element: red, green or blue; of a grey target red stands for all.
inline double component(const Spectrum& s, std::size_t index) {
  return index == 0 ? s.red : index == 1 ? s.green : s.blue;
}

}  // namespace assay::metropolis
