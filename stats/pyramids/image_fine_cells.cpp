#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

#include "stats/basics/vector_copies.h"
#include "stats/pyramids/image_cells.h"

namespace assay::stats {
namespace {

// ---- Tiles

// A tile of an image, and the sums over the squares that begin in it. All channels stand side by
// side as in the image. Everything beyond the image's edge is zero, so a cell cut off by the edge
// is a whole square here.
struct Tile {
  static constexpr std::size_t rows = 16;
  static constexpr std::size_t columns = 128;
  static constexpr std::size_t halo = 8;  // Rows and columns beyond, into which its squares reach.

  static std::size_t padded(std::size_t count) { return (count + 7) / 8 * 8; }

  ImageExtent extent;
  std::size_t x = 0;
  std::size_t y = 0;

  // Columns and rows that begin here, in multiples of 8.
  std::size_t width() const { return std::min(columns, padded(extent.width - x)); }
  std::size_t height() const { return std::min(rows, padded(extent.height - y)); }
  // Distance from one row of values to the next.
  std::size_t stride() const { return (columns + halo) * extent.channels; }
};

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

// Sums squares of twice the side from squares that are `apart` numbers and `lines` rows from each
// other.
struct Doubling {
  std::size_t rows;
  std::size_t size;  // Length of a row of sums.
  std::size_t stride;
  std::size_t apart;
  std::size_t lines;
};

void double_side(const std::vector<double>& from, std::vector<double>& to, const Doubling& by) {
  for (std::size_t row = 0; row < by.rows; ++row) {
    const double* const top = from.data() + row * by.stride;
    const double* const bottom = top + by.lines * by.stride;
    add({top, top + by.apart, bottom, bottom + by.apart}, to.data() + row * by.stride, by.size);
  }
}

class TileSums {
 public:
  explicit TileSums(const ImageExtent& extent);

  // Rows of Tile::stride() values, Tile::height() + halo of them. The caller fills them.
  std::span<double> values() { return values_; }
  void add_up(const Tile& tile);

  // Sums by index in fine_squares, row after row of Tile::stride() / step.
  const std::vector<double>& of(std::size_t squares) const { return sums_[squares]; }

 private:
  std::size_t channels_;
  std::vector<double> values_;
  std::vector<double> blocks_;  // Blocks of 2 x 2, at even columns and rows.
  std::vector<double> fours_;   // Blocks of 2 x 2 of these, at each of them.
  std::array<std::vector<double>, fine_squares.size()> sums_;
};

TileSums::TileSums(const ImageExtent& extent) : channels_(extent.channels) {
  const std::size_t stride = Tile{extent}.stride();
  const std::size_t size = (Tile::rows + Tile::halo) * stride;
  values_.resize(size);
  blocks_.resize(size / 4);
  fours_.resize(size / 4);
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    sums_[i].resize(size / (fine_squares[i].step * fine_squares[i].step));
  }
}

void TileSums::add_up(const Tile& tile) {
  const std::size_t c = channels_;
  const std::size_t stride = tile.stride();
  const std::size_t rows = tile.height();
  const std::size_t width = tile.width();
  std::vector<double>& twos = sums_[0];
  // Side 2 as far as side 8 reaches: it begins at most 2 before the end and
  // takes 8.
  double_side(values_, twos, {rows + 7, (width + 7) * c, stride, c, 1});
  double_side(twos, sums_[1], {rows, width * c, stride, 2 * c, 2});
  const std::size_t half = stride / 2;
  for (std::size_t row = 0; row < rows / 2 + 3; ++row) {
    for (std::size_t block = 0; block < width / 2 + 3; ++block) {
      const double* const from = twos.data() + 2 * row * stride + 2 * block * c;
      std::copy(from, from + c, blocks_.data() + row * half + block * c);
    }
  }
  double_side(blocks_, fours_, {rows / 2 + 2, (width / 2 + 2) * c, half, c, 1});
  double_side(fours_, sums_[2], {rows / 2, width / 2 * c, half, 2 * c, 2});
}

// ---- Loops over elements

template <class Real, class Centre>
ASSAY_VECTOR_COPIES void weigh(const Real* value, const Centre* centre, const double* weight,
                               std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = weight[i] * (static_cast<double>(value[i]) - static_cast<double>(centre[i]));
  }
}

