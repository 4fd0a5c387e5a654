#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/plan/sample_size.h"
#include "harness/run/evaluate.h"

namespace assay::harness {

/// Settings of the family's test at the current look.
ImageTest image_test(const DrawnTest& test);

/// The observations of this look: the subject's elements of each.
ImageViews images_of(const DrawnTest& test, std::size_t subject);

/// Red if rare lights that the pilot did not meet move the level.
Gate own_skewness_gate(const ImageOutcome& images);

/// "; the mean at that place is 1.03 against 1, +3 %" for a failed claim on images that one window
/// decided; else "".
std::string means_where_it_differs(const DrawnTest& test);

/// The least detectable difference that is the same everywhere, by the sum over the whole image.
/// nullopt if the claim allows a difference.
std::optional<double> detectable_uniformly(const TestOutcome& outcome, const TestSize& size,
                                           const ChannelOutcome& channel);

}  // namespace assay::harness
