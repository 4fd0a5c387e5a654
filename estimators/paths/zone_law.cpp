#include "paths/zone_law.h"

#include <cmath>

namespace assay::paths {

Rgb ZonedScene::mean_emission() const {
  Rgb total;
  for (const Zone& zone : zones) total += zone.fraction * zone.surface.emission;
  return total;
}

Rgb ZonedScene::mean_albedo() const {
  Rgb total;
  for (const Zone& zone : zones) total += zone.fraction * zone.surface.albedo();
  return total;
}

Rgb ZonedScene::mean_radiance() const { return mean_emission() / (Rgb::grey(1) - mean_albedo()); }

Rgb ZonedScene::seen_radiance() const {
  const Surface& surface = zones[seen].surface;
  return surface.emission + surface.albedo() * mean_radiance();
}

ZoneMoments moments(const std::vector<ZoneSteps>& zones) {
  double score = 0;
  double albedo = 0;
  for (const ZoneSteps& z : zones) {
    score += z.fraction * z.score;
    albedo += z.fraction * z.albedo;
  }
  ZoneMoments out{.mean = score / (1 - albedo)};
  //`E[X^2 | z] = (D+e)^2 + 2 (D+e)(a mu - e) + Var D + (a^2 S - 2 a e mu + e^2) / s`.
  double known = 0;
  double factor = 0;
  for (const ZoneSteps& z : zones) {
    if (z.albedo == 0) {
      known += z.fraction * (z.score * z.score + z.score_variance);
      continue;
    }
    const double sure = z.score + z.terminal;
    const double reflected = z.albedo * out.mean;
    known += z.fraction * (sure * sure + 2 * sure * (reflected - z.terminal) + z.score_variance +
                           (z.terminal * z.terminal - 2 * z.terminal * reflected) / z.survival);
    factor += z.fraction * z.albedo * z.albedo / z.survival;
  }
  if (factor < 1) out.square = known / (1 - factor);
  return out;
}

std::optional<double> path_variance(const std::vector<ZoneSteps>& zones, std::size_t first,
                                    double splitting) {
  const ZoneSteps& z = zones[first];
  if (z.albedo == 0) return z.score_variance;
  const ZoneMoments next = moments(zones);
  if (!next.square) return {};
  const double n = splitting * z.survival;
  const double part = n - std::floor(n);
  // X = D + e + sum of N terms Y / n. Y = a X' - e; N has mean n and variance part (1 - part).
  const double mean = z.albedo * next.mean - z.terminal;
  const double variance = z.albedo * z.albedo * (*next.square - next.mean * next.mean);
  return z.score_variance + variance / n + part * (1 - part) * mean * mean / (n * n);
}

}  // namespace assay::paths