// Calls fill(first element, where to) for each row of the tile that the image
// has, zeros elsewhere.
template <class Fill>
void fill_tile(const Tile& tile, std::span<double> values, const Fill& fill) {
  const ImageExtent& extent = tile.extent;
  const std::size_t stride = tile.stride();
  const std::size_t size = std::min(stride, (extent.width - tile.x) * extent.channels);
  for (std::size_t row = 0; row < tile.height() + Tile::halo; ++row) {
    const std::span<double> line = values.subspan(row * stride, stride);
    const bool there = tile.y + row < extent.height;
    if (there) {
      fill(((tile.y + row) * extent.width + tile.x) * extent.channels, line.first(size));
    }
    std::ranges::fill(line.subspan(there ? size : 0), 0.0);
  }
}

struct Updated {
  const double* sum;
  double* mean;
  double* m2;
};

ASSAY_VECTOR_COPIES void update(const Updated& row, double inverse_count, std::size_t size) {
  const double* const sum = row.sum;
  double* const __restrict mean = row.mean;
  double* const __restrict m2 = row.m2;
  for (std::size_t i = 0; i < size; ++i) {
    const double delta = sum[i] - mean[i];
    mean[i] += delta * inverse_count;
    m2[i] += delta * (sum[i] - mean[i]);
  }
}

struct ColumnSums {
  const double* row;
  double* sum;
  double* signed_sum;
};

ASSAY_VECTOR_COPIES void add_row(const ColumnSums& to, double sign, std::size_t size) {
  const double* const row = to.row;
  double* const __restrict sum = to.sum;
  double* const __restrict signed_sum = to.signed_sum;
  for (std::size_t i = 0; i < size; ++i) {
    sum[i] += row[i];
    signed_sum[i] += sign * row[i];
  }
}

// Sums of powers of a row of elements' weighted deviations.
struct RowPowers {
  double* squares;
  double* cubes;
  double* sixths;
};

template <class Real>
ASSAY_VECTOR_COPIES void add_powers(const Real* value, const double* mean, const double* weight,
                                    const RowPowers& to, std::size_t size) {
  double* const __restrict squares = to.squares;
  double* const __restrict cubes = to.cubes;
  double* const __restrict sixths = to.sixths;
  for (std::size_t i = 0; i < size; ++i) {
    const double d = weight[i] * (static_cast<double>(value[i]) - mean[i]);
    const double square = d * d;
    const double cube = square * d;
    squares[i] += square;
    cubes[i] += cube;
    sixths[i] += cube * cube;
  }
}

