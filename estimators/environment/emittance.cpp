// Irradiance from a sky by directions drawn where it is bright.
//
// A texel t has probability s_t O_t / S, and the direction is uniform in it. Its radiance is s = r
// + g + b, its solid angle O, and S = sum s O. The density is p = s / S per solid angle.
//   X_c = (L_c / s) S cos+ V. E[X_c] = E_c, since s > 0 wherever any L_c > 0.
//   E[X_c^2] = S sum over texels of (L_c^2 / s) times the integral of cos+^2.

#include <algorithm>

#include "environment/sky.h"
#include "render/alias_table.h"

namespace assay::plugins {

namespace {

using namespace environment;
using render::Vector3;

double sum(const Rgb& rgb) { return rgb[0] + rgb[1] + rgb[2]; }

std::vector<double> powers(const render::EnvironmentMap& map) {
  std::vector<double> all;
  for (std::size_t texel = 0; texel < map.size(); ++texel) {
    all.push_back(sum(map.radiance(texel)) * solid_angle(map.patch(texel)));
  }
  return all;
}

/// A direction and the texel that it was drawn in; near a border, rounding may disagree with the
/// map's own look-up.
struct Choice {
  std::size_t texel;
  Vector3 direction;
};

/// Directions of the world's frame, drawn by brightness.
class EmittanceSampler final : public Sampler {
 public:
  explicit EmittanceSampler(SharedSky sky) : sky_(std::move(sky)), texels_(powers(sky_->map())) {}

  Domain domain() const override { return Domain::sphere; }
  SamplerDraw sample(Stream& random) const override {
    const Choice choice = choose(random);
    const Vector3& w = choice.direction;
    Cost uncounted;
    return {.point = {w.x, w.y, w.z},
            .density = density(choice.texel),
            .weight = grey(contribution(choice, uncounted))};
  }
  double density(const Point& p) const override {
    return density(sky_->map().texel({p[0], p[1], p[2]}));
  }
  double evaluate(const Point& p) const override {
    const Vector3 w{p[0], p[1], p[2]};
    Cost uncounted;
    return grey(sky_->map().radiance(w)) * received(w, uncounted);
  }
  // The density jumps between texels: rows in theta, columns in phi.
  Panels panels() const override {
    return {.first = sky_->map().resolution().height, .second = sky_->map().resolution().width};
  }

  Choice choose(Stream& random) const {
    const double u = random.uniform();
    const std::size_t texel = texels_.pick(u, random.uniform());
    const double v = random.uniform();
    return {texel, direction_in(sky_->map().patch(texel), {v, random.uniform()})};
  }
  /// X: radiance times cos+ V over the density.
  Rgb contribution(const Choice& choice, Cost& cost) const {
    const double factor = received(choice.direction, cost) / density(choice.texel);
    Rgb value = sky_->map().radiance(choice.texel);
    for (double& x : value) x *= factor;
    return value;
  }
  double total() const { return texels_.total(); }

 private:
  double density(std::size_t texel) const {
    return sum(sky_->map().radiance(texel)) / texels_.total();
  }
  double received(const Vector3& w, Cost& cost) const {
    const Vector3 local = sky_->frame().to_local(w);
    return local.z > 0 && sky_->visible(local, cost) ? local.z : 0;
  }

  SharedSky sky_;
  render::AliasTable texels_;
};

Primaries primaries(const SharedSky& sky, double total) {
  Primaries result;
  const render::EnvironmentMap& map = sky->map();
  for (std::size_t texel = 0; texel < map.size(); ++texel) {
    const Rgb& radiance = map.radiance(texel);
    for (std::size_t c = 0; c < 3 && sum(radiance) > 0; ++c) {
      result.largest[c] = std::max(result.largest[c], total * radiance[c] / sum(radiance));
    }
  }
  result.second_moment = [sky, total](std::size_t texel, const render::CosineMoments& moments) {
    const double brightness = sum(sky->map().radiance(texel));
    return brightness > 0 ? total * moments.second / brightness : 0;
  };
  return result;
}

std::shared_ptr<const Setup> prepare(Parameters& given) {
  const SharedSky sky = read_sky(given);
  const render::EnvironmentMap& map = sky->map();
  bool black = true;
  for (std::size_t texel = 0; texel < map.size(); ++texel) black &= sum(map.radiance(texel)) == 0;
  if (black) given.refuse("map", "is black all over: there is nothing to draw directions from");

  const auto sampler = std::make_shared<const EmittanceSampler>(sky);
  const auto primary = [sampler](Stream& random, Cost& cost) {
    return sampler->contribution(sampler->choose(random), cost);
  };
  return rgb_setup(irradiance_channels(*sky, primaries(sky, sampler->total())), primary,
                   NamedSampler{"direction", sampler});
}

}  // namespace

std::vector<Entry> environment_emittance() {
  return {{{.name = "environment/emittance",
            .summary = "Irradiance from a picture of the sky by directions to its bright texels.",
            .description =
                "Estimates the integral of L(w) max(0, n . w) V(w) over directions, channels r, g "
                "and b, by L max(0, n . w) V / p: a texel with probability proportional to (r + g "
                "+ b) times its solid angle, then a direction uniform in it. Under the open sky "
                "mean and variance are exact. The sampler `direction` is in the world's frame.",
            .parameters = parameters()},
           prepare}};
}

}  // namespace assay::plugins
