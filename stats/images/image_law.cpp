#include "stats/images/image_law.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "stats/basics/scores.h"
#include "stats/basics/vector_copies.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr std::size_t scores = 4;
constexpr std::size_t element_scores = 3;  // the others are of whole images
// Side of the tiles that threads take.
constexpr std::size_t tile_side = 32;
// Results of so many tiles are kept apart before they are merged.
constexpr std::size_t tiles_at_a_time = 64;
// Permutations are drawn in batches of twice the size before, as the elements are scored for each.
// The first mostly settles a true hypothesis. After so many that are as extreme, no more are drawn.
constexpr std::size_t first_batch_size = 64;
constexpr std::size_t largest_batch_size = 4096;
constexpr std::size_t enough = 10;

// The first side's images, one list for each labelling.
using Labels = std::vector<std::vector<std::uint32_t>>;

// Scores of the cells of one size, side by side, one row of cells an image.
struct Cells {
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t side = 1;
  std::size_t x = 0;  // The first cell's, in elements.
  std::size_t y = 0;
  std::vector<std::vector<float>> images = {};

  std::size_t count() const { return width * height; }
};

// Cells of twice the side; an odd last row or column stays as it is.
Cells doubled(const Cells& cells) {
  Cells out{.width = (cells.width + 1) / 2,
            .height = (cells.height + 1) / 2,
            .side = 2 * cells.side,
            .x = cells.x,
            .y = cells.y};
  for (const std::vector<float>& image : cells.images) {
    std::vector<float>& sums = out.images.emplace_back(out.count());
    for (std::size_t y = 0; y < cells.height; ++y) {
      for (std::size_t x = 0; x < cells.width; ++x) {
        sums[y / 2 * out.width + x / 2] += image[y * cells.width + x];
      }
    }
  }
  return out;
}

// The largest |z| of one score and size, for each labelling.
struct Group {
  std::size_t cells = 0;
  std::vector<float> largest = {};
  ImageLawFinding most = {};  // By the first labelling.
};
// By score, then by the logarithm of the side.
using Groups = std::array<std::vector<Group>, scores>;

ASSAY_VECTOR_COPIES void add_images(const std::vector<std::vector<float>>& images,
                                    const std::vector<std::uint32_t>& chosen, float* sums,
                                    std::size_t size) {
  std::fill_n(sums, size, 0.F);
  for (const std::uint32_t image : chosen) {
    const float* const from = images[image].data();
    for (std::size_t i = 0; i < size; ++i) sums[i] += from[i];
  }
}

ASSAY_VECTOR_COPIES float largest_of(const float* sums, const float* scale, std::size_t size) {
  float largest = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const float z = std::abs(sums[i] * scale[i]);
    largest = z > largest ? z : largest;
  }
  return largest;
}

// One over the standard deviation of a cell's sum over m chosen images of N, by permutation. Scores
// add up to 0 over images, so its square is m (N - m) / (N (N - 1)) times the sum of squares. A
// cell that does not vary has 0.
std::vector<float> scales_of(const Cells& cells, double chosen) {
  const auto all = static_cast<double>(cells.images.size());
  std::vector<double> squares(cells.count());
  for (const std::vector<float>& image : cells.images) {
    for (std::size_t i = 0; i < squares.size(); ++i) {
      squares[i] += static_cast<double>(image[i]) * static_cast<double>(image[i]);
    }
  }
  std::vector<float> scales(cells.count());
  // Sums of rounded scores of a cell that does not vary are not quite 0.
  const double least = 1e-6 * static_cast<double>(cells.side * cells.side);
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const double variance = squares[i] * chosen * (all - chosen) / (all * (all - 1));
    scales[i] = variance > least ? static_cast<float>(1 / std::sqrt(variance)) : 0.F;
  }
  return scales;
}

