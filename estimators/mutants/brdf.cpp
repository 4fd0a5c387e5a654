// Reflectance samplers with one defect each. Every mutant is the original's reflectance with one
// part exchanged; its declared density, weight and reference stay the original's, as its author
// would have claimed.

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <type_traits>
#include <utility>

#include "brdf/albedo.h"
#include "estimators/mutant.h"

namespace assay::plugins {

namespace {

using render::AshikhminShirley;
using render::Vector3;
using render::Ward;
using std::numbers::pi;

template <class Brdf>
struct SingleQuadrant final : Brdf {
  using Brdf::Brdf;
  double azimuth(double u) const override { return Brdf::azimuth(u / 4); }
};

template <class Brdf>
struct UniformAzimuth final : Brdf {
  using Brdf::Brdf;
  double azimuth(double u) const override { return 2 * pi * u; }
};

template <class Brdf>
struct NoJacobian final : Brdf {
  using Brdf::Brdf;
  double jacobian(const Vector3&) const override { return 1; }
};

struct UnmirroredQuadrants final : AshikhminShirley {
  using AshikhminShirley::AshikhminShirley;
  double azimuth(double u) const override {
    const double quadrant = std::floor(4 * u);
    return quadrant * pi / 2 + first_quadrant(4 * u - quadrant);
  }
};

struct ExponentWithoutOne final : AshikhminShirley {
  using AshikhminShirley::AshikhminShirley;
  double squared_sine(double azimuth, double v) const override {
    return -std::expm1(2 * std::log(v) / exponent(azimuth));
  }
};

struct NoArctangent final : Ward {
  using Ward::Ward;
  double azimuth(double u) const override {
    return roughness().y / roughness().x * std::tan(2 * pi * u);
  }
};

struct NoSineOfAzimuth final : Ward {
  using Ward::Ward;
  Vector3 half_vector(double u, double v) const override {
    const Vector3 h = Ward::half_vector(u, v);
    return normalised(Vector3{h.x, std::hypot(h.x, h.y), h.z});
  }
};

using Draw = std::function<SamplerDraw(const Sampler& original, Stream& random)>;
using Density = std::function<double(const Sampler& original, const Point& p)>;

// The original's points with one part of what is said of them exchanged.
class Misreported final : public Sampler {
 public:
  Misreported(std::shared_ptr<const Sampler> original, Draw draw, Density density)
      : original_(std::move(original)), draw_(std::move(draw)), density_(std::move(density)) {}
  Domain domain() const override { return original_->domain(); }
  SamplerDraw sample(Stream& random) const override { return draw_(*original_, random); }
  double density(const Point& p) const override { return density_(*original_, p); }
  double evaluate(const Point& p) const override { return original_->evaluate(p); }
  Panels panels() const override { return original_->panels(); }

