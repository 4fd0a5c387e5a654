#include "path_tracing/scattering.h"

#include <numbers>

namespace assay::path_tracing {

namespace {

using std::numbers::pi;

Vector3 mirrored(const Vector3& v) { return {-v.x, -v.y, v.z}; }

}  // namespace

double Rough::lobe_share() const {
  const double lobe = paths::largest(glossy);
  return lobe > 0 ? lobe / (lobe + paths::largest(diffuse)) : 0;
}

double Rough::lobe(const Vector3& in, const Vector3& out) const {
  const double cosine = render::dot(mirrored(in), out);
  return cosine > 0 ? std::pow(cosine, exponent) / (2 * pi) : 0;
}

Spectrum Rough::value(const Vector3& in, const Vector3& out) const {
  if (in.z <= 0 || out.z <= 0) return {};
  const Spectrum base = 1 / pi * diffuse;
  if (glossy == Spectrum{}) return base;
  return base + (exponent + 2) * lobe(in, out) * glossy;
}

double Rough::density(const Vector3& in, const Vector3& out) const {
  const double base = std::max(out.z, 0.0) / pi;
  const double share = lobe_share();
  if (share == 0) return base;
  return (1 - share) * base + share * (exponent + 1) * lobe(in, out);
}

Scattered Rough::scatter(const Vector3& in, Stream& random) const {
  const double share = lobe_share();
  const bool glossily = share > 0 && random.uniform() < share;
  const double u = random.uniform();
  const double v = random.uniform();
  Vector3 out = glossily ? render::Frame::about(mirrored(in))
                               .to_world(render::direction_at(std::pow(u, 1 / (exponent + 1)), v))
                         : render::cosine_hemisphere(u, v);
  if (share == 0) return {out, diffuse, out.z / pi, out.z > 0};
  const double p = density(in, out);
  if (out.z <= 0 || p <= 0) return {.survives = false};
  return {out, out.z / p * value(in, out), p};
}

double fresnel(double cosine, double ratio) {
  const double sine = (1 - cosine * cosine) / (ratio * ratio);
  if (sine >= 1) return 1;
  const double beyond = std::sqrt(1 - sine);
  const double parallel = (ratio * cosine - beyond) / (ratio * cosine + beyond);
  const double across = (cosine - ratio * beyond) / (cosine + ratio * beyond);
  return (parallel * parallel + across * across) / 2;
}

Scattered scatter(const Glass& glass, const Vector3& in, double (*reflectance)(double, double),
                  Stream& random) {
  const double side = in.z < 0 ? -1 : 1;
  const double cosine = side * in.z;
  const double ratio = in.z < 0 ? 1 / glass.index : glass.index;
  const Spectrum whole = Spectrum::grey(1);
  if (random.uniform() < reflectance(cosine, ratio)) return {mirrored(in), whole};
  const double squared_sine = (1 - cosine * cosine) / (ratio * ratio);
  if (squared_sine >= 1) return {mirrored(in), whole};
  return {{-in.x / ratio, -in.y / ratio, -side * std::sqrt(1 - squared_sine)}, whole};
}

}  // namespace assay::path_tracing
