#include "stats/pyramids/image_noise.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace assay::stats {
namespace {

constexpr std::uint32_t bits_of_half_octave = 22;

std::size_t half_octave(float size) {
  return (std::bit_cast<std::uint32_t>(size) -
          std::bit_cast<std::uint32_t>(PooledNoise::least_rare)) >>
         bits_of_half_octave;
}

float lower_end(std::size_t bin) {
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(PooledNoise::least_rare) +
                              (static_cast<std::uint32_t>(bin) << bits_of_half_octave));
}

double square(double x) { return x * x; }

// True if a sum is 0 within the rounding of the other.
bool is_dark(double sum, double other) { return std::abs(sum) <= 1e-12 * other; }

// Hall's transformation of |t|, where g is the skewness of the numerator in the direction from
// which t is too far.
double without_skewness(double t, double g) {
  if (!(g > 0)) return t;
  const double shrunk =
      g * t < 3 ? t - g * t * t / 3 + g * g * t * t * t / 27 - g / 6 : 1 / g - g / 6;
  return std::clamp(shrunk, 0.0, t);
}

}  // namespace

void PooledNoise::add_element(const Element& element) {
  const double variance = element.sum_of_squares / (element.replicates - 1);
  count_ += element.replicates;
  squares_ += variance * element.replicates;
  if (!(element.mean > 0)) return;
  ++lit_;
  relative_variances_ += variance / square(element.mean);
}

double PooledNoise::relative_variance() const { return lit_ > 0 ? relative_variances_ / lit_ : 0; }

void PooledNoise::add_rare(float deviation) {
  const float size = std::abs(deviation);
  Bin& bin = rare_[deviation > 0 ? upward : downward][std::min(half_octave(size), bins - 1)];
  bin.count += 1;
  bin.sum += size;
}

void PooledNoise::add_largest(const Largest& largest) {
  ++elements_;
  for (std::size_t d = 0; d < directions; ++d) largest_[d] += largest[d];
}

double PooledNoise::usual_largest(std::size_t direction) const {
  constexpr double least = least_rare;
  return elements_ > 0 ? std::max(least, largest_[direction] / elements_) : least;
}

void PooledNoise::merge(const PooledNoise& other) {
  count_ += other.count_;
  squares_ += other.squares_;
  elements_ += other.elements_;
  lit_ += other.lit_;
  relative_variances_ += other.relative_variances_;
  for (std::size_t d = 0; d < directions; ++d) largest_[d] += other.largest_[d];
  for (std::size_t d = 0; d < directions; ++d) {
    for (std::size_t i = 0; i < bins; ++i) {
      rare_[d][i].count += other.rare_[d][i].count;
      rare_[d][i].sum += other.rare_[d][i].sum;
    }
  }
}

PooledNoise::Tail PooledNoise::beyond(std::size_t direction, double c) const {
  if (count_ == 0) return {};
  double excess = 0;
  double squared_excess = 0;
  double squares = squares_;
  double fourths = 0;
  double common = squares_;  // Squares of the values that are not rare.
  for (std::size_t d = 0; d < directions; ++d) {
    for (std::size_t i = 0; i < bins; ++i) {
      const Bin& bin = rare_[d][i];
      if (bin.count == 0) continue;
      const double mean = static_cast<double>(bin.sum) / bin.count;
      common -= bin.count * square(mean);
      const double low = lower_end(i);
      const double high = lower_end(i + 1);
      if (d != direction || (c >= high && i + 1 < bins)) {
        fourths += bin.count * square(square(mean));
        continue;
      }
      // The values of the bin that c cuts are taken to be spread evenly.
      const bool cut = c > low && i + 1 < bins;
      const double above = cut ? bin.count * (high - c) / (high - low) : bin.count;
      const double centre = cut ? (high + c) / 2 : std::max(mean, c);
      excess += above * (centre - c);
      squared_excess += above * square(centre - c);
      squares -= above * (square(centre) - square(c));
      fourths += above * square(square(c)) + (bin.count - above) * square(square(low));
    }
  }
  common = std::max(common, 0.0);
  return {.excess = excess / count_,
          .excess_variance = squared_excess / square(count_),
          .square = std::max(squares, 0.0) / count_,
          .square_variance = (fourths + 3 * square(common) / count_) / square(count_)};
}

double variance_of_missing_light(const CellNoise& element) {
  const std::size_t dark = element.level[0] < element.level[1] ? 0 : 1;
  const double error = std::sqrt(element.variance[dark]);
  const double ahead = element.level[1 - dark] - std::sqrt(element.variance[1 - dark]);
  if (is_dark(element.level[dark], ahead)) return square(std::max(ahead, 0.0));
  const double behind = element.level[dark] + error;
  return behind > 0 && ahead > behind ? square(error) * (square(ahead / behind) - 1) : 0;
}

NoisePyramid::NoisePyramid(const ImageExtent& extent,
                           std::array<std::size_t, sides_of_pair> replicates)
    : levels_(1) {
  Level& level = levels_[0];
  level.width = (extent.width + block - 1) / block;
  level.height = (extent.height + block - 1) / block;
  level.channels = extent.channels;
  for (std::size_t s = 0; s < sides_of_pair; ++s) {
    replicates_[s] = static_cast<double>(replicates[s]);
    if (replicates[s] > 0) level.noise[s].resize(level.width * level.height * level.channels);
  }
}

