#include <numbers>
#include <string>
#include <utility>

#include "correlated/estimators.h"
#include "estimators/parameters.h"
#include "sky/directions.h"
#include "steerable/directions.h"

namespace assay::correlated {

namespace {

sky::SharedDirections directions_of(Parameters& given, const sky::Setting& setting) {
  const std::string sampling = given.string("sampling");
  if (sampling == "uniform") return std::make_shared<const sky::UniformDirections>();
  if (sampling == "cosine") return std::make_shared<const sky::CosineDirections>();
  // A lobe of one coefficient is constant: what is left is the sky alone.
  const steerable::Lobe lobe =
      sampling == "emittance" ? steerable::Lobe{.coefficients = 1, .offset = 0} : steerable::Lobe{};
  const auto tree = std::make_shared<const steerable::SkyTree>(
      setting.radiance(), steerable::Preparation{.coefficients = lobe.coefficients});
  given.require(tree->least() > 0, "sky",
                "is black at a vertex of the subdivision that `sampling: " + sampling +
                    "` draws by: some directions would never be drawn; sample it uniformly or by "
                    "the cosine");
  return std::make_shared<const steerable::SteeredDirections<>>(tree, lobe, setting.frame());
}

}  // namespace

SharedPairs read_sky_pairs(Parameters& given) {
  const sky::SharedSetting setting = sky::read_setting(given);
  const sky::SharedDirections directions = directions_of(given, *setting);
  const Rgb mean = setting->radiance().mean();
  PairSource pairs{
      .colours = {},
      .draw =
          [setting, directions, mean](Stream& random, std::span<Pair> out, Cost& cost) {
            for (Pair& pair : out) {
              const double u = random.uniform();
              const sky::Direction direction = directions->draw(u, random.uniform());
              pair = {};
              if (direction.w.z <= 0) continue;
              pair.full = setting->received(direction.w, cost) / direction.density;
              pair.control = direction.w.z * mean / direction.density;
            }
          },
      .samplers = {{"direction", std::make_shared<sky::DirectionSampler>(setting, directions)}}};
  for (const Channel& channel : sky::irradiance_channels(*setting)) {
    pairs.colours.push_back({.name = channel.name,
                             .control_integral = std::numbers::pi * mean[pairs.colours.size()],
                             .integral = channel.mean,
                             .integral_error = channel.mean_error});
  }
  return std::make_shared<const PairSource>(std::move(pairs));
}

}  // namespace assay::correlated

namespace assay::plugins {

std::vector<Entry> correlated_sky() {
  return correlated::entries(
      {.name = "correlated/sky",
       .integral = "Irradiance from a sky",
       .description =
           "f is the irradiance that arrives from a direction of the sky, L cos+ V, g what would "
           "arrive from a uniform sky of the same mean radiance M if nothing stood in the way, M "
           "cos+; J = pi M. Directions are drawn as `sampling` says; by the cosine g/p = J is "
           "constant and corrects nothing. One shadow ray a primary, none below the horizon.",
       .parameters = joined(sky::parameters(),
                            {text_parameter("sampling", "the density of directions", "emittance",
                                            {"uniform", "cosine", "emittance", "steered"})}),
       .read = correlated::read_sky_pairs});
}

}  // namespace assay::plugins
