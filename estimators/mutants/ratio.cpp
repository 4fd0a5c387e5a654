// Mutants of the ratio estimators of e^(3x): the sound parts with one replaced.

#include "analytic/ratio.h"

#include "estimators/mutant.h"

namespace assay::plugins {

namespace {

using namespace analytic;

// The target at a point of its own.
struct OtherPoint {
  RatioPair operator()(Stream& random) const {
    const RatioPair own = SamePoint{}(random);
    return {own.full, SamePoint{}(random).target};
  }
};

struct MeanOfRatios {
  double operator()(std::span<const RatioPair> pairs) const {
    double total = 0;
    for (const RatioPair& pair : pairs) total += pair.full / pair.target;
    return total / static_cast<double>(pairs.size());
  }
};

struct NumeratorLeftOut {
  double operator()(const RatioPair& without, const RatioPair& all) const {
    return without.full / all.target;
  }
};

struct DenominatorLeftOut {
  double operator()(const RatioPair& without, const RatioPair& all) const {
    return all.full / without.target;
  }
};

template <class Draw, class Combine>
Entry entry(const Mutant& its) {
  return mutant(
      its, [](Parameters&) { return ratio_setup<Draw, Combine>(Channel{.mean = integral()}); });
}

}  // namespace

std::vector<Entry> mutants_ratio() {
  return {
      entry<OtherPoint, RatioOfSums>(
          {"ratio_of_other_points", "analytic/ratio",
           "evaluates the target at other points than the integrand: consistent, but of 50 times "
           "the variance, and M times the bias tends to I Var g = +3.03 for -0.50."}),
      entry<SamePoint, MeanOfRatios>(
          {"mean_of_ratios", "analytic/ratio",
           "averages the ratios f / g in place of dividing the sums: the mean is that of f / g, "
           "5.96, -6.3 % whatever M."}),
      entry<SamePoint, Jackknife<NumeratorLeftOut>>(
          {"jackknifed_numerator", "analytic/jackknifed_ratio",
           "leaves points out of the numerator alone: repairs nothing, M times the bias tends to "
           "-0.50 as without the jackknife."}),
      entry<SamePoint, Jackknife<DenominatorLeftOut>>(
          {"jackknifed_denominator", "analytic/jackknifed_ratio",
           "leaves points out of the denominator alone: takes I Var g away and leaves - Cov(f, g), "
           "M times the bias tends to -3.54."})};
}

}  // namespace assay::plugins
