#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "stats/basics/vector_copies.h"
#include "stats/means/constant_sample.h"
#include "stats/pyramids/image_cells.h"

namespace assay::stats {
namespace {

// ---- Tiles

// A tile of an image. All channels stand side by side as in the image. Everything beyond the
// image's edge is zero, so a cell cut off by the edge is a whole square here.
struct Tile {
  static constexpr std::size_t rows = 32;
  static constexpr std::size_t columns = 64;
  static constexpr std::size_t halo = 8;  // Rows and columns beyond, into which its squares reach.

  ImageExtent extent;
  std::size_t x = 0;
  std::size_t y = 0;

  std::size_t width() const { return std::min(columns, extent.width - x); }
  std::size_t height() const { return std::min(rows, extent.height - y); }
  // Numbers of a row that begin in the tile.
  std::size_t size() const { return width() * extent.channels; }
  // Distance from one row of numbers to the next.
  std::size_t stride() const { return (columns + halo) * extent.channels; }
  // The element that a row begins with.
  std::size_t first(std::size_t row) const {
    return ((y + row) * extent.width + x) * extent.channels;
  }
};

std::size_t tiles_across(const ImageExtent& extent) {
  return (extent.width + Tile::columns - 1) / Tile::columns;
}

// Sides of the squares, and distance from one square to the next.
struct Squares {
  std::uint32_t side;
  std::uint32_t step;
};
constexpr std::array<Squares, 3> fine_squares{{{2, 1}, {4, 1}, {8, 2}}};

ASSAY_VECTOR_COPIES void add(const std::array<const double*, 4>& from, double* to,
                             std::size_t size) {
  const auto [a, b, c, d] = from;
  double* const __restrict sum = to;
  for (std::size_t i = 0; i < size; ++i) sum[i] = (a[i] + b[i]) + (c[i] + d[i]);
}

// Sums over the squares that begin in a tile, row after row. A square is four of half its side. Of
// each side only as many rows are kept as the next side needs.
class TileSums {
 public:
  explicit TileSums(const ImageExtent& extent) : channels_(extent.channels) {
    stride_ = Tile{extent}.stride();
    for (std::size_t k = 0; k < kept_.size(); ++k) kept_[k].resize(depth(k) * stride_);
  }

  // Calls fill(row, numbers) for the tile's rows of numbers and those beyond. Calls visit(index in
  // fine_squares, row, sums) for rows of squares, of which one begins at each column.
  template <class Fill, class Visit>
  void add_up(const Tile& tile, const Fill& fill, const Visit& visit) {
    for (std::size_t y = 0; y < tile.height() + Tile::halo - 1; ++y) {
      fill(y, row(0, y));
      for (std::size_t k = 0; k < fine_squares.size(); ++k) {
        const auto [side, step] = fine_squares[k];
        const std::size_t first = y + 1 - side;
        if (y + 1 < side || first % step != 0) break;
        const double* const top = row(k, first);
        const double* const bottom = row(k, first + side / 2);
        const std::size_t apart = side / 2 * channels_;
        double* const sums = row(k + 1, first);
        add({top, top + apart, bottom, bottom + apart}, sums,
            (tile.width() + Tile::halo - side) * channels_);
        if (first < tile.height()) visit(k, first, sums);
      }
    }
  }

 private:
  // How many rows are kept of numbers, and then of the squares of each side.
  static constexpr std::size_t depth(std::size_t k) {
    return k < fine_squares.size() ? fine_squares[k].side / 2 + 1 : 1;
  }
  double* row(std::size_t k, std::size_t y) { return kept_[k].data() + y % depth(k) * stride_; }

