#pragma once

// Pairs of an integrand and a control at the same random point, and sums over them. Source: Szecsi,
// Sbert and Szirmay-Kalos 2004, "Combined correlated and importance sampling in direct light source
// computation and environment mapping".
//
// The integrand is f, the density of the points p, and the control g has the known integral J:
//   I^ = (1/M) sum over M points of f/p + lambda (J - g/p).
// Importance sampling is lambda = 0, correlated sampling lambda = 1. A lambda that does not depend
// on the points leaves I^ unbiased. The variance is least at lambda* = Cov(f/p, g/p) / Var(g/p).

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "estimators/estimator.h"
#include "render/environment_map.h"

namespace assay::correlated {

using render::Rgb;

/// f/p and g/p of one random point, a number for each colour; grey sources use the first alone.
struct Pair {
  Rgb full{};
  Rgb control{};
};

/// Second moments of a pair.
struct Moments {
  double full = 0;     ///< E[(f/p)^2]
  double product = 0;  ///< E[(f/p) (g/p)]
  double control = 0;  ///< E[(g/p)^2]
};

struct Colour {
  std::string name;
  double control_integral = 0;          ///< J
  std::optional<double> integral = {};  ///< I, the integral of f
  double integral_error = 0;            ///< bound of its error
  std::optional<Moments> moments = {};  ///< where they are exact
};

/// Draws pairs. Immutable, shared by all workers.
class PairSource {
 public:
  virtual ~PairSource() = default;
  virtual const std::vector<Colour>& colours() const = 0;
  virtual void draw(Stream& random, std::span<Pair> out, Cost& cost) const = 0;
  virtual std::vector<NamedSampler> samplers() const { return {}; }
};

using SharedPairs = std::shared_ptr<const PairSource>;

/// Draws `count` pairs in batches and gives each to `use`.
template <class Use>
void for_each_pair(const PairSource& source, std::uint64_t count, Stream& random, Cost& cost,
                   const Use& use) {
  std::array<Pair, 32> batch;
  for (std::uint64_t done = 0; done < count; done += batch.size()) {
    const std::size_t size = std::min<std::uint64_t>(batch.size(), count - done);
    source.draw(random, std::span(batch).first(size), cost);
    for (std::size_t i = 0; i < size; ++i) use(batch[i]);
  }
  cost.samples += count;
}

/// Sums over samples of one colour; d = J - g/p is what the control lacks.
struct Sums {
  double count = 0;
  double full = 0;          ///< of f/p
  double lack = 0;          ///< of d
  double lack_squared = 0;  ///< of d^2
  double product = 0;       ///< of d f/p

  void add(double full_value, double lack_value) {
    ++count;
    full += full_value;
    lack += lack_value;
    lack_squared += lack_value * lack_value;
    product += lack_value * full_value;
  }
  /// The combined estimate of these samples.
  double estimate(double lambda) const { return (full + lambda * lack) / count; }
  /// Sum of d (mean(f/p) - f/p), which tends to count times Cov(f/p, g/p).
  double covariation() const { return full / count * lack - product; }
};

}  // namespace assay::correlated
