#pragma once

// The numbers that a path is made of, asked for one after the other.

#include "estimators/stream.h"

namespace assay::metropolis {

/// A point of the primary sample space [0, 1)^infinity whose coordinates come into being when they
/// are asked for. It stands where a path tracer has its source of random numbers.
class Coordinates {
 public:
  virtual ~Coordinates() = default;
  /// The next coordinate.
  virtual double uniform() = 0;
};

/// Independent uniform coordinates: plain Monte Carlo.
class IndependentCoordinates final : public Coordinates {
 public:
  explicit IndependentCoordinates(Stream& random) : random_(random) {}
  double uniform() override { return random_.uniform(); }

 private:
  Stream& random_;
};

}  // namespace assay::metropolis