  std::size_t channels_;
  std::size_t stride_;
  std::array<std::vector<double>, fine_squares.size() + 1> kept_;
};

// ---- Loops over elements

ASSAY_VECTOR_COPIES void weigh(const float* value, const double* mean, const double* weight,
                               std::span<double> out) {
  double* const __restrict deviation = out.data();
  for (std::size_t i = 0; i < out.size(); ++i) {
    deviation[i] = weight[i] * (static_cast<double>(value[i]) - mean[i]);
  }
}

ASSAY_VECTOR_COPIES void add_squares(const double* from, double* to, std::size_t size) {
  double* const __restrict squares = to;
  for (std::size_t i = 0; i < size; ++i) squares[i] += from[i] * from[i];
}

ASSAY_VECTOR_COPIES void add_row(const double* from, double* to, std::size_t size) {
  double* const __restrict sum = to;
  for (std::size_t i = 0; i < size; ++i) sum[i] += from[i];
}

// Sums of powers of a row of elements' weighted deviations.
struct RowPowers {
  double* squares;
  double* cubes;
};

// True if a deviation is beyond its limit.
ASSAY_VECTOR_COPIES bool add_powers(const double* deviation, const double* limit,
                                    const RowPowers& to, std::size_t size) {
  double* const __restrict squares = to.squares;
  double* const __restrict cubes = to.cubes;
  std::uint64_t beyond = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const double d = deviation[i];
    const double square = d * d;
    squares[i] += square;
    cubes[i] += square * d;
    beyond |= std::abs(d) > limit[i] ? 1U : 0U;
  }
  return beyond != 0;
}

// Adds a part's third cumulants of the weighted effect, of `count` replicates, which is below 0 of
// the second side. Makes powers of weighted deviations those of plain ones, the squares without
// bias.
ASSAY_VECTOR_COPIES void finish_row(const RowPowers& powers, const double* weight, double count,
                                    double* to_third, std::size_t size) {
  double* const __restrict squares = powers.squares;
  double* const __restrict cubes = powers.cubes;
  double* const __restrict third = to_third;
  const double n = std::abs(count);
  for (std::size_t i = 0; i < size; ++i) {
    third[i] += factor_of_half * factor_of_half / (count * count * count) * cubes[i];
    const double inverse = weight[i] > 0 ? 1 / weight[i] : 0.0;
    squares[i] *= inverse * inverse * n / (n - 1);
    cubes[i] *= inverse * inverse * inverse;
  }
}

// Asks for numbers before they are needed. A tile's rows are too short for the machine to foresee
// the next.
void fetch_ahead(const float* first, std::size_t size) {
  constexpr std::size_t line = 64 / sizeof(float);
  for (std::size_t i = 0; i < size; i += line) __builtin_prefetch(first + i);
}

// The group of aligned and the group of shifted cells of one side, where there
// are any.
struct GroupsOfSide {
  std::optional<std::size_t> aligned;
  std::optional<std::size_t> shifted;
};

GroupsOfSide groups_of_side(const std::vector<WindowGroup>& groups, std::uint32_t side) {
  GroupsOfSide found;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!is_fine(groups[g]) || groups[g].size != side) continue;
    (groups[g].grid == Grid::aligned ? found.aligned : found.shifted) = g;
  }
  return found;
}

// Column of tiles, whose sums with alternating signs stand by themselves until all rows are there.
class FineTiles {
 public:
  FineTiles(const FineCells& cells, std::size_t column, FineFindings& found)
      : cells_(cells),
        extent_(cells.pair.a.extent),
        found_(found),
        coarse_(found.coarse),
        alternating_(column * extent_.channels * alternations),
        sums_(extent_) {
    for (std::size_t k = 0; k < fine_squares.size(); ++k) {
      groups_[k] = groups_of_side(cells.groups, fine_squares[k].side);
    }
  }

  const ElementCounts& counts() const { return counts_; }
  std::vector<UnseenElement> take_unseen() { return std::move(unseen_); }

  void take(const Tile& tile) {
    candidates_.assign(cells_.groups.size(), {});
    const std::size_t size = Tile::rows * tile.stride();
    elements_.start(size);
    for (WelchCells& moments : moments_) moments.start(size);
    for (std::vector<OfSide>& channels : of_sides_) channels.clear();
    find_light(tile);
    for (std::size_t h = 0; h < halves; ++h) {
      add_weights(tile, h);
      take_part(tile, cells_.pair.a, {h, 0});
      if (cells_.pair.b != nullptr) take_part(tile, *cells_.pair.b, {h, 1});
      add_effect(tile, h);
      add_third(tile, h);
      count_varied(tile, h);
      if (!coarse_.half[h].squared_error.blocks.empty()) add_reference_error(tile, h);
    }
    add_rare_elements(tile);
    offer_elements(tile);
    for (std::size_t k = 0; k < fine_squares.size(); ++k) offer_squares(tile, k);
    found_.tiles[index_of(tile)] = std::move(candidates_);
  }

 private:
  std::size_t index_of(const Tile& tile) const {
    return tile.y / Tile::rows * tiles_across(extent_) + tile.x / Tile::columns;
  }

  struct Part {
    std::size_t half;
    std::size_t side;
  };
  // A deviation is large beyond this many times the light of the block, or the neighbours' spread.
  static constexpr double most_light = 2;
  static constexpr double most_spreads = 5;

  struct RareOfElement {
    double largest = 0;
    double number = 0;
  };

  // Elements that begin in a tile, rows as far apart as the tile's.
  struct Elements {
    void start(std::size_t size) {
      third.assign(size, 0.0);
      light.assign(size, 0.0);
      for (std::vector<RareOfElement>& side : rare) side.assign(size, {});
    }
    void start_part(std::size_t size) {
      for (std::vector<double>* each : {&squares, &cubes, &limit}) each->assign(size, 0.0);
    }
    std::vector<double> light;
    std::array<std::vector<RareOfElement>, sides_of_pair> rare;
    // These are of the current part.
    std::vector<double> squares;
    std::vector<double> cubes;
    std::vector<double> limit;  // Weighted deviations beyond are large.
    std::vector<double> third;  // This is of the current half, and weighted.
  };

