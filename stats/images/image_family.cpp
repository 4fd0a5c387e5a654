#include "stats/images/image_family.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/basics/check.h"
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

void leave_out(ImageFamily& family, LeftOut which) {
  if (family.different_constants > 0) return;
  std::erase_if(family.groups, [&](const ImageFinding& finding) {
    if (finding.statistic == ImageStatistic::energy) return which.energy;
    return finding.statistic == ImageStatistic::window && finding.size < which.smallest;
  });
  family.log_p = 0;
  family.winner = {};
  decide(family);
}

void add_energy(ImageFamily& family, const ImageExtent& extent, double log_p) {
  check::log_probability({"add_energy", "log_p"}, log_p);
  ImageFinding finding = whole_image(ImageStatistic::energy, extent);
  finding.log_p = log_p;
  finding.z =
      log_p < 0 ? normal_quantile({Tail::upper, log_p}) : -std::numeric_limits<double>::infinity();
  finding.adjusted_log_p = std::min(0.0, log_p - std::log(energy_share));
  family.groups.push_back(finding);
  decide(family);
}

double energy_notice(const ImageFamily& family) { return family.log_p + std::log(energy_share); }

ImageFinding whole_image(ImageStatistic statistic, const ImageExtent& extent) {
  ImageFinding finding;
  finding.statistic = statistic;
  finding.window = {0, 0, static_cast<std::uint32_t>(extent.width),
                    static_cast<std::uint32_t>(extent.height)};
  finding.size = std::max(finding.window.width, finding.window.height);
  return finding;
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
          never};
}

}  // namespace assay::stats
