#include "metropolis/small_step.h"

#include <cmath>

namespace assay::metropolis {

namespace {

/// 1 itself, where rounding may have led, is 0 of the next round.
double wrapped(double u) {
  const double fraction = u - std::floor(u);
  return fraction < 1 ? fraction : 0;
}

double reflected(double u) {
  const double inside = u < 0 ? -u : u >= 1 ? 2 - u : u;
  return inside < 1 ? inside : std::nextafter(1.0, 0.0);
}

}  // namespace

double SmallStep::step(Stream& random) const {
  const double xi = 2 * random.uniform() - 1;
  const double length = largest * std::exp(-std::log(largest / smallest) * std::abs(xi));
  return xi < 0 ? -length : length;
}

std::optional<double> SmallStep::settled(double u) const {
  if (u >= 0 && u < 1) return u;
  if (boundary_ == Boundary::wrap) return wrapped(u);
  if (boundary_ == Boundary::reflect) return reflected(u);
  return {};
}

}  // namespace assay::metropolis