// Asks for the rows of a tile before they are needed. A tile's rows are too short for the machine
// to foresee the next.
template <class Real>
void fetch_ahead(const Tile& tile, const ImageStack<Real>& stack, std::size_t image) {
  constexpr std::size_t line = 64 / sizeof(Real);
  const ImageExtent& extent = tile.extent;
  const std::size_t size = std::min(tile.stride(), (extent.width - tile.x) * extent.channels);
  const std::size_t rows = std::min(tile.height() + Tile::halo, extent.height - tile.y);
  for (std::size_t row = 0; row < rows; ++row) {
    const Real* const first =
        stack.at(image, ((tile.y + row) * extent.width + tile.x) * extent.channels);
    for (std::size_t i = 0; i < size; i += line) __builtin_prefetch(first + i);
  }
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

template <class Real>
class FineTiles {
 public:
  FineTiles(const FineCells<Real>& cells, std::size_t band, FineFindings& found)
      : cells_(cells),
        extent_(cells.pair.a.extent),
        found_(found),
        coarse_(found.coarse),
        alternating_(band * extent_.channels * alternations),
        sums_(extent_),
        column_sums_(Tile{extent_}.stride()),
        signed_column_sums_(column_sums_.size()),
        elements_(extent_) {
    for (std::size_t k = 0; k < fine_squares.size(); ++k) {
      groups_[k] = groups_of_side(cells.groups, fine_squares[k].side);
    }
  }

  const ElementCounts& counts() const { return counts_; }

  void take(const Tile& tile) {
    candidates_.assign(cells_.groups.size(), {});
    elements_.start();
    find_light(tile);
    const std::size_t size = Tile::rows * tile.stride();
    for (std::size_t k = 0; k < fine_squares.size(); ++k) {
      moments_[k].start(size / (fine_squares[k].step * fine_squares[k].step));
    }
    for (std::size_t h = 0; h < halves; ++h) {
      take_half(tile, cells_.pair.a, {h, 0}, 0.5);
      take_elements(tile, cells_.pair.a, {h, 0}, 0.5);
      if (cells_.pair.b != nullptr) {
        take_half(tile, *cells_.pair.b, {h, 1}, -0.5);
        take_elements(tile, *cells_.pair.b, {h, 1}, -0.5);
      }
      count_varied(tile, h);
    }
    if (!coarse_.squared_error.blocks.empty()) add_reference_error(tile);
    add_weights(tile);
    offer_elements(tile);
    for (std::size_t k = 0; k < fine_squares.size(); ++k) offer_squares(tile, k);
    const std::size_t across = (extent_.width + Tile::columns - 1) / Tile::columns;
    found_.tiles[tile.y / Tile::rows * across + tile.x / Tile::columns] = std::move(candidates_);
  }

 private:
  struct Part {
    std::size_t half;
    std::size_t side;
  };

  // Elements that begin in a tile, row after row, without those beyond it.
  struct Elements {
    explicit Elements(const ImageExtent& extent) : stride(Tile::columns * extent.channels) {}
    void start() {
      for (std::vector<double>* each :
           {&effect, &variance[0], &variance[1], &reciprocal_degrees, &third, &light}) {
        each->assign(Tile::rows * stride, 0.0);
      }
    }
    void start_part() {
      for (std::vector<double>* each : {&squares, &cubes, &sixths}) {
        each->assign(Tile::rows * stride, 0.0);
      }
    }
    std::size_t stride;
    std::vector<double> light;
    // These are of the current part.
    std::vector<double> squares;
    std::vector<double> cubes;
    std::vector<double> sixths;
    // These add up the parts that are done.
    std::vector<double> effect;
    std::array<std::vector<double>, sides_of_pair> variance;
    std::vector<double> reciprocal_degrees;
    std::vector<double> third;
  };

  std::size_t rows_of(const Tile& tile) const {
    return std::min(Tile::rows, extent_.height - tile.y);
  }
  std::size_t columns_of(const Tile& tile) const {
    return std::min(Tile::columns, extent_.width - tile.x);
  }
  // Calls visit(index here, element of the image, x, y, channel).
  template <class Visit>
  void for_each_element(const Tile& tile, const Visit& visit) const {
    for (std::size_t y = 0; y < rows_of(tile); ++y) {
      std::size_t i = y * elements_.stride;
      std::size_t element = ((tile.y + y) * extent_.width + tile.x) * extent_.channels;
      for (std::size_t x = 0; x < columns_of(tile); ++x) {
        for (std::size_t c = 0; c < extent_.channels; ++c) {
          visit(i++, element++, tile.x + x, tile.y + y, c);
        }
      }
    }
  }

  void take_elements(const Tile& tile, const ImageStack<Real>& stack, Part part, double factor) {
    Elements& all = elements_;
    all.start_part();
    const Half& own = cells_.half[part.half];
    const Half& other = cells_.half[1 - part.half];
    const std::size_t size = columns_of(tile) * extent_.channels;
    std::size_t count = 0;
    for (std::size_t r = part.half; r < stack.images.size(); r += halves) {
      ++count;
      for (std::size_t y = 0; y < rows_of(tile); ++y) {
        const std::size_t element = ((tile.y + y) * extent_.width + tile.x) * extent_.channels;
        const std::size_t here = element - own.first;
        const std::size_t row = y * all.stride;
        add_powers(
            stack.at(r, element), own.mean[part.side].data() + here, other.weight.data() + here,
            {all.squares.data() + row, all.cubes.data() + row, all.sixths.data() + row}, size);
        note_rare(tile, stack.at(r, element), part, y, size);
      }
    }
    finish_elements(tile, part, static_cast<double>(count), factor);
  }

  // Deviations beyond twice the light of the block are rare.
  void note_rare(const Tile& tile, const Real* value, Part part, std::size_t y, std::size_t size) {
    const std::size_t here =
        ((tile.y + y) * extent_.width + tile.x) * extent_.channels - cells_.half[0].first;
    const double* const mean = cells_.half[part.half].mean[part.side].data() + here;
    const double* const weight = cells_.half[1 - part.half].weight.data() + here;
    const double* const light = elements_.light.data() + y * elements_.stride;
    constexpr double rare = 2;
    for (std::size_t i = 0; i < size; ++i) {
      const double deviation = static_cast<double>(value[i]) - mean[i];
      if (std::abs(deviation) <= rare * light[i] || weight[i] == 0) continue;
      found_.noise.at(part.side, tile.x + i / extent_.channels, tile.y + y, i % extent_.channels)
          .add_rare(deviation);
    }
  }

  void finish_elements(const Tile& tile, Part part, double count, double factor) {
    const Half& own = cells_.half[part.half];
    const Half& other = cells_.half[1 - part.half];
    Elements& all = elements_;
    const double third_factor = factor * factor * factor / (count * count * count);
    for_each_element(
        tile, [&](std::size_t i, std::size_t element, std::size_t x, std::size_t y, std::size_t c) {
          const std::size_t here = element - own.first;
          const double weight = other.weight[here];
          if (part.side == 0) all.effect[i] += factor * weight * own.difference[here];
          if (weight == 0) return;
          const double variance = factor * factor * all.squares[i] / (count * (count - 1));
          all.variance[part.side][i] += variance;
          all.reciprocal_degrees[i] += variance * variance / (count - 1);
          all.third[i] += third_factor * all.cubes[i];
          found_.noise.at(part.side, x, y, c)
              .add({.count = count,
                    .squares = all.squares[i] / (weight * weight) * count / (count - 1),
                    .cubes = all.cubes[i] / (weight * weight * weight),
                    .sixths = all.sixths[i] / std::pow(weight, 6)});
        });
  }

  // Tests each element.
  void offer_elements(const Tile& tile) {
    Elements& all = elements_;
    for_each_element(
        tile, [&](std::size_t i, std::size_t element, std::size_t x, std::size_t y, std::size_t c) {
          const std::size_t block =
              (y / block_side * coarse_.extent.width + x / block_side) * extent_.channels + c;
          coarse_.third[block] += all.third[i];
          const double weight = weight_of(element);
          found_.weights[element] = static_cast<float>(weight);
          if (halves_that_vary(element) < halves) {
            note_constant(element);
            found_.z[element] = 0;
            return;
          }
          ++counts_.tested;
          note_noisier(i, element, x, y, c);
          Candidate candidate;
          candidate.finding.window = {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                      1, 1};
          candidate.finding.channel = c;
          candidate.noise.effect = all.effect[i];
          candidate.noise.variance = {all.variance[0][i], all.variance[1][i] + error_of(element)};
          const double total = candidate.noise.variance[0] + candidate.noise.variance[1];
          candidate.noise.degrees = total * total / all.reciprocal_degrees[i];
          candidate.noise.weight = weight;
          const StudentValue value = own_value(candidate.noise);
          found_.z[element] = candidate.finding.z = t_to_z(value);
          if (candidates_[0].wants(value)) candidates_[0].keep(candidate);
        });
  }

  double mean_of(std::size_t side, std::size_t element) const {
    if (side == 1 && cells_.pair.b == nullptr) return cells_.pair.reference->value[element];
    const std::size_t here = element - cells_.half[0].first;
    return std::midpoint(cells_.half[0].mean[side][here], cells_.half[1].mean[side][here]);
  }

  // Which side has the larger variance over its squared mean?
  void note_noisier(std::size_t i, std::size_t element, std::size_t x, std::size_t y,
                    std::size_t c) {
    const auto noise = [&](std::size_t side) {
      return elements_.variance[side][i] * std::pow(mean_of(1 - side, element), 2);
    };
    found_.noise.at(0, x, y, c).add_element(noise(0) > noise(1));
    if (cells_.pair.b != nullptr) found_.noise.at(1, x, y, c).add_element(noise(1) > noise(0));
  }

  double weight_of(std::size_t element) const {
    const std::size_t here = element - cells_.half[0].first;
    return (cells_.half[0].weight[here] + cells_.half[1].weight[here]) / 2;
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

  // Sums of the weights and of their squares.
  void add_weights(const Tile& tile) {
    fill_tile(tile, sums_.values(), [&](std::size_t first, std::span<double> out) {
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = weight_of(first + i);
    });
    sums_.add_up(tile);
    keep_blocks(tile, coarse_.weights);
    for (std::size_t k = 0; k < fine_squares.size(); ++k) weights_[k] = sums_.of(k);
    for (double& weight : sums_.values()) weight *= weight;
    sums_.add_up(tile);
    keep_blocks(tile, coarse_.squared_weights);
    add_alternating(tile, coarse_.squared_weights);
  }

  // A reference's squared error, weighted as the element is.
  double error_of(std::size_t element) const {
    if (coarse_.squared_error.blocks.empty()) return 0;
    const double error = weight_of(element) * cells_.pair.reference->standard_error[element];
    return error * error;
  }

  std::size_t halves_that_vary(std::size_t element) const {
    const std::size_t here = element - cells_.half[0].first;
    return static_cast<std::size_t>(std::ranges::count_if(
        cells_.half, [here](const Half& half) { return half.varied[here] > 0; }));
  }

  // An element that varied in one half alone is in sums only.
  void note_constant(std::size_t element) {
    const double difference = cells_.half[0].difference[element - cells_.half[0].first];
    ElementCounts one;
    if (halves_that_vary(element) > 0 || difference == 0 || !cells_.constants_decide) {
      one.equal_constants = 1;
    } else {
      one = {.tested = 0,
             .equal_constants = 0,
             .different_constants = 1,
             .first_different = element,
             .difference = difference};
    }
    counts_.merge(one);
  }

  void take_half(const Tile& tile, const ImageStack<Real>& stack, Part part, double factor) {
    const Half& other = cells_.half[1 - part.half];
    std::vector<BlockSums>& kept = coarse_.images[part.half][part.side];
    double count = 0;
    for (std::size_t r = part.half; r < stack.images.size(); r += halves) {
      if (r + halves < stack.images.size()) fetch_ahead(tile, stack, r + halves);
      fill_tile(tile, sums_.values(), [&](std::size_t first, std::span<double> out) {
        const Real* const value = stack.at(r, first);
        const double* const weight = other.weight.data() + (first - other.first);
        if (cells_.pair.b != nullptr) {
          weigh(value, cells_.pair.b->at(0, first), weight, out);
        } else {
          weigh(value, cells_.pair.reference->value.data() + first, weight, out);
        }
      });
      sums_.add_up(tile);
      const double inverse = 1 / ++count;
      for (std::size_t k = 0; k < fine_squares.size(); ++k) update_squares(tile, k, inverse);
      BlockSums& blocks = kept[r / halves];
      keep_blocks(tile, blocks);
      add_alternating(tile, blocks);
    }
    for (WelchCells& moments : moments_) moments.finish_part(part.half, part.side, count, factor);
  }

  void update_squares(const Tile& tile, std::size_t k, double inverse) {
    const std::size_t step = fine_squares[k].step;
    const std::size_t stride = tile.stride() / step;
    for (std::size_t row = 0; row < tile.height() / step; ++row) {
      update({sums_.of(k).data() + row * stride, moments_[k].mean.data() + row * stride,
              moments_[k].m2.data() + row * stride},
             inverse, tile.width() / step * extent_.channels);
    }
  }

  // Calls visit(index of the block, of its sum) for the first channel of each
  // block of the tile.
  template <class Visit>
  void for_each_block(const Tile& tile, const Visit& visit) const {
    for (std::size_t y = 0; y < tile.height() && tile.y + y < extent_.height; y += block_side) {
      for (std::size_t x = 0; x < tile.width() && tile.x + x < extent_.width; x += block_side) {
        const std::size_t row = (tile.y + y) / block_side;
        const std::size_t block = row * coarse_.extent.width + (tile.x + x) / block_side;
        visit(block * extent_.channels, y * tile.stride() + x * extent_.channels);
      }
    }
  }
  void keep_blocks(const Tile& tile, BlockSums& to) const {
    const double* const sums = sums_.of(1).data();
    for_each_block(tile, [&](std::size_t block, std::size_t sum) {
      std::copy_n(sums + sum, extent_.channels, to.blocks.data() + block);
    });
  }

  void add_alternating(const Tile& tile, BlockSums& to) {
    const std::size_t size = tile.width() * extent_.channels;
    std::fill_n(column_sums_.begin(), size, 0.0);
    std::fill_n(signed_column_sums_.begin(), size, 0.0);
    for (std::size_t y = 0; y < tile.height(); ++y) {
      add_row({sums_.values().data() + y * tile.stride(), column_sums_.data(),
               signed_column_sums_.data()},
              y % 2 == 0 ? 1 : -1, size);
    }
    for (std::size_t x = 0; x < tile.width(); ++x) {
      const double sign = x % 2 == 0 ? 1 : -1;
      for (std::size_t c = 0; c < extent_.channels; ++c) {
        const std::size_t i = x * extent_.channels + c;
        double* const channel = to.alternating.data() + alternating_ + c * alternations;
        channel[0] += sign * column_sums_[i];
        channel[1] += signed_column_sums_[i];
        channel[2] += sign * signed_column_sums_[i];
      }
    }
  }

  // Squares of that side did not vary if none of their elements did. Their sums are then equal in
  // every replicate, to the last bit. Sums of larger cells need the count.
  void count_varied(const Tile& tile, std::size_t h) {
    fill_tile(tile, sums_.values(), [&](std::size_t first, std::span<double> out) {
      const double* const weight =
          cells_.half[1 - h].weight.data() + (first - cells_.half[h].first);
      const unsigned char* const varied =
          cells_.half[h].varied.data() + (first - cells_.half[h].first);
      for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = weight[i] > 0 && varied[i] > 0 ? 1 : 0;
      }
    });
    sums_.add_up(tile);
    keep_blocks(tile, coarse_.varied[h]);
  }

  // A reference's error is one for both halves, independent between elements, and known without
  // degrees of freedom. A sum that did not vary stays untested, without variance. The error says
  // nothing of values never seen.
  void add_reference_error(const Tile& tile) {
    fill_tile(tile, sums_.values(), [&](std::size_t first, std::span<double> out) {
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = error_of(first + i);
    });
    sums_.add_up(tile);
    keep_blocks(tile, coarse_.squared_error);
    for (std::size_t k = 0; k < fine_squares.size(); ++k) {
      for (std::size_t i = 0; i < moments_[k].variance[0].size(); ++i) {
        if (moments_[k].variance[0][i] > 0) moments_[k].variance[1][i] += sums_.of(k)[i];
      }
    }
  }

  void offer_squares(const Tile& tile, std::size_t k) {
    const auto [side, step] = fine_squares[k];
    const std::size_t stride = tile.stride() / step;
    for (std::size_t row = 0; row < tile.height() / step; ++row) {
      for (std::size_t column = 0; column < tile.width() / step; ++column) {
        const Rectangle square{static_cast<std::uint32_t>(tile.x + column * step),
                               static_cast<std::uint32_t>(tile.y + row * step), side, side};
        offer_square(square, k, row * stride + column * extent_.channels);
      }
    }
  }

  void offer_square(Rectangle square, std::size_t k, std::size_t first) {
    const auto width = static_cast<std::uint32_t>(extent_.width);
    const auto height = static_cast<std::uint32_t>(extent_.height);
    if (square.x >= width || square.y >= height) return;
    const bool aligned = square.x % square.width == 0 && square.y % square.height == 0;
    const std::optional<std::size_t> group = aligned ? groups_[k].aligned : groups_[k].shifted;
    if (!group) return;
    const std::uint32_t wide = std::min(square.width, width);
    const std::uint32_t high = std::min(square.height, height);
    if (!aligned && (square.x + wide > width || square.y + high > height)) return;
    square.width = std::min(wide, width - square.x);
    square.height = std::min(high, height - square.y);
    const WelchCells& moments = moments_[k];
    Candidate candidate;
    candidate.finding.size = cells_.groups[*group].size;
    candidate.finding.window = square;
    for (std::size_t c = 0; c < extent_.channels; ++c) {
      if (!moments.varied(first + c)) continue;
      candidate.finding.channel = c;
      moments.put(first + c, candidate.noise);
      const StudentValue value = own_value(candidate.noise);
      if (!candidates_[*group].wants(value)) continue;
      candidate.noise.weight = sums_.of(k)[first + c] / weights_[k][first + c];
      candidate.finding.z = t_to_z(value);
      candidates_[*group].keep(candidate);
    }
  }

  const FineCells<Real>& cells_;
  const ImageExtent& extent_;
  std::vector<Candidates> candidates_;  // A tile's, of each group.
  ElementCounts counts_;
  FineFindings& found_;
  CoarseImages& coarse_;
  std::size_t alternating_;  // Index of the band's sums with alternating signs.
  TileSums sums_;
  std::vector<double> column_sums_;
  std::vector<double> signed_column_sums_;
  std::array<WelchCells, fine_squares.size()> moments_;  // Squares that begin in the tile.
  std::array<GroupsOfSide, fine_squares.size()> groups_;
  std::array<std::vector<double>, fine_squares.size()> weights_;  // Sums over the squares.
  Elements elements_;
};

// Rows of an image are looked at in bands of tiles. Each band has alternating sums of its own until
// all are there.
constexpr std::size_t band_rows = 2 * Tile::rows;
static_assert(fine_rows % band_rows == 0 && fine_rows_ahead == Tile::halo);

template <class Real>
CoarseImages empty_blocks(const ImagePair<Real>& pair) {
  const ImageExtent& extent = pair.a.extent;
  const std::size_t bands = (extent.height + band_rows - 1) / band_rows;
  CoarseImages coarse;
  coarse.extent = {blocks_of(extent.width), blocks_of(extent.height), extent.channels};
  const BlockSums none{std::vector<double>(coarse.extent.elements()),
                       std::vector<double>(bands * extent.channels * alternations)};
  const auto per_half = [](const ImageStack<Real>& stack, std::size_t h) {
    return (stack.images.size() + 1 - h) / halves;
  };
  coarse.third.resize(coarse.extent.elements());
  coarse.weights = none;
  coarse.squared_weights = none;
  for (std::size_t h = 0; h < halves; ++h) {
    coarse.images[h][0].assign(per_half(pair.a, h), none);
    if (pair.b != nullptr) coarse.images[h][1].assign(per_half(*pair.b, h), none);
    coarse.varied[h] = none;
  }
  if (pair.reference != nullptr && !pair.reference->standard_error.empty()) {
    coarse.squared_error = none;
  }
  return coarse;
}

}  // namespace

