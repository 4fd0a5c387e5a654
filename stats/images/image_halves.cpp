#include "stats/images/image_halves.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "stats/images/image_moments.h"

namespace assay::stats {
namespace {

// Mean and squared standard error of every element over every other replicate.
struct HalfMoments {
  std::vector<double> mean;
  std::vector<double> squared_error;
};

std::size_t half_count(std::size_t replicates, std::size_t half) {
  return (replicates + 1 - half) / halves;
}

template <class Real>
HalfMoments half_moments(const ImageStack<Real>& stack, std::size_t half, ElementRange range,
                         const ForEach& for_each) {
  constexpr std::size_t at_a_time = std::size_t{1} << 15;
  HalfMoments moments{std::vector<double>(range.size()), std::vector<double>(range.size())};
  const double n = static_cast<double>(half_count(stack.images.size(), half));
  for_each((range.size() + at_a_time - 1) / at_a_time, [&](std::size_t i) {
    const std::size_t done = i * at_a_time;
    const std::size_t size = std::min(at_a_time, range.size() - done);
    const std::span<double> errors = std::span(moments.squared_error).subspan(done, size);
    moments_of_range(stack, range.first + done,
                     {std::span(moments.mean).subspan(done, size), errors}, {half, halves});
    for (double& m2 : errors) m2 /= n * (n - 1);
  });
  return moments;
}

// Means over the 5 elements around each along rows or columns, fewer at the edge.
struct Line {
  std::size_t size;
  std::size_t stride;
};
void smooth_line(std::vector<double>& values, std::size_t first, Line line) {
  std::array<double, 2 * rows_beside + 1> around{};  // A ring of the unsmoothed values.
  const auto value = [&](std::size_t i) -> double& { return values[first + i * line.stride]; };
  const auto kept = [&](std::size_t i) -> double& { return around[i % around.size()]; };
  for (std::size_t i = 0; i < std::min(rows_beside, line.size); ++i) kept(i) = value(i);
  for (std::size_t i = 0; i < line.size; ++i) {
    const std::size_t begin = i - std::min(i, rows_beside);
    const std::size_t end = std::min(i + rows_beside + 1, line.size);
    if (i + rows_beside < line.size) kept(i + rows_beside) = value(i + rows_beside);
    double sum = 0;
    for (std::size_t j = begin; j < end; ++j) sum += kept(j);
    value(i) = sum / static_cast<double>(end - begin);
  }
}

std::vector<double> smoothed(const ImageExtent& extent, std::vector<double> values) {
  const std::size_t row = extent.width * extent.channels;
  for (std::size_t y = 0; y < extent.height; ++y) {
    for (std::size_t c = 0; c < extent.channels; ++c) {
      smooth_line(values, y * row + c, {extent.width, extent.channels});
    }
  }
  for (std::size_t i = 0; i < row; ++i) smooth_line(values, i, {extent.height, row});
  return values;
}

// The mean of each element's variance and that of its neighbourhood in the channel.
std::vector<double> steadied(const ImageExtent& extent, const std::vector<double>& variance) {
  std::vector<double> steady = smoothed(extent, variance);
  for (std::size_t i = 0; i < steady.size(); ++i) steady[i] = std::midpoint(steady[i], variance[i]);
  return steady;
}

// Subtracts the reference from the difference and adds its error to the variance. It joins no
// weight: a reference that is bright by chance has a large error, and the sums would lean to the
// dark.
void add_reference(const ImageReference& reference, Half& half) {
  for (std::size_t i = 0; i < half.difference.size(); ++i) {
    const double error = check::reference_error("image_pyramid", reference, half.first + i);
    half.difference[i] -= reference.value[half.first + i];
    half.variance[i] += error * error;
  }
}

template <class Real>
Half half_of(const ImagePair<Real>& pair, std::size_t half, RowRange rows,
             const ForEach& for_each) {
  const ImageExtent& extent = pair.a.extent;
  const ElementRange range = rows.elements(extent);
  const ImageExtent part{extent.width, rows.last - rows.first, extent.channels};
  HalfMoments a = half_moments(pair.a, half, range, for_each);
  Half result{range.first, {a.mean, {}}, std::move(a.mean), std::move(a.squared_error), {}, {}};
  if (pair.b != nullptr) {
    HalfMoments b = half_moments(*pair.b, half, range, for_each);
    for (std::size_t i = 0; i < b.mean.size(); ++i) {
      result.difference[i] -= b.mean[i];
      result.variance[i] += b.squared_error[i];
    }
    result.mean[1] = std::move(b.mean);
  }
  result.varied.reserve(range.size());
  for (const double variance : result.variance) result.varied.push_back(variance > 0);
  result.weight = steadied(part, result.variance);
  if (pair.reference != nullptr) add_reference(*pair.reference, result);
  for (double& weight : result.weight) weight = weight > 0 ? 1 / std::sqrt(weight) : 0;
  return result;
}

}  // namespace

template <class Real>
std::array<Half, halves> halves_of(const ImagePair<Real>& pair, RowRange rows,
                                   const ForEach& for_each) {
  std::array<Half, halves> both;
  const RowRange wider{rows.first - std::min(rows.first, rows_beside),
                       std::min(rows.last + rows_beside, pair.a.extent.height)};
  for_each(halves, [&](std::size_t half) { both[half] = half_of(pair, half, wider, for_each); });
  return both;
}

template std::array<Half, halves> halves_of(const ImagePair<float>&, RowRange, const ForEach&);
template std::array<Half, halves> halves_of(const ImagePair<double>&, RowRange, const ForEach&);

}  // namespace assay::stats
