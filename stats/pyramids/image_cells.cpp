#include "stats/pyramids/image_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace assay::stats {
namespace {

// The larger |z|. Among equals the first in the image.
bool beats(const ImageFinding& a, const ImageFinding& b) {
  const double ours = std::abs(a.z);
  const double theirs = std::abs(b.z);
  return ours > theirs || (ours == theirs && std::tuple(a.channel, a.window.y, a.window.x) <
                                                 std::tuple(b.channel, b.window.y, b.window.x));
}

}  // namespace

StudentValue own_value(const CellNoise& noise) {
  return {noise.effect / std::sqrt(noise.variance[0] + noise.variance[1]), noise.degrees};
}

bool Candidates::wants(double t) {
  // Student's tails are heavier than the normal law's: |z| <= |t|, but for the rounding of z.
  constexpr double rounding = 1e-6;
  ++windows_;
  return kept_.size() < most || std::abs(t) > largest_t_ ||
         std::abs(t) * (1 + rounding) >= std::abs(kept_.back().finding.z);
}

void Candidates::keep(const Candidate& candidate) {
  const double t = std::abs(own_value(candidate.noise).t);
  if (t > largest_t_) {
    largest_t_ = t;
    clearest_ = candidate;
  }
  const auto place = std::ranges::find_if(
      kept_, [&](const Candidate& other) { return beats(candidate.finding, other.finding); });
  kept_.insert(place, candidate);
  if (kept_.size() > most) kept_.pop_back();
}

void offer(BestCell& best, const Candidate& candidate, const NoisePyramid& noise) {
  // Neighbours only take away: no cell wins that does not by its own noise.
  const bool may_win = !best.finding || std::abs(candidate.finding.z) >= std::abs(best.finding->z);
  const double clearest = best.clearest ? std::abs(best.clearest->effect.t()) : 0;
  if (!may_win && !(std::abs(own_value(candidate.noise).t) > clearest)) return;
  ImageFinding finding = candidate.finding;
  finding.effect = noise.kept(candidate.noise, finding.window, finding.channel);
  finding.z = t_to_z({finding.effect.t(), finding.effect.degrees});
  if (std::abs(finding.effect.t()) > clearest) best.clearest = finding;
  if (may_win && (!best.finding || beats(finding, *best.finding))) best.finding = finding;
}

void WelchCells::start(std::size_t cells) {
  for (std::vector<double>* each :
       {&inverse, &squares, &effect, &weights, &concentration, &third, &variance[0], &variance[1],
        &of_half[0], &of_half[1], &reciprocal_degrees}) {
    each->assign(cells, 0.0);
  }
}

void WelchCells::start_half(std::size_t first, std::span<const double> sums) {
  for (std::size_t i = 0; i < sums.size(); ++i) {
    inverse[first + i] = sums[i] > 0 ? 1 / sums[i] : 0;
    weights[first + i] += factor_of_half * sums[i];
  }
}

void WelchCells::add(std::vector<double>& to, std::size_t first, std::span<const double> sums,
                     int power) const {
  for (std::size_t i = 0; i < sums.size(); ++i) {
    double part = factor_of_half * sums[i];
    for (int k = 0; k < power; ++k) part *= inverse[first + i];
    to[first + i] += part;
  }
}

void WelchCells::finish_part(std::size_t half, std::size_t side, double count) {
  const double scale = factor_of_half * factor_of_half / (count * (count - 1));
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const double part = scale * squares[i] * inverse[i] * inverse[i];
    variance[side][i] += part;
    of_half[half][i] += part;
    reciprocal_degrees[i] += part * part / (count - 1);
    squares[i] = 0;
  }
}

void WelchCells::statistics(std::size_t first, std::span<double> t) const {
  for (std::size_t i = 0; i < t.size(); ++i) {
    const std::size_t cell = first + i;
    t[i] = varied(cell) ? effect[cell] / std::sqrt(variance[0][cell] + variance[1][cell])
                        : std::numeric_limits<double>::quiet_NaN();
  }
}

CellNoise WelchCells::noise(std::size_t cell) const {
  const std::array<double, sides_of_pair> own{variance[0][cell], variance[1][cell]};
  const double total = own[0] + own[1];
  return {.effect = effect[cell],
          .variance = own,
          .degrees = total * total / reciprocal_degrees[cell],
          .third = third[cell],
          .weights = weights[cell],
          .concentration = concentration[cell]};
}

}  // namespace assay::stats
