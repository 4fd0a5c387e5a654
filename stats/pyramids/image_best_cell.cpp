#include "stats/pyramids/image_best_cell.h"

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

}  // namespace assay::stats
