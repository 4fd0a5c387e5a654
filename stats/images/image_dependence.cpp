#include "stats/images/image_dependence.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <string_view>

#include "stats/basics/moments.h"
#include "stats/basics/scores.h"

namespace assay::stats {
namespace {

constexpr std::size_t tile_side = 8;
// Probability that independent images repeat a tile anywhere.
constexpr double chance = 1e-6;
constexpr std::size_t most_sampled = 16384;
constexpr std::size_t fewest_sampled = 64;
// Pairs whose indices differ by at most so much show how alike others are.
constexpr std::size_t most_apart = 8;
constexpr double errors_beyond = 8;
constexpr double least_correlation = .05;

template <class Real>
std::vector<const ImageStack<Real>*> sides_of(const ImagePair<Real>& pair) {
  std::vector<const ImageStack<Real>*> sides{&pair.a};
  if (pair.b != nullptr) sides.push_back(pair.b);
  return sides;
}

std::size_t tiles_across(std::size_t size) { return (size + tile_side - 1) / tile_side; }
std::size_t tiles_of(const ImageExtent& extent) {
  return tiles_across(extent.width) * tiles_across(extent.height);
}

// The pixels of a tile that the image has.
Rectangle tile_at(const ImageExtent& extent, std::size_t x, std::size_t y, std::size_t rows_end) {
  return {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
          static_cast<std::uint32_t>(std::min(tile_side, extent.width - x)),
          static_cast<std::uint32_t>(std::min(tile_side, rows_end - y))};
}

template <class Real>
const Real* row_of(const ImageStack<Real>& stack, std::size_t image, const Rectangle& tile,
                   std::size_t row) {
  return stack.at(image, ((tile.y + row) * stack.extent.width + tile.x) * stack.extent.channels);
}

// A hash of a quarter of the tile's elements. Tiles of one hash are compared whole.
template <class Real>
std::uint64_t digest(const ImageStack<Real>& stack, std::size_t image, const Rectangle& tile) {
  std::uint64_t state = 0;
  for (std::size_t row = 0; row < tile.height; ++row) {
    const Real* const values = row_of(stack, image, tile, row);
    for (std::size_t i = row % 4; i < tile.width * stack.extent.channels; i += 4) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, values + i, sizeof(Real));
      state = (state ^ bits) * 0x9e3779b97f4a7c15;
      state ^= state >> 29;
    }
  }
  return state;
}

template <class Real>
bool equal_in(const Rectangle& tile, const ImageStack<Real>& a, std::size_t i,
              const ImageStack<Real>& b, std::size_t j) {
  for (std::size_t row = 0; row < tile.height; ++row) {
    if (std::memcmp(row_of(a, i, tile, row), row_of(b, j, tile, row),
                    tile.width * a.extent.channels * sizeof(Real)) != 0) {
      return false;
    }
  }
  return true;
}

// The logarithm of a bound on the probability that another image repeats this one's tile.
template <class Real>
double log_chance(const std::vector<const ImageStack<Real>*>& sides, const WhichImage& image,
                  const Rectangle& tile) {
  const std::size_t channels = sides[0]->extent.channels;
  std::map<std::string_view, double> by_value;
  for (std::size_t i = 0; i < std::size_t{tile.width} * tile.height; ++i) {
    const auto place_of = [&](const ImageStack<Real>& stack, std::size_t index) {
      const Real* const row = row_of(stack, index, tile, i / tile.width);
      return std::string_view(reinterpret_cast<const char*>(row + i % tile.width * channels),
                              channels * sizeof(Real));
    };
    const std::string_view value = place_of(*sides[image.side], image.index);
    double equal = 0;
    double all = 0;
    for (const ImageStack<Real>* stack : sides) {
      for (std::size_t r = 0; r < stack->images.size(); ++r, ++all) {
        equal += place_of(*stack, r) == value ? 1 : 0;
      }
    }
    by_value[value] += std::log(equal / all);
  }
  double sum = 0;
  double least = 0;
  for (const auto& [value, log_p] : by_value) {
    sum += log_p;
    least = std::min(least, log_p);
  }
  return sum - least;
}

struct Seen {
  std::uint64_t digest;
  WhichImage image;
};

template <class Real>
std::optional<RepeatedTile> repeated_in(const std::vector<const ImageStack<Real>*>& sides,
                                        const Rectangle& tile) {
  std::vector<Seen> seen;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    for (std::size_t r = 0; r < sides[s]->images.size(); ++r) {
      seen.push_back({digest(*sides[s], r, tile), {s, r}});
    }
  }
  std::ranges::stable_sort(seen, {}, &Seen::digest);
  const auto all = static_cast<double>(seen.size());
  const double compared = all * (all - 1) / 2 * static_cast<double>(tiles_of(sides[0]->extent));
  bool known = false;  // The images up to here repeat by chance.
  for (std::size_t i = 1; i < seen.size(); ++i) {
    const WhichImage& one = seen[i - 1].image;
    const WhichImage& other = seen[i].image;
    const bool repeats =
        seen[i - 1].digest == seen[i].digest &&
        equal_in(tile, *sides[one.side], one.index, *sides[other.side], other.index);
    if (repeats && !known && log_chance(sides, one, tile) < std::log(chance / compared)) {
      return RepeatedTile{.tile = tile, .one = one, .other = other, .tiles = 1};
    }
    known = repeats;
  }
  return {};
}