  // Calls visit(index here, element of the image, x, y, channel).
  template <class Visit>
  void for_each_element(const Tile& tile, const Visit& visit) const {
    for (std::size_t y = 0; y < tile.height(); ++y) {
      std::size_t i = y * tile.stride();
      std::size_t element = tile.first(y);
      for (std::size_t x = 0; x < tile.width(); ++x) {
        for (std::size_t c = 0; c < extent_.channels; ++c) {
          visit(i++, element++, tile.x + x, tile.y + y, c);
        }
      }
    }
  }

  // Adds up numbers that fill(row, first element, where to) gives for rows of the image, and zeros
  // beyond. Keeps the sums over blocks and with alternating signs. Calls visit as TileSums does.
  template <class Number, class Fill, class Visit>
  void add_up(const Tile& tile, BlockSums<Number>& kept, const Fill& fill, const Visit& visit) {
    for (std::vector<double>& sums : column_sums_) sums.assign(tile.size(), 0.0);
    const std::size_t size = std::min(tile.stride(), (extent_.width - tile.x) * extent_.channels);
    const auto fill_row = [&](std::size_t y, double* numbers) {
      const bool there = tile.y + y < extent_.height;
      if (there) fill(y, tile.first(y), std::span(numbers, size));
      std::fill(numbers + (there ? size : 0), numbers + tile.stride(), 0.0);
      if (y < tile.height()) add_row(numbers, column_sums_[y % 2].data(), tile.size());
    };
    sums_.add_up(tile, fill_row, [&](std::size_t k, std::size_t y, const double* sums) {
      if (fine_squares[k].side == block_side && y % block_side == 0) {
        keep_blocks(tile, y, sums, kept.blocks);
      }
      visit(k, y, sums);
    });
    add_alternating(tile, kept);
  }

  void take_part(const Tile& tile, const ImageStack& stack, Part part) {
    const Half& own = cells_.half[part.half];
    const double* const mean = own.mean[part.side].data();
    const double* const weights = cells_.half[1 - part.half].weight.data();
    start_part(tile, weights, static_cast<double>(stack.images.size()) / halves);
    Elements& all = elements_;
    std::size_t count = 0;
    for (std::size_t r = part.half; r < stack.images.size(); r += halves) {
      const auto fill = [&](std::size_t y, std::size_t first, std::span<double> out) {
        const float* const values = stack.at(r, first);
        if (r + halves < stack.images.size()) fetch_ahead(stack.at(r + halves, first), out.size());
        const std::size_t here = first - own.first;
        weigh(values, mean + here, weights + here, out);
        if (y >= tile.height()) return;
        const std::size_t i = y * tile.stride();
        const RowPowers powers{&all.squares[i], &all.cubes[i]};
        if (add_powers(out.data(), &all.limit[i], powers, tile.size())) {
          note_large(tile, y, part, values, out);
        }
      };
      add_up(tile, coarse_.half[part.half].images[part.side][count++], fill,
             [&](std::size_t k, std::size_t y, const double* sums) {
               add_squares(sums, moments_[k].squares.data() + y * tile.stride(), tile.size());
             });
    }
    add_squares_of_sides(tile);
    for (WelchCells& moments : moments_) {
      moments.finish_part(part.half, part.side, static_cast<double>(count));
    }
    finish_elements(tile, stack, part, static_cast<double>(count));
  }

  void add_squares_of_sides(const Tile& tile) {
    const std::size_t index = index_of(tile);
    for (std::size_t c = 0; c < extent_.channels; ++c) {
      NoisePyramid::SquaresOfSides& sums = found_.squares[index * extent_.channels + c];
      const auto add = [&](std::size_t k, std::size_t side, const std::vector<double>& squares) {
        for (std::size_t y = 0; y < tile.height(); y += side) {
          for (std::size_t x = 0; x < tile.width(); x += side)
            sums[k] += squares[y * tile.stride() + x * extent_.channels + c];
        }
      };
      add(0, 1, elements_.squares);
      for (std::size_t k = 0; k < fine_squares.size(); ++k)
        add(k + 1, fine_squares[k].side, moments_[k].squares);
    }
  }

  // A weight is 1 / the error that the neighbours' noise gives the mean of so many values.
  void start_part(const Tile& tile, const double* weights, double count) {
    elements_.start_part(Tile::rows * tile.stride());
    for_each_element(tile, [&](std::size_t i, std::size_t element, auto...) {
      const double weight = weights[element - cells_.half[0].first];
      elements_.limit[i] =
          std::min(most_light * elements_.light[i] * weight, most_spreads * std::sqrt(count));
    });
  }

