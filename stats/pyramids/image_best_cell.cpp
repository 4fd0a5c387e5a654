#include "stats/pyramids/image_best_cell.h"

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

void offer(BestCell& best, const ImageFinding& candidate, StudentValue value) {
  // Student's tails are heavier than the normal law's: |z| <= |t|, but for the
  // rounding of z.
  constexpr double rounding = 1e-6;
  const bool first = best.windows++ == 0;
  if (!first && std::abs(value.t) * (1 + rounding) < std::abs(best.finding.z)) return;
  ImageFinding finding = candidate;
  finding.z = t_to_z(value);
  if (!first && !beats(finding, best.finding)) return;
  best.finding = finding;
  best.value = value;
}

void join(BestCell& best, const BestCell& other) {
  if (other.windows == 0) return;
  const bool better = best.windows == 0 || beats(other.finding, best.finding);
  best.windows += other.windows;
  if (!better) return;
  best.finding = other.finding;
  best.value = other.value;
}

}  // namespace assay::stats
