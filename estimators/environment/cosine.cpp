// Irradiance from a sky by directions with density cos / pi about the receiver's normal:
// X = pi L(w) V(w). E[X] = E, E[X^2] = pi times the integral of L^2 cos+ under the open sky.

#include <algorithm>
#include <numbers>

#include "environment/sky.h"
#include "render/hemisphere.h"

namespace assay::plugins {

namespace {

using namespace environment;
using render::Vector3;
using std::numbers::pi;

Vector3 draw(Stream& random) {
  const double u = random.uniform();
  return render::cosine_hemisphere(u, random.uniform());
}

Rgb radiance(const Sky& sky, const Vector3& local, Cost& cost) {
  return sky.visible(local, cost) ? sky.map().radiance(sky.frame().to_world(local)) : Rgb{};
}

/// Directions of the receiver's frame.
class CosineSampler final : public Sampler {
 public:
  explicit CosineSampler(SharedSky sky) : sky_(std::move(sky)) {}

  Domain domain() const override { return Domain::hemisphere; }
  SamplerDraw sample(Stream& random) const override {
    const Vector3 w = draw(random);
    Cost uncounted;
    return {.point = {w.x, w.y, w.z},
            .density = w.z / pi,
            .weight = pi * grey(radiance(*sky_, w, uncounted))};
  }
  double density(const Point& p) const override { return p[2] / pi; }
  double evaluate(const Point& p) const override {
    Cost uncounted;
    return p[2] * grey(radiance(*sky_, {p[0], p[1], p[2]}, uncounted));
  }

 private:
  SharedSky sky_;
};

Rgb primary(const Sky& sky, Stream& random, Cost& cost) {
  Rgb value = radiance(sky, draw(random), cost);
  for (double& x : value) x *= pi;
  return value;
}

Rgb largest(const render::EnvironmentMap& map) {
  Rgb most{};
  for (std::size_t texel = 0; texel < map.size(); ++texel) {
    for (std::size_t c = 0; c < 3; ++c) most[c] = std::max(most[c], pi * map.radiance(texel)[c]);
  }
  return most;
}

std::shared_ptr<const Setup> prepare(Parameters& given) {
  const SharedSky sky = read_sky(given);
  auto channels = irradiance_channels(
      *sky,
      {.second_moment = [](std::size_t, const render::CosineMoments& m) { return pi * m.first; },
       .largest = largest(sky->map())});
  const auto draw_one = [sky](Stream& random, Cost& cost) { return primary(*sky, random, cost); };
  return rgb_setup(std::move(channels), draw_one,
                   NamedSampler{"direction", std::make_shared<CosineSampler>(sky)});
}

}  // namespace

std::vector<Entry> environment_cosine() {
  return {{{.name = "environment/cosine",
            .summary = "Irradiance from a picture of the sky by cosine-distributed directions.",
            .description =
                "Estimates the integral of L(w) max(0, n . w) V(w) over directions, channels r, g "
                "and b, by pi L(w) V(w) with w of density cos / pi about the normal n. The "
                "picture's texels are constant, so that under the open sky mean and variance are "
                "exact. The sampler `direction` is in the receiver's frame (z along n).",
            .parameters = parameters()},
           prepare}};
}

}  // namespace assay::plugins