// Standardised midranks; empty if all values are equal.
std::vector<double> scores_of(const std::vector<float>& values) {
  std::vector<std::uint32_t> order;
  std::vector<double> scores;
  midranks(std::span<const float>(values), order, scores);
  if (!standardise(scores)) scores.clear();
  return scores;
}

// [image][element]: the elements that vary on every side.
using Scores = std::vector<std::vector<float>>;

std::vector<Scores> scored(const std::vector<std::vector<std::vector<float>>>& sampled) {
  std::vector<Scores> sides;
  for (const auto& side : sampled) sides.emplace_back(side.empty() ? 0 : side[0].size());
  for (std::size_t e = 0; !sampled.empty() && e < sampled[0].size(); ++e) {
    std::vector<std::vector<double>> each;
    for (const auto& side : sampled) each.push_back(scores_of(side[e]));
    if (std::ranges::any_of(each, [](const auto& scores) { return scores.empty(); })) continue;
    for (std::size_t s = 0; s < each.size(); ++s) {
      for (std::size_t r = 0; r < each[s].size(); ++r)
        sides[s][r].push_back(static_cast<float>(each[s][r]));
    }
  }
  return sides;
}

double correlation(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  }
  return sum / static_cast<double>(a.size());
}

// The mean correlation of pairs whose indices differ by `apart`, if it departs by too many errors
// from that of pairs a little further apart.
std::optional<double> departure(const Scores& a, const Scores& b, std::size_t apart) {
  Moments near;
  Moments others;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::size_t first = apart > 0 ? i + apart : i - std::min(i, most_apart);
    for (std::size_t j = first; j < std::min(i + most_apart, b.size()); ++j) {
      (j == i + apart ? near : others).add(correlation(a[i], b[j]));
    }
  }
  if (near.count < 2 || others.count < 2) return {};
  const double difference = near.mean - others.mean;
  const double error =
      others.standard_deviation() *
      std::sqrt(1 / static_cast<double>(near.count) + 1 / static_cast<double>(others.count));
  if (std::abs(difference) < std::max(least_correlation, errors_beyond * error)) return {};
  return near.mean;
}

std::optional<AlikeImages> alike_in(const std::vector<Scores>& sides) {
  if (sides.empty() || sides[0].size() < least_replicates || sides[0][0].size() < fewest_sampled)
    return {};
  if (sides.size() == 2) {
    if (const auto found = departure(sides[0], sides[1], 0)) return AlikeImages{true, 0, *found};
  }
  for (std::size_t s = 0; s < sides.size(); ++s) {
    if (const auto found = departure(sides[s], sides[s], 1)) return AlikeImages{false, s, *found};
  }
  return {};
}

}  // namespace

template <class Real>
void RowDependence<Real>::take(const ImagePair<Real>& pair, RowRange rows,
                               const ForEach& for_each) {
  const std::vector<const ImageStack<Real>*> sides = sides_of(pair);
  const ImageExtent& extent = pair.a.extent;
  const std::size_t across = tiles_across(extent.width);
  const std::size_t down = tiles_across(rows.last - rows.first);
  std::vector<std::optional<RepeatedTile>> found(across * down);
  for_each(found.size(), [&](std::size_t i) {
    const Rectangle tile =
        tile_at(extent, i % across * tile_side, rows.first + i / across * tile_side, rows.last);
    found[i] = repeated_in(sides, tile);
  });
  for (const std::optional<RepeatedTile>& tile : found) {
    if (tile && repeated_) ++repeated_->tiles;
    if (tile && !repeated_) repeated_ = tile;
  }
  sampled_.resize(sides.size());
  // Coprime to a row, so that it meets all columns and channels.
  std::size_t step = (extent.elements() + most_sampled - 1) / most_sampled;
  while (std::gcd(step, extent.row()) > 1) ++step;
  const ElementRange range = rows.elements(extent);
  for (std::size_t e = (range.first + step - 1) / step * step; e < range.last; e += step) {
    for (std::size_t s = 0; s < sides.size(); ++s) {
      std::vector<float>& values = sampled_[s].emplace_back();
      for (std::size_t r = 0; r < sides[s]->images.size(); ++r) {
        values.push_back(static_cast<float>(*sides[s]->at(r, e)));
      }
    }
  }
}

template <class Real>
ImageDependence RowDependence<Real>::found() const {
  return {.repeated = repeated_, .alike = alike_in(scored(sampled_))};
}

template class RowDependence<float>;
template class RowDependence<double>;

}  // namespace assay::stats
