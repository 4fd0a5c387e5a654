#pragma once

// A plugin's internal source of points with the density it declares, testable by itself.

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "estimators/stream.h"

namespace assay {

/// The domain of points, and the measure of densities.
enum class Domain {
  interval,    ///< Point x in [low, high]; measure dx. One coordinate.
  square,      ///< Point (u, v) in [0,1]^2; measure du dv.
  triangle,    ///< Point (u, v), u, v >= 0, u + v <= 1 (barycentric); measure du dv.
  hemisphere,  ///< Unit vector (x, y, z), z >= 0; measure solid angle.
  sphere,      ///< Unit vector (x, y, z); measure solid angle.
};

/// True if points are directions.
constexpr bool has_directions(Domain domain) {
  return domain == Domain::hemisphere || domain == Domain::sphere;
}

/// Numbers of a point that the domain uses.
constexpr std::size_t coordinates(Domain domain) {
  return domain == Domain::interval ? 1 : has_directions(domain) ? 3 : 2;
}

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

  bool operator==(const SamplerDraw&) const = default;
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

/// Numbers of equal parts of a domain's coordinates (x; u and v; theta and phi), for quadrature by
/// a few nodes a part. A part is no wider than the narrowest lobe. Jumps along lines of a
/// coordinate lie on borders of parts.
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
  /// Relative rounding of weight x density(point) against evaluate(point), and of a draw's density
  /// against density(point). A point that is stored and read again loses some digits if a lobe is
  /// narrow.
  virtual double rounding() const { return 1e-9; }
  /// How finely a quadrature of the density must look.
  virtual Panels panels() const { return {}; }
  /// The discrete choices that a draw's `lobe` numbers from 0.
  virtual int lobes() const { return 1; }
  /// The part of density() of one lobe: its probability times its own density. They sum to
  /// density().
  virtual double lobe_density(int /*lobe*/, const Point& point) const { return density(point); }
  /// Probability of a lobe that has no density but sits on points, as a mirror's does. It is no
  /// part of density(). All its draws are one cell.
  virtual double point_mass(int /*lobe*/) const { return 0; }

  /// The same of many streams or points at a time, for a sampler in another process: each question
  /// takes some microseconds, of any length. They write the numbers of the first few, at least one,
  /// and return how many. Ask again for the others. An exception concerns the first. The streams
  /// stay as they are: who asks again gets the draws of a single question.
  virtual std::size_t samples(std::span<const Stream> random, std::span<SamplerDraw> draws) const;
  virtual std::size_t densities(std::span<const Point> points, std::span<double> out) const;
  std::size_t lobe_densities(int lobe, std::span<const Point> points, std::span<double> out) const;
  virtual std::size_t evaluations(std::span<const Point> points, std::span<double> out) const;
  /// CPU seconds that other processes have spent so far on what the calling thread asked.
  virtual double seconds_elsewhere() const { return 0; }
};

/// The parts of a sampler whose draws are of one lobe. A draw's density is density() at its point,
/// its weight evaluate() over that.
struct SamplerParts {
  Domain domain = Domain::interval;
  std::function<std::optional<Point>(Stream&)> point;  ///< nullopt where none comes out
  std::function<double(const Point&)> density;
  std::function<double(const Point&)> evaluate = {};  ///< if empty, the density: every weight is 1
  std::array<double, 2> bounds = {0, 1};
  Panels panels = {};
};
std::shared_ptr<const Sampler> sampler_of(SamplerParts parts);

/// The density of points that are uniform in their domain.
inline std::function<double(const Point&)> uniform_density(double density) {
  return [density](const Point&) { return density; };
}

}  // namespace assay
