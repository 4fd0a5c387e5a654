#pragma once

#include <vector>

#include "stats/basics/for_each.h"
#include "stats/images/image.h"

namespace assay::stats {

// The sum of each image's elements in their order. Several images are added up in step, so that no
// addition waits for the last. Each sum has the bits of adding up that image alone.
template <class Real>
std::vector<double> image_sums(const ImageStack<Real>& stack, const ForEach& for_each = one_by_one);

// The same for elements that follow those in `sums`.
template <class Real>
void add_to_sums(std::vector<double>& sums, const ImageStack<Real>& stack, ElementRange range,
                 const ForEach& for_each = one_by_one);

// The sums of each image's channels, those of an image together. Elements stay in their order.
template <class Real>
std::vector<double> image_channel_sums(const ImageStack<Real>& stack,
                                       const ForEach& for_each = one_by_one);

// The same for whole pixels that follow those in `sums`.
template <class Real>
void add_to_channel_sums(std::vector<double>& sums, const ImageStack<Real>& stack,
                         ElementRange range, const ForEach& for_each = one_by_one);

}  // namespace assay::stats
