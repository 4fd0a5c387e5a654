#pragma once

// The common parts of this folder's estimators: parameters, worlds, channels, set-up.

#include <functional>
#include <memory>
#include <optional>
#include <variant>

#include "estimators/estimator.h"
#include "paths/path.h"
#include "paths/worlds.h"
#include "paths/zone_law.h"

namespace assay::paths {

using SharedSphere = std::shared_ptr<const SphereWorld>;
using SharedMesh = std::shared_ptr<const MeshWorld>;

/// A scene ready for paths.
struct Scene {
  std::variant<SharedSphere, SharedMesh> world;
  bool grey = true;
  /// Present if vertices are independent: in spheres and furnaces.
  std::optional<ZonedScene> law;
  Incoming global;
};

Scene read_scene(Parameters& parameters);

struct Known {
  std::optional<double> mean = {};
  std::optional<double> variance = {};
};

/// Exact facts of an estimator, by colour, and the expected numbers of vertices at each bounce.
struct Knowledge {
  std::array<Known, 3> colours = {};
  std::optional<std::array<double, Tally::bounces>> vertices = {};
  std::optional<double> all_vertices = {};
  double low = -std::numeric_limits<double>::infinity();
};

/// The steps of a path in the zones of a sphere or of a furnace.
struct Steps {
  std::function<double(const Surface&)> survival;
  std::function<Rgb(const Surface&)> terminal = [](const Surface&) { return Rgb{}; };
  Direct direct = Direct::hit;
  double splitting = 1;
};

/// The exact means, and with `steps`, where survival depends on the zone alone, the variances and
/// numbers of vertices.
Knowledge knowledge(const Scene& scene, const std::optional<Steps>& steps);

/// One path, or one tree of them.
using Trace = std::function<void(Stream&, Tally&, Cost&)>;

std::shared_ptr<const Setup> setup(const Scene& scene, const Knowledge& known, Trace trace,
                                   std::vector<NamedSampler> samplers = {}, const Cost& cost = {});

/// The same for paths that `path(world, random, tally, cost)` follows in the world that a scene
/// has.
template <class Path>
std::shared_ptr<const Setup> setup_in_world(const Scene& scene, const Knowledge& known,
                                            const Path& path,
                                            std::vector<NamedSampler> samplers = {},
                                            const Cost& cost = {}) {
  return std::visit(
      [&](const auto& world) {
        return setup(
            scene, known,
            [world, path](Stream& random, Tally& tally, Cost& spent) {
              path(*world, random, tally, spent);
            },
            std::move(samplers), cost);
      },
      scene.world);
}

ParameterInformation scene_parameter(std::string fallback);
ParameterInformation direct_parameter();
Direct read_direct(Parameters& parameters, const Scene& scene);

/// The sampler of diffuse directions in the frame of the normal, of density cos / pi.
NamedSampler direction_sampler();

/// Everything that a path with roulette needs besides its world.
struct RoulettePlan {
  Rule rule = Rule::max_albedo;
  Direct direct = Direct::hit;
  /// e of each patch; empty for the classical roulette.
  std::vector<Rgb> terminal = {};
  /// The global estimate and the factor that e was made with; nothing for local estimates.
  std::optional<Incoming> incoming = {};
  double scale = 0;
  Cost cost = {};

  Roulette roulette(const Scene& scene) const { return {rule, scene.global.all, terminal}; }
};

RoulettePlan read_classical(Parameters& parameters, const Scene& scene);
RoulettePlan read_improved(Parameters& parameters, const Scene& scene);

/// e of every patch of a scene from its global estimate.
std::vector<Rgb> global_terminal(const Scene& scene, const Incoming& incoming, Direct direct,
                                 double scale);

}  // namespace assay::paths
