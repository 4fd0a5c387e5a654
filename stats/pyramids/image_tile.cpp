#include "stats/pyramids/image_tile.h"

#include <algorithm>

#include "stats/basics/vector_copies.h"

namespace assay::stats {
namespace {

constexpr std::size_t multiple = 8;

std::size_t padded(std::size_t count) { return (count + multiple - 1) / multiple * multiple; }

struct Four {
  const double* first;
  const double* second;
  const double* third;
  const double* fourth;
};

ASSAY_VECTOR_COPIES void add(const Four& from, double* to, std::size_t size) {
  const double* const a = from.first;
  const double* const b = from.second;
  const double* const c = from.third;
  const double* const d = from.fourth;
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

}  // namespace

std::size_t Tile::width() const { return std::min(columns, padded(extent.width - x)); }
std::size_t Tile::height() const { return std::min(rows, padded(extent.height - y)); }

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

}  // namespace assay::stats
