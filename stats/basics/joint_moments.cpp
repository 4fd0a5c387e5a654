#include "stats/basics/joint_moments.h"

namespace assay::stats {
namespace {

// Distance of the common mean below a part's own mean, in both coordinates.
struct Shift {
  double x;
  double cost;
};

// The sum of (d + u)^2 (e + v) over a part. Its sums of d and e are 0, so it is m21 + v m2 + 2 u
// m11 + n u^2 v.
double moved_m21(const JointMoments& part, Shift shift) {
  const double n = static_cast<double>(part.x.count);
  return part.m21 + shift.cost * part.x.m2 + 2 * shift.x * part.m11 +
         n * shift.x * shift.x * shift.cost;
}

double moved_m11(const JointMoments& part, Shift shift) {
  return part.m11 + static_cast<double>(part.x.count) * shift.x * shift.cost;
}

}  // namespace

void JointMoments::add(double value, double its_cost) {
  if (x.count > 0 && cost.m2 == 0 && its_cost == cost.mean) {
    // The cost has no spread so far, as with rays of an estimator that traces none. The sums of its
    // deviations stay zero, which saves three fourths of the arithmetic.
    x.add(value);
    ++cost.count;
    cost.nonzero += its_cost != 0;
    return;
  }
  // One more pair. Its own part has no sums, only its distance from the common mean.
  const double share = 1 / (static_cast<double>(x.count) + 1);
  const double dx = x.count == 0 ? 0 : value - x.mean;
  const double dc = x.count == 0 ? 0 : its_cost - cost.mean;
  const Shift mine{-dx * share, -dc * share};
  const Shift theirs{dx * (1 - share), dc * (1 - share)};
  m21 = moved_m21(*this, mine) + theirs.x * theirs.x * theirs.cost;
  m11 = moved_m11(*this, mine) + theirs.x * theirs.cost;
  x.add(value);
  cost.add(its_cost);
}

void JointMoments::merge(const JointMoments& other) {
  if (other.x.count == 0) return;
  if (x.count == 0) {
    *this = other;
    return;
  }
  const double here = static_cast<double>(x.count);
  const double there = static_cast<double>(other.x.count);
  const double share = there / (here + there);
  const double dx = other.x.mean - x.mean;
  const double dc = other.cost.mean - cost.mean;
  const Shift mine{-dx * share, -dc * share};
  const Shift theirs{dx * (1 - share), dc * (1 - share)};
  m21 = moved_m21(*this, mine) + moved_m21(other, theirs);
  m11 = moved_m11(*this, mine) + moved_m11(other, theirs);
  x.merge(other.x);
  cost.merge(other.cost);
}

}  // namespace assay::stats
