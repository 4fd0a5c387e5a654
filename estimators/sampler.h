#pragma once

// A plugin's internal source of points with the density it declares, testable by itself.

#include <array>
#include <cstddef>
#include <limits>
#include <span>
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

/// Numbers of equal parts of the ranges of a domain's coordinates (x; u and v; theta and phi) in
/// which a density shows itself to a few nodes: a part is no wider than the narrowest lobe, and
/// jumps along lines of a coordinate lie on borders of parts.
struct Panels {
  std::size_t first = 1;
  std::size_t second = 1;
};

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
  /// What rounding may leave of weight x density(point) against evaluate(point), and of a draw's
  /// density against density(point), relative. A point that is computed, stored and read again
  /// loses some digits where a lobe is narrow.
  virtual double rounding() const { return 1e-9; }
  /// How finely a quadrature of the density must look.
  virtual Panels panels() const { return {}; }
  /// The discrete choices that a draw's `lobe` numbers from 0.
  virtual int lobes() const { return 1; }
  /// What a lobe adds to density(): its probability times its own density. They sum to density().
  virtual double lobe_density(int /*lobe*/, const Point& point) const { return density(point); }
  /// Probability of a lobe that has no density but sits on points, as a mirror's does: no part of
  /// density(), and all its draws are one cell.
  virtual double point_mass(int /*lobe*/) const { return 0; }

  /// The same of many streams or points at a time, for a sampler that another process must be asked
  /// for: each question then takes some microseconds, however many it is about. They write the
  /// numbers of the first few, at least one, and return of how many; who wants the others asks
  /// again. What one cannot be had of is thrown where it is the first.
  virtual std::size_t samples(std::span<Stream> random, std::span<SamplerDraw> draws) const;
  virtual std::size_t densities(std::span<const Point> points, std::span<double> out) const;
  virtual std::size_t lobe_densities(int lobe, std::span<const Point> points,
                                     std::span<double> out) const;
  virtual std::size_t evaluations(std::span<const Point> points, std::span<double> out) const;
  /// Whether it is such a sampler.
  virtual bool is_elsewhere() const { return false; }
  /// CPU seconds that other processes have spent so far on what the calling thread asked.
  virtual double seconds_elsewhere() const { return 0; }
};

}  // namespace assay