bool is_fine(const WindowGroup& group) {
  return group.grid != Grid::alternating &&
         std::ranges::any_of(fine_squares,
                             [&](const Squares& squares) { return squares.side == group.size; });
}

template <class Real>
void offer_fine_cells(const FineCells<Real>& cells, RowRange rows, FineFindings& found,
                      const ForEach& for_each) {
  const ImageExtent& extent = cells.pair.a.extent;
  std::vector<ElementCounts> counts((rows.last - rows.first + band_rows - 1) / band_rows);
  for_each(counts.size(), [&](std::size_t i) {
    const std::size_t first = rows.first + i * band_rows;
    FineTiles<Real> tiles(cells, first / band_rows, found);
    for (std::size_t y = first; y < std::min(first + band_rows, rows.last); y += Tile::rows) {
      for (std::size_t x = 0; x < extent.width; x += Tile::columns) tiles.take({extent, x, y});
    }
    counts[i] = tiles.counts();
  });
  for (const ElementCounts& of_band : counts) found.counts.merge(of_band);
}

void ElementCounts::merge(const ElementCounts& other) {
  if (different_constants == 0) {
    first_different = other.first_different;
    difference = other.difference;
  }
  tested += other.tested;
  equal_constants += other.equal_constants;
  different_constants += other.different_constants;
}

