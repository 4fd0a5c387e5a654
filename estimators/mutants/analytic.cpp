// The teaching estimators with one defect each.

#include <limits>

#include "analytic/exponential.h"
#include "analytic/law.h"
#include "estimators/estimator.h"
#include "estimators/mutant.h"

namespace assay::plugins {

namespace {

using namespace analytic;

std::shared_ptr<const Setup> scaled(Parameters& parameters) {
  const double factor = parameters.number("factor");
  return averaging(Channel{.mean = integral()},
                   [factor](Stream& random) { return factor * integrand(random.uniform()); });
}

// A substream decides if an observation is spoilt, so that all others are the original's.
std::shared_ptr<const Setup> rare_nan(Parameters& parameters) {
  const NormalLaw law = normal_law(parameters);
  const double probability = parameters.number("probability");
  return averaging(Channel{.mean = law.mean}, [law, probability](Stream& random) {
    const bool spoilt = random.substream(1).uniform() < probability;
    const double value = law(random);
    return spoilt ? std::numeric_limits<double>::quiet_NaN() : value;
  });
}

// Replacements for parts of the ratio estimators.

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
Entry ratio_mutant(const Mutant& its) {
  return mutant(
      its, [](Parameters&) { return ratio_setup<Draw, Combine>(Channel{.mean = integral()}); });
}

}  // namespace

std::vector<Entry> mutants_analytic() {
  return {{{.name = "mutants/scaled",
            .summary = "analytic/exponential_uniform times a factor.",
            .description = "Estimates (e^3 - 1) / 3 = 6.361846 by c e^(3u): biased by c - 1.",
            .parameters = {number_parameter("factor", "c, what every primary is multiplied by",
                                            "1.01", {0, 1000})},
            .original = "analytic/exponential_uniform",
            .defect = "every primary is multiplied by a factor."},
           scaled},
          {{.name = "mutants/rare_nan",
            .summary = "analytic/normal with an observation that is not a number, now and then.",
            .description =
                "A normal variable; with a given probability an observation is not a number.",
            .parameters = {number_parameter("probability", "of an observation that is not a number",
                                            "1e-3", {0, 1})},
            .original = "analytic/normal",
            .defect = "an observation is not a number now and then."},
           rare_nan},
          ratio_mutant<OtherPoint, RatioOfSums>(
              {"ratio_of_other_points", "analytic/ratio",
               "evaluates the target at other points than the integrand: consistent, but of 50 "
               "times the variance, and M times the bias tends to I Var g = +3.03 for -0.50."}),
          ratio_mutant<SamePoint, MeanOfRatios>(
              {"mean_of_ratios", "analytic/ratio",
               "averages the ratios f / g in place of dividing the sums: the mean is that of f / "
               "g, 5.96, -6.3 % whatever M."}),
          ratio_mutant<SamePoint, Jackknife<NumeratorLeftOut>>(
              {"jackknifed_numerator", "analytic/jackknifed_ratio",
               "leaves points out of the numerator alone: repairs nothing, M times the bias tends "
               "to -0.50 as without the jackknife."}),
          ratio_mutant<SamePoint, Jackknife<DenominatorLeftOut>>(
              {"jackknifed_denominator", "analytic/jackknifed_ratio",
               "leaves points out of the denominator alone: takes I Var g away and leaves - Cov(f, "
               "g), M times the bias tends to -3.54."})};
}

}  // namespace assay::plugins
