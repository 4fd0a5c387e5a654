#include "stats/pyramids/image_noise.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "stats/images/image_halves.h"
#include "stats/means/constant_sample.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

double square(double x) { return x * x; }

PooledNoise::Powers powers_of(double x, double count) {
  return {.count = 0, .squares = count * x * x, .cubes = count * x * x * x};
}

}  // namespace

void PooledNoise::add(const Powers& powers) {
  common_.count += powers.count;
  common_.squares += powers.squares;
  common_.cubes += powers.cubes;
}

void PooledNoise::add_element(bool noisier) {
  elements_ += 1;
  noisier_ += noisier ? 1 : 0;
}

PooledNoise::Powers PooledNoise::powers_of(std::size_t direction, const Pile& pile) {
  return stats::powers_of((direction == 0 ? 1.0 : -1.0) * pile.sum / pile.count, pile.count);
}

// Octaves that fall off the end join the common values.
void PooledNoise::raise(int top) {
  if (top <= top_) return;
  const int rise = std::min(top - top_, octaves);
  for (std::size_t d = 0; d < tails_.size(); ++d) {
    Tail& tail = tails_[d];
    for (auto bin = tail.end() - rise; bin != tail.end(); ++bin) {
      if (bin->large.count > 0) add(powers_of(d, bin->large));
    }
    std::shift_right(tail.begin(), tail.end(), rise);
    std::fill_n(tail.begin(), rise, Bin{});
  }
  top_ = top;
}

void PooledNoise::add_large(double deviation, bool rare) {
  const double size = std::abs(deviation);
  const int octave = std::ilogb(size) + 1;
  raise(octave);
  if (top_ - octave >= octaves) return;
  const Pile one{1, static_cast<float>(size)};
  tails_[deviation > 0 ? 0 : 1][static_cast<std::size_t>(top_ - octave)].add(
      {one, rare ? one : Pile{}});
  add(stats::powers_of(deviation, -1));
}

void PooledNoise::add_rare_element(double largest, double number) {
  const int below = top_ - std::ilogb(largest) - 1;
  if (below < octaves)
    tails_[0][static_cast<std::size_t>(below)].rare_squares += static_cast<float>(number * number);
}

void PooledNoise::merge(const PooledNoise& other) {
  add(other.common_);
  elements_ += other.elements_;
  noisier_ += other.noisier_;
  if (other.top_ == no_octave) return;
  raise(other.top_);
  for (std::size_t d = 0; d < tails_.size(); ++d) {
    for (int i = 0; i < octaves; ++i) {
      const Bin& from = other.tails_[d][static_cast<std::size_t>(i)];
      if (from.large.count == 0) continue;
      const int to = i + top_ - other.top_;
      if (to >= octaves) {
        add(powers_of(d, from.large));
        continue;
      }
      tails_[d][static_cast<std::size_t>(to)].add(from);
    }
  }
}

PooledNoise::Moments PooledNoise::moments_of(Powers others, Pile Bin::*pile, int octave,
                                             Signs signs) const {
  if (!(common_.count > 0)) return {};
  const float c = std::ldexp(1.0F, octave);
  for (std::size_t d = 0; d < tails_.size(); ++d) {
    if (signs == (d == 0 ? Signs::downward : Signs::upward)) continue;
    for (const Bin& bin : tails_[d]) {
      const auto& [count, sum] = bin.*pile;
      if (count == 0) continue;
      const Powers powers = powers_of(d, {count, std::min(c * count, sum)});
      others.squares += powers.squares;
      others.cubes += powers.cubes;
    }
  }
  return {.second = others.squares / common_.count, .third = others.cubes / common_.count};
}

PooledNoise::Moments PooledNoise::cut_off(int octave) const {
  return moments_of(common_, &Bin::large, octave, Signs::both);
}

PooledNoise::Moments PooledNoise::rare_cut_off(int octave, Signs signs) const {
  return moments_of({}, &Bin::rare, octave, signs);
}

int PooledNoise::bottom() const {
  int depth = octaves - 1;
  const auto large = [&](const Tail& tail) {
    return tail[static_cast<std::size_t>(depth)].large.count;
  };
  while (depth > 0 && large(tails_[0]) + large(tails_[1]) == 0) --depth;
  return top_ - depth;
}

PooledNoise::Rare PooledNoise::rare(int octave) const {
  const int i = top_ - octave;
  if (i < 0 || i >= octaves) return {};
  const auto below = static_cast<std::size_t>(i);
  const Bin& up = tails_[0][below];
  const Bin& down = tails_[1][below];
  return {.count = up.rare.count + down.rare.count, .squares = up.rare_squares + down.rare_squares};
}

double PooledNoise::hidden_squares(double replicates) const {
  const Moments all = cut_off(top_);
  if (all.third == 0) return 0;
  const double size = all.third / all.second;
  const double probability = all.second / square(size);
  return elements_ * square(size * probability * std::exp(-replicates * probability));
}

