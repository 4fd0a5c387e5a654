#include "render/alias_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace assay::render {

AliasTable::AliasTable(const std::vector<double>& weights)
    : total_(std::accumulate(weights.begin(), weights.end(), 0.0)), columns_(weights.size()) {
  const bool valid = std::ranges::all_of(weights, [](double w) { return w >= 0; });
  if (!valid || !(total_ > 0) || !std::isfinite(total_)) {
    throw std::invalid_argument("AliasTable: weights must not be negative and their sum positive");
  }
  // The rest of each weight, in units of the mean. A column too small for its share is filled up
  // from one that has more.
  std::vector<double> left;
  for (const double w : weights) {
    left.push_back(w / total_ * static_cast<double>(weights.size()));
  }
  std::vector<std::size_t> small, large;
  for (std::size_t i = 0; i < left.size(); ++i) (left[i] < 1 ? small : large).push_back(i);
  while (!small.empty() && !large.empty()) {
    const std::size_t i = small.back();
    const std::size_t donor = large.back();
    small.pop_back();
    columns_[i] = {left[i], i, donor};
    left[donor] -= 1 - left[i];
    if (left[donor] < 1) {
      large.pop_back();
      small.push_back(donor);
    }
  }
  // Rounding alone leaves columns over; they are full. One of weight zero, if rounding strands it,
  // goes to the heaviest index instead.
  const auto heaviest =
      static_cast<std::size_t>(std::ranges::max_element(weights) - weights.begin());
  for (const auto* rest : {&small, &large}) {
    for (const std::size_t i : *rest) {
      const std::size_t index = weights[i] > 0 ? i : heaviest;
      columns_[i] = {1, index, index};
    }
  }
}

}  // namespace assay::render
