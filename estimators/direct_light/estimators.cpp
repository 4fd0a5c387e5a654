// Light reflected towards a viewer: by sampling the luminaire, the BRDF, or both (multiple
// importance sampling), and the directions of these as samplers.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "direct_light/exact.h"
#include "estimators/parameters.h"
#include "luminaire/solid_angle.h"

namespace assay::plugins {

namespace {

using namespace direct_light;

using luminaire::LitTriangle;
using render::Vector3;
using render::vector_of;
using std::numbers::pi;

// Directions in which f is the integrand of direct lighting, of one technique or of both with these
// probabilities, then a lobe each.
class Directions final : public Sampler {
 public:
  Directions(SharedTechniques techniques, const Pair& probabilities)
      : techniques_(std::move(techniques)),
        probabilities_(probabilities),
        triangles_(luminaire::lit_triangles(techniques_->setting())) {}

  Domain domain() const override { return luminaire::domain_of(triangles_); }

  SamplerDraw sample(Stream& random) const override {
    const bool light =
        lobes() == 1 ? probabilities_.light > 0 : random.uniform() < probabilities_.light;
    const int lobe = lobes() == 1 || light ? 0 : 1;
    if (light) {
      const auto point = techniques_->light_sampling().sample(random);
      if (!point) return {.lobe = lobe, .valid = false};
      const Vector3 w = normalised(point->to_light);
      return draw(w, probabilities_.light * point->density + by_brdf(w), lobe);
    }
    const Vector3 w = techniques_->reflectance().sample(random);
    if (w.z <= 0) return {.lobe = lobe, .valid = false};
    return draw(w, density(point_of(w)), lobe);
  }

  double density(const Point& point) const override {
    return by_light(vector_of(point)) + by_brdf(vector_of(point));
  }
  int lobes() const override { return probabilities_.light > 0 && probabilities_.brdf > 0 ? 2 : 1; }
  double lobe_density(int lobe, const Point& point) const override {
    if (lobes() == 1) return density(point);
    return lobe == 0 ? by_light(vector_of(point)) : by_brdf(vector_of(point));
  }

  double evaluate(const Point& point) const override {
    const Vector3 w = vector_of(point);
    const LitTriangle* triangle = luminaire::containing(triangles_, w);
    if (!triangle) return 0;
    return techniques_->setting().received(
        {luminaire::shadow_ray(triangle->distance(w) * w), techniques_->integrand(w)}, Uncounted());
  }

  // Parts as narrow as a quarter of the lobe, and thirty nodes across the luminaire.
  Panels panels() const override {
    double omega = 0;
    for (const LitTriangle& triangle : triangles_) omega += triangle.seen.solid_angle();
    const double outline = omega > 0 ? luminaire::parts_across(omega) : 1;
    const double lobe = pi / 2 / (4 * techniques_->reflectance().width());
    const double parts = std::ceil(std::max(outline, lobe));
    return {.first = static_cast<std::size_t>(parts),
            .second = static_cast<std::size_t>(2 * parts)};
  }

 private:
  // All triangles of a planar luminaire lie in the plane of the first.
  double by_light(const Vector3& w) const {
    if (probabilities_.light == 0 || !luminaire::containing(triangles_, w)) return 0;
    return probabilities_.light *
           techniques_->light_sampling().density(techniques_->setting().triangles()[0], w);
  }
  double by_brdf(const Vector3& w) const {
    if (probabilities_.brdf == 0 || w.z <= 0) return 0;
    return probabilities_.brdf * techniques_->reflectance().density(w);
  }
  SamplerDraw draw(const Vector3& w, double declared, int lobe) const {
    const Point point = point_of(w);
    return {
        .point = point, .density = declared, .weight = evaluate(point) / declared, .lobe = lobe};
  }

