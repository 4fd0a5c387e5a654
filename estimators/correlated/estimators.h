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
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "estimators/estimator.h"
#include "luminaire/scene_description.h"
#include "render/environment_map.h"

namespace assay::correlated {

using render::Rgb;

/// f/p and g/p of one random point, a number for each colour; grey sources use the first alone.
struct Pair {
  Rgb full;
  Rgb control;
};

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

/// Draws pairs. Shared by all workers.
struct PairSource {
  std::vector<Colour> colours;
  std::function<void(Stream& random, std::span<Pair> out, Cost& cost)> draw;
  std::vector<NamedSampler> samplers;
};

using SharedPairs = std::shared_ptr<const PairSource>;

/// f is the irradiance that arrives from points uniform on a planar luminaire. If nothing stood in
/// the way, g would arrive: g/p = A L cos+ light_cosine+ / r^2. J is Lambert's formula for the
/// polygon clipped at the horizon. With polygonal occluders I is exact. So are the second moments
/// E[f^2] = E[f g] and E[g^2].
///
/// A luminaire that is not one planar polygon throws std::invalid_argument. It may shade itself,
/// and then J has no closed form.
SharedPairs area_pairs(const luminaire::SceneDescription& description, const Location& where);
/// Reads the parameter `scene`; InputError there when the luminaire is a mesh.
SharedPairs read_area_pairs(Parameters&);

/// f is the irradiance that arrives from directions of a sky. An open uniform sky of the same mean
/// M has g: `f/p = L cos+ V / p`, `g/p = M cos+ / p`, `J = pi M`. Directions have a density
/// that is positive wherever cos+ is.
///
/// Reads the parameters of a sky and `sampling`. It is uniform, cosine, emittance (in
/// proportion to the sky, interpolated on 2048 triangles) or steered (the sky times the lobe of
/// nine harmonics). InputError at `sky` where emittance or steered sampling would never draw some
/// directions: the sky is black at a vertex.
SharedPairs read_sky_pairs(Parameters&);

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

/// lambda from sums over samples and the control's integral J.
using LambdaRule = std::function<double(const Sums&, double control_integral)>;

/// The centre about which the spread of the control is measured.
enum class Centre {
  integral,  ///< The centre is J. As published: lambda = sum d (mean f - f) / sum d^2.
  mean,      ///< The centre is the samples' mean. Lambda is the least-squares slope of f on g.
};

/// The estimate of lambda* from samples. It is 0 if the control's root mean square deviation is
/// below 2^-40 J: there is nothing to correct.
LambdaRule estimated_lambda(Centre);
/// The same moved into [0, 1].
LambdaRule clamped_lambda(Centre);

/// I^ with the lambda given: unbiased, the mean of its primaries. Channels: a colour each, with
/// mean and variance where they are known.
std::shared_ptr<const Setup> fixed(SharedPairs, double lambda);

/// The estimator with lambda from the same samples. With f and g divided by p its bias is
///  `-E[(f - I - lambda* (g - J)) (g - J)^2] / (M Var g)`
/// and terms of higher order. Channels: one a colour, then the diagnostic `lambda` (lambda_r,
/// lambda_g, lambda_b if there are several colours). Their limit lambda* is stated if it is known.
std::shared_ptr<const Setup> same_samples(SharedPairs, LambdaRule);

/// I^ by halves, each with the lambda of the other: unbiased. Of an odd M the second half is the
/// larger. A half of no or one sample gives lambda = 0. Channels as of same_samples(); lambda is
/// the mean of the two.
std::shared_ptr<const Setup> cross_fitted(SharedPairs, LambdaRule);

/// J sum(f/p) / sum(g/p), weighted importance sampling: biased like 1/M; 0 where all g/p are 0.
std::shared_ptr<const Setup> ratio(SharedPairs);

/// The channels of same_samples() and cross_fitted().
std::vector<Channel> channels_with_lambda(const PairSource&);

/// Reads `centre` and `clamped`.
LambdaRule read_rule(Parameters&);

/// The names of one kind of source, and how it is made.
struct Family {
  std::string name;         ///< "correlated/area"
  std::string integral;     ///< "the irradiance from ..."
  std::string description;  ///< of f, g, p and J
  std::vector<ParameterInformation> parameters;
  std::function<SharedPairs(Parameters&)> read;  ///< a source of pairs from a plugin's parameters
};

/// The four estimators of a source: NAME, NAME_same_samples, NAME_cross_fitted, NAME_ratio.
std::vector<Entry> entries(const Family&);

}  // namespace assay::correlated
