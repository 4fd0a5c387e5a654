#include "harness/sampling/element_sums.h"

#include <algorithm>
#include <array>
#include <limits>

#include "harness/base/parallel.h"
#include "harness/sampling/beyond_doubles.h"
#include "stats/images/image_element_moments.h"

namespace assay::harness {
namespace {

constexpr std::size_t elements_at_a_time = 4096;

/// Extremes over some elements.
struct Extremes {
  double minimum = std::numeric_limits<double>::infinity();
  double maximum = -std::numeric_limits<double>::infinity();
  std::uint64_t nonzero = 0;
  bool sound = true;
};

Extremes extremes_of(std::span<const stats::Moments> elements) {
  Extremes extremes;
  for (const stats::Moments& each : elements) {
    extremes.minimum = std::min(extremes.minimum, each.minimum);
    extremes.maximum = std::max(extremes.maximum, each.maximum);
    extremes.nonzero += each.nonzero;
    const bool varies = each.minimum < each.maximum;
    extremes.sound = extremes.sound && (!varies || beyond_doubles(each, "").empty());
  }
  return extremes;
}

/// The extremes of these elements; `sums` keeps their moments.
Extremes take_side(const stats::ImageStack<float>& stack, stats::ElementRange range,
                   ElementSums& sums) {
  std::vector<stats::Moments> moments(range.size());
  stats::element_moments(stack, range.first, moments);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    sums.mean[range.first + i] = moments[i].mean;
    sums.m2[range.first + i] = moments[i].m2;
  }
  if (range.first == 0) sums.first = moments[0];
  return extremes_of(moments);
}

void join(ElementSums& sums, const Extremes& found) {
  sums.minimum = std::min(sums.minimum, found.minimum);
  sums.maximum = std::max(sums.maximum, found.maximum);
  sums.nonzero += found.nonzero;
}

}  // namespace

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
  std::vector<std::array<Extremes, 2>> parts((range.size() + elements_at_a_time - 1) / elements_at_a_time);
  on_all_threads(parts.size(), [&](std::size_t i) {
    const std::size_t first = range.first + i * elements_at_a_time;
    const stats::ElementRange some{first, std::min(first + elements_at_a_time, range.last)};
    parts[i] = {take_side(pair.a, some, sides_[0]), take_side(*pair.b, some, sides_[1])};
  });
  for (const auto& part : parts) {
    for (std::size_t s = 0; s < sides_.size(); ++s) {
      join(sides_[s], part[s]);
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
