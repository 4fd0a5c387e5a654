#include "stats/images/image_dependence.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <string_view>

#include "stats/basics/moments.h"
#include "stats/basics/scores.h"
#include "stats/basics/vector_copies.h"

namespace assay::stats {
namespace {

constexpr std::size_t tile_side = 8;
// Probability that independent images repeat a tile anywhere.
constexpr double chance = 1e-6;
constexpr std::size_t most_sampled = 16384;
constexpr std::size_t fewest_sampled = 64;
// A filter spreads one sample over many pixels, so that a value may follow from those beside it.
constexpr double least_frequency = 1.0 / 8;
// Pairs whose indices differ by at most so much show how alike others are.
constexpr std::size_t most_apart = 8;
constexpr double errors_beyond = 8;
constexpr double least_correlation = .05;

std::vector<const ImageStack*> sides_of(const ImagePair& pair) {
  std::vector<const ImageStack*> sides{&pair.a};
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

const float* row_of(const ImageStack& stack, std::size_t image, const Rectangle& tile,
                    std::size_t row) {
  return stack.at(image, ((tile.y + row) * stack.extent.width + tile.x) * stack.extent.channels);
}

std::uint32_t bits_of(float value) { return std::bit_cast<std::uint32_t>(value); }

// The rows of a tile, or of all tiles beside each other.
using TileRows = std::array<const float*, tile_side>;

// Products of numbers four rows apart, summed over a column. Each number is first disguised by its
// place, so that no zero hides another.
ASSAY_VECTOR_COPIES void hash_columns(const TileRows& rows, std::span<std::uint64_t> out) {
  const auto [a, b, c, d, e, f, g, h] = rows;
  std::uint64_t* const __restrict hash = out.data();
  const auto product = [](float one, std::uint32_t key, float other) {
    return std::uint64_t{bits_of(one) ^ key} * (bits_of(other) ^ ~key);
  };
  for (std::size_t i = 0; i < out.size(); ++i) {
    hash[i] = (product(a[i], 0x9e3779b9, e[i]) + product(b[i], 0x85ebca6b, f[i])) +
              (product(c[i], 0xc2b2ae35, g[i]) + product(d[i], 0x27d4eb2f, h[i]));
  }
}

// Hashes of the image's tiles that begin in a row. Tiles of one hash are compared whole.
std::vector<std::uint64_t> digests(const ImageStack& stack, std::size_t image, RowRange rows) {
  const std::size_t row = stack.extent.row();
  const std::vector<float> none(rows.first + tile_side > rows.last ? row : 0);
  TileRows numbers;
  for (std::size_t y = 0; y < tile_side; ++y) {
    numbers[y] = rows.first + y < rows.last ? stack.at(image, (rows.first + y) * row) : none.data();
  }
  std::vector<std::uint64_t> columns(row);
  hash_columns(numbers, columns);
  std::vector<std::uint64_t> tiles(tiles_across(stack.extent.width));
  std::size_t i = 0;
  for (std::uint64_t& tile : tiles) {
    const std::size_t end = std::min(i + tile_side * stack.extent.channels, row);
    for (; i < end; ++i) tile += columns[i] * (2 * i + 0x9e3779b97f4a7c15);
  }
  return tiles;
}

bool equal_in(const Rectangle& tile, const ImageStack& a, std::size_t i, const ImageStack& b,
              std::size_t j) {
  for (std::size_t row = 0; row < tile.height; ++row) {
    if (std::memcmp(row_of(a, i, tile, row), row_of(b, j, tile, row),
                    tile.width * a.extent.channels * sizeof(float)) != 0) {
      return false;
    }
  }
  return true;
}

// The logarithm of a bound on the probability that another image repeats this one's tile.
double log_chance(const std::vector<const ImageStack*>& sides, const WhichImage& image,
                  const Rectangle& tile) {
  const std::size_t channels = sides[0]->extent.channels;
  std::map<std::string_view, double> by_value;
  for (std::size_t i = 0; i < std::size_t{tile.width} * tile.height; ++i) {
    const auto place_of = [&](const ImageStack& stack, std::size_t index) {
      const float* const row = row_of(stack, index, tile, i / tile.width);
      return std::string_view(reinterpret_cast<const char*>(row + i % tile.width * channels),
                              channels * sizeof(float));
    };
    const std::string_view value = place_of(*sides[image.side], image.index);
    double equal = 0;
    double all = 0;
    for (const ImageStack* stack : sides) {
      for (std::size_t r = 0; r < stack->images.size(); ++r, ++all) {
        equal += place_of(*stack, r) == value ? 1 : 0;
      }
    }
    by_value[value] += std::log(std::max(equal / all, least_frequency));
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

// Digests of the tiles beside each other, of each image of the first side and then of the second.
using Digests = std::vector<std::vector<std::uint64_t>>;

std::optional<RepeatedTile> repeated_in(const std::vector<const ImageStack*>& sides,
                                        const Rectangle& tile, const Digests& digests) {
  std::vector<Seen> seen;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    for (std::size_t r = 0; r < sides[s]->images.size(); ++r) {
      seen.push_back({digests[seen.size()][tile.x / tile_side], {s, r}});
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
  std::vector<Placed<float>> order;
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

// The mean correlation of pairs whose indices differ by `apart`, if it departs by too many errors
// from that of pairs a little further apart.
std::optional<double> departure(const Scores& a, const Scores& b, std::size_t apart) {
  Moments near;
  Moments others;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::size_t first = apart > 0 ? i + apart : i - std::min(i, most_apart);
    for (std::size_t j = first; j < std::min(i + most_apart, b.size()); ++j) {
      (j == i + apart ? near : others).add(dot(a[i], b[j]) / static_cast<double>(a[i].size()));
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

void RowDependence::take(const ImagePair& pair, RowRange rows, const ForEach& for_each) {
  const std::vector<const ImageStack*> sides = sides_of(pair);
  const ImageExtent& extent = pair.a.extent;
  const std::size_t of_first = pair.a.images.size();
  Digests all(of_first + (pair.b != nullptr ? pair.b->images.size() : 0));
  std::vector<std::optional<RepeatedTile>> found(tiles_across(extent.width));
  for (std::size_t y = rows.first; y < rows.last; y += tile_side) {
    for_each(all.size(), [&](std::size_t i) {
      const bool first = i < of_first;
      all[i] = digests(*sides[first ? 0 : 1], first ? i : i - of_first, {y, rows.last});
    });
    for_each(found.size(), [&](std::size_t i) {
      found[i] = repeated_in(sides, tile_at(extent, i * tile_side, y, rows.last), all);
    });
    for (const std::optional<RepeatedTile>& tile : found) {
      if (tile && repeated_) ++repeated_->tiles;
      if (tile && !repeated_) repeated_ = tile;
    }
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

ImageDependence RowDependence::found() const {
  return {.repeated = repeated_, .alike = alike_in(scored(sampled_))};
}

ImageDependence image_dependence(const ImagePair& pair, const ForEach& for_each) {
  RowDependence rows;
  rows.take(pair, {0, pair.a.extent.height}, for_each);
  return rows.found();
}

}  // namespace assay::stats
