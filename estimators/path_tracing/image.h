#pragma once

// Pictures of a scene by path tracing, and the radiance that a camera ray meets.

#include <span>

#include "estimators/cost.h"
#include "estimators/estimator.h"
#include "estimators/path_tracing/scene.h"
#include "estimators/stream.h"

namespace assay::path_tracing {

/// How light is found at a bounce that is neither mirror nor glass. All three have one expectation.
enum class Integrator {
  light,    ///< By a point on an emitter. Emitters that the path hits by itself count for nothing.
  bsdf,     ///< By emitters that the path hits.
  multiple  ///< By both, with the balance heuristic (Veach & Guibas 1995).
};

/// The errors of a mutant; by default all is right.
struct Defects {
  double light_density = 0;  ///< Relative error of the density of points on emitters.
  double weight = 0;         ///< Part of the way of the bsdf's weight to 1.
  double roulette = 0;       ///< Part of the compensation that is left out.
  double clamp = 0;          ///< Largest value of a path's component, if above 0.
  double shadow_offset = 0;  ///< Added to the offset of shadow rays.
  double schlick = 0;        ///< Part of the way from Fresnel's reflectance to Schlick's.
};

/// One path from the camera. Russian roulette from the third bounce on.
Rgb radiance(const Scene& scene, Integrator integrator, const Defects& defects, Ray ray,
             Stream& random, Cost& cost);

/// A picture to render, and its defects.
struct Picture {
  std::shared_ptr<const Scene> scene;
  Integrator integrator = Integrator::multiple;
  std::size_t width = 0;
  std::size_t height = 0;
  Defects defects = {};
  double shift = 0;  ///< A tile of a quarter of the width and height is shifted by so many pixels.
  double dead = 0;   ///< The part of its light that one pixel loses.
};

/// The parameters of path_tracing/image.
Picture read_picture(Parameters& given);

/// Writes red, green and blue of every pixel. Each is the mean of `primaries` paths through uniform
/// points of the pixel, from a substream of its own.
void render(const Picture& picture, Stream& random, std::uint64_t primaries, std::span<double> out,
            Cost& cost);

std::shared_ptr<const Setup> image_setup(Picture picture);

}  // namespace assay::path_tracing
