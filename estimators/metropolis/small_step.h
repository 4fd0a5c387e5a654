#pragma once

// How far a small mutation moves one coordinate.

#include <optional>

#include "estimators/stream.h"

namespace assay::metropolis {

/// The fate of a coordinate that steps out of [0, 1). All three keep uniform coordinates uniform
/// and are symmetric: the density to go from u to v is that to go from v to u.
enum class Boundary {
  wrap,     ///< comes in again at the other end
  reflect,  ///< is turned back at the end
  reject,   ///< the whole proposal is rejected
};

/// A step of random sign and of length largest (smallest / largest)^xi (Kelemen et al. 2002,
/// section 3.2). Its density is in proportion to 1 / length between `smallest` and `largest`.
class SmallStep {
 public:
  static constexpr double smallest = 1.0 / 1024;
  static constexpr double largest = 1.0 / 64;

  explicit SmallStep(Boundary boundary) : boundary_(boundary) {}
  virtual ~SmallStep() = default;

  /// The coordinate moved; nothing if the step leaves [0, 1) and is to be rejected.
  std::optional<double> moved(double u, Stream& random) const { return settled(u + step(random)); }
  /// The step with its sign, from one random number.
  virtual double step(Stream& random) const;
  /// The place in [0, 1) of a coordinate in (-1, 2); nullopt if the step is rejected.
  virtual std::optional<double> settled(double u) const;

 private:
  Boundary boundary_;
};

}  // namespace assay::metropolis
