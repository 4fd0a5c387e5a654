#pragma once

// What taking a look at images needs of a test's data.

#include <optional>
#include <string>
#include <vector>

#include "harness/plan/sample_size.h"
#include "harness/run/evaluate.h"

namespace assay::harness {

/// How the family of an image is tested at the current look.
ImageTest image_test(const DrawnTest& test);

/// The observations of this look, the subject's elements of each.
ImageViews images_of(const DrawnTest& test, std::size_t subject);

/// Whether rare lights, met by the test and not by its pilot, move the level of what took part.
reports::Gate own_skewness_gate(const ImageOutcome& images);

/// "; the mean at that place is 1.03 against 1, +3 %": of a failed claim on images whose deciding
/// sum is one over a window, what it shows. Else "".
std::string means_where_it_differs(const DrawnTest& test);

/// Of images against a picture that says nothing of its error: a fail has to be read with that. ""
/// of others.
std::string taken_as_exact(const Question& question);

/// The difference that a test of this size would find by the sum over the whole image, were it the
/// same everywhere; nullopt where the claim allows a difference.
std::optional<double> detectable_uniformly(const TestOutcome& outcome, const TestSize& size,
                                           const ChannelOutcome& channel);

}  // namespace assay::harness
