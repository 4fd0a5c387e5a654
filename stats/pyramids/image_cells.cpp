#include "stats/pyramids/image_cells.h"

#include <algorithm>
#include <cmath>
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

bool Candidates::wants(StudentValue value) {
  // Student's tails are heavier than the normal law's: |z| <= |t|, but for the rounding of z.
  constexpr double rounding = 1e-6;
  ++windows_;
  return kept_.size() < most ||
         std::abs(value.t) * (1 + rounding) >= std::abs(kept_.back().finding.z);
}

void Candidates::keep(const Candidate& candidate) {
  const auto place = std::ranges::find_if(
      kept_, [&](const Candidate& other) { return beats(candidate.finding, other.finding); });
  kept_.insert(place, candidate);
  if (kept_.size() > most) kept_.pop_back();
}

bool beats(const ImageFinding& finding, const BestCell& best) {
  return best.value.degrees == 0 || std::abs(finding.z) >= std::abs(best.finding.z);
}

void offer(BestCell& best, const Candidate& candidate, const NoisePyramid& noise) {
  if (!beats(candidate.finding, best)) return;
  const NoisePyramid::Kept kept =
      noise.kept(candidate.noise, candidate.finding.window, candidate.finding.channel);
  const StudentValue value{kept.t, candidate.noise.degrees};
  ImageFinding finding = candidate.finding;
  finding.z = t_to_z(value);
  finding.effect = {.estimate = candidate.noise.effect,
                    .standard_error = kept.standard_error,
                    .degrees = candidate.noise.degrees};
  if (best.value.degrees > 0 && !beats(finding, best.finding)) return;
  best.finding = finding;
  best.value = value;
}

void WelchCells::start(std::size_t cells) {
  for (std::vector<double>* each :
       {&mean, &m2, &effect, &variance[0], &variance[1], &reciprocal_degrees}) {
    each->assign(cells, 0.0);
  }
  halves_that_vary.assign(cells, 0);
}

void WelchCells::finish_part(std::size_t half, std::size_t side, double count, double factor) {
  for (std::size_t i = 0; i < mean.size(); ++i) {
    const double part = factor * factor * m2[i] / (count * (count - 1));
    effect[i] += factor * mean[i];
    variance[side][i] += part;
    if (part > 0) halves_that_vary[i] |= static_cast<unsigned char>(1U << half);
    reciprocal_degrees[i] += part * part / (count - 1);
  }
  std::ranges::fill(mean, 0.0);
  std::ranges::fill(m2, 0.0);
}

void WelchCells::put(std::size_t cell, CellNoise& noise) const {
  noise.effect = effect[cell];
  noise.variance = {variance[0][cell], variance[1][cell]};
  const double total = noise.variance[0] + noise.variance[1];
  noise.degrees = total * total / reciprocal_degrees[cell];
}

}  // namespace assay::stats
