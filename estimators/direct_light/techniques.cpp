#include "direct_light/techniques.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "brdf/albedo.h"
#include "estimators/core/value.h"
#include "estimators/parameters.h"
#include "luminaire/area.h"
#include "luminaire/solid_angle.h"
#include "render/hemisphere.h"

namespace assay::direct_light {

namespace {

using luminaire::LightTriangle;
using luminaire::SharedSetting;
using render::Vector3;
using std::numbers::pi;

// f = albedo / pi, drawn by the cosine.
class Lambert final : public Reflectance {
 public:
  explicit Lambert(double albedo) : albedo_(albedo) {}

  double value(const Vector3&) const override { return albedo_ / pi; }
  Vector3 sample(Stream& random) const override {
    const double u = random.uniform();
    return render::cosine_hemisphere(u, random.uniform());
  }
  double density(const Vector3& w) const override { return std::max(0.0, w.z) / pi; }
  double weight_bound() const override { return albedo_; }
  double width() const override { return 1; }
  std::optional<double> constant() const override { return albedo_ / pi; }

 private:
  double albedo_;
};

LightSampling area_sampling(SharedSetting setting) {
  const auto points = std::make_shared<const luminaire::AreaPrimary<>>(std::move(setting));
  const auto sample = [points](Stream& random) -> std::optional<LightPoint> {
    const auto [index, x, y] = points->shares().choose(random);
    const LightTriangle& triangle = points->setting().triangles()[index];
    const auto [u, v] = luminaire::UniformTriangle{}(x, y);
    if (!triangle.emits) return {};
    const luminaire::Connection way = points->setting().connect(triangle, u, v);
    return LightPoint{way.to_light,
                      way.squared_distance / (points->setting().area() * way.light_cosine())};
  };
  const auto density = [points](const LightTriangle& triangle, const Vector3& w) {
    const double cosine = -dot(w, triangle.normal);
    const double distance = triangle.plane_distance / cosine;
    return distance * distance / (points->setting().area() * cosine);
  };
  return {sample, density};
}

}  // namespace

SharedReflectance read_reflectance(Parameters& given) {
  const Value& value = given.structure("brdf");
  require_keys(value, "the brdf", {"lambert", "ward", "ashikhmin_shirley"});
  given.require(value.members().size() == 1, "brdf",
                "must have one of the keys `lambert`, `ward` and `ashikhmin_shirley`");
  const auto& [kind, own] = value.members().front();
  const auto parameters = [&](std::vector<ParameterInformation> declared) {
    return Parameters(given.plugin() + ": " + kind, std::move(declared), own, given.folder());
  };
  if (kind == "ward") {
    Parameters ward = parameters(brdf::ward_parameters());
    return brdf::read<render::Ward>(ward);
  }
  if (kind == "ashikhmin_shirley") {
    Parameters ashikhmin_shirley = parameters(brdf::ashikhmin_shirley_parameters());
    return brdf::read<render::AshikhminShirley>(ashikhmin_shirley);
  }
  Parameters lambert =
      parameters({number_parameter("albedo", "reflected part of the light", "", {0, 1})});
  return std::make_shared<Lambert>(lambert.number("albedo"));
}

LightSampling solid_angle_sampling(SharedSetting setting) {
  const auto directions =
      std::make_shared<const luminaire::SolidAnglePrimary<>>(std::move(setting));
  const auto sample = [directions](Stream& random) -> std::optional<LightPoint> {
    if (directions->triangles().empty()) return {};
    const auto [index, u, v] = directions->shares().choose(random);
    const luminaire::LitTriangle& triangle = directions->triangles()[index];
    const Vector3 w = triangle.seen.sample(u, v);
    return LightPoint{triangle.distance(w) * w, 1 / directions->solid_angle()};
  };
  const auto density = [directions](const LightTriangle&, const Vector3&) {
    return 1 / directions->solid_angle();
  };
  return {sample, density};
}

LightSampling read_light_sampling(Parameters& given, SharedSetting setting) {
  if (given.string("light_sampling") == "solid_angle") return solid_angle_sampling(setting);
  return area_sampling(std::move(setting));
}

Techniques::Techniques(luminaire::SharedSetting setting, SharedReflectance reflectance,
                       LightSampling light_sampling)
    : setting_(std::move(setting)),
      reflectance_(std::move(reflectance)),
      light_sampling_(std::move(light_sampling)) {}

double Techniques::integrand(const Vector3& w) const {
  return w.z > 0 ? setting_->radiance() * reflectance_->value(w) * w.z : 0;
}

Pair Techniques::density(const luminaire::LightTriangle& triangle, const Vector3& w) const {
  return {light_sampling_.density(triangle, w), reflectance_->density(w)};
}

Draw Techniques::light(Stream& random, Cost& cost) const {
  const std::optional<LightPoint> point = light_sampling_.sample(random);
  if (!point) return {};
  const Vector3 w = normalised(point->to_light);
  const luminaire::LightSample sample{luminaire::shadow_ray(point->to_light), integrand(w)};
  return {setting_->received(sample, cost), {point->density, reflectance_->density(w)}};
}

Draw Techniques::brdf(Stream& random, Cost& cost) const {
  const Vector3 w = reflectance_->sample(random);
  if (w.z <= 0) return {};
  const luminaire::LightTriangle* const triangle = setting_->first_hit(setting_->ray(w), cost);
  if (!triangle || !triangle->emits) return {};
  return {integrand(w), density(*triangle, w)};
}

std::vector<ParameterInformation> common_parameters() {
  return {
      luminaire::scene_parameter(),
      structure_parameter(
          "brdf",
          "the reflectance and its parameters: {lambert: {albedo}}, {ward: {alpha_x, alpha_y, "
          "theta_i, phi_i}} or {ashikhmin_shirley: {nu, nv, reflectance, theta_i, phi_i}}; theta_i "
          "and phi_i are the viewer's direction",
          "{ward: {alpha_x: 0.15, alpha_y: 0.4, theta_i: 0.8, phi_i: 0.5}}")};
}

std::vector<ParameterInformation> parameters_with(std::vector<ParameterInformation> more) {
  const ParameterInformation light_sampling = text_parameter(
      "light_sampling", "how points of the luminaire are drawn: uniform in solid angle or in area",
      "solid_angle", {"solid_angle", "area"});
  return joined(joined(common_parameters(), {light_sampling}), more);
}

}  // namespace assay::direct_light
