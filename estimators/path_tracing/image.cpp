// A picture of a small scene by path tracing.
//
// Each pixel is the mean of primaries, paths through a point uniform in its square. The integrators
// sample the same sum over paths of at most `depth` scatterings: the expectation of every pixel is
// the same for all.

#include "path_tracing/image.h"

namespace assay::path_tracing {

namespace {

ParameterInformation pixels(const char* name, const char* summary, const char* fallback) {
  return {.name = name,
          .type = ParameterType::count,
          .summary = summary,
          .fallback = fallback,
          .low = 2,
          .high = 4096};
}

Integrator integrator_called(const std::string& name) {
  if (name == "bsdf") return Integrator::bsdf;
  return name == "light" ? Integrator::light : Integrator::mis;
}

}  // namespace

Information image_information() {
  return {
      .name = "path_tracing/image",
      .summary = "A picture of a small scene by path tracing, with caustics and fireflies.",
      .description =
          "A primary is one path for each pixel, through a point uniform in the pixel's square. "
          "Scenes: `mild`, a closed diffuse room with a large light; `glass`, the room with a "
          "sphere of glass, one of mirror and a small light; `veach`, four plates of growing "
          "roughness under four lights of growing size (Veach and Guibas 1995). Integrators "
          "find a light by chance (`bsdf`), by a shadow ray (`light`), or by both with the "
          "balance heuristic (`mis`). What a mirror or glass sees is found by chance in all "
          "three, so all have the same expectation. Roulette ends paths from the fourth "
          "scattering on and makes up for it; the scene limits their number. Means are not "
          "known in closed form: compare integrators.",
      .parameters = {{.name = "scene",
                      .type = ParameterType::string,
                      .summary = "what the camera sees",
                      .fallback = "mild",
                      .choices = {"mild", "glass", "veach"}},
                     {.name = "integrator",
                      .type = ParameterType::string,
                      .summary = "how a path finds light",
                      .fallback = "mis",
                      .choices = {"bsdf", "light", "mis"}},
                     pixels("width", "columns of the picture", "32"),
                     pixels("height", "rows of the picture", "24")}};
}

Picture read_picture(Parameters& parameters) {
  return {.scene = named_scene(parameters.string("scene")),
          .integrator = integrator_called(parameters.string("integrator")),
          .shape = {.width = parameters.count("width"),
                    .height = parameters.count("height"),
                    .components = {"red", "green", "blue"}}};
}

}  // namespace assay::path_tracing

namespace assay::plugins {

std::vector<Entry> path_tracing_image() {
  using namespace path_tracing;
  return {{image_information(), [](Parameters& given) { return prepare_picture<>(given); }}};
}

}  // namespace assay::plugins