  void note_large(const Tile& tile, std::size_t y, Part part, const float* values,
                  std::span<const double> weighted) {
    const double* const limit = elements_.limit.data() + y * tile.stride();
    const Half& own = cells_.half[part.half];
    const double* const mean = own.mean[part.side].data() + (tile.first(y) - own.first);
    for (std::size_t i = 0; i < tile.size(); ++i) {
      if (!(std::abs(weighted[i]) > limit[i])) continue;
      note_large(tile, y, part, i, static_cast<double>(values[i]) - mean[i]);
    }
  }

  // A deviation is rare in its element beyond twice the spread that the sides have there.
  void note_large(const Tile& tile, std::size_t y, Part part, std::size_t i, double deviation) {
    const Half& own = cells_.half[part.half];
    double shares = 0;  // of the squared spread in the squared error
    for (const auto& images : coarse_.half[part.half].images) {
      if (!images.empty()) shares += 1 / static_cast<double>(images.size());
    }
    const double variance = own.variance_at(tile.first(y) + i - own.first);
    const bool is_rare = shares * deviation * deviation > 4 * variance;
    found_.noise.at(part.side, tile.x + i / extent_.channels, tile.y + y, i % extent_.channels)
        .add_large(deviation, is_rare);
    if (!is_rare) return;
    RareOfElement& rare = elements_.rare[part.side][y * tile.stride() + i];
    rare.number += 1;
    rare.largest = std::max(rare.largest, std::abs(deviation));
  }

  void add_rare_elements(const Tile& tile) {
    for (std::size_t s = 0; s < sides_of_pair; ++s) {
      for_each_element(
          tile, [&](std::size_t i, std::size_t, std::size_t x, std::size_t y, std::size_t c) {
            const auto [largest, number] = elements_.rare[s][i];
            if (number > 0) found_.noise.at(s, x, y, c).add_rare_element(largest, number);
          });
    }
  }

  // Powers of the deviations of an element that the other half gives no weight.
  PooledNoise::Powers powers_without_weight(const Tile& tile, const ImageStack& stack,
                                            std::size_t y, Part part, std::size_t i) {
    const Half& own = cells_.half[part.half];
    const std::size_t element = tile.first(y) + i;
    const std::size_t here = element - own.first;
    PooledNoise::Powers powers;
    if (own.variance_at(here) == 0) return powers;
    for (std::size_t r = part.half; r < stack.images.size(); r += halves) {
      const double deviation =
          static_cast<double>(*stack.at(r, element)) - own.mean[part.side][here];
      powers.count += 1;
      powers.squares += deviation * deviation;
      powers.cubes += deviation * deviation * deviation;
      if (std::abs(deviation) > most_light * elements_.light[y * tile.stride() + i]) {
        note_large(tile, y, part, i, deviation);
      }
    }
    powers.squares *= powers.count / (powers.count - 1);
    return powers;
  }

  void finish_elements(const Tile& tile, const ImageStack& stack, Part part, double count) {
    constexpr std::size_t block = NoisePyramid::block;
    const double sign = part.side == 0 ? 1 : -1;
    Elements& all = elements_;
    for (std::size_t y = 0; y < tile.height(); ++y) {
      const std::size_t i = y * tile.stride();
      const double* const weight =
          cells_.half[1 - part.half].weight.data() + (tile.first(y) - cells_.half[0].first);
      finish_row({&all.squares[i], &all.cubes[i]}, weight, sign * count, &all.third[i],
                 tile.size());
      for (std::size_t x = 0; x < tile.width(); x += block) {
        const std::size_t end = std::min(x + block, tile.width()) * extent_.channels;
        for (std::size_t c = 0; c < extent_.channels; ++c) {
          PooledNoise& noise = found_.noise.at(part.side, tile.x + x, tile.y + y, c);
          for (std::size_t e = x * extent_.channels + c; e < end; e += extent_.channels) {
            noise.add(weight[e] > 0
                          ? PooledNoise::Powers{count, all.squares[i + e], all.cubes[i + e]}
                          : powers_without_weight(tile, stack, y, part, e));
          }
        }
      }
    }
  }

  // Tests each element.
  void offer_elements(const Tile& tile) {
    for_each_element(
        tile, [&](std::size_t, std::size_t element, std::size_t x, std::size_t y, std::size_t c) {
          const std::size_t vary = halves_that_vary(element);
          found_.weights[element] = static_cast<float>(weight_of(element));
          if (vary > 0) add_element(element, x, y, c);
          if (vary < halves) {
            const bool differs = cells_.constants_decide && vary == 0 && is_different(element);
            if (differs) note_different(tile, element, c);
            counts_.equal_constants += differs ? 0 : 1;
            found_.z[element] = differs ? unseen_.back().z() : 0;
            return;
          }
          ++counts_.tested;
          const CellNoise noise = noise_of(element);
          const StudentValue value = own_value(noise);
          found_.z[element] = t_to_z(value);
          if (!candidates_[0].wants(value.t)) return;
          const Rectangle place{static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 1, 1};
          candidates_[0].keep({{.window = place, .channel = c, .z = found_.z[element]}, noise});
        });
  }