void look_at(const Cells& cells, const Labels& labels, std::size_t channel, Group& group) {
  const std::vector<float> scales = scales_of(cells, static_cast<double>(labels[0].size()));
  std::vector<float> sums(cells.count());
  group.cells += cells.count();
  group.largest.resize(labels.size());
  for (std::size_t l = 0; l < labels.size(); ++l) {
    add_images(cells.images, labels[l], sums.data(), sums.size());
    const float largest = largest_of(sums.data(), scales.data(), sums.size());
    if (!(largest > group.largest[l])) continue;
    group.largest[l] = largest;
    if (l > 0) continue;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const float z = sums[i] * scales[i];
      if (std::abs(z) != largest) continue;
      group.most.channel = channel;
      group.most.z = z;
      group.most.window = {static_cast<std::uint32_t>(cells.x + i % cells.width * cells.side),
                           static_cast<std::uint32_t>(cells.y + i / cells.width * cells.side),
                           static_cast<std::uint32_t>(cells.side),
                           static_cast<std::uint32_t>(cells.side)};
      break;
    }
  }
}

void merge(Group& group, const Group& other) {
  group.cells += other.cells;
  if (group.largest.empty()) group.largest.resize(other.largest.size());
  for (std::size_t l = 0; l < other.largest.size(); ++l) {
    if (!(other.largest[l] > group.largest[l])) continue;
    group.largest[l] = other.largest[l];
    if (l == 0) group.most = other.most;
  }
}

struct Place {
  std::size_t x;
  std::size_t y;
  std::size_t channel;
};

class Pooled {
 public:
  Pooled(const ImageStack& a, const ImageStack& b) : extent_(a.extent) {
    for (const ImageStack* stack : {&a, &b}) {
      images_.insert(images_.end(), stack->images.begin(), stack->images.end());
    }
  }

  const ImageExtent& extent() const { return extent_; }
  std::size_t tiles_across() const { return (extent_.width + tile_side - 1) / tile_side; }
  std::size_t tiles() const {
    return tiles_across() * ((extent_.height + tile_side - 1) / tile_side) * extent_.channels;
  }
  Place place(std::size_t tile) const {
    const std::size_t square = tile / extent_.channels;
    return {square % tiles_across() * tile_side, square / tiles_across() * tile_side,
            tile % extent_.channels};
  }

  // The scores of each image's largest value, for every channel.
  std::vector<Cells> brightest(const ForEach& for_each) const {
    std::vector<std::vector<double>> largest(
        extent_.channels,
        std::vector<double>(images_.size(), -std::numeric_limits<double>::infinity()));
    for_each(images_.size(), [&](std::size_t r) {
      for (std::size_t i = 0; i < images_[r].size(); ++i) {
        double& most = largest[i % extent_.channels][r];
        most = std::max(most, static_cast<double>(images_[r][i]));
      }
    });
    std::vector<Cells> all;
    for (const std::vector<double>& values : largest) {
      std::vector<Placed<double>> order;
      std::vector<double> ranks;
      midranks(std::span<const double>(values), order, ranks);
      standardise(ranks);
      Cells& whole = all.emplace_back(Cells{.width = 1, .height = 1});
      for (const double rank : ranks) whole.images.push_back({static_cast<float>(rank)});
    }
    return all;
  }

  // Scores of a tile's elements.
  std::array<Cells, element_scores> scored(const Place& at) const {
    std::array<Cells, element_scores> all;
    for (Cells& cells : all) {
      cells = {.width = std::min(tile_side, extent_.width - at.x),
               .height = std::min(tile_side, extent_.height - at.y),
               .x = at.x,
               .y = at.y};
      cells.images.assign(images_.size(), std::vector<float>(cells.count()));
    }
    // One element's values in all images, in order, and its scores.
    std::vector<Placed<double>> order;
    std::array<std::vector<double>, element_scores> by;
    auto& [value, rank, spread] = by;
    value.resize(images_.size());
    for (std::size_t i = 0; i < all[0].count(); ++i) {
      const std::size_t x = at.x + i % all[0].width;
      const std::size_t y = at.y + i / all[0].width;
      const std::size_t index = (y * extent_.width + x) * extent_.channels + at.channel;
      for (std::size_t r = 0; r < images_.size(); ++r) value[r] = images_[r][index];
      midranks(std::span<const double>(value), order, rank);
      standardise(value);
      standardise(rank);
      spread = rank;
      for (double& each : spread) each *= each;
      standardise(spread);
      for (std::size_t s = 0; s < element_scores; ++s) {
        for (std::size_t r = 0; r < images_.size(); ++r) {
          all[s].images[r][i] = static_cast<float>(by[s][r]);
        }
      }
    }
    return all;
  }