 private:
  std::shared_ptr<const Sampler> original_;
  Draw draw_;
  Density density_;
};

SamplerDraw redrawn(const Sampler& original, Stream& random) {
  while (true) {
    const SamplerDraw draw = original.sample(random);
    if (draw.valid) return draw;
  }
}

SamplerDraw weighted_without_cosine(const Sampler& original, Stream& random) {
  SamplerDraw draw = original.sample(random);
  if (draw.valid) draw.weight /= draw.point[2];
  return draw;
}

// Off in one hundredth of the azimuth, phi - pi in [0.05, 0.05 + pi / 50).
double off_in_a_sector(const Sampler& original, const Point& p) {
  const double turned = std::atan2(-p[1], -p[0]);
  return (turned >= 0.05 && turned < 0.05 + pi / 50 ? 1.001 : 1) * original.density(p);
}

// Tangent and bitangent exchanged: the mirror image about the diagonal of the surface axes.
SamplerDraw mirrored(const Sampler& original, Stream& random) {
  SamplerDraw draw = original.sample(random);
  if (!draw.valid) return draw;
  draw.weight = original.evaluate({draw.point[1], draw.point[0], draw.point[2]}) / draw.density;
  return draw;
}

struct Defect {
  const char* name;
  const char* what;
  Draw draw = &Sampler::sample;
  Density density = &Sampler::density;
};

// The defects are in the published sampler, the only choice. `broken` makes the sampler that has
// it from the sound reflectance.
template <class Sound>
Entry entry(const Defect& defect, const auto& broken) {
  ParameterInformation sampler = brdf::sampler_parameter();
  sampler.summary = "the one that has the defect";
  sampler.choices = {"published"};
  const bool is_ward = std::is_same_v<Sound, Ward>;
  return mutant(
      {defect.name, is_ward ? "brdf/ward" : "brdf/ashikhmin_shirley", defect.what, {sampler}},
      [broken](Parameters& given) {
        given.string("sampler");
        const auto sound = brdf::read<Sound>(given);
        return brdf::albedo(only_mean(brdf::published_channel(*sound)), broken(sound, given));
      });
}

template <class Mutant>
Entry exchanged(const Defect& defect) {
  using Sound = std::conditional_t<std::is_base_of_v<Ward, Mutant>, Ward, AshikhminShirley>;
  return entry<Sound>(defect, [](const auto&, Parameters& given) {
    return brdf::published_sampler(brdf::read<Mutant>(given));
  });
}

template <class Sound>
Entry misreported(const Defect& defect) {
  return entry<Sound>(defect, [defect](const auto& sound, Parameters&) {
    return std::make_shared<Misreported>(brdf::published_sampler(sound), defect.draw,
                                         defect.density);
  });
}

}  // namespace

std::vector<Entry> mutants_brdf() {
  const auto* const quadrant = "draws half vectors in the first quadrant only.";
  const auto* const uniform = "takes the azimuth 2 pi u although the lobe is anisotropic.";
  const auto* const jacobian = "leaves the factor 1 / (4 h . w_i) out of the density.";
  const auto* const draws_again =
      "draws directions below the horizon again and does not renormalise the density.";
  return {
      exchanged<SingleQuadrant<Ward>>({"ward_single_quadrant", quadrant}),
      exchanged<UniformAzimuth<Ward>>({"ward_uniform_azimuth", uniform}),
      exchanged<NoJacobian<Ward>>({"ward_no_jacobian", jacobian}),
      exchanged<NoArctangent>(
          {"ward_no_arctangent",
           "takes the azimuth (ay / ax) tan 2 pi u without the arctangent, as printed in the paper "
           "of 1992."}),
      exchanged<NoSineOfAzimuth>(
          {"ward_no_sine", "leaves the factor sin phi out of the y component of h."}),
      misreported<Ward>({"ward_redrawn", draws_again, redrawn}),
      misreported<Ward>({"ward_weight_without_cosine", "weights by f / p, without the cosine.",
                         weighted_without_cosine}),
      misreported<Ward>({.name = "ward_density_sector",
                         .what = "declares the density at a point .1 % too large in a "
                                 "hundredth of the azimuth, that from pi + 0.05 on.",
                         .density = off_in_a_sector}),
      misreported<Ward>(
          {"ward_weight_mirrored",
           "takes the BRDF in the weight of the direction with its x and y exchanged.", mirrored}),
      exchanged<SingleQuadrant<AshikhminShirley>>({"ashikhmin_shirley_single_quadrant", quadrant}),
      exchanged<UniformAzimuth<AshikhminShirley>>({"ashikhmin_shirley_uniform_azimuth", uniform}),
      exchanged<UnmirroredQuadrants>(
          {"ashikhmin_shirley_unmirrored",
           "turns the first quadrant into the second and fourth instead of mirroring it."}),
      exchanged<ExponentWithoutOne>(
          {"ashikhmin_shirley_exponent", "takes cos d = v^(1/e) instead of v^(1/(e+1))."}),
      exchanged<NoJacobian<AshikhminShirley>>({"ashikhmin_shirley_no_jacobian", jacobian}),
      misreported<AshikhminShirley>({"ashikhmin_shirley_redrawn", draws_again, redrawn}),
  };
}

}  // namespace assay::plugins
