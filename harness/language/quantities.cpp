#include "harness/language/quantities.h"

#include <algorithm>

namespace assay::harness {

const std::vector<QuantityRow>& quantities() {
  using enum QuantityName;
  static const std::vector<QuantityRow> table{
      {.name = mean,
       .word = "mean",
       .example = "mean(a) == analytic",
       .summary = "The expected value of an observation, or of every pixel of an image.",
       .may_be_analytic = true},
      {.name = bias,
       .word = "bias",
       .example = "bias(a) within 1% of 0",
       .summary = "The mean less the truth, which the plugin or `reference` says."},
      {.name = variance,
       .word = "variance",
       .example = "variance(a) < 0.5 * variance(b)",
       .summary = "The variance of a primary estimate, channel by channel.",
       .never_negative = true,
       .may_be_analytic = true},
      {.name = total_variance,
       .word = "total_variance",
       .example = "total_variance(a) < total_variance(b)",
       .summary = "The sum of the variances of all channels.",
       .never_negative = true,
       .over_all_channels = true},
      {.name = worst_variance,
       .word = "worst_variance",
       .example = "worst_variance(a) <= 2",
       .summary = "The largest of the variances of all channels.",
       .never_negative = true,
       .over_all_channels = true},
      {.name = quantile,
       .word = "quantile",
       .example = "quantile(a, 0.5) == 1",
       .summary = "The value that an observation exceeds with a given probability."},
      {.name = efficiency,
       .word = "efficiency",
       .example = "efficiency(a) > efficiency(b)",
       .summary = "One over the product of mean squared error and cost.",
       .never_negative = true},
      {.name = cost,
       .word = "cost",
       .example = "cost(a) <= 2",
       .summary = "Rays, samples or CPU seconds of a primary estimate, as `cost` says.",
       .never_negative = true},
      {.name = distribution,
       .word = "distribution",
       .example = "distribution(a) == normal(0, 1)",
       .summary = "The law of an observation, or of a sampler's draws."},
      {.name = integral,
       .word = "integral",
       .example = "integral(a.sampler) == 1",
       .summary = "What the density that a sampler declares integrates to.",
       .of_a_sampler = true,
       .never_negative = true},
      {.name = inconsistency,
       .word = "inconsistency",
       .example = "inconsistency(a.sampler) == 0",
       .summary = "The probability that a draw contradicts what its sampler declares.",
       .of_a_sampler = true,
       .never_negative = true}};
  return table;
}

const QuantityRow& row_of(QuantityName name) {
  return quantities()[static_cast<std::size_t>(name)];
}

const QuantityRow* find_quantity(std::string_view word) {
  const auto found = std::ranges::find(quantities(), word, &QuantityRow::word);
  return found == quantities().end() ? nullptr : &*found;
}

const char* to_string(QuantityName name) { return row_of(name).word.c_str(); }

}  // namespace assay::harness
