#include "direct_light/light_sampling.h"

#include <utility>

#include "luminaire/area.h"
#include "luminaire/solid_angle.h"

namespace assay::direct_light {

namespace {

using luminaire::LightTriangle;
using luminaire::SharedSetting;
using render::Vector3;

class AreaSampling final : public LightSampling {
 public:
  explicit AreaSampling(SharedSetting setting) : points_(std::move(setting)) {}

  std::optional<LightPoint> sample(Stream& random) const override {
    double x = random.uniform();
    const double y = random.uniform();
    const LightTriangle& triangle = points_.setting().triangles()[points_.shares().pick(x)];
    const auto [u, v] = luminaire::UniformTriangle{}(x, y);
    if (!triangle.emits) return {};
    const luminaire::Connection way = points_.setting().connect(triangle, u, v);
    return LightPoint{way.to_light,
                      way.squared_distance / (points_.setting().area() * way.light_cosine())};
  }

  double density(const LightTriangle& triangle, const Vector3& w) const override {
    const double cosine = -dot(w, triangle.normal);
    const double distance = triangle.plane_distance / cosine;
    return distance * distance / (points_.setting().area() * cosine);
  }

 private:
  luminaire::AreaPrimary<> points_;
};

class SolidAngleSampling final : public LightSampling {
 public:
  explicit SolidAngleSampling(SharedSetting setting) : directions_(std::move(setting)) {}

  std::optional<LightPoint> sample(Stream& random) const override {
    if (directions_.triangles().empty()) return {};
    double u = random.uniform();
    const double v = random.uniform();
    const luminaire::LitTriangle& triangle = directions_.triangles()[directions_.shares().pick(u)];
    const Vector3 w = triangle.seen.sample(u, v);
    return LightPoint{triangle.distance(w) * w, 1 / directions_.solid_angle()};
  }

  double density(const LightTriangle&, const Vector3&) const override {
    return 1 / directions_.solid_angle();
  }

 private:
  luminaire::SolidAnglePrimary<> directions_;
};

}  // namespace

SharedLightSampling area_sampling(SharedSetting setting) {
  return std::make_shared<AreaSampling>(std::move(setting));
}

SharedLightSampling solid_angle_sampling(SharedSetting setting) {
  return std::make_shared<SolidAngleSampling>(std::move(setting));
}

ParameterInformation light_sampling_parameter() {
  return {.name = "light_sampling",
          .type = ParameterType::string,
          .summary = "how points of the luminaire are drawn: uniform in solid angle or in area",
          .fallback = "solid_angle",
          .choices = {"solid_angle", "area"}};
}

SharedLightSampling read_light_sampling(Parameters& given, SharedSetting setting) {
  return given.string("light_sampling") == "area" ? area_sampling(std::move(setting))
                                                  : solid_angle_sampling(std::move(setting));
}

}  // namespace assay::direct_light
