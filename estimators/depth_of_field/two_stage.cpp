// Lens integration in two stages: a pilot decides how many lens samples follow, and is thrown away.
//
// X is the mean of N fresh lens samples, N a function of the pilot alone: E[X | N] is the average
// over the lens, whatever N.

#include "depth_of_field/two_stage.h"

namespace assay::depth_of_field {

Information two_stage_information() {
  return {.name = "depth_of_field/two_stage",
          .summary = "The radiance at one pixel, by as many lens points as a pilot asks for.",
          .description =
              "A pilot of lens samples gives their variance s^2; X is the mean of N = max(1, "
              "ceil(s^2 / noise^2)) further ones, at most `most`. As the pilot is not averaged "
              "with them, N does not depend on what is averaged, and X is unbiased; to average "
              "the pilot too is a bias (Kirk and Arvo 1991, \"Unbiased sampling techniques for "
              "image synthesis\"). The pilot's rays are counted.",
          .parameters = {scene_parameter("edge"),
                         pixel_parameter(),
                         {.name = "pilot",
                          .type = ParameterType::count,
                          .summary = "lens samples of the pilot",
                          .fallback = "8",
                          .low = 2,
                          .high = 1e6},
                         {.name = "noise",
                          .summary = "standard error that is asked for",
                          .unit = "radiance",
                          .fallback = "0.1",
                          .low = 0,
                          .low_excluded = true},
                         {.name = "most",
                          .type = ParameterType::count,
                          .summary = "lens samples after the pilot, at most",
                          .fallback = "4096",
                          .low = 1,
                          .high = 1e6}}};
}

StageRule read_stage_rule(Parameters& given) {
  return {given.count("pilot"), given.number("noise"), given.count("most")};
}

}  // namespace assay::depth_of_field

namespace assay::plugins {

std::vector<Entry> depth_of_field_two_stage() {
  using namespace depth_of_field;
  return {{two_stage_information(), [](Parameters& given) { return prepare_two_stage<>(given); }}};
}

}  // namespace assay::plugins
