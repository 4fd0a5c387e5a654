#pragma once

// One Markov chain as an observation.

#include <functional>
#include <memory>

#include "estimators/estimator.h"
#include "metropolis/rules.h"

namespace assay::metropolis {

struct Recipe {
  SharedTarget target;
  double p_large;  ///< probability of a large step, in (0, 1]
  std::shared_ptr<const SmallStep> step;
  std::shared_ptr<const Rules> rules;
  std::shared_ptr<const Start> start;
  /// The coordinates of a worker's chains.
  std::function<std::unique_ptr<LazyCoordinates>(std::shared_ptr<const SmallStep>)> coordinates;
};

/// Coordinates as they should be.
std::unique_ptr<LazyCoordinates> lazy_coordinates(std::shared_ptr<const SmallStep> step);

/// A secondary estimate is the image of one chain of `primaries` steps. Channels: the image's
/// elements; then diagnostic ones, `image_mean` (of I over the image), `normaliser` (b) and
/// `acceptance` (mean of a).
std::shared_ptr<const Setup> chain(Recipe recipe);

/// A secondary estimate is the image of `primaries` independent points: what chains are held
/// against. Channels: the image's elements and `image_mean`.
std::shared_ptr<const Setup> independent(SharedTarget target);

}  // namespace assay::metropolis
