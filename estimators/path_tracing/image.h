#pragma once

// Pictures of a scene by path tracing.

#include <span>

#include "estimators/estimator.h"
#include "estimators/path_tracing/tracer.h"

namespace assay::path_tracing {

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

/// Static information of path_tracing/image, and its parameters.
Information image_information();
Picture read_picture(Parameters& given);

/// Writes red, green and blue of every pixel. Each is the mean of `primaries` paths through uniform
/// points of the pixel, from a substream of its own.
void render(const Picture& picture, Stream& random, std::uint64_t primaries, std::span<double> out,
            Cost& cost);

std::shared_ptr<const Setup> image_setup(Picture picture);

}  // namespace assay::path_tracing
