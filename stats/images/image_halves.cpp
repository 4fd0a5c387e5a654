#include "stats/images/image_halves.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "stats/images/image_moments.h"

namespace assay::stats {
namespace {

// Means over the 5 groups of `size` numbers around each, fewer at the ends.
void smooth(std::span<const double> values, std::size_t size, std::span<double> means) {
  const std::size_t count = values.size() / size;
  for (std::size_t group = 0; group < count; ++group) {
    const std::size_t begin = group - std::min(group, rows_beside);
    const std::size_t end = std::min(group + rows_beside + 1, count);
    for (std::size_t i = 0; i < size; ++i) {
      double sum = 0;
      for (std::size_t j = begin; j < end; ++j) sum += values[j * size + i];
      means[group * size + i] = sum / static_cast<double>(end - begin);
    }
  }
}

std::vector<double> smoothed(const ImageExtent& extent, std::span<const double> values) {
  std::vector<double> along_rows(values.size());
  for (std::size_t i = 0; i < values.size(); i += extent.row()) {
    smooth(values.subspan(i, extent.row()), extent.channels,
           std::span(along_rows).subspan(i, extent.row()));
  }
  std::vector<double> both(values.size());
  smooth(along_rows, extent.row(), both);
  return both;
}

// The mean of each element's variance and that of its neighbourhood in the channel.
std::vector<double> steadied(const ImageExtent& extent, const std::vector<double>& variance) {
  std::vector<double> steady = smoothed(extent, variance);
  for (std::size_t i = 0; i < steady.size(); ++i) steady[i] = std::midpoint(steady[i], variance[i]);
  return steady;
}

const ImageStack& stack_of(const ImagePair& pair, std::size_t side) {
  return side == 0 ? pair.a : *pair.b;
}

// True if this side has more replicates than the other.
bool has_more(const ImagePair& pair, std::size_t side) {
  return pair.b != nullptr &&
         stack_of(pair, side).images.size() > stack_of(pair, 1 - side).images.size();
}

// Sets means, variances and difference of these elements.
void take(const ImagePair& pair, std::size_t which, ElementRange range, Half& half) {
  const std::size_t here = range.first - half.first;
  const std::size_t size = range.size();
  const auto part = [&](std::vector<double>& all) { return std::span(all).subspan(here, size); };
  const auto take_moments = [&](const ImageStack& stack, MomentArrays of) {
    moments_of_range(stack, range.first, of, {which, halves});
    const double n = static_cast<double>(half_count(stack.images.size(), which));
    for (double& m2 : of.m2) m2 /= n * (n - 1);
  };
  const auto take_side = [&](const ImageStack& stack, std::size_t side) {
    take_moments(stack, {part(half.mean[side]), part(half.variance[side])});
    if (!has_more(pair, side)) return;
    ImageStack fewest = stack;
    fewest.images.resize(stack_of(pair, 1 - side).images.size());
    take_moments(fewest, {part(half.mean_of_fewest[side]), part(half.variance_of_fewest[side])});
  };
  take_side(pair.a, 0);
  if (pair.b != nullptr) take_side(*pair.b, 1);
  for (std::size_t i = here; i < here + size; ++i) {
    half.difference[i] =
        half.mean[0][i] -
        (pair.b != nullptr ? half.mean[1][i] : pair.reference.value[half.first + i]);
  }
}

// Drops elements before the range, and takes those that are new. A reference's error joins no
// weight. A reference that is bright by chance has a large error, and the sums would lean to the
// dark.
void advance(const ImagePair& pair, std::size_t which, ElementRange range, Half& half,
             const ForEach& for_each) {
  constexpr std::size_t at_a_time = std::size_t{1} << 12;
  const std::size_t gone = std::min(range.first - half.first, half.difference.size());
  const std::size_t kept = half.difference.size() - gone;
  half.first = range.first;
  const auto move = [&](auto& all) {
    all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(gone));
    all.resize(range.size());
  };
  for (std::size_t side = 0; side < (pair.b != nullptr ? 2U : 1U); ++side) {
    move(half.mean[side]);
    move(half.variance[side]);
    if (!has_more(pair, side)) continue;
    move(half.mean_of_fewest[side]);
    move(half.variance_of_fewest[side]);
  }
  move(half.difference);
  for_each((range.size() - kept + at_a_time - 1) / at_a_time, [&](std::size_t i) {
    const std::size_t first = range.first + kept + i * at_a_time;
    take(pair, which, {first, std::min(first + at_a_time, range.last)}, half);
  });
  const std::size_t row = pair.a.extent.row();
  std::vector<double> variance(range.size());
  for (std::size_t i = 0; i < variance.size(); ++i) variance[i] = half.variance_at(i);
  half.weight =
      steadied({pair.a.extent.width, range.size() / row, pair.a.extent.channels}, variance);
  for (double& weight : half.weight) weight = weight > 0 ? 1 / std::sqrt(weight) : 0;
}

}  // namespace

std::array<Half, halves> halves_of(const ImagePair& pair, RowRange rows, const ForEach& for_each,
                                   std::array<Half, halves> before) {
  const RowRange wider{rows.first - std::min(rows.first, rows_beside),
                       std::min(rows.last + rows_beside, pair.a.extent.height)};
  const ElementRange range = wider.elements(pair.a.extent);
  for (std::size_t e = range.first; pair.b == nullptr && e < range.last; ++e) {
    check::reference_error("image_pyramid", pair.reference, e);
  }
  for_each(halves, [&](std::size_t half) { advance(pair, half, range, before[half], for_each); });
  for (std::size_t i = 0; i < range.size(); ++i) {
    const auto tells = [i](const Half& half) {
      return half.variance_at(i) > 0 || half.difference[i] != 0;
    };
    if (std::ranges::any_of(before, tells)) continue;
    for (Half& half : before) half.weight[i] = 0;
  }
  return before;
}

}  // namespace assay::stats