 private:
  ImageExtent extent_;
  std::vector<std::span<const float>> images_;
};

// Looks at cells of this size and larger ones, up to `last`, and returns those.
Cells look_upward(Cells cells, std::size_t last, const Labels& labels, std::size_t channel,
                  std::vector<Group>& groups) {
  for (;;) {
    const auto level = static_cast<std::size_t>(std::countr_zero(cells.side));
    if (groups.size() <= level) groups.resize(level + 1);
    look_at(cells, labels, channel, groups[level]);
    if (cells.side >= last || cells.count() == 1) return cells;
    cells = doubled(cells);
  }
}

// The z of a tile's elements by their values, with the sides as they are.
void note_elements(const Cells& values, const Place& at, const ImageExtent& extent,
                   const std::vector<std::uint32_t>& first, std::span<double> z) {
  const std::vector<float> scales = scales_of(values, static_cast<double>(first.size()));
  std::vector<float> sums(values.count());
  add_images(values.images, first, sums.data(), sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const std::size_t x = at.x + i % values.width;
    const std::size_t y = at.y + i / values.width;
    z[(y * extent.width + x) * extent.channels + at.channel] = sums[i] * scales[i];
  }
}

Groups groups_of(const Pooled& pooled, const std::vector<Cells>& brightest, const Labels& labels,
                 const ForEach& for_each, std::span<double> z) {
  Groups all;
  // By tile, score and image.
  std::vector<std::array<std::vector<float>, element_scores>> sums(pooled.tiles());
  for (std::size_t first = 0; first < sums.size(); first += tiles_at_a_time) {
    std::vector<Groups> found(std::min(tiles_at_a_time, sums.size() - first));
    for_each(found.size(), [&](std::size_t i) {
      const Place at = pooled.place(first + i);
      std::array<Cells, element_scores> scored = pooled.scored(at);
      if (!z.empty()) note_elements(scored[0], at, pooled.extent(), labels[0], z);
      for (std::size_t s = 0; s < element_scores; ++s) {
        Cells cells =
            look_upward(std::move(scored[s]), tile_side / 2, labels, at.channel, found[i][s]);
        while (cells.count() > 1) cells = doubled(cells);
        for (const auto& image : cells.images) sums[first + i][s].push_back(image[0]);
      }
    });
    for (const Groups& groups : found) {
      for (std::size_t s = 0; s < scores; ++s) {
        all[s].resize(std::max(all[s].size(), groups[s].size()));
        for (std::size_t l = 0; l < groups[s].size(); ++l) merge(all[s][l], groups[s][l]);
      }
    }
  }
  // Tiles are the cells of larger sizes.
  const ImageExtent& extent = pooled.extent();
  for (std::size_t s = 0; s < element_scores; ++s) {
    for (std::size_t c = 0; c < extent.channels; ++c) {
      Cells tiles{.width = pooled.tiles_across(),
                  .height = pooled.tiles() / pooled.tiles_across() / extent.channels,
                  .side = tile_side};
      tiles.images.assign(sums[0][s].size(), std::vector<float>(tiles.count()));
      for (std::size_t t = 0; t < tiles.count(); ++t) {
        for (std::size_t r = 0; r < tiles.images.size(); ++r) {
          tiles.images[r][t] = sums[t * extent.channels + c][s][r];
        }
      }
      look_upward(std::move(tiles), std::bit_ceil(std::max(extent.width, extent.height)), labels, c,
                  all[s]);
    }
  }
  Group& largest = all[static_cast<std::size_t>(ImageScore::largest)].emplace_back();
  for (std::size_t c = 0; c < extent.channels; ++c) look_at(brightest[c], labels, c, largest);
  largest.most.window = {0, 0, static_cast<std::uint32_t>(extent.width),
                         static_cast<std::uint32_t>(extent.height)};
  return all;
}

double adjusted_log_p(const Group& group, std::size_t labelling) {
  return adjusted(log_p_two_sided(normal_tails(static_cast<double>(group.largest[labelling]))),
                  {static_cast<double>(group.cells), 1});
}

// The smallest adjusted p-value of each labelling, over scores and sizes.
std::vector<double> statistics_of(const Groups& groups, std::size_t labellings) {
  std::vector<double> least(labellings, 0);
  for (const std::vector<Group>& sizes : groups) {
    for (const Group& group : sizes) {
      if (group.cells == 0) continue;
      for (std::size_t l = 0; l < labellings; ++l) {
        least[l] = std::min(least[l], adjusted_log_p(group, l));
      }
    }
  }
  return least;
}

