#pragma once

// A plugin's internal source of points with the density it declares, testable by itself.

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "estimators/stream.h"

namespace assay {

/// Where points live and the measure of densities.
enum class Domain {
  interval,    ///< x in [low, high]; measure dx. One coordinate.
  square,      ///< (u, v) in [0,1]^2; measure du dv.
  triangle,    ///< (u, v) with u, v >= 0, u + v <= 1 (barycentric); measure du dv.
  hemisphere,  ///< unit vector (x, y, z), z >= 0; measure solid angle.
  sphere,      ///< unit vector (x, y, z); measure solid angle.
};

/// Coordinates of a point of a domain; those the domain does not use are 0.
using Point = std::array<double, 3>;

/// One draw. Where `valid` is false no point came out (a direction below the horizon): this mass is
/// a cell of its own, never redrawn.
struct SamplerDraw {
  Point point{};
  double density = 0;  ///< as declared, at this point
  double weight = 0;   ///< what the estimator multiplies by: evaluate / density
  int lobe = 0;        ///< which discrete choice made the point
  bool valid = true;
};

/// A coordinate of a point under a name: theta and phi of a direction, u and v of a square.
struct Marginal {
  std::string name;
  double low;
  double high;
  double (*coordinate)(const Point&);
};

/// The marginals of a domain. Directions: theta = acos z in [0, pi/2] or [0, pi], phi = atan2(y, x)
/// in [0, 2 pi). Interval: x (its bounds are the sampler's). Square and triangle: u and v.
std::vector<Marginal> marginals(Domain domain);

/// A source of points. Immutable: shared by all workers, its randomness is the stream's.
class Sampler {
 public:
  virtual ~Sampler() = default;
  virtual Domain domain() const = 0;
  /// Bounds of an interval domain.
  virtual std::array<double, 2> bounds() const { return {0, 1}; }
  virtual SamplerDraw sample(Stream& random) const = 0;
  /// The declared density per unit measure; it integrates to 1 - missing mass over the domain.
  virtual double density(const Point& point) const = 0;
  /// The function whose integral the weight estimates (for a BRDF: f cos).
  virtual double evaluate(const Point& point) const = 0;
  /// Largest number of cells along one coordinate on which the density is smooth enough for
  /// quadrature is the tester's business; a narrow lobe may ask for subdivision here.
  virtual int quadrature_subdivision() const { return 1; }
};

}  // namespace assay
