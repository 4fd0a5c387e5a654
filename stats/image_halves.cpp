#include "stats/image_halves.h"

#include <cmath>
#include <numeric>

#include "stats/image_moments.h"

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
HalfMoments half_moments(const ImageStack<Real>& stack, std::size_t half) {
  HalfMoments moments{std::vector<double>(stack.extent.elements()),
                      std::vector<double>(stack.extent.elements())};
  moments_of_range(stack, 0, {moments.mean, moments.squared_error}, {half, halves});
  const double n = static_cast<double>(half_count(stack.images.size(), half));
  for (double& m2 : moments.squared_error) m2 /= n * (n - 1);
  return moments;
}

// Means over 3 elements along rows or columns, fewer at the edge.
struct Line {
  std::size_t size;
  std::size_t stride;
};
void smooth_line(std::vector<double>& values, std::size_t first, Line line) {
  double before = 0;
  for (std::size_t i = 0; i < line.size; ++i) {
    double& value = values[first + i * line.stride];
    double sum = value;
    double count = 1;
    if (i > 0) {
      sum += before;
      ++count;
    }
    if (i + 1 < line.size) {
      sum += values[first + (i + 1) * line.stride];
      ++count;
    }
    before = value;
    value = sum / count;
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

// The reference leaves the difference, and its error joins the variance. It joins that of the
// weight only where something varied: alone, an error of 1e-17 would weigh 1e17.
void add_reference(const ImageReference& reference, Half& half) {
  std::vector<double> squared(half.difference.size());
  for (std::size_t i = 0; i < squared.size(); ++i) {
    const double error = check::reference_error("image_pyramid", reference, i);
    squared[i] = error * error;
    half.difference[i] -= reference.value[i];
    half.variance[i] += squared[i];
  }
  const std::vector<double> steady = steadied(reference.extent, squared);
  for (std::size_t i = 0; i < squared.size(); ++i) {
    if (half.weight[i] > 0) half.weight[i] += steady[i];
  }
}

template <class Real>
Half half_of(const ImagePair<Real>& pair, std::size_t half) {
  HalfMoments a = half_moments(pair.a, half);
  Half result{std::move(a.mean), std::move(a.squared_error), {}, {}};
  if (pair.b != nullptr) {
    const HalfMoments b = half_moments(*pair.b, half);
    for (std::size_t i = 0; i < b.mean.size(); ++i) {
      result.difference[i] -= b.mean[i];
      result.variance[i] += b.squared_error[i];
    }
  }
  for (const double variance : result.variance) result.varied.push_back(variance > 0);
  result.weight = steadied(pair.a.extent, result.variance);
  if (pair.reference != nullptr) add_reference(*pair.reference, result);
  for (double& weight : result.weight) weight = weight > 0 ? 1 / std::sqrt(weight) : 0;
  return result;
}

}  // namespace

std::vector<double> steadied(const ImageExtent& extent, const std::vector<double>& variance) {
  std::vector<double> steady = smoothed(extent, variance);
  for (std::size_t i = 0; i < steady.size(); ++i) steady[i] = std::midpoint(steady[i], variance[i]);
  return steady;
}

template <class Real>
std::array<Half, halves> halves_of(const ImagePair<Real>& pair, const ForEach& for_each) {
  std::array<Half, halves> both;
  for_each(halves, [&](std::size_t half) { both[half] = half_of(pair, half); });
  return both;
}

template std::array<Half, halves> halves_of(const ImagePair<float>&, const ForEach&);
template std::array<Half, halves> halves_of(const ImagePair<double>&, const ForEach&);

}  // namespace assay::stats
