#include "direct_light/samplers.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "luminaire/direction_sampler.h"
#include "luminaire/solid_angle.h"

namespace assay::direct_light {

namespace {

using luminaire::direction_of;
using luminaire::LitTriangle;
using luminaire::point_of;
using render::Vector3;
using std::numbers::pi;

// Directions in which f is the integrand of direct lighting.
class Directions : public Sampler {
 public:
  explicit Directions(SharedTechniques techniques)
      : techniques_(std::move(techniques)),
        triangles_(luminaire::lit_triangles(techniques_->setting())) {}

  Domain domain() const override {
    const bool above = std::ranges::all_of(triangles_, [](const LitTriangle& t) {
      return t.seen.a().z >= 0 && t.seen.b().z >= 0 && t.seen.c().z >= 0;
    });
    return above ? Domain::hemisphere : Domain::sphere;
  }

  double evaluate(const Point& point) const override {
    const Vector3 w = direction_of(point);
    const LitTriangle* triangle = containing(w);
    if (!triangle) return 0;
    Cost uncounted;
    return techniques_->setting().received(
        {luminaire::shadow_ray(triangle->distance(w) * w), techniques_->integrand(w)}, uncounted);
  }

  // Parts as narrow as a quarter of the lobe, and thirty nodes across the luminaire.
  Panels panels() const override {
    double omega = 0;
    for (const LitTriangle& triangle : triangles_) omega += triangle.seen.solid_angle();
    const double outline = omega > 0 ? std::clamp(2 * pi / std::sqrt(omega), 32.0, 128.0) : 1;
    const double lobe = pi / 2 / (4 * techniques_->reflectance().width());
    const double parts = std::ceil(std::max(outline, lobe));
    return {.first = static_cast<std::size_t>(parts),
            .second = static_cast<std::size_t>(2 * parts)};
  }

 protected:
  const LitTriangle* containing(const Vector3& w) const {
    const auto found =
        std::ranges::find_if(triangles_, [&](const LitTriangle& t) { return t.seen.contains(w); });
    return found == triangles_.end() ? nullptr : &*found;
  }
  // All triangles of a planar luminaire lie in the plane of the first.
  double light_density(const Vector3& w) const {
    if (!containing(w)) return 0;
    return techniques_->light_sampling().density(techniques_->setting().triangles()[0], w);
  }
  double brdf_density(const Vector3& w) const {
    return w.z > 0 ? techniques_->reflectance().density(w) : 0;
  }
  SamplerDraw draw(const Vector3& w, double declared, int lobe) const {
    const Point point = point_of(w);
    return {
        .point = point, .density = declared, .weight = evaluate(point) / declared, .lobe = lobe};
  }
  const Techniques& techniques() const { return *techniques_; }

 private:
  SharedTechniques techniques_;
  std::vector<LitTriangle> triangles_;
};

class LightDirections final : public Directions {
 public:
  using Directions::Directions;

  SamplerDraw sample(Stream& random) const override {
    const auto point = techniques().light_sampling().sample(random);
    if (!point) return {.valid = false};
    return draw(normalised(point->to_light), point->density, 0);
  }
  double density(const Point& point) const override { return light_density(direction_of(point)); }
};

class BrdfDirections final : public Directions {
 public:
  using Directions::Directions;

  SamplerDraw sample(Stream& random) const override {
    const Vector3 w = techniques().reflectance().sample(random);
    return w.z > 0 ? draw(w, brdf_density(w), 0) : SamplerDraw{.valid = false};
  }
  double density(const Point& point) const override { return brdf_density(direction_of(point)); }
};

class MixtureDirections final : public Directions {
 public:
  MixtureDirections(SharedTechniques techniques, const Pair& probabilities)
      : Directions(std::move(techniques)), probabilities_(probabilities) {}

  SamplerDraw sample(Stream& random) const override {
    if (random.uniform() < probabilities_.light) {
      const auto point = techniques().light_sampling().sample(random);
      if (!point) return {.lobe = 0, .valid = false};
      const Vector3 w = normalised(point->to_light);
      return draw(w, probabilities_.light * point->density + probabilities_.brdf * brdf_density(w),
                  0);
    }
    const Vector3 w = techniques().reflectance().sample(random);
    if (w.z <= 0) return {.lobe = 1, .valid = false};
    return draw(w, density(point_of(w)), 1);
  }
  double density(const Point& point) const override {
    return lobe_density(0, point) + lobe_density(1, point);
  }
  int lobes() const override { return 2; }
  double lobe_density(int lobe, const Point& point) const override {
    const Vector3 w = direction_of(point);
    return lobe == 0 ? probabilities_.light * light_density(w)
                     : probabilities_.brdf * brdf_density(w);
  }

 private:
  Pair probabilities_;
};

bool has_directions(const Techniques& techniques) {
  const luminaire::Setting& setting = techniques.setting();
  return setting.planar() && setting.triangles()[0].emits;
}

}  // namespace

std::vector<NamedSampler> light_samplers(const SharedTechniques& techniques) {
  if (!has_directions(*techniques)) return {};
  return {{"light", std::make_shared<LightDirections>(techniques)}};
}

std::vector<NamedSampler> brdf_samplers(const SharedTechniques& techniques) {
  return {{"brdf", std::make_shared<BrdfDirections>(techniques)}};
}

std::vector<NamedSampler> mixture_samplers(const SharedTechniques& techniques,
                                           const Pair& probabilities) {
  if (!has_directions(*techniques)) return {};
  return {{"mixture", std::make_shared<MixtureDirections>(techniques, probabilities)}};
}

}  // namespace assay::direct_light
