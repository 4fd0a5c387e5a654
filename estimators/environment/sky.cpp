// A receiver under the picture of an environment, with occluders between (sky/setting.h).

#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "estimators/core/mapped.h"
#include "estimators/estimator.h"
#include "estimators/parameters.h"
#include "render/environment_map.h"
#include "render/share_table.h"
#include "sky/directions.h"

namespace assay::plugins {

namespace {

using render::Rgb;
using render::Vector3;
using std::numbers::pi;

struct Sky {
  std::shared_ptr<const sky::Picture> picture;
  sky::SharedSetting setting;
};

/// map, normal, position, occluders.
std::vector<ParameterInformation> parameters() {
  return sky::with_receiver(
      text_parameter("map", "the sky: a picture, latitude-longitude, +z the first row's pole"));
}

/// Reads them. InputError at the parameter for a picture that cannot be used.
Sky read_sky(Parameters& given) {
  sky::Receiver receiver = sky::read_receiver(given);
  const std::string file = given.file("map");
  try {
    auto picture = std::make_shared<const sky::Picture>(render::read_environment(file));
    auto setting = std::make_shared<const sky::Setting>(picture, std::move(receiver));
    return {std::move(picture), std::move(setting)};
  } catch (const InputError& error) {
    given.refuse("map", "`" + file + "`: " + error.message());
  }
}

struct Primaries {
  /// E[X^2] of a channel is the sum of L^2 times this over texels of radiance L.
  std::function<double(std::size_t texel, const render::CosineMoments&)> second_moment;
  Rgb largest;  ///< no X is above, channel by channel
};

/// The channels r, g, b. Under the open sky with mean and variance.
std::vector<Channel> irradiance_channels(const Sky& sky, const Primaries& primaries) {
  const render::EnvironmentMap& map = sky.picture->map();
  Rgb square;
  for (std::size_t texel = 0; sky.setting->open() && texel < map.size(); ++texel) {
    const auto moments = cosine_moments(map.patch(texel), sky.setting->frame().normal);
    square += primaries.second_moment(texel, moments) * (map.radiance(texel) * map.radiance(texel));
  }
  std::vector<Channel> channels = sky::irradiance_channels(*sky.setting);
  for (std::size_t c = 0; c < 3; ++c) {
    // A uniform sky gives equal numbers to the cosine sampler, but for the rounding of their sums.
    channels[c].rounding = primaries.largest[c] * 0x1p-40;
    channels[c].low = 0;
    channels[c].high = primaries.largest[c] + channels[c].rounding;
    if (!channels[c].mean) continue;
    // A variance with fewer than some eight digits left by the difference counts as unknown.
    const double variance = square[c] - *channels[c].mean * *channels[c].mean;
    if (variance > 1e-6 * square[c] || square[c] == 0) channels[c].variance = variance;
  }
  return channels;
}

// E[X^2] = pi times the integral of L^2 cos+ under the open sky.

std::shared_ptr<const Setup> prepare_cosine(Parameters& given) {
  const Sky sky = read_sky(given);
  Primaries primaries{
      .second_moment = [](std::size_t, const render::CosineMoments& m) { return pi * m.first; }};
  for (std::size_t c = 0; c < 3; ++c) primaries.largest[c] = pi * sky.picture->most(c);
  const auto directions = std::make_shared<const sky::CosineDirections>();
  return sky::sky_setup(irradiance_channels(sky, primaries),
                        sky::StratifiedPrimary<>{sky.setting, directions, 1},
                        std::make_shared<sky::DirectionSampler>(sky.setting, directions), false);
}

// A texel t has probability s_t O_t / S, and the direction is uniform in it. Its radiance is s = r
// + g + b, its solid angle O, and S = sum s O. The density is p = s / S per solid angle.
//   X_c = (L_c / s) S cos+ V. E[X_c] = E_c, since s > 0 wherever any L_c > 0.
//   E[X_c^2] = S sum over texels of (L_c^2 / s) times the integral of cos+^2.

/// A direction and the texel that it was drawn in; near a border, rounding may disagree with the
/// map's own look-up.
struct Choice {
  std::size_t texel;
  Vector3 direction;
};

/// Directions of the world's frame, drawn by brightness.
class EmittanceSampler final : public Sampler {
 public:
  explicit EmittanceSampler(Sky sky)
      : sky_(std::move(sky)), texels_(mapped_indices(map().size(), [this](std::size_t texel) {
          return sum(map().radiance(texel)) * solid_angle(map().patch(texel));
        })) {}

