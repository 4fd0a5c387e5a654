#pragma once

// The exact law of paths whose vertices are independent. In a sphere the next diffuse hit is
// uniform in area for every vertex. In a furnace all vertices are alike.
//
// A path from a vertex of zone z estimates
//   X(z) = D(z) + e(z) + B (a(z)/s(z) X' - e(z)/s(z)).
// B is 1 with probability s(z), e is the terminal value, and D is the vertex's own score. X' is the
// same from a vertex of a random zone. Means and second moments follow from one linear equation.

#include <algorithm>
#include <optional>
#include <vector>

#include "paths/surface.h"

namespace assay::paths {

/// One zone of a scene and the first vertex's zone.
struct ZonedScene {
  struct Zone {
    double fraction;  ///< of the area
    Surface surface;
  };
  std::vector<Zone> zones;
  std::size_t seen = 0;  ///< the zone that the camera sees

  bool has_mirrors() const {
    return std::ranges::any_of(zones, [](const Zone& z) { return z.surface.mirror != Rgb{}; });
  }
  Rgb mean_emission() const;
  Rgb mean_albedo() const;
  /// Mean of L over the area: mean emission / (1 - mean albedo).
  Rgb mean_radiance() const;
  /// Le + albedo x mean radiance, of the zone that the camera sees.
  Rgb seen_radiance() const;
};

/// The step of a path in one zone, for one colour.
struct ZoneSteps {
  double fraction = 0;
  double albedo = 0;
  double survival = 0;        ///< s: number of children expected of a vertex beyond the first
  double terminal = 0;        ///< e
  double score = 0;           ///< mean of D
  double score_variance = 0;  ///< of D
};

/// Mean of X over a random zone, and of its square. Of the square nothing where it is infinite.
struct ZoneMoments {
  double mean = 0;
  std::optional<double> square;
};
ZoneMoments moments(const std::vector<ZoneSteps>& zones);

/// The variance of a path that begins in zone `first`. It has floor(n + u) continuations there,
/// each weighted by albedo / n, n = `splitting` x s. With splitting 1 it is roulette. nullopt if it
/// is infinite.
std::optional<double> path_variance(const std::vector<ZoneSteps>& zones, std::size_t first,
                                    double splitting);

}  // namespace assay::paths
