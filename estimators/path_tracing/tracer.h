#pragma once

// The radiance that a camera ray meets, by paths of random bounces.

#include <string>
#include <vector>

#include "estimators/cost.h"
#include "estimators/path_tracing/scene.h"
#include "estimators/stream.h"

namespace assay::path_tracing {

/// How light is found at a bounce that is neither mirror nor glass. All three have one expectation.
enum class Integrator {
  light,    ///< by a point on an emitter; emitters that the path hits by itself count for nothing
  bsdf,     ///< by emitters that the path hits
  multiple  ///< by both, with the balance heuristic (Veach & Guibas 1995)
};
std::vector<std::string> integrator_names();
Integrator integrator_of(const std::string& name);

/// The errors of a mutant; by default all is right.
struct Defects {
  double light_density = 0;  ///< relative error of the density of points on emitters
  double weight = 0;         ///< part of the way of the bsdf's weight to 1
  double roulette = 0;       ///< part of the compensation that is left out
  double clamp = 0;          ///< largest value of a path's component, if above 0
  double shadow_offset = 0;  ///< added to the offset of shadow rays
  double schlick = 0;        ///< part of the way from Fresnel's reflectance to Schlick's
};

/// One path from the camera. Russian roulette from the third bounce on.
Colour radiance(const Scene& scene, Integrator integrator, const Defects& defects, Ray ray,
                Stream& random, Cost& cost);

}  // namespace assay::path_tracing
