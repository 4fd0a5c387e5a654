#pragma once

// The claim language: one line that reads as the hypothesis. Its grammar is in suites/README.md.

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "estimators/core/value.h"
#include "harness/base/refuse.h"
#include "stats/means/student_t.h"

namespace assay {
struct Channel;
}

namespace assay::harness {

class Theta;

using Constant = stats::Reference;  ///< A number, known up to its standard error.

/// An estimator of the suite (in `check` also a plugin's name), and a part of it. A part is a
/// channel, a sampler, a marginal of the only sampler, or "sampler.marginal"; "" is the whole.
struct Source {
  std::string estimator;
  std::string part = "";
  Location where = {};
  bool operator==(const Source& other) const {
    return estimator == other.estimator && part == other.part;
  }
};

/// A row of the table of quantities, which is in families/.
struct QuantityRow {
  std::string word;
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
  /// A channel's plugin may know it; null if no plugin does.
  std::optional<double> Channel::*analytic = nullptr;
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

struct Quantity {
  const QuantityRow* row = nullptr;  ///< Never null in a parsed claim.
  Source source = {};
  std::vector<double> arguments = {};  ///< The probability of a quantile.
  bool slope = false;                  ///< slope(quantity)
  Location where = {};
};

enum class Relation { equal, at_most, at_least, less, greater, within };
const char* to_string(Relation);  ///< "==", "<=", …, "within"

/// True for `<`, `>` and `within`: the claim must be shown, not only left standing.
inline bool is_proof(Relation relation) { return relation >= Relation::less; }
inline bool is_two_sided(Relation relation) {
  return relation == Relation::equal || relation == Relation::within;
}
/// True for `<=` and `<`.
inline bool is_upper(Relation relation) {
  return relation == Relation::at_most || relation == Relation::less;
}

/// An effect size: relative to the reference ("0.5%" is 0.005, relative) or absolute.
struct Margin {
  double value = 0;
  bool relative = false;
  Location where = {};
};

struct ScaledQuantity {
  double factor = 1;
  Quantity quantity;
};
struct Analytic {};
/// A law by name: "density" (the sampler's own), or one of Boost.Math's with its parameters.
struct Law {
  std::string name;
  std::vector<double> arguments = {};
  Location where = {};
};
using Side = std::variant<ScaledQuantity, Constant, Analytic, Law>;

struct Claim {
  std::string text;  ///< as the user wrote it
  Quantity left;
  Relation relation = Relation::equal;
  Margin margin = {};  ///< of `within`
  Side right;
};

/// Parses a claim; `where` is the place of its first character. InputError with the column of the
/// first word that cannot be understood, what was expected, and a known word that is near.
Claim parse_claim(std::string_view text, const Location& where);

/// Parses "0.5%" or "0.002". InputError otherwise, and for a negative or infinite number.
Margin parse_margin(std::string_view text, const Location& where, std::string_view what);

std::string to_string(const Margin&);
std::string to_string(const Constant&);
std::string to_string(const Law&);
std::string to_string(const Source&);
std::string to_string(const Quantity&);
std::string to_string(const ScaledQuantity&);

/// The claim in one spelling: shortest round-trip numbers, one blank around a relation.
/// parse_claim(to_string(claim)) is the claim again; `text` is ignored.
std::string to_string(const Claim&);

/// Parses "estimator" or "estimator.part".
Source parse_source(std::string_view text, const Location& where);
/// Parses a source, or a number as "6.36" or "6.36 +- 0.01".
std::variant<Source, Constant> parse_reference(std::string_view text, const Location& where);

/// True if a claim can use the name: a letter or `_`, then letters, digits, `_`, `-`, `/`.
bool is_estimator_name(std::string_view name);

/// The names of the method table (theta/methods.h), each once, in its order.
const std::vector<std::string>& method_names();

}  // namespace assay::harness