ImageLawFinding most_of(const Groups& groups, const ImageExtent& extent) {
  ImageLawFinding most{.window = {0, 0, static_cast<std::uint32_t>(extent.width),
                                  static_cast<std::uint32_t>(extent.height)}};
  double least = 1;
  for (std::size_t s = 0; s < scores; ++s) {
    for (const Group& group : groups[s]) {
      if (group.cells == 0 || !(group.largest[0] > 0)) continue;
      const double log_p = adjusted_log_p(group, 0);
      if (!(log_p < least)) continue;
      least = log_p;
      most = group.most;
      most.score = static_cast<ImageScore>(s);
    }
  }
  const auto cut = [](std::uint32_t first, std::uint32_t size, std::size_t all) {
    return std::min(size, static_cast<std::uint32_t>(all) - first);
  };
  most.window.width = cut(most.window.x, most.window.width, extent.width);
  most.window.height = cut(most.window.y, most.window.height, extent.height);
  return most;
}

}  // namespace

std::vector<std::uint32_t> drawn_subset(const std::function<double()>& uniform, std::size_t count,
                                        std::size_t size) {
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0);
  for (std::size_t i = 0; i < size; ++i) {
    const double rest = static_cast<double>(count - i);
    std::swap(all[i], all[i + static_cast<std::size_t>(uniform() * rest)]);
  }
  all.resize(size);
  return all;
}

std::size_t permutations_at(double alpha) {
  constexpr double least = 999;
  constexpr double usual = 9999;
  const double many = std::min(static_cast<double>(enough) / alpha - 1, usual);
  return static_cast<std::size_t>(std::max({least, many, std::ceil(1 / alpha) - 1}));
}

ImageLawTest image_law_test(const ImageStack& a, const ImageStack& b,
                            const ImageLawOptions& options) {
  check::image_pair("image_law_test", {a, b});
  const Pooled pooled(a, b);
  const std::vector<Cells> brightest = pooled.brightest(options.for_each);
  const std::size_t first = a.images.size();
  const std::size_t all = first + b.images.size();
  ImageLawTest test{.z = std::vector<double>(a.extent.elements())};
  Labels labels(1, std::vector<std::uint32_t>(first));
  std::iota(labels[0].begin(), labels[0].end(), 0);
  std::size_t as_small = 0;
  double observed = 0;
  std::size_t batch = first_batch_size;
  while (test.permutations < options.permutations && as_small < enough) {
    labels.resize(1);
    const bool first_batch = test.permutations == 0;
    const std::size_t size = std::min(batch, options.permutations - test.permutations);
    batch = std::min(2 * batch, largest_batch_size);
    for (std::size_t i = 0; i < size; ++i) {
      labels.push_back(options.draw(test.permutations + i, all, first));
    }
    const Groups groups = groups_of(pooled, brightest, labels, options.for_each,
                                    first_batch ? std::span(test.z) : std::span<double>());
    const std::vector<double> statistics = statistics_of(groups, labels.size());
    if (first_batch) {
      observed = statistics[0];
      test.most = most_of(groups, a.extent);
    }
    for (std::size_t i = 1; i < statistics.size() && as_small < enough; ++i) {
      ++test.permutations;
      if (statistics[i] <= observed) ++as_small;
    }
  }
  const auto drawn = static_cast<double>(test.permutations);
  const auto count = static_cast<double>(as_small);
  test.log_p = std::log(as_small < enough ? (count + 1) / (drawn + 1) : count / drawn);
  return test;
}

Evidence law_evidence(const ImageLawTest& test) {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  const TestResult equal{.statistic = test.most.z,
                         .distribution = {"permutation", {static_cast<double>(test.permutations)}},
                         .log_p_lower = 0,
                         .log_p_upper = test.log_p};
  return {.estimate = unknown,
          .at = [equal](double) { return equal; },
          .interval =
              [](double confidence) {
                return Interval{-unknown, unknown, confidence};
              },
          .quantity = "difference of the laws",
          .distance = true};
}

}  // namespace assay::stats
