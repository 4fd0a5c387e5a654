#include "harness/sampling/element_sums.h"

#include <algorithm>
#include <array>

#include "harness/base/parallel.h"
#include "harness/sampling/summary.h"
#include "stats/images/image_moments.h"

namespace assay::harness {
namespace {

constexpr std::size_t elements_at_a_time = 4096;

/// Results of some elements of one side.
struct SideResult {
  Extremes extremes = {};
  bool sound = true;
};

/// The extremes of these elements; `sums` keeps their moments.
SideResult take_side(const stats::ImageStack<float>& stack, stats::ElementRange range,
                     ElementSums& sums) {
  std::vector<stats::Moments> moments(range.size());
  stats::element_moments(stack, range.first, moments);
  SideResult result;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const stats::Moments& each = moments[i];
    sums.mean[range.first + i] = each.mean;
    sums.m2[range.first + i] = each.m2;
    result.extremes.merge({each.minimum, each.maximum, each.nonzero});
    const bool varies = each.minimum < each.maximum;
    result.sound = result.sound && (!varies || beyond_doubles(each, "").empty());
  }
  if (range.first == 0) sums.first = moments[0];
  return result;
}

}  // namespace

void Extremes::merge(const Extremes& other) {
  minimum = std::min(minimum, other.minimum);
  maximum = std::max(maximum, other.maximum);
  nonzero += other.nonzero;
}

stats::Moments ElementSums::moments(std::size_t channel) const {
  if (channel == 0) return first;
  if (channel == mean.size()) return average;
  return {.count = count, .mean = mean[channel], .m2 = m2[channel]};
}

SumsOfTwo::SumsOfTwo(const stats::ImageExtent& extent, std::uint64_t pictures)
    : extent_(extent),
      sides_(2, {.count = pictures,
                 .mean = std::vector<double>(extent.elements()),
                 .m2 = std::vector<double>(extent.elements())}) {}

void SumsOfTwo::take(const stats::ImagePair<float>& pair, stats::RowRange rows) {
  const stats::ElementRange range = rows.elements(extent_);
  std::vector<std::array<SideResult, 2>> parts((range.size() + elements_at_a_time - 1) /
                                               elements_at_a_time);
  on_all_threads(parts.size(), [&](std::size_t i) {
    const std::size_t first = range.first + i * elements_at_a_time;
    const stats::ElementRange some{first, std::min(first + elements_at_a_time, range.last)};
    parts[i] = {take_side(pair.a, some, sides_[0]), take_side(*pair.b, some, sides_[1])};
  });
  for (const auto& part : parts) {
    for (std::size_t s = 0; s < sides_.size(); ++s) {
      sides_[s].extremes.merge(part[s].extremes);
      sound_ = sound_ && part[s].sound;
    }
  }
}

std::vector<ElementSums> SumsOfTwo::finish(std::span<const std::vector<double>> averages) {
  for (std::size_t s = 0; s < 2; ++s) {
    stats::ImageStack<double> stack{{.width = 1, .height = 1}, {}};
    for (const double& average : averages[s]) stack.images.emplace_back(&average, 1);
    stats::element_moments(stack, 0, std::span(&sides_[s].average, 1));
  }
  return std::move(sides_);
}

}  // namespace assay::harness
