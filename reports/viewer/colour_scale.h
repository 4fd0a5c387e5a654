#pragma once

// Numbers as colours, the same in light, dark and print.

#include <string>

#include "reports/formats/png.h"
#include "reports/record/record.h"

namespace assay::reports {

enum class Palette {
  difference,  ///< blue below zero, white at zero, red above
  brightness,  ///< black to white
  evidence     ///< a probability's logarithm: white at 1, dark violet at the lower end
};

/// Maps [low, high] to a palette; what lies beyond has the colour of the end.
struct ColourScale {
  Palette palette = Palette::brightness;
  double low = 0;
  double high = 1;

  Rgb operator()(double value) const;
};

/// The scale of a map. z goes from -L to L, where L is the largest |z|, clamped to [5, 15].
/// Probabilities go from 1e-6 to 1 by their logarithm. Others go from 0, or the least value below
/// it, to the largest.
ColourScale scale_of(const Map& map);

/// One component of a map, in colours.
Pixels picture_of(const Map& map, std::size_t component, const ColourScale& scale);

}  // namespace assay::reports