  // The halves' own moments tell of an element alone.
  CellNoise noise_of(std::size_t element) const {
    const std::size_t here = element - cells_.half[0].first;
    CellNoise noise{
        .variance = {0, error_of(element)}, .weights = weight_of(element), .concentration = 1};
    double reciprocal_degrees = 0;
    for (std::size_t h = 0; h < halves; ++h) {
      const Half& half = cells_.half[h];
      noise.effect += factor_of_half * half.difference[here];
      for (std::size_t side = 0; side < sides_of_pair; ++side) {
        if (half.variance[side].empty()) continue;
        const double part = factor_of_half * factor_of_half * half.variance[side][here];
        const auto count = static_cast<double>(coarse_.half[h].images[side].size());
        noise.variance[side] += part;
        reciprocal_degrees += part * part / (count - 1);
      }
    }
    const double total = noise.variance[0] + noise.variance[1];
    noise.degrees = total * total / reciprocal_degrees;
    return noise;
  }

  double mean_of(std::size_t side, std::size_t element) const {
    if (side == 1 && cells_.pair.b == nullptr) return cells_.pair.reference.value[element];
    const std::size_t here = element - cells_.half[0].first;
    return std::midpoint(cells_.half[0].mean[side][here], cells_.half[1].mean[side][here]);
  }

  // Counts it. Of two sides one has the larger variance over its squared mean.
  void add_element(std::size_t element, std::size_t x, std::size_t y, std::size_t c) {
    const auto& [even, odd] = cells_.half;
    const std::size_t here = element - even.first;
    const auto noise = [&](std::size_t side) {
      return (even.fair_variance(side, here) + odd.fair_variance(side, here)) *
             std::pow(even.fair_mean(1 - side, here) + odd.fair_mean(1 - side, here), 2);
    };
    const bool of_two = cells_.pair.b != nullptr;
    found_.noise.at(0, x, y, c).add_element(of_two && noise(0) > noise(1));
    if (of_two) found_.noise.at(1, x, y, c).add_element(noise(1) > noise(0));
  }

  // The weight in this half, which the other gives.
  double weight_in(std::size_t h, std::size_t element) const {
    return cells_.half[1 - h].weight[element - cells_.half[0].first];
  }
  double weight_of(std::size_t element) const {
    return std::midpoint(weight_in(0, element), weight_in(1, element));
  }

  // The mean of the brighter side, or its error where that is larger.
  double light_of(std::size_t element) const {
    const double weight = weight_of(element);
    if (weight == 0) return 0;
    return std::max({1 / weight, std::abs(mean_of(0, element)), std::abs(mean_of(1, element))});
  }
  // An element's light is the mean over its block.
  void find_light(const Tile& tile) {
    constexpr std::size_t block = NoisePyramid::block;
    const std::size_t across = Tile::columns / block;
    struct Mean {
      double sum = 0;
      double count = 0;
    };
    std::vector<Mean> mean(Tile::rows / block * across * extent_.channels);
    const auto of_block = [&](std::size_t x, std::size_t y, std::size_t c) -> Mean& {
      return mean[((y - tile.y) / block * across + (x - tile.x) / block) * extent_.channels + c];
    };
    for_each_element(tile, [&](std::size_t, std::size_t element, auto... place) {
      const double light = light_of(element);
      Mean& here = of_block(place...);
      here.sum += light;
      here.count += light > 0 ? 1 : 0;
    });
    for_each_element(tile, [&](std::size_t i, std::size_t, auto... place) {
      const Mean& here = of_block(place...);
      elements_.light[i] = here.count > 0 ? here.sum / here.count : 0;
    });
  }

  // Fills rows with a number of each element.
  static auto each(const auto& number) {
    return [=](std::size_t, std::size_t first, std::span<double> out) {
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = number(first + i);
    };
  }

  // Sums of the weights and of their squares.
  void add_weights(const Tile& tile, std::size_t h) {
    add_up(tile, coarse_.half[h].weights,
           each([=, this](std::size_t element) { return weight_in(h, element); }),
           [&](std::size_t k, std::size_t y, const double* sums) {
             moments_[k].start_half(y * tile.stride(), {sums, tile.size()});
           });
    add_up(tile, coarse_.half[h].squared_weights, each([=, this](std::size_t element) {
             return weight_in(h, element) * weight_in(h, element);
           }),
           [&](std::size_t k, std::size_t y, const double* sums) {
             moments_[k].add(moments_[k].concentration, y * tile.stride(), {sums, tile.size()}, 2);
           });
  }

