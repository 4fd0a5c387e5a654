#include "stats/pyramids/image_pyramid.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "stats/basics/check.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr const char* function_name = "image_pyramid";

LogTails tails_of(const ImageEffect& effect) {
  return std::isinf(effect.degrees) ? normal_tails(effect.t())
                                    : student_t_tails(effect.t(), effect.degrees);
}

// The least rectangle around the elements of a channel in the window of which this holds.
template <class Holds>
Rectangle around(const Rectangle& window, std::size_t channel, const ImageExtent& extent,
                 const Holds& holds) {
  std::uint32_t left = window.x + window.width, right = 0, top = window.y + window.height,
                bottom = 0;
  for (std::uint32_t y = window.y; y < window.y + window.height; ++y) {
    for (std::uint32_t x = window.x; x < window.x + window.width; ++x) {
      if (!holds((y * extent.width + x) * extent.channels + channel)) continue;
      left = std::min(left, x);
      right = std::max(right, x + 1);
      top = std::min(top, y);
      bottom = std::max(bottom, y + 1);
    }
  }
  return right == 0 ? window : Rectangle{left, top, right - left, bottom - top};
}

}  // namespace

RowPyramid::RowPyramid(const ImagePair& pair, const PyramidOptions& options)
    : extent_(pair.a.extent),
      for_each_(options.for_each),
      constants_decide_(options.constants_decide),
      unseen_(options.unseen) {
  check::image_pair(function_name, pair);
  if (!options.z.empty() && options.z.size() != extent_.elements()) {
    check::fail({function_name, "z.size()"}, options.z.size(), "that of the elements");
  }
  if (options.z.empty()) own_z_.resize(extent_.elements());
  groups_ = window_groups(extent_, coarse_size);
  found_ = empty_findings(pair, options.z.empty() ? std::span(own_z_) : options.z);
  best_.resize(groups_.size());
}

void RowPyramid::take(const ImagePair& pair, RowRange rows) {
  const RowRange reached{rows.first, std::min(rows.last + fine_rows_ahead, extent_.height)};
  half_ = halves_of(pair, reached, for_each_, std::move(half_));
  for (const Half& each : half_) {
    for (std::size_t i = 0; i < each.difference.size(); ++i) {
      if (const double variance = each.variance_at(i); !std::isfinite(variance)) {
        check::fail({function_name, "element " + std::to_string(each.first + i)}, variance,
                    "a finite difference with a finite variance");
      }
    }
  }
  offer_fine_cells({pair, half_, groups_, constants_decide_}, rows, found_, for_each_);
}

std::vector<CellNoiseOfMean> RowPyramid::offer_cells() {
  for (std::size_t i = 0; i < found_.squares.size(); ++i) {
    found_.noise.add_squares(i % extent_.channels, found_.squares[i]);
  }
  found_.noise.build();
  for (const std::vector<Candidates>& tile : found_.tiles) {
    for (std::size_t g = 0; g < tile.size(); ++g) {
      best_[g].windows += tile[g].windows();
      for (const Candidate& candidate : tile[g].kept()) offer(best_[g], candidate, found_.noise);
      if (tile[g].clearest()) offer(best_[g], *tile[g].clearest(), found_.noise);
    }
  }
  add_up_alternating(found_.coarse);
  std::vector<CellNoiseOfMean> typical;
  for (std::size_t c = 0; c < extent_.channels; ++c) {
    typical.push_back(offer_coarse_cells(found_.coarse, groups_, c, found_.noise, best_));
  }
  return typical;
}

void RowPyramid::add_best(ImageFamily& family) const {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const BestCell& best = best_[g];
    if (!best.finding) continue;
    const GroupSize size{best.windows, groups_[g].share};
    if (groups_[g].size == typical_side && groups_[g].grid == Grid::aligned)
      family.typical.group = size;
    const auto add = [&](ImageFinding finding, std::vector<ImageFinding>& findings) {
      finding.log_p = log_p_two_sided(tails_of(finding.effect));
      finding.adjusted_log_p = adjusted(finding.log_p, size);
      finding.group = size;
      finding.window = around(finding.window, finding.channel, extent_,
                              [&](std::size_t element) { return found_.weights[element] > 0; });
      findings.push_back(finding);
    };
    add(*best.finding, family.groups);
    if (best.clearest) add(*best.clearest, family.clearest);
  }
}

ImageFamily RowPyramid::family() {
  const ElementCounts& counts = found_.counts;
  ImageFamily family{.tested = counts.tested,
                     .equal_constants = counts.equal_constants - unseen_.size(),
                     .unseen = std::move(unseen_),
                     .hidden_squares = found_.noise.hidden_squares(),
                     .hidden_squares_of_twice = found_.noise.hidden_squares(2)};
  std::ranges::copy(found_.unseen, std::back_inserter(family.unseen));
  std::ranges::sort(family.unseen, {}, &UnseenElement::element);
  family.typical.noise = offer_cells();
  add_best(family);
  add_unseen(extent_, family);
  family.weights = std::move(found_.weights);
  decide(family);
  return family;
}

ImageFamily image_pyramid(const ImagePair& pair, const PyramidOptions& options) {
  // Intermediate data is not kept for all elements of a large image.
  constexpr std::size_t rows_at_a_time = 128;
  const std::size_t height = pair.a.extent.height;
  RowPyramid pyramid(pair, options);
  for (std::size_t row = 0; row < height; row += rows_at_a_time) {
    pyramid.take(pair, {row, std::min(row + rows_at_a_time, height)});
  }
  return pyramid.family();
}

}  // namespace assay::stats
