#include "render/rejection.h"

#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "render/unit_circle.h"

namespace assay::render {

namespace {

// The bounds are attained, so that rounding can lift the quotient a few units in the last place
// above them.
constexpr double rounding = 1 + 0x1p-40;

Vector3 propose(Stream& random) {
  const double xi = random.uniform_open();
  const double cosine = xi * xi;
  const double sine = std::sqrt(1 - cosine * cosine);
  const auto [x, y] = on_unit_circle(random.uniform());
  return {sine * x, sine * y, cosine};
}

[[noreturn]] void exceeded(const Vector3& out, double acceptance) {
  std::ostringstream message;
  message << "sample_by_rejection: the target is " << acceptance << " times its bound at (" << out.x
          << ", " << out.y << ", " << out.z << ")";
  throw std::logic_error(message.str());
}

}  // namespace

Vector3 sample_by_rejection(const HalfVectorBrdf& brdf, Target target, Stream& random) {
  const double bound = brdf.rejection_bound(target);
  while (true) {
    const Vector3 out = propose(random);
    const double quotient = 4 * std::numbers::pi * std::sqrt(out.z) * brdf.target(target, out);
    const double acceptance = quotient / bound;
    if (!(acceptance <= rounding)) exceeded(out, acceptance);
    if (random.uniform() < acceptance) return out;
  }
}

}  // namespace assay::render