  // A reference's squared error.
  double error_of(std::size_t element) const {
    const auto& error = cells_.pair.reference.standard_error;
    return error.empty() ? 0 : error[element] * error[element];
  }

  std::size_t halves_that_vary(std::size_t element) const {
    const std::size_t here = element - cells_.half[0].first;
    return static_cast<std::size_t>(std::ranges::count_if(
        cells_.half, [here](const Half& half) { return half.variance_at(here) > 0; }));
  }

  // True of an element that varies in neither half, if the sides have one value each, and not the
  // same.
  bool is_different(std::size_t element) const {
    const auto& [even, odd] = cells_.half;
    const std::size_t here = element - even.first;
    const auto has_one_value = [&](std::size_t side) {
      return even.mean[side].empty() || even.mean[side][here] == odd.mean[side][here];
    };
    return has_one_value(0) && has_one_value(1) && mean_of(0, element) != mean_of(1, element);
  }

  void note_different(const Tile& tile, std::size_t element, std::size_t channel) {
    const double first = mean_of(0, element);
    const double second = mean_of(1, element);
    const ConstantSample exact{second, second, second, 1};
    const bool of_two = cells_.pair.b != nullptr;
    unseen_.push_back(
        {element, first < second ? -1.0 : 1.0,
         log_p_constants(
             with_unseen(tile, cells_.pair.a, {0, element, channel}, first),
             of_two ? with_unseen(tile, *cells_.pair.b, {1, element, channel}, second) : exact)});
  }

  struct OfTile {
    std::size_t side;
    std::size_t element;
    std::size_t channel;
  };
  // Unseen values are as large as those of the tile, where some element near has others beside this
  // value. Else there are none, as far as anyone can tell.
  ConstantSample with_unseen(const Tile& tile, const ImageStack& stack, OfTile of, double value) {
    const double size = is_left_near(tile, stack, of, static_cast<float>(value))
                            ? size_about(value, values_of_tile(tile, stack, of))
                            : 0;
    return {value, value - size, value + size, stack.images.size()};
  }

  // Near is within so many elements of the tile.
  static constexpr std::size_t near = 8;
  bool is_left_near(const Tile& tile, const ImageStack& stack, OfTile of, float value) {
    if (!varies(tile, of)) return false;
    const std::size_t place = of.element / extent_.channels;
    const auto first = [](std::size_t at, std::size_t start) {
      return std::max(at, start + near) - near;
    };
    const std::size_t x = place % extent_.width, y = place / extent_.width;
    const std::size_t right = std::min(x + near + 1, tile.x + tile.width());
    const std::size_t bottom = std::min(y + near + 1, tile.y + tile.height());
    for (std::size_t row = first(y, tile.y); row < bottom; ++row) {
      for (std::size_t column = first(x, tile.x); column < right; ++column) {
        const std::size_t element = (row * extent_.width + column) * extent_.channels + of.channel;
        const std::size_t here = element - cells_.half[0].first;
        if (!varies(of.side, here)) continue;
        for (std::size_t r = 0; r < stack.images.size(); ++r) {
          if (*stack.at(r, element) == value) return true;
        }
      }
    }
    return false;
  }

  bool varies(std::size_t side, std::size_t here) const {
    return std::ranges::any_of(cells_.half,
                               [&](const Half& half) { return half.variance[side][here] > 0; });
  }

  // One channel of a side in the tile.
  struct OfSide {
    std::optional<bool> varies = {};
    Moments values = {};
  };
  OfSide& asked_for(OfTile of) {
    std::vector<OfSide>& channels = of_sides_[of.side];
    channels.resize(extent_.channels);
    return channels[of.channel];
  }
  bool varies(const Tile& tile, OfTile of) {
    std::optional<bool>& known = asked_for(of).varies;
    if (known) return *known;
    bool any = false;
    for_each_element(tile, [&](std::size_t, std::size_t element, auto, auto, std::size_t c) {
      any = any || (c == of.channel && varies(of.side, element - cells_.half[0].first));
    });
    return known.emplace(any);
  }
  const Moments& values_of_tile(const Tile& tile, const ImageStack& stack, OfTile of) {
    Moments& values = asked_for(of).values;
    if (values.count > 0) return values;
    for_each_element(tile, [&](std::size_t, std::size_t element, auto, auto, std::size_t c) {
      if (c != of.channel) return;
      for (std::size_t r = 0; r < stack.images.size(); ++r) values.add(*stack.at(r, element));
    });
    return values;
  }

