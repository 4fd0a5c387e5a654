#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/plan/sizes.h"
#include "harness/run/evaluate.h"

namespace assay::harness {

/// Settings of the family's test at the current look. They refer to `test`.
ImageTest image_test(const DrawnTest& test);

/// The observations of this look: the subject's elements of each.
ImageViews images_of(const DrawnTest& test, std::size_t subject);

/// True if a place of the images rejects the claim, and not their distance over all pixels alone.
bool is_told_by_place(const TestOutcome& outcome, const ChannelOutcome& channel);

/// The mean difference over the cell that speaks most against equality, in units of the images and
/// weighted as the test weighs it. The cell was searched for: the interval is one of those that
/// hold the differences of all cells at once.
struct PlaceEffect {
  double estimate = 0;
  stats::Interval interval = {};
  double other = 0;                        ///< The mean that it is held against.
  std::vector<std::size_t> elements = {};  ///< In the question.
};
std::optional<PlaceEffect> effect_at_place(const DrawnTest& test);

/// "G differs by -5.1 %, B by -4.9 %": plain means of components that clearly differ there, three
/// at most. "B by -4.9 % unweighted" is the place's own component, if its effect says otherwise.
std::string others_at(const DrawnTest& test, const PlaceEffect& place);

/// "; at that place it is 3 % too bright (2 to 4 %): 1.03 against 1". It is "" unless one cell
/// decided a failed claim on images.
std::string means_where_it_differs(const DrawnTest& test);

/// Sets the least detectable difference: one that is the same everywhere, by the sum over the whole
/// image, and one in a typical cell. Not if the claim allows a difference.
void note_detectable(const TestOutcome& outcome, const TestSize& size, ChannelOutcome& channel);

}  // namespace assay::harness
