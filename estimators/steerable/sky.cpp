// Irradiance from a sky by steerable importance sampling: X = L cos+ V / p(w), p in proportion to
// the sky times the clamped cosine, both approximately; E[X] = E as p > 0 wherever L cos+ > 0.

#include "sky/estimator.h"
#include "steerable/directions.h"
#include "steerable/parameters.h"

namespace assay::plugins {

namespace {

std::shared_ptr<const Setup> prepare(Parameters& given) {
  const sky::SharedSetting setting = sky::read_setting(given);
  const steerable::Lobe lobe = steerable::read_lobe(given);
  const auto directions = std::make_shared<const steerable::SteeredDirections<>>(
      steerable::read_tree(given, *setting), lobe, setting->frame());
  return sky::sky_setup(setting, directions,
                        sky::StratifiedPrimary<>(setting, directions, given.count("strata")), true);
}

std::vector<ParameterInformation> parameters() {
  std::vector<ParameterInformation> all = sky::parameters();
  for (ParameterInformation& p : steerable::parameters()) all.push_back(std::move(p));
  all.push_back(sky::strata_parameter());
  return all;
}

}  // namespace

std::vector<Entry> steerable_sky() {
  return {
      {{.name = "steerable/sky",
        .summary = "Irradiance from a sky by steerable importance sampling.",
        .description =
            "Estimates the integral of L(w) max(0, n . w) V(w) by L cos+ V / p (Subr and Arvo "
            "2007). The sphere is cut into 8 4^level triangles; at their vertices the sky's "
            "luminance times spherical harmonics, summed over a binary tree. For the normal n nine "
            "coefficients turn the harmonics into the clamped cosine (plus an offset that keeps it "
            "positive: above 0.140319), and every node's weight is a scalar product. A sample "
            "descends the tree, draws a point q of a triangle with linear density, and has p = "
            "weight(q) / Z |q|^3 / d, Z the root's weight, d the distance of the triangle's plane. "
            "Directions below the horizon count as zero. Channels `below` (the part of them) and "
            "`nodes` (of the tree, passed through for a sample) are diagnostic. The sampler "
            "`direction` is in the receiver's frame (z along n).",
        .parameters = parameters()},
       prepare}};
}

}  // namespace assay::plugins