  void keep_blocks(const Tile& tile, std::size_t y, const double* sums, auto& blocks) const {
    const std::size_t row = (tile.y + y) / block_side * coarse_.extent.width;
    for (std::size_t x = 0; x < tile.width(); x += block_side) {
      for (std::size_t c = 0; c < extent_.channels; ++c) {
        blocks[(row + (tile.x + x) / block_side) * extent_.channels + c] =
            static_cast<std::remove_cvref_t<decltype(blocks[0])>>(sums[x * extent_.channels + c]);
      }
    }
  }

  template <class Number>
  void add_alternating(const Tile& tile, BlockSums<Number>& to) const {
    for (std::size_t c = 0; c < extent_.channels; ++c) {
      const auto of = [&](std::size_t odd_row, std::size_t odd_column) {
        double sum = 0;
        for (std::size_t x = odd_column; x < tile.width(); x += 2) {
          sum += column_sums_[odd_row][x * extent_.channels + c];
        }
        return sum;
      };
      const double even[] = {of(0, 0), of(0, 1)};
      const double odd[] = {of(1, 0), of(1, 1)};
      double* const channel = to.alternating.data() + alternating_ + c * alternations;
      channel[0] += (even[0] + odd[0]) - (even[1] + odd[1]);
      channel[1] += (even[0] + even[1]) - (odd[0] + odd[1]);
      channel[2] += (even[0] + odd[1]) - (even[1] + odd[0]);
    }
  }

  // Differences of the means of a half.
  void add_effect(const Tile& tile, std::size_t h) {
    const Half& own = cells_.half[h];
    add_up(tile, coarse_.half[h].effect, each([&](std::size_t element) {
             return weight_in(h, element) * own.difference[element - own.first];
           }),
           [&](std::size_t k, std::size_t y, const double* sums) {
             moments_[k].add(moments_[k].effect, y * tile.stride(), {sums, tile.size()}, 1);
           });
  }

  void add_third(const Tile& tile, std::size_t h) {
    for_each_element(
        tile, [&](std::size_t i, std::size_t, std::size_t x, std::size_t y, std::size_t c) {
          const std::size_t block =
              (y / block_side * coarse_.extent.width + x / block_side) * extent_.channels + c;
          coarse_.half[h].third.blocks[block] += std::exchange(elements_.third[i], 0);
        });
  }

  // Squares of that side did not vary if none of their elements did. Deviations are then zero in
  // every replicate, to the last bit. Sums of larger cells need the count.
  void count_varied(const Tile& tile, std::size_t h) {
    const Half& own = cells_.half[h];
    const auto varies = [&](std::size_t element) {
      return weight_in(h, element) > 0 && own.variance_at(element - own.first) > 0 ? 1 : 0;
    };
    add_up(tile, coarse_.half[h].varied, each(varies), [](auto...) {});
  }

  // A reference's error is one for both halves, independent between elements, and known without
  // degrees of freedom. It says nothing of values never seen.
  void add_reference_error(const Tile& tile, std::size_t h) {
    add_up(tile, coarse_.half[h].squared_error, each([&](std::size_t element) {
             return weight_in(h, element) * weight_in(h, element) * error_of(element);
           }),
           [&](std::size_t k, std::size_t y, const double* sums) {
             moments_[k].add(moments_[k].variance[1], y * tile.stride(), {sums, tile.size()}, 2);
           });
  }

  void offer_squares(const Tile& tile, std::size_t k) {
    const auto [side, step] = fine_squares[k];
    t_.resize(tile.size());
    for (std::size_t y = 0; y < tile.height(); y += step) {
      moments_[k].statistics(y * tile.stride(), t_);
      for (std::size_t x = 0; x < tile.width(); x += step) {
        const Rectangle square{static_cast<std::uint32_t>(tile.x + x),
                               static_cast<std::uint32_t>(tile.y + y), side, side};
        const std::size_t first = x * extent_.channels;
        offer_square(square, k, y * tile.stride() + first,
                     std::span(t_).subspan(first, extent_.channels));
      }
    }
  }

  // Offers the channels' cells, which are known by the first and by their statistics.
  void offer_square(Rectangle square, std::size_t k, std::size_t first, std::span<const double> t) {
    const auto width = static_cast<std::uint32_t>(extent_.width);
    const auto height = static_cast<std::uint32_t>(extent_.height);
    const bool aligned = square.x % square.width == 0 && square.y % square.height == 0;
    const std::optional<std::size_t> group = aligned ? groups_[k].aligned : groups_[k].shifted;
    if (!group) return;
    const std::uint32_t wide = std::min(square.width, width);
    const std::uint32_t high = std::min(square.height, height);
    if (!aligned && (square.x + wide > width || square.y + high > height)) return;
    square.width = std::min(wide, width - square.x);
    square.height = std::min(high, height - square.y);
    for (std::size_t c = 0; c < extent_.channels; ++c) {
      if (std::isnan(t[c]) || !candidates_[*group].wants(t[c])) continue;
      Candidate candidate{
          .finding = {.size = cells_.groups[*group].size, .window = square, .channel = c},
          .noise = moments_[k].noise(first + c)};
      candidate.finding.z = t_to_z(own_value(candidate.noise));
      candidates_[*group].keep(candidate);
    }
  }

