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

Entry ratio_mutant(const Mutant& its, const auto& draw, const auto& combine) {
  return mutant(its, [draw, combine](Parameters&) {
    return ratio_setup(Channel{.mean = integral()}, draw, combine);
  });
}

}  // namespace

std::vector<Entry> mutants_analytic() {
  return {mutant({"scaled",
                  "analytic/exponential_uniform",
                  "multiplies every primary by a factor c: biased by c - 1.",
                  {number_parameter("factor", "c, what every primary is multiplied by", "1.01",
                                    {0, 1000})}},
                 scaled),
          mutant({"rare_nan",
                  "analytic/normal",
                  "gives an observation that is not a number now and then.",
                  {number_parameter("probability", "of an observation that is not a number", "1e-3",
                                    {0, 1})}},
                 rare_nan),
          ratio_mutant(
              {"ratio_of_other_points", "analytic/ratio",
               "evaluates the target at other points than the integrand: consistent, but of 50 "
               "times the variance, and M times the bias tends to I Var g = +3.03 for -0.50."},
              [](Stream& random) -> RatioPair {
                const RatioPair own = same_point(random);
                return {own.full, same_point(random).target};
              },
              ratio_of_sums),
          ratio_mutant(
              {"mean_of_ratios", "analytic/ratio",
               "averages the ratios f / g in place of dividing the sums: the mean is that of f / "
               "g, 5.96, -6.3 % whatever M."},
              same_point,
              [](std::span<const RatioPair> pairs) {
                double total = 0;
                for (const RatioPair& pair : pairs) total += pair.full / pair.target;
                return total / static_cast<double>(pairs.size());
              }),
          ratio_mutant(
              {"jackknifed_numerator", "analytic/jackknifed_ratio",
               "leaves points out of the numerator alone: repairs nothing, M times the bias tends "
               "to -0.50 as without the jackknife."},
              same_point, jackknife([](const RatioPair& without, const RatioPair& all) {
                return without.full / all.target;
              })),
          ratio_mutant(
              {"jackknifed_denominator", "analytic/jackknifed_ratio",
               "leaves points out of the denominator alone: takes I Var g away and leaves - Cov(f, "
               "g), M times the bias tends to -3.54."},
              same_point, jackknife([](const RatioPair& without, const RatioPair& all) {
                return all.full / without.target;
              }))};
}

}  // namespace assay::plugins