  Domain domain() const override { return Domain::sphere; }
  SamplerDraw sample(Stream& random) const override {
    const Choice choice = choose(random);
    return {.point = point_of(choice.direction),
            .density = density(choice.texel),
            .weight = sky_.setting->grey(contribution(choice, Uncounted()))};
  }
  double density(const Point& p) const override {
    return density(map().texel(render::vector_of(p)));
  }
  double evaluate(const Point& p) const override {
    const Vector3 w = render::vector_of(p);
    return sky_.setting->grey(map().radiance(w)) * received(w, Uncounted());
  }
  // The density jumps between texels: rows in theta, columns in phi.
  Panels panels() const override {
    return {.first = map().resolution().height, .second = map().resolution().width};
  }

  Choice choose(Stream& random) const {
    const auto [texel, u, v] = texels_.choose(random);
    return {texel, direction_in(map().patch(texel), {u, v})};
  }
  /// X: radiance times cos+ V over the density.
  Rgb contribution(const Choice& choice, Cost& cost) const {
    return received(choice.direction, cost) / density(choice.texel) * map().radiance(choice.texel);
  }
  double total() const { return texels_.total(); }

 private:
  const render::EnvironmentMap& map() const { return sky_.picture->map(); }
  double density(std::size_t texel) const { return sum(map().radiance(texel)) / texels_.total(); }
  double received(const Vector3& w, Cost& cost) const {
    const Vector3 local = sky_.setting->frame().to_local(w);
    return local.z > 0 && sky_.setting->visible(local, cost) ? local.z : 0;
  }

  Sky sky_;
  render::ShareTable texels_;
};

std::shared_ptr<const Setup> prepare_emittance(Parameters& given) {
  const Sky sky = read_sky(given);
  const render::EnvironmentMap& map = sky.picture->map();
  bool black = true;
  for (std::size_t texel = 0; texel < map.size(); ++texel) black &= sum(map.radiance(texel)) == 0;
  given.require(!black, "map", "is black everywhere: no direction can be drawn");

  const auto sampler = std::make_shared<const EmittanceSampler>(sky);
  const double total = sampler->total();
  Primaries primaries;
  for (std::size_t texel = 0; texel < map.size(); ++texel) {
    const Rgb& radiance = map.radiance(texel);
    if (sum(radiance) == 0) continue;
    primaries.largest = brighter(primaries.largest, total * radiance / sum(radiance));
  }
  primaries.second_moment = [&map, total](std::size_t texel, const render::CosineMoments& moments) {
    const double brightness = sum(map.radiance(texel));
    return brightness > 0 ? total * moments.second / brightness : 0;
  };
  const auto primary = [sampler](Stream& random, Cost& cost) {
    ++cost.samples;
    return sky::Outcome{.value = sampler->contribution(sampler->choose(random), cost)};
  };
  return sky::sky_setup(irradiance_channels(sky, primaries), primary, sampler, false);
}

}  // namespace

std::vector<Entry> environment_sky() {
  return {{{.name = "environment/cosine",
            .summary = "Irradiance from a picture of the sky by cosine-distributed directions.",
            .description =
                "Estimates the integral of L(w) max(0, n . w) V(w) over directions, channels r, g "
                "and b, by pi L(w) V(w) with w of density cos / pi about the normal n. The "
                "picture's texels are constant, so that under the open sky mean and variance are "
                "exact. The sampler `direction` is in the receiver's frame (z along n).",
            .parameters = parameters()},
           prepare_cosine},
          {{.name = "environment/emittance",
            .summary = "Irradiance from a picture of the sky by directions to its bright texels.",
            .description =
                "Estimates the integral of L(w) max(0, n . w) V(w) over directions, channels r, g "
                "and b, by L max(0, n . w) V / p: a texel with probability proportional to (r + g "
                "+ b) times its solid angle, then a direction uniform in it. Under the open sky "
                "mean and variance are exact. The sampler `direction` is in the world's frame.",
            .parameters = parameters()},
           prepare_emittance}};
}

}  // namespace assay::plugins