void NoisePyramid::build() {
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level coarse{.side = 2 * fine.side,
                 .width = (fine.width + 1) / 2,
                 .height = (fine.height + 1) / 2,
                 .channels = fine.channels,
                 .noise = {}};
    for (std::size_t s = 0; s < sides_of_pair; ++s) {
      if (replicates_[s] == 0) continue;
      coarse.noise[s].resize(coarse.width * coarse.height * coarse.channels);
      for (std::size_t y = 0; y < fine.height; ++y) {
        for (std::size_t x = 0; x < fine.width; ++x) {
          for (std::size_t c = 0; c < fine.channels; ++c) {
            coarse.noise[s][coarse.index(x / 2, y / 2, c)].merge(
                fine.noise[s][fine.index(x, y, c)]);
          }
        }
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

double NoisePyramid::variance_if_equal(const CellNoise& cell, const Rectangle& window,
                                       std::size_t channel) const {
  const double plain = cell.variance[0] + cell.variance[1];
  const std::size_t dark = cell.level[0] < cell.level[1] ? 0 : 1;
  const double ahead = cell.level[1 - dark];
  const double behind = cell.level[dark];
  const bool is_zero = is_dark(behind, ahead);
  if (replicates_[dark] == 0 || !(ahead > 0) || (behind < 0 && !is_zero)) return plain;
  const std::uint32_t size = std::max(window.width, window.height);
  const auto around = std::ranges::find_if(
      levels_, [&](const Level& each) { return each.side >= size || &each == &levels_.back(); });
  const std::size_t block_of =
      around->index((window.x + window.width / 2) / around->side,
                    (window.y + window.height / 2) / around->side, channel);
  const double variance = is_zero
                              ? square(ahead) * around->noise[dark][block_of].relative_variance() /
                                    (cell.elements * replicates_[dark])
                              : cell.variance[dark] * square(ahead / behind);
  return std::max(variance + cell.variance[1 - dark], plain + cell.more);
}

NoisePyramid::Kept NoisePyramid::kept(const CellNoise& cell, const Rectangle& window,
                                      std::size_t channel) const {
  constexpr std::size_t sides_around = 4;
  constexpr double safety = 3;
  constexpr double errors = 2;
  const double own = variance_if_equal(cell, window, channel);
  const std::uint32_t size = std::max(window.width, window.height);
  const std::size_t x = window.x + window.width / 2;
  const std::size_t y = window.y + window.height / 2;
  const double effect = std::abs(cell.effect);
  Kept kept{.t = effect / std::sqrt(own), .margin = 0, .standard_error = std::sqrt(own)};
  double neighbours = -1;  // What neighbours add to the variance.
  for (const Level& level : levels_) {
    if (level.side < sides_around * size && &level != &levels_.back()) continue;
    const std::size_t block_of = level.index(x / level.side, y / level.side, channel);
    double margin = 0;
    double more = 0;
    for (std::size_t s = 0; s < sides_of_pair; ++s) {
      // A side that is too low lacks upward values, one that is too high lacks downward ones.
      const std::size_t direction = (s == 0) == (cell.effect < 0) ? upward : downward;
      std::array<PooledNoise::Tail, sides_of_pair> tail;
      std::array<double, sides_of_pair> lacks = {};
      double error = 0;
      for (std::size_t i = 0; i < sides_of_pair; ++i) {
        if (replicates_[i] == 0) continue;
        tail[i] = level.noise[i][block_of].beyond(
            direction, std::max(cell.largest[i][direction], PooledNoise::least_rare));
        lacks[i] =
            std::max(0.0, cell.elements * tail[i].square / replicates_[i] - cell.variance[i]);
        error += tail[i].square_variance / square(replicates_[i]);
      }
      const double excess = tail[s].excess - tail[1 - s].excess;
      const double excess_error = std::sqrt(tail[s].excess_variance + tail[1 - s].excess_variance);
      margin += safety * cell.elements * std::max(0.0, excess - excess_error);
      more += std::max(0.0, lacks[s] - lacks[1 - s] - errors * cell.elements * std::sqrt(error));
    }
    if (neighbours < 0) neighbours = more;
    const double standard_error = std::sqrt(own + neighbours);
    const double t = std::max(0.0, effect - margin) / standard_error;
    if (t <= kept.t) kept = {.t = t, .margin = margin, .standard_error = standard_error};
  }
  const double plain = cell.variance[0] + cell.variance[1];
  const double skewness = cell.third / (plain * std::sqrt(plain));
  kept.t = without_skewness(kept.t, cell.effect < 0 ? skewness : -skewness);
  kept.t = std::copysign(kept.t, cell.effect);
  return kept;
}

double NoisePyramid::hidden(std::size_t x, std::size_t y, std::size_t channel) const {
  const Level& level = levels_[0];
  const std::size_t i = level.index(x / block, y / block, channel);
  std::array<double, directions> bias = {};  // Of the first image, down and up.
  for (std::size_t s = 0; s < sides_of_pair; ++s) {
    if (replicates_[s] == 0) continue;
    const PooledNoise& noise = level.noise[s][i];
    for (std::size_t d = 0; d < directions; ++d) {
      bias[s == 0 ? d : 1 - d] += noise.beyond(d, noise.usual_largest(d)).excess;
    }
  }
  return std::max(bias[0], bias[1]);
}

}  // namespace assay::stats
