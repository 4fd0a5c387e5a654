#include "estimators/parameters.h"
#include "sky/directions.h"

namespace assay::plugins {

namespace {

template <class Kind>
std::shared_ptr<const Setup> prepare(Parameters& given) {
  const sky::SharedSetting setting = sky::read_setting(given);
  const auto directions = std::make_shared<const Kind>();
  return sky::sky_setup(sky::irradiance_channels(*setting),
                        sky::StratifiedPrimary<>{setting, directions, given.count("strata")},
                        std::make_shared<sky::DirectionSampler>(setting, directions), false);
}

std::vector<ParameterInformation> parameters() {
  return joined(sky::parameters(), {sky::strata_parameter()});
}

}  // namespace

std::vector<Entry> sky_uniform() {
  return {{{.name = "sky/uniform",
            .summary = "Irradiance from a sky by directions uniform over the hemisphere.",
            .description = "Estimates the integral of L(w) max(0, n . w) V(w) by 2 pi L cos V, w "
                           "uniform over the hemisphere about n. The sampler `direction` is in "
                           "the receiver's frame (z along n).",
            .parameters = parameters()},
           prepare<sky::UniformDirections>},
          {{.name = "sky/cosine",
            .summary = "Irradiance from a sky by cosine-distributed directions.",
            .description = "Estimates the integral of L(w) max(0, n . w) V(w) by pi L V, w of "
                           "density cos / pi about n. The sampler `direction` is in the "
                           "receiver's frame (z along n).",
            .parameters = parameters()},
           prepare<sky::CosineDirections>}};
}

}  // namespace assay::plugins
