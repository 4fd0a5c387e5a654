#include "stats/image_best_cell.h"

#include <cmath>
#include <tuple>

namespace assay::stats {
namespace {

bool comes_before(const ImageFinding& a, const ImageFinding& b) {
  return std::tuple(a.channel, a.window.y, a.window.x) <
         std::tuple(b.channel, b.window.y, b.window.x);
}

}  // namespace

void offer(BestCell& best, const ImageFinding& candidate, StudentValue value) {
  const bool first = best.windows++ == 0;
  // Student's tails are heavier than the normal law's: |z| <= |t|, but for the
  // rounding of z.
  constexpr double rounding = 1e-6;
  const double largest = std::abs(best.finding.z);
  if (!first && std::abs(value.t) * (1 + rounding) < largest) return;
  const double z = t_to_z(value);
  const bool better =
      std::abs(z) > largest || (std::abs(z) == largest && comes_before(candidate, best.finding));
  if (!first && !better) return;
  best.finding = candidate;
  best.finding.z = z;
  best.value = value;
}

void join(BestCell& best, const BestCell& other) {
  if (other.windows == 0) return;
  const double ours = std::abs(best.finding.z);
  const double theirs = std::abs(other.finding.z);
  const bool better = best.windows == 0 || theirs > ours ||
                      (theirs == ours && comes_before(other.finding, best.finding));
  best.windows += other.windows;
  if (!better) return;
  best.finding = other.finding;
  best.value = other.value;
}

}  // namespace assay::stats
