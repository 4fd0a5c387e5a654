#include "harness/image/image_flips.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "harness/base/parallel.h"
#include "harness/theta/decision.h"

namespace assay::harness {
namespace {

// Up to so many replicates all sign vectors are enumerated; beyond that a random choice is made.
// The other limits bound the number and length of vectors, so that the test takes a fraction of a
// second.
constexpr std::size_t most_enumerated = 18;
constexpr double most_flips = 0x1p19;
constexpr std::size_t most_flipped = 64;
constexpr std::uint64_t enough_flips = 100;

using Images = std::vector<std::vector<double>>;

/// Means of the images r, r + groups, r + 2 groups, …: their signs flip as well as the images'.
template <class Real>
Images grouped(const stats::ImageStack<Real>& stack, stats::ElementRange range,
               std::size_t groups) {
  Images means(groups, std::vector<double>(range.size()));
  on_all_threads(groups, [&](std::size_t g) {
    const std::size_t members = (stack.images.size() - g + groups - 1) / groups;
    const Real* const first = stack.at(0, range.first);
    for (std::size_t r = g; r < stack.images.size(); r += groups) {
      const Real* const image = stack.at(r, range.first);
      for (std::size_t i = 0; i < means[g].size(); ++i) {
        // Taken from the first image on, so that a constant's mean has no rounding.
        const double difference = double{image[i]} - double{first[i]};
        means[g][i] += difference / static_cast<double>(members);
      }
    }
    for (std::size_t i = 0; i < means[g].size(); ++i) means[g][i] += first[i];
  });
  return means;
}

stats::ImageStack<double> stack_of(const stats::ImageExtent& extent, const Images& images,
                                   stats::ElementRange range) {
  stats::ImageStack<double> stack{extent, {}, range};
  for (const std::vector<double>& image : images) stack.images.emplace_back(image);
  return stack;
}

double least_log_p(const FlipSize& size) {
  return size.enumerated() ? -std::log(2.0) * static_cast<double>(size.images - 1)
                           : -std::log1p(static_cast<double>(size.flips));
}

}  // namespace

bool FlipSize::enumerated() const { return images <= most_enumerated; }

std::optional<FlipSize> flip_size(const ErrorShare& share, std::size_t images) {
  FlipSize size{.share = share.alpha * stats::energy_share,
                .images = std::min(most_flipped, images)};
  const double flips = std::ceil(4 / size.share);
  if (static_cast<double>(size.images) < 2 + std::log2(1 / size.share)) return {};
  if (!size.enumerated() && flips > most_flips) return {};
  size.flips = static_cast<std::uint64_t>(flips);
  return size;
}

template <class Real>
void GroupedFlips<Real>::take(const stats::ImagePair<Real>& pair, stats::RowRange rows) {
  const std::size_t first_count = pair.a.images.size();
  const std::size_t second_count = pair.b != nullptr ? pair.b->images.size() : first_count;
  // Pairs a group of one side with one of the other.
  const std::size_t groups = std::min({most_flipped, first_count, second_count});
  is_grouped_ = std::max(first_count, second_count) > groups;
  if (!is_grouped_) {
    single_.take(pair, rows, on_all_threads);
    return;
  }
  const stats::ElementRange range = rows.elements(pair.a.extent);
  const Images first = grouped(pair.a, range, groups);
  const Images other = pair.b != nullptr ? grouped(*pair.b, range, groups) : Images();
  const stats::ImageStack<double> a = stack_of(pair.a.extent, first, range);
  const stats::ImageStack<double> b = stack_of(pair.a.extent, other, range);
  grouped_.take({a, pair.b != nullptr ? &b : nullptr, pair.reference}, rows, on_all_threads);
}

template <class Real>
stats::FlipMatrix GroupedFlips<Real>::matrix() const {
  return is_grouped_ ? grouped_.matrix() : single_.matrix();
}

template class GroupedFlips<float>;
template class GroupedFlips<double>;

bool add_flipped_energy(stats::ImageFamily& family, const stats::ImageExtent& extent,
                        const FlipSize& size, Stream signs,
                        const std::function<stats::FlipMatrix()>& matrix) {
  if (least_log_p(size) >= stats::energy_notice(family)) return false;
  signs.draw_ahead();
  const stats::FlipPlan plan{size.share, size.flips, enough_flips};
  const stats::SignFlip flip = size.enumerated() ? stats::sign_flip(matrix(), size.share)
                                                 : stats::sign_flip(matrix(), plan, signs);
  stats::add_energy(family, extent, flip.log_p);
  return true;
}

}  // namespace assay::harness