NoisePyramid::NoisePyramid(const ImageExtent& extent,
                           std::array<std::size_t, sides_of_pair> replicates)
    : levels_(1), squares_(extent.channels) {
  Level& level = levels_[0];
  level.width = (extent.width + block - 1) / block;
  level.height = (extent.height + block - 1) / block;
  level.channels = extent.channels;
  for (std::size_t s = 0; s < sides_of_pair; ++s) {
    replicates_[s] = static_cast<double>(replicates[s]);
    level.noise[s].resize(level.width * level.height * level.channels);
  }
}

void NoisePyramid::add_squares(std::size_t channel, const SquaresOfSides& squares) {
  for (std::size_t k = 0; k < squares.size(); ++k) squares_[channel][k] += squares[k];
}

double NoisePyramid::together(std::uint32_t side, std::size_t channel) const {
  const SquaresOfSides& squares = squares_[channel];
  const auto doublings = static_cast<std::size_t>(std::bit_width(side) - 1);
  const std::size_t k = std::min(doublings, squares.size() - 1);
  return squares[0] > 0 ? std::max(1.0, squares[k] / squares[0]) : 1;
}

void NoisePyramid::build() {
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level coarse{.side = 2 * fine.side,
                 .width = (fine.width + 1) / 2,
                 .height = (fine.height + 1) / 2,
                 .channels = fine.channels};
    for (std::size_t s = 0; s < sides_of_pair; ++s) {
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

NoisePyramid::Around NoisePyramid::around(const Rectangle& window, std::size_t channel) const {
  constexpr std::size_t sides_around = 4;
  const std::uint32_t size = std::max(window.width, window.height);
  const std::size_t x = window.x + window.width / 2;
  const std::size_t y = window.y + window.height / 2;
  Around found{.first = -PooledNoise::no_octave,
               .last = PooledNoise::no_octave,
               .together = together(block, channel)};
  for (const Level& level : levels_) {
    if (level.side < sides_around * size && &level != &levels_.back()) continue;
    const std::size_t block_of = level.index(x / level.side, y / level.side, channel);
    found.blocks.push_back({{&level.noise[0][block_of], &level.noise[1][block_of]},
                            level.side >= sides_around * size});
    for (const PooledNoise* side : found.blocks.back().sides) {
      if (side->top() == PooledNoise::no_octave) continue;
      found.last = std::max(found.last, side->top());
      found.first = std::min(found.first, side->bottom());
    }
  }
  // Without large values every octave is the same.
  if (found.last == PooledNoise::no_octave) found.first = found.last;
  return found;
}

double NoisePyramid::inverse(std::size_t side) const {
  return replicates_[side] > 0 ? 1 / replicates_[side] : 0;
}

bool NoisePyramid::of_one_law(const Around& near, double toward) const {
  constexpr double errors_of_signs = 6;
  constexpr double errors_of_rates = 2.25;
  if (replicates_[1] == 0) return false;
  // The root of a count plus 3/8 has the standard error 1/2 (Anscombe 1948), of counts in clusters
  // the root of their mean size times that.
  const auto root = [](double count) { return std::sqrt(count + 0.375); };
  return std::ranges::all_of(near.blocks, [&](const Block& each) {
    const auto& here = each.sides;
    const double more = root(here[0]->noisier()) - root(here[1]->noisier());
    if (std::abs(more) > errors_of_signs * std::numbers::sqrt2 / 2) return false;
    std::array<PooledNoise::Rare, sides_of_pair> beyond = {};
    const int first = std::max({near.first, here[0]->lowest(), here[1]->lowest()});
    for (int octave = near.last; octave >= first; --octave) {
      std::array<double, sides_of_pair> rates = {};
      double variance = 0;
      for (std::size_t s = 0; s < sides_of_pair; ++s) {
        const PooledNoise::Rare more_rare = here[s]->rare(octave);
        auto& [count, squares] = beyond[s];
        count += more_rare.count;
        squares += more_rare.squares;
        rates[s] = root(count) * std::sqrt(inverse(s));
        variance += (count > 0 ? squares / count : 1) * near.together * inverse(s) / 4;
      }
      const double errors = toward * (rates[0] - rates[1]) / std::sqrt(variance);
      if (errors > errors_of_rates || errors < -errors_of_signs) return false;
    }
    return true;
  });
}

double NoisePyramid::growth(const std::array<PooledNoise::Moments, sides_of_pair>& here,
                            double toward, const std::array<double, sides_of_pair>& parts) const {
  std::array<double, sides_of_pair> third = {};
  for (std::size_t s = 0; s < sides_of_pair; ++s) {
    third[s] = (s == 0 ? toward : -toward) * here[s].third * square(inverse(s));
  }
  // A side may have missed values: bright ones if it is darker, dark ones if it is brighter.
  double largest = 0;
  for (std::size_t s = 0; s < sides_of_pair; ++s) {
    const double second = here[s].second * inverse(s);
    const double own = third[s] + parts[1 - s] * std::min(0.0, third[1 - s]);
    if (own > 0 && second > 0) largest = std::max(largest, own / second);
  }
  return largest;
}

std::optional<double> NoisePyramid::growth_of_blocks(const CellNoise& cell, double sign,
                                                     const Rectangle& window,
                                                     std::size_t channel) const {
  const double moved = together(cell, window, channel);
  // Beside a reference missed light moves signs in turn either way.
  const bool either_way = cell.alternates && replicates_[1] == 0;
  const double toward = either_way || (sign < 0) != (cell.concentration < 0) ? 1 : -1;
  std::optional<double> largest = growth_toward(cell, around(window, channel), toward, moved);
  if (largest) *largest *= std::abs(cell.concentration) * moved;
  return largest;
}

std::optional<double> NoisePyramid::growth_toward(const CellNoise& cell, const Around& near,
                                                  double toward, double moved) const {
  constexpr double fewest = 2;  // One giant tells no size of the rare.
  if (of_one_law(near, toward)) return std::nullopt;
  using Signs = PooledNoise::Signs;
  const Signs missed = toward > 0 ? Signs::upward : Signs::downward;
  const Signs signs = replicates_[1] == 0 ? missed : Signs::both;
  double largest = 0;
  for (const auto& [sides, is_wide] : near.blocks) {
    const auto& [a, b] = sides;
    const auto grow = [&](const std::array<PooledNoise::Moments, sides_of_pair>& here) {
      std::array<double, sides_of_pair> parts{1, 1};
      for (std::size_t s = 0; is_wide && s < sides_of_pair; ++s) {
        const double usual = here[s].second * inverse(s) * std::abs(cell.concentration) * moved;
        if (usual > 0) parts[s] = std::min(1.0, cell.variance[s] / usual);
      }
      largest = std::max(largest, growth(here, toward, parts));
    };
    double beyond = 0;
    for (int octave = near.last; octave >= near.first; --octave) {
      beyond += (lacking(toward) == 0 ? a : b)->rare(octave).count;
      grow({a->cut_off(octave), b->cut_off(octave)});
      if (beyond >= fewest) grow({a->rare_cut_off(octave, signs), b->rare_cut_off(octave, signs)});
    }
  }
  return largest;
}

double NoisePyramid::own_growth(const CellNoise& cell, double sign, const Rectangle& window,
                                std::size_t channel) const {
  const double third = cell.third * square(together(cell, window, channel));
  return (sign < 0 ? 1 : -1) * third / (cell.variance[0] + cell.variance[1]);
}

double NoisePyramid::growth(const CellNoise& cell, double sign, const Rectangle& window,
                            std::size_t channel) const {
  return std::max(growth_of_blocks(cell, sign, window, channel).value_or(0),
                  own_growth(cell, sign, window, channel));
}

ImageEffect NoisePyramid::kept(const CellNoise& cell, const Rectangle& window,
                               std::size_t channel) const {
  const auto& [a, b] = cell.variance;
  const auto of_blocks = growth_of_blocks(cell, cell.effect, window, channel);
  const double ratio = replicates_[0] / replicates_[1];
  const double variance = of_blocks ? a + b : std::max(a + b, ratio * a + b / ratio);
  const double growing =
      std::max(of_blocks.value_or(0), own_growth(cell, cell.effect, window, channel));
  const ImageEffect effect{.estimate = cell.effect,
                           .standard_error = std::sqrt(variance + std::abs(cell.effect) * growing),
                           .degrees = cell.degrees};
  if (!of_blocks) return effect;
  const double log_p = log_p_with_unseen(effect, cell.weights / together(cell, window, channel));
  if (log_p <= log_p_two_sided(student_t_tails(effect.t(), effect.degrees))) return effect;
  const double errors =
      student_t_quantile({Tail::upper, log_p - std::numbers::ln2}, effect.degrees);
  return {.estimate = cell.effect,
          .standard_error = std::abs(cell.effect) / errors,
          .degrees = cell.degrees};
}

// A weight is 1 / the error that its neighbours' noise gives the mean of a half.
double NoisePyramid::log_p_with_unseen(const ImageEffect& effect, double weights) const {
  const auto& [a, b] = replicates_;
  const double fewest = b > 0 ? std::min(a, b) : a;
  // A value of probability q is (q (1 - q))^(-1/2) spreads away from another: 3.3 for q = .1.
  constexpr double spreads = 3;
  const double size = spreads * std::sqrt(fewest / halves) / weights;
  return log_p_constant(
      {.value = 0, .low = -size, .high = size, .count = static_cast<std::uint64_t>(fewest)},
      {effect.estimate, effect.standard_error});
}

double NoisePyramid::hidden_squares(double times) const {
  const Level& fine = levels_[0];
  double sum = 0;
  for (std::size_t i = 0; i < fine.width * fine.height * fine.channels; ++i) {
    double larger = 0;
    for (std::size_t s = 0; s < sides_of_pair; ++s) {
      if (replicates_[s] == 0) continue;
      larger = std::max(larger, fine.noise[s][i].hidden_squares(times * replicates_[s]));
    }
    sum += larger;
  }
  return sum;
}

}  // namespace assay::stats
