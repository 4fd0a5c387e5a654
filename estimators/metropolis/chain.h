#pragma once

// One Markov chain as an observation: how it decides, what its steps count for, how it starts.

#include <functional>
#include <memory>
#include <vector>

#include "estimators/estimator.h"
#include "metropolis/coordinates.h"
#include "metropolis/target.h"

namespace assay::metropolis {

/// One step of a chain, from `current` to `proposed`.
struct Step {
  const Contribution& current;   ///< x
  const Contribution& proposed;  ///< y
  double acceptance;             ///< a
  bool large;
  bool accepted;      ///< weights do without it: a is its expectation
  double normaliser;  ///< b, the estimate of the integral of I
};

/// Sums over steps.
struct Tally {
  std::vector<Rgb> pixels;
  double steps = 0;
  double acceptance = 0;

  void add(std::size_t pixel, double weight, const Rgb& value) { pixels[pixel] += weight * value; }
};

/// The factors of F(y) and F(x) in a step.
struct Weights {
  double proposed;
  double current;
};

/// How a chain decides and what its steps count for.
class Rules {
 public:
  virtual ~Rules() = default;
  /// a = min(1, I(y) / I(x)); 1 where I(x) = 0.
  virtual double acceptance(double proposed, double current) const;
  virtual Weights weights(const Step& step) const = 0;
  /// Adds a step to the sums: both ends, each in its own pixel.
  virtual void record(const Step& step, Tally& tally) const;
};

/// Both ends of a step by the expected value (Veach and Guibas 1997): a b / I(y) and (1 - a) b /
/// I(x).
class MeanValueRules : public Rules {
 public:
  Weights weights(const Step& step) const override;
};

/// Weights of multiple importance sampling (Kelemen et al. 2002, section 3.4). Large steps are a
/// second way of sampling, uniform:
///   (a + [large]) / (I(y) / b + p_large)  and  (1 - a) / (I(x) / b + p_large).
class MultipleImportanceRules : public Rules {
 public:
  explicit MultipleImportanceRules(double p_large) : p_large_(p_large) {}
  Weights weights(const Step& step) const override;

 private:
  double p_large_;
};

/// The recipe of a chain and its state.
struct Walker {
  const Target& target;
  LazyCoordinates& coordinates;
  Stream& random;
  Cost& cost;
  Contribution current = {};

  /// The value of a proposal; nothing where it has left the unit cube.
  Contribution propose(bool large);
};

/// Puts the walker at its first state and returns b, the mean of I over `count` independent points.
using Start = double (*)(Walker& walker, std::uint64_t count);

/// The first state is one of the points, drawn in proportion to I. So E[b h(first)] is the integral
/// of h I for every h.
double start_in_proportion(Walker& walker, std::uint64_t count);
/// The first state is another uniform point.
double start_anywhere(Walker& walker, std::uint64_t count);

struct Recipe {
  SharedTarget target;
  double p_large;  ///< probability of a large step, in (0, 1]
  Boundary boundary;
  std::shared_ptr<const SmallStep> step;
  std::shared_ptr<const Rules> rules;
  std::uint64_t bootstrap;  ///< number of points that the start takes b from
  Start start = start_in_proportion;
  /// The coordinates of a worker's chains.
  std::function<std::unique_ptr<LazyCoordinates>(std::shared_ptr<const SmallStep>)> coordinates;
};

/// A secondary estimate is the image of one chain of `primaries` steps. Channels: the image's
/// elements; then diagnostic ones, `image_mean` (of I over the image), `normaliser` (b) and
/// `acceptance` (mean of a).
std::shared_ptr<const Setup> chain(Recipe recipe);

/// Reads a sound chain, started from the bootstrap. Its rules are MultipleImportanceRules where
/// `combined`, else MeanValueRules.
Recipe read_recipe(Parameters& given, bool combined);

}  // namespace assay::metropolis