  SharedTechniques techniques_;
  Pair probabilities_;
  std::vector<LitTriangle> triangles_;
};

/// The directions as a sampler; none that draw the light unless it is planar and emits towards the
/// receiver.
std::vector<NamedSampler> samplers(const char* name, const SharedTechniques& techniques,
                                   const Pair& probabilities) {
  const luminaire::Setting& setting = techniques->setting();
  const bool has_light = setting.planar() && setting.triangles()[0].emits;
  if (probabilities.light > 0 && !has_light) return {};
  return {{name, std::make_shared<Directions>(techniques, probabilities)}};
}

// The most that a draw of the BRDF brings when all the light of the scene is weighted by 1.
double highest_of_brdf(const Techniques& techniques) {
  // A product and a quotient of a few factors, each rounded.
  return techniques.setting().radiance() * techniques.reflectance().weight_bound() * (1 + 0x1p-40);
}

// The channel of primaries with these weights, in [0, high]. Quadrature gives the mean of smooth
// weights, and the moments from which `variance_of` takes the variance. The mean has a closed form
// for a constant BRDF. The variance is stated if it is known to 1e-8.
template <class VarianceOf>
Channel radiance_channel(const Techniques& techniques, const WeightedByHeuristic& weights,
                         double high, const VarianceOf& variance_of) {
  const auto known = weights.smooth() ? moments(techniques, weights) : std::nullopt;
  // Quadrature takes its time where a BRDF has kinks: not twice.
  Channel channel = mean_channel(
      known && !techniques.reflectance().constant() ? known->radiance() : radiance(techniques));
  channel.low = 0;
  channel.high = high;
  if (!known) return channel;
  const Known variance = variance_of(*known);
  if (variance.error <= 1e-8 * variance.value) channel.variance = variance.value;
  return channel;
}

// The same of the one-sample model, with these probabilities of the techniques.
Channel one_sample_channel(const Techniques& techniques, const WeightedByHeuristic& weights,
                           double high, const Pair& probabilities) {
  return radiance_channel(techniques, weights, high, [&](const Moments& known) {
    return known.one_sample_variance(probabilities);
  });
}

std::shared_ptr<const Setup> prepare_light(Parameters& given) {
  const SharedTechniques techniques = read_techniques(given);
  const WeightedByHeuristic alone(Heuristic::balance(), {1, 0});
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  return averaging(
      one_sample_channel(*techniques, alone, unbounded, {1, 0}),
      [techniques, alone](Stream& random, Cost& cost) {
        return from_light(alone, techniques->light(random, cost));
      },
      samplers("light", techniques, {1, 0}));
}

std::shared_ptr<const Setup> prepare_brdf(Parameters& given) {
  const luminaire::SharedSetting setting = luminaire::read_setting(given);
  const auto techniques = std::make_shared<const Techniques>(setting, read_reflectance(given),
                                                             solid_angle_sampling(setting));
  const WeightedByHeuristic alone(Heuristic::balance(), {0, 1});
  return averaging(
      one_sample_channel(*techniques, alone, highest_of_brdf(*techniques), {0, 1}),
      [techniques, alone](Stream& random, Cost& cost) {
        return from_brdf(alone, techniques->brdf(random, cost));
      },
      samplers("brdf", techniques, {0, 1}));
}

std::shared_ptr<const Setup> prepare_multi_sample(Parameters& given) {
  const SharedTechniques techniques = read_techniques(given);
  const Counts counts = read_counts(given);
  const Pair n = counts.shares();
  const WeightedByHeuristic combination(read_heuristic(given), n);
  // For every heuristic of exponent 1 or more a weighted draw brings f / q_b at most, q_b = n_b
  // p_b.
  //   Balance: w_i f / q_i = f / (q_l + q_b).
  //   Power: f q_i^(e-1) / (q_l^e + q_b^e) <= f / q_b, since x^(e-1) <= 1 + x^e.
  //   Maximum and cutoff: f / q_i with q_i the larger, if the other is left out.
  const double high = highest_of_brdf(*techniques) * (n.light + n.brdf) / n.brdf;
  std::vector<NamedSampler> both = samplers("light", techniques, {1, 0});
  both.push_back(samplers("brdf", techniques, {0, 1}).front());
  return averaging(
      radiance_channel(*techniques, combination, high,
                       [&](const Moments& known) { return known.multi_sample_variance(counts); }),
      MultiSamplePrimary<>{techniques, counts, combination}, std::move(both));
}

std::shared_ptr<const Setup> prepare_one_sample(Parameters& given) {
  const SharedTechniques techniques = read_techniques(given);
  const Pair probabilities = read_probabilities(given);
  const WeightedByHeuristic combination(read_heuristic(given), probabilities);
  // The bound of the multi-sample model, with one draw.
  const double high = highest_of_brdf(*techniques) / probabilities.brdf;
  return averaging(one_sample_channel(*techniques, combination, high, probabilities),
                   OneSamplePrimary<>{techniques, probabilities, combination},
                   samplers("mixture", techniques, probabilities));
}

}  // namespace

std::vector<Entry> direct_light_estimators() {
  return {
      {{.name = "direct_light/light",
        .summary = "Light reflected towards a viewer, by sampling the luminaire.",
        .description =
            "Estimates L_r = integral of L(w) f(w, viewer) cos+ dw, what a surface reflects "
            "towards a viewer of the light that arrives from a luminaire past occluders, by X "
            "= L f cos+ [visible] / p at points of the luminaire. p is per solid angle: 1 / "
            "Omega of directions uniform in the solid angle, distance^2 / (A cos') of points "
            "uniform in area. One shadow ray a primary, none below the horizon. Varies much "
            "where the BRDF has a narrow lobe and the luminaire is large. Mean and variance "
            "are known by adaptive quadrature for polygons past up to eight convex polygons; "
            "of a Lambertian surface the mean is f times Lambert's formula. Sampler: light "
            "(of a polygon).",
        .parameters = parameters_with({})},
       prepare_light},
      {{.name = "direct_light/brdf",
        .summary = "Light reflected towards a viewer, by sampling the BRDF.",
        .description =
            "Estimates L_r = integral of L(w) f(w, viewer) cos+ dw, as direct_light/light "
            "does, by X = L f cos / p where a ray along a direction of the BRDF's sampler, of "
            "density p, first hits the side of the luminaire that emits, else 0. One closest "
            "hit a primary, none below the horizon. Varies much where the luminaire is small "
            "beside the lobe. X is never above L times the bound of f cos / p. Mean and "
            "variance as of direct_light/light. Sampler: brdf.",
        .parameters = common_parameters()},
       prepare_brdf},

      {{.name = "direct_light/multi_sample",
        .summary = "Light reflected towards a viewer, by multiple importance sampling.",
        .description =
            "Estimates L_r = integral of L(w) f(w, viewer) cos+ dw by X = 1/n_l sum w_l f/p_l + "
            "1/n_b sum w_b f/p_b over n_l samples of the luminaire and n_b of the BRDF (Veach "
            "1997, eq. 9.4), as direct_light/light and direct_light/brdf draw them. Weights sum "
            "to 1 at every direction, so X is unbiased. With q = n p they are, by `heuristic`: "
            "balance q_i / sum q; power q_i^e / sum q^e; cutoff: 0 where q_i is below t times the "
            "larger, else as balance; maximum: 1 for the larger. By balance V[X] <= V[any other "
            "weights] + (1 / min n_i - 1 / sum n_i) L_r^2 (theorem 9.2). n_l shadow rays and n_b "
            "closest hits a primary, none below the horizon. Means are known as for "
            "direct_light/light, variances for balance and power. Samplers: light (of a polygon), "
            "brdf.",
        .parameters = parameters_with(
            {count_parameter("light_samples", "samples of the light in a primary", "1", {1, 1000}),
             count_parameter("brdf_samples", "samples of the BRDF in a primary", "1", {1, 1000}),
             heuristic_parameter()})},
       prepare_multi_sample},

      {{.name = "direct_light/one_sample",
        .summary = "Light reflected towards a viewer, by one-sample multiple importance sampling.",
        .description =
            "Estimates L_r = integral of L(w) f(w, viewer) cos+ dw by X = w_i f / (c_i p_i) with "
            "the technique i drawn, the luminaire with `light_probability` c_l, else the BRDF "
            "(Veach 1997, section 9.2.4, eq. 9.15). Weights as of direct_light/multi_sample with "
            "q = c p. By balance X = f / (c_l p_l + c_b p_b): importance sampling of the mixture, "
            "and no weights have less variance. Two such primaries with c = 1/2 have no less "
            "variance than one of the multi-sample model with a sample each. One ray a primary at "
            "most. Mean and variance as of direct_light/multi_sample. Sampler: mixture (of a "
            "polygon), a lobe for each technique.",
        .parameters = parameters_with(
            {{.name = "light_probability",
              .summary = "probability that the light is sampled, not the BRDF",
              .fallback = "0.5",
              .range = {.low = 0, .high = 1, .low_excluded = true, .high_excluded = true},
              .reason = "a technique that is never chosen leaves nothing to combine"},
             heuristic_parameter()})},
       prepare_one_sample}};
}

}  // namespace assay::plugins
