#include "direct_light/reflectance.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "brdf/ashikhmin_shirley.h"
#include "brdf/ward.h"
#include "luminaire/scene_description.h"
#include "render/hemisphere.h"

namespace assay::direct_light {

namespace {

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

template <class Brdf>
class Glossy final : public Reflectance {
 public:
  explicit Glossy(Brdf brdf) : brdf_(std::move(brdf)) {}

  double value(const Vector3& w) const override { return brdf_.value(w); }
  Vector3 sample(Stream& random) const override {
    const double u = random.uniform();
    return brdf_.reflected(brdf_.half_vector(u, random.uniform_open()));
  }
  double density(const Vector3& w) const override { return brdf_.density(w); }
  double weight_bound() const override { return brdf_.weight_bound(); }
  // The lobe of w is twice as wide as that of the half vector.
  double width() const override { return 2 * brdf_.width(); }

 private:
  Brdf brdf_;
};

template <class Brdf>
SharedReflectance glossy(Brdf brdf) {
  return std::make_shared<Glossy<Brdf>>(std::move(brdf));
}

}  // namespace

ParameterInformation brdf_parameter() {
  return {.name = "brdf",
          .type = ParameterType::structure,
          .summary =
              "the reflectance and its parameters: {lambert: {albedo}}, {ward: {alpha_x, "
              "alpha_y, theta_i, phi_i}} or {ashikhmin_shirley: {nu, nv, reflectance, "
              "theta_i, phi_i}}; theta_i and phi_i are the viewer's direction",
          .fallback = "{ward: {alpha_x: 0.15, alpha_y: 0.4, theta_i: 0.8, phi_i: 0.5}}"};
}

SharedReflectance read_reflectance(Parameters& given) {
  const Value& value = given.structure("brdf");
  luminaire::require_keys(value, "the brdf", {"lambert", "ward", "ashikhmin_shirley"});
  if (value.members().size() != 1) {
    given.refuse("brdf", "must have one of the keys `lambert`, `ward` and `ashikhmin_shirley`");
  }
  const auto& [kind, own] = value.members().front();
  const auto parameters = [&](std::vector<ParameterInformation> declared) {
    return Parameters(given.plugin() + ": " + kind, std::move(declared), own, given.folder());
  };
  if (kind == "ward") {
    Parameters ward = parameters(brdf::ward_parameters());
    return glossy(brdf::ward(ward));
  }
  if (kind == "ashikhmin_shirley") {
    Parameters ashikhmin_shirley = parameters(brdf::ashikhmin_shirley_parameters());
    return glossy(brdf::ashikhmin_shirley(ashikhmin_shirley));
  }
  Parameters lambert = parameters(
      {{.name = "albedo", .summary = "reflected part of the light", .low = 0, .high = 1}});
  return std::make_shared<Lambert>(lambert.number("albedo"));
}

}  // namespace assay::direct_light
