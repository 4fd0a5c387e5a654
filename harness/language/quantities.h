#pragma once

// The table of quantities that a claim can be about.

#include <string>
#include <string_view>
#include <vector>

namespace assay::harness {

enum class QuantityName {
  mean,
  bias,
  variance,
  total_variance,
  worst_variance,
  quantile,
  efficiency,
  cost,
  distribution,
  integral,
  inconsistency
};

struct QuantityRow {
  QuantityName name;
  std::string word;     ///< as in claims
  std::string example;  ///< a claim about it
  std::string summary;
  bool of_a_sampler = false;
  bool never_negative = false;
  bool over_all_channels = false;
  bool may_be_analytic = false;  ///< a plugin may know it
};

/// All of them, in the order of the enumeration.
const std::vector<QuantityRow>& quantities();
const QuantityRow& row_of(QuantityName);
/// Null where there is none.
const QuantityRow* find_quantity(std::string_view word);

const char* to_string(QuantityName);

}  // namespace assay::harness
