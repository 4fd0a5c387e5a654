#pragma once

// The table of quantities that a claim can be about, and the names of methods. Their rows are in
// families/.

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace assay {
struct Channel;
}

namespace assay::harness {

struct Constant;
struct PreparedEstimator;
struct Source;
class Theta;

using Estimators = std::map<std::string, PreparedEstimator>;

struct QuantityRow {
  std::string word;     ///< The word in claims.
  std::string example;  ///< A claim about it.
  std::string summary;
  const Theta* theta;  ///< The theta of a claim about it, unless of images or a slope.
  /// What `slope(…)` of it is about; null if it has no slope.
  const Theta* slope = nullptr;
  bool of_a_sampler = false;
  bool of_a_law = false;           ///< It is compared with a law by `==`, not with a number.
  bool of_a_probability = false;   ///< It takes a probability beside the estimator.
  bool tested_as_a_ratio = false;  ///< The claimed number is above 0 and exact.
  bool over_all_channels = false;
  /// Gives what a channel's plugin knows of it, or InputError; null if no plugin knows any.
  Constant (*analytic)(const Channel&, const Source&) = nullptr;
  bool takes_standard_error = false;  ///< The claimed number may have one, by `+-`.
  bool relative_to_0 = false;    ///< The truth, not the claimed number, is what per cent are of.
  bool told_by_moments = false;  ///< A recorded run of it has moments that other claims can use.
  bool takes_reference = false;  ///< The test may have `reference`.
  bool counts_cost = false;      ///< The test may have `cost`.

  bool never_negative() const { return tested_as_a_ratio || of_a_sampler; }
  /// Its margins are differences of probabilities, so they lie below 1.
  bool is_a_probability() const { return of_a_law || of_a_sampler; }
};

const std::vector<QuantityRow>& quantities();
/// Null if there is none.
const QuantityRow* find_quantity(std::string_view word);

/// The names of the method table (theta/methods.h), each once, in its order.
const std::vector<std::string>& method_names();

}  // namespace assay::harness