  const FineCells& cells_;
  const ImageExtent& extent_;
  std::vector<Candidates> candidates_;  // A tile's, of each group.
  ElementCounts counts_;
  std::vector<UnseenElement> unseen_;
  std::array<std::vector<OfSide>, sides_of_pair> of_sides_;  // By channel, where asked for.
  FineFindings& found_;
  CoarseImages& coarse_;
  std::size_t alternating_;  // Index of the column's sums with alternating signs.
  TileSums sums_;
  std::array<std::vector<double>, 2> column_sums_;  // Even rows, odd rows.
  std::vector<double> t_;                           // Statistics of a row of squares.
  std::array<GroupsOfSide, fine_squares.size()> groups_;
  // These are of the squares that begin in the tile.
  std::array<WelchCells, fine_squares.size()> moments_;
  Elements elements_;
};

static_assert(fine_rows % Tile::rows == 0 && fine_rows_ahead == Tile::halo);

CoarseImages empty_blocks(const ImagePair& pair) {
  const ImageExtent& extent = pair.a.extent;
  CoarseImages coarse;
  coarse.extent = {blocks_of(extent.width), blocks_of(extent.height), extent.channels};
  const BlockSums<double> none{
      std::vector<double>(coarse.extent.elements()),
      std::vector<double>(tiles_across(extent) * extent.channels * alternations)};
  const BlockSums<float> no_image{std::vector<float>(none.blocks.size()), none.alternating};
  for (std::size_t h = 0; h < halves; ++h) {
    CoarseHalf& half = coarse.half[h];
    half = {
        .effect = none, .varied = none, .weights = none, .squared_weights = none, .third = none};
    half.images[0].assign(half_count(pair.a.images.size(), h), no_image);
    if (pair.b != nullptr) half.images[1].assign(half_count(pair.b->images.size(), h), no_image);
    if (!pair.reference.standard_error.empty()) half.squared_error = none;
  }
  return coarse;
}

}  // namespace

bool is_fine(const WindowGroup& group) {
  return group.grid != Grid::alternating &&
         std::ranges::any_of(fine_squares,
                             [&](const Squares& squares) { return squares.side == group.size; });
}

void offer_fine_cells(const FineCells& cells, RowRange rows, FineFindings& found,
                      const ForEach& for_each) {
  const ImageExtent& extent = cells.pair.a.extent;
  std::vector<ElementCounts> counts(tiles_across(extent));
  std::vector<std::vector<UnseenElement>> unseen(counts.size());
  for_each(counts.size(), [&](std::size_t column) {
    FineTiles tiles(cells, column, found);
    for (std::size_t y = rows.first; y < rows.last; y += Tile::rows) {
      tiles.take({extent, column * Tile::columns, y});
    }
    counts[column] = tiles.counts();
    unseen[column] = tiles.take_unseen();
  });
  for (std::size_t column = 0; column < counts.size(); ++column) {
    found.counts.tested += counts[column].tested;
    found.counts.equal_constants += counts[column].equal_constants;
    std::ranges::copy(unseen[column], std::back_inserter(found.unseen));
  }
}

FineFindings empty_findings(const ImagePair& pair, std::span<double> z) {
  const ImageExtent& extent = pair.a.extent;
  const std::size_t down = (extent.height + Tile::rows - 1) / Tile::rows;
  const std::size_t tiles = tiles_across(extent) * down;
  return {.coarse = empty_blocks(pair),
          .noise = {extent, {pair.a.images.size(), pair.b != nullptr ? pair.b->images.size() : 0}},
          .squares = std::vector<NoisePyramid::SquaresOfSides>(tiles * extent.channels),
          .tiles = std::vector<std::vector<Candidates>>(tiles),
          .weights = std::vector<float>(extent.elements()),
          .z = z};
}

void add_up_alternating(CoarseImages& coarse) {
  const std::size_t size = coarse.extent.channels * alternations;
  const auto add_up = [&](auto& image) {
    for (std::size_t i = size; i < image.alternating.size(); ++i) {
      image.alternating[i % size] += image.alternating[i];
    }
    image.alternating.resize(size);
  };
  for (CoarseHalf& half : coarse.half) {
    add_up(half.effect);
    add_up(half.squared_weights);
    for (auto& side : half.images) std::ranges::for_each(side, add_up);
  }
}

}  // namespace assay::stats
