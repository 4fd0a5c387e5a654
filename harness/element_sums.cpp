#include "harness/element_sums.h"

#include <algorithm>
#include <array>

#include "harness/assumptions.h"
#include "harness/difference_skewness.h"
#include "harness/parallel.h"
#include "stats/image_element_moments.h"

namespace assay::harness {
namespace {

constexpr std::size_t elements_at_a_time = 4096;

/// What some elements of one side have together.
struct Extremes {
  double minimum;
  double maximum;
  std::uint64_t nonzero = 0;
  bool sound = true;
};

Extremes extremes_of(std::span<const stats::Moments> elements) {
  Extremes extremes{elements[0].minimum, elements[0].maximum};
  for (const stats::Moments& each : elements) {
    extremes.minimum = std::min(extremes.minimum, each.minimum);
    extremes.maximum = std::max(extremes.maximum, each.maximum);
    extremes.nonzero += each.nonzero;
    const bool varies = each.minimum < each.maximum;
    extremes.sound = extremes.sound && (!varies || beyond_doubles(each, "").empty());
  }
  return extremes;
}

/// Of some elements.
struct Part {
  std::array<Extremes, 2> sides = {};
  std::vector<double> skewness = {};
};

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
  const stats::ImageStack<float>* const stacks[] = {&pair.a, pair.b};
  const stats::ElementRange range = rows.elements(extent_);
  std::vector<Part> parts((range.size() + elements_at_a_time - 1) / elements_at_a_time);
  on_all_threads(parts.size(), [&](std::size_t i) {
    const std::size_t first = range.first + i * elements_at_a_time;
    const std::size_t size = std::min(elements_at_a_time, range.last - first);
    std::array<std::vector<stats::Moments>, 2> moments;
    for (std::size_t s = 0; s < 2; ++s) {
      moments[s].resize(size);
      stats::element_moments(*stacks[s], first, moments[s]);
      for (std::size_t k = 0; k < size; ++k) {
        sides_[s].mean[first + k] = moments[s][k].mean;
        sides_[s].m2[first + k] = moments[s][k].m2;
      }
      parts[i].sides[s] = extremes_of(moments[s]);
      if (first == 0) sides_[s].first = moments[s][0];
    }
    for (std::size_t k = 0; k < size; ++k) {
      const SkewedSide sides[] = {{moments[0][k], 1, 1}, {moments[1][k], 1, -1}};
      if (const auto skewness = difference_skewness(sides)) parts[i].skewness.push_back(*skewness);
    }
  });
  for (const Part& part : parts) {
    for (std::size_t s = 0; s < 2; ++s) {
      const bool none = &part == &parts[0] && rows.first == 0;
      const Extremes& found = part.sides[s];
      ElementSums& side = sides_[s];
      side.minimum = none ? found.minimum : std::min(side.minimum, found.minimum);
      side.maximum = none ? found.maximum : std::max(side.maximum, found.maximum);
      side.nonzero += found.nonzero;
      sound_ = sound_ && found.sound;
    }
    for (const double skewness : part.skewness) skewness_ += skewness;
    varying_ += static_cast<double>(part.skewness.size());
  }
}

double SumsOfTwo::skewness() const { return varying_ > 0 ? skewness_ / varying_ : 0; }

std::vector<ElementSums> SumsOfTwo::finish(std::span<const std::vector<double>> averages) {
  for (std::size_t s = 0; s < 2; ++s) {
    stats::ImageStack<double> stack{{.width = 1, .height = 1}, {}};
    for (const double& average : averages[s]) stack.images.emplace_back(&average, 1);
    stats::element_moments(stack, 0, std::span(&sides_[s].average, 1));
  }
  return std::move(sides_);
}

}  // namespace assay::harness
