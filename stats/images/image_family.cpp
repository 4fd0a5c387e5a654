#include "stats/images/image_family.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/tails/tails.h"

namespace assay::stats {

double adjusted(double log_p, GroupSize group) {
  // Below 1e-300 the union bound is the same number, and exp(log_p) may be zero.
  const double one_of_all = log_p < -690
                                ? log_p + std::log(group.count)
                                : log_complement(group.count * std::log1p(-std::exp(log_p)));
  return std::min(0.0, one_of_all - std::log(group.share));
}

void decide(ImageFamily& family) {
  if (family.groups.empty()) return;
  family.winner = *std::min_element(family.groups.begin(), family.groups.end(),
                                    [](const ImageFinding& a, const ImageFinding& b) {
                                      return a.adjusted_log_p < b.adjusted_log_p;
                                    });
  family.log_p = family.winner.adjusted_log_p;
}

ImageFinding certain_finding(const ImageExtent& extent, std::size_t element, double sign) {
  const std::size_t place = element / extent.channels;
  const Rectangle window{static_cast<std::uint32_t>(place % extent.width),
                         static_cast<std::uint32_t>(place / extent.width), 1, 1};
  constexpr double never = std::numeric_limits<double>::lowest();
  return {ImageStatistic::window,
          1,
          window,
          element % extent.channels,
          std::copysign(std::numeric_limits<double>::infinity(), sign),
          never,
          never,
          Alternation::columns,
          {}};
}

}  // namespace assay::stats
