#include <algorithm>

#include "harness/families/families.h"

namespace assay::harness {

// A new quantity is a row here, and a file of its family.
const std::vector<QuantityRow>& quantities() {
  static const std::vector<QuantityRow> table{
      {.word = "mean",
       .example = "mean(a) == analytic",
       .summary = "The expected value of an observation, or of every pixel of an image.",
       .theta = &theta_of_means(),
       .slope = &theta_of_slopes(),
       .analytic = &Channel::mean,
       .takes_standard_error = true,
       .told_by_moments = true},
      {.word = "bias",
       .example = "bias(a) within 1% of 0",
       .summary = "The mean minus the truth, which the plugin or `reference` gives.",
       .theta = &theta_of_biases(),
       .slope = &theta_of_slopes(),
       .takes_standard_error = true,
       .relative_to_0 = true,
       .told_by_moments = true,
       .takes_reference = true},
      {.word = "variance",
       .example = "variance(a) < 0.5 * variance(b)",
       .summary = "The variance of a primary estimate, channel by channel.",
       .theta = &theta_of_variances(),
       .slope = &theta_of_variance_slopes(),
       .tested_as_a_ratio = true,
       .analytic = &Channel::variance,
       .told_by_moments = true},
      {.word = "total_variance",
       .example = "total_variance(a) < total_variance(b)",
       .summary = "The sum of the variances of all channels.",
       .theta = &theta_of_total_variances(),
       .tested_as_a_ratio = true,
       .over_all_channels = true,
       .told_by_moments = true},
      {.word = "worst_variance",
       .example = "worst_variance(a) <= 2",
       .summary = "The largest variance of any channel.",
       .theta = &theta_of_variances(),
       .tested_as_a_ratio = true,
       .over_all_channels = true,
       .told_by_moments = true},
      {.word = "quantile",
       .example = "quantile(a, 0.5) == 1",
       .summary = "The value that an observation stays below with a given probability.",
       .theta = &theta_of_quantiles(),
       .of_a_probability = true},
      {.word = "efficiency",
       .example = "efficiency(a) > efficiency(b)",
       .summary = "1 / (mean squared error × cost).",
       .theta = &theta_of_efficiencies(),
       .tested_as_a_ratio = true,
       .told_by_moments = true,
       .takes_reference = true,
       .counts_cost = true},
      {.word = "cost",
       .example = "cost(a) <= 2",
       .summary = "Rays, samples or CPU seconds of a primary estimate; the key `cost` chooses.",
       .theta = &theta_of_costs(),
       .slope = &theta_of_slopes(),
       .tested_as_a_ratio = true,
       .told_by_moments = true,
       .counts_cost = true},
      {.word = "distribution",
       .example = "distribution(a) == normal(0, 1)",
       .summary = "The law of an observation, or of a sampler's draws, "
                  "`distribution(a.sampler) == density`.",
       .theta = &theta_of_laws(),
       .of_a_law = true},
      {.word = "integral",
       .example = "integral(a.sampler) == 1",
       .summary = "The integral of the density that a sampler declares.",
       .theta = &theta_of_integrals(),
       .of_a_sampler = true},
      {.word = "inconsistency",
       .example = "inconsistency(a.sampler) == 0",
       .summary = "The probability that a draw contradicts what its sampler declares.",
       .theta = &theta_of_inconsistencies(),
       .of_a_sampler = true}};
  return table;
}

const QuantityRow* find_quantity(std::string_view word) {
  const auto found = std::ranges::find(quantities(), word, &QuantityRow::word);
  return found == quantities().end() ? nullptr : &*found;
}

}  // namespace assay::harness
