#include "harness/sampling/kept_observations.h"

#include <algorithm>
#include <iterator>

#include "estimators/ready_made.h"

namespace assay::harness {

Observations KeptObservations::range(std::uint64_t begin, std::uint64_t end) const {
  const std::size_t last = std::min<std::size_t>(size(), end);
  const std::size_t first = std::min<std::size_t>(begin, last);
  if (!pictures.empty()) return std::span(pictures).subspan(first, last - first);
  if (values.empty()) return {};  // read but not kept
  return std::span(values).subspan(first, last - first);
}

std::span<const double> KeptObservations::whole(std::size_t index, std::span<double> out) const {
  if (pictures.empty()) return values[index];
  std::ranges::copy(pictures[index], out.begin());
  out.back() = recorded::average_of(pictures[index]);
  return out;
}

void KeptObservations::append(KeptObservations&& next) {
  std::ranges::move(next.values, std::back_inserter(values));
  std::ranges::move(next.texels, std::back_inserter(texels));
  std::ranges::move(next.pictures, std::back_inserter(pictures));
  std::ranges::move(next.costs, std::back_inserter(costs));
}

}  // namespace assay::harness