template <class Real>
FineFindings empty_findings(const ImagePair<Real>& pair, std::span<double> z) {
  const ImageExtent& extent = pair.a.extent;
  const std::size_t across = (extent.width + Tile::columns - 1) / Tile::columns;
  const std::size_t down = (extent.height + Tile::rows - 1) / Tile::rows;
  return {.coarse = empty_blocks(pair),
          .noise = {extent, {pair.a.images.size(), pair.b != nullptr ? pair.b->images.size() : 0}},
          .tiles = std::vector<std::vector<Candidates>>(across * down),
          .counts = {},
          .weights = std::vector<float>(extent.elements()),
          .z = z};
}

void add_up_alternating(CoarseImages& coarse) {
  const std::size_t size = coarse.extent.channels * alternations;
  for (auto& half : coarse.images) {
    for (std::vector<BlockSums>& side : half) {
      for (BlockSums& image : side) {
        for (std::size_t i = size; i < image.alternating.size(); ++i) {
          image.alternating[i % size] += image.alternating[i];
        }
        image.alternating.resize(size);
      }
    }
  }
}

template FineFindings empty_findings(const ImagePair<float>&, std::span<double>);
template FineFindings empty_findings(const ImagePair<double>&, std::span<double>);
template void offer_fine_cells(const FineCells<float>&, RowRange, FineFindings&, const ForEach&);
template void offer_fine_cells(const FineCells<double>&, RowRange, FineFindings&, const ForEach&);

}  // namespace assay::stats
