#include "stats/images/lost_lights.h"

#include <variant>

#include "stats/basics/moments.h"
#include "stats/images/image_cell_skewness.h"

namespace assay::stats {
namespace {

// Flags of an element that differs among the images that weigh, and among the others.
struct Varied {
  std::vector<unsigned char> weighing;
  std::vector<unsigned char> others;
};

bool is_weighing(std::size_t image, EveryImage which) { return image % which.step == which.start; }

template <class Real>
Varied varied_of(const ImageStack<Real>& stack, EveryImage which, ElementRange range) {
  Varied varied{std::vector<unsigned char>(range.size()), std::vector<unsigned char>(range.size())};
  const std::size_t first_other = which.start == 0 ? 1 : 0;
  for (std::size_t r = 0; r < stack.images.size(); ++r) {
    const bool weighing = is_weighing(r, which);
    const Real* const base = stack.at(weighing ? which.start : first_other, range.first);
    const Real* const image = stack.at(r, range.first);
    unsigned char* const out = (weighing ? varied.weighing : varied.others).data();
    for (std::size_t i = 0; i < range.size(); ++i) {
      if (image[i] != base[i]) out[i] = 1;
    }
  }
  return varied;
}

template <class Real>
Moments moments_of(const ImageStack<Real>& stack, EveryImage which, std::size_t element) {
  Moments moments;
  for (std::size_t r = which.start; r < stack.images.size(); r += which.step) {
    moments.add(static_cast<double>(*stack.at(r, element)));
  }
  return moments;
}

}  // namespace

std::vector<LostLight> lost_lights(const CellPilot& side, EveryImage weighing,
                                   std::span<const double> weights, std::size_t first_weight,
                                   RowRange rows) {
  const ImageExtent& extent = extent_of(side.stack);
  const ElementRange range = rows.elements(extent);
  std::vector<LostLight> lost;
  std::visit(
      [&](const auto& stack) {
        const Varied varied = varied_of(stack, weighing, range);
        for (std::size_t i = 0; i < range.size(); ++i) {
          const std::size_t element = range.first + i;
          const double weight = weights[element - first_weight];
          if (!varied.weighing[i] || varied.others[i] || !(weight > 0)) continue;
          const Moments seen = moments_of(stack, weighing, element);
          const std::size_t place = element / extent.channels;
          lost.push_back({.x = place % extent.width,
                          .y = place / extent.width,
                          .channel = element % extent.channels,
                          .cumulants = cumulants_of_mean({.m2 = weight * weight * seen.m2,
                                                          .m3 = weight * weight * weight * seen.m3,
                                                          .count = static_cast<double>(seen.count),
                                                          .factor = side.factor,
                                                          .replicates = side.replicates})});
        }
      },
      side.stack);
  return lost;
}

}  // namespace assay::stats
