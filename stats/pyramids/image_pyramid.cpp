#include "stats/pyramids/image_pyramid.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "stats/basics/check.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

bool tested(const ZMap& map, std::size_t element) {
  return map.untested.empty() || map.untested[element] == 0;
}

void check_map(const ZMap& map) {
  constexpr const char* function = "image_pyramid";
  const std::size_t elements = map.extent.elements();
  check::at_least({function, "number of elements"}, elements, 1);
  if (map.z.size() != elements) check::fail({function, "size of z"}, map.z.size(), "the extent's");
  if (!map.untested.empty() && map.untested.size() != elements) {
    check::fail({function, "size of untested"}, map.untested.size(), "the extent's");
  }
  for (const double z : map.z) {
    if (std::isnan(z)) check::fail({function, "z"}, z, "a number");
  }
}

// One channel: its z-values and which of them count, both as summed-area tables.
class Channel {
 public:
  Channel(const ZMap& map, std::size_t channel)
      : map_(map), channel_(channel), sums_(map.extent), counts_(map.extent) {
    std::vector<double> z(map.extent.width * map.extent.height);
    std::vector<double> counted(z.size());
    for (std::size_t i = 0; i < z.size(); ++i) {
      const std::size_t element = i * map.extent.channels + channel;
      counted[i] = tested(map, element) ? 1 : 0;
      z[i] = counted[i] * map.z[element];
    }
    sums_.load(z);
    counts_.load(counted);
  }

  // Raises `best` where a window of this channel has a larger |z|; counts the windows tested.
  void scan(const WindowGroup& group, ImageFinding& best, double& windows) const {
    for (std::size_t i = 0; i < group.windows.size(); ++i) {
      const double count =
          group.grid == Grid::alternating ? counts_.of_all() : counts_.of(group, i);
      if (count == 0) continue;
      ++windows;
      const double z =
          group.size == 1 ? element(group.windows[i]) : sums_.of(group, i) / std::sqrt(count);
      if (windows > 1 && std::abs(z) <= std::abs(best.z)) continue;
      best.window = group.windows[i];
      best.channel = channel_;
      best.z = z;
    }
  }

 private:
  double element(const Rectangle& at) const {
    return map_.z[(at.y * map_.extent.width + at.x) * map_.extent.channels + channel_];
  }

  const ZMap& map_;
  std::size_t channel_;
  WindowSums sums_;
  WindowSums counts_;
};

void add_windows(ImageFamily& family, const ZMap& map) {
  std::vector<Channel> channels;
  for (std::size_t c = 0; c < map.extent.channels; ++c) channels.emplace_back(map, c);
  for (const WindowGroup& group : window_groups(map.extent, 1 - energy_share)) {
    ImageFinding best;
    best.statistic =
        group.grid == Grid::alternating ? ImageStatistic::alternating : ImageStatistic::window;
    best.size = group.size;
    double windows = 0;
    for (const Channel& channel : channels) channel.scan(group, best, windows);
    if (windows == 0) continue;
    best.log_p = log_p_two_sided(normal_tails(best.z));
    best.adjusted_log_p = adjusted(best.log_p, {windows, group.share});
    family.groups.push_back(best);
  }
}

// The energy of each channel. Channels may depend on each other, so the union bound joins them.
void add_energy(ImageFamily& family, const ZMap& map) {
  ImageFinding best = whole_image(ImageStatistic::energy, map.extent);
  double channels = 0;
  for (std::size_t c = 0; c < map.extent.channels; ++c) {
    double sum = 0;
    double degrees = 0;
    for (std::size_t i = c; i < map.z.size(); i += map.extent.channels) {
      if (!tested(map, i)) continue;
      sum += map.z[i] * map.z[i];
      ++degrees;
    }
    if (degrees == 0) continue;
    ++channels;
    const double log_p = chi_square_tails(sum, degrees).upper;
    if (channels > 1 && log_p >= best.log_p) continue;
    best.log_p = log_p;
    best.channel = c;
    best.z = (sum - degrees) / std::sqrt(2 * degrees);
  }
  if (channels == 0) return;
  best.adjusted_log_p = std::min(0.0, best.log_p + std::log(channels / energy_share));
  family.groups.push_back(best);
}

}  // namespace

ImageFamily image_pyramid(const ZMap& map) {
  check_map(map);
  ImageFamily family;
  for (std::size_t i = 0; i < map.z.size(); ++i) {
    if (!tested(map, i)) {
      ++family.equal_constants;
    } else if (std::isinf(map.z[i])) {
      ++family.different_constants;
      if (family.groups.empty()) {
        family.groups.push_back(certain_finding(map.extent, i, map.z[i]));
      }
    } else {
      ++family.tested;
    }
  }
  if (family.different_constants == 0) {
    add_windows(family, map);
    add_energy(family, map);
  }
  decide(family);
  return family;
}

}  // namespace assay::stats
