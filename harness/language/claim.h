#pragma once

// The claim language: one line that reads as the hypothesis.
//
//  `claim    = quantity relation side
//   side     = [ number "*" ] quantity | number [ "+-" number ] | "analytic" | law
//   quantity = name "(" source { "," number } ")" | "slope" "(" quantity ")"
//   source   = estimator [ "." part ]
//   name     = mean | bias | variance | total_variance | worst_variance | quantile | efficiency |
//              cost | distribution | integral | inconsistency
//   relation = "==" | "<=" | ">=" | "<" | ">" | "within" margin "of"`

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "estimators/core/value.h"
#include "harness/base/refuse.h"
#include "harness/language/quantities.h"

namespace assay::harness {

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
struct Constant {
  double value = 0;
  double standard_error = 0;
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

/// "0.5%" or "0.002".
std::string to_string(const Margin&);

/// "0.481" or "0.481 +- 0.0001".
std::string to_string(const Constant&);
/// "normal(0, 1)" or "density".
std::string to_string(const Law&);

/// "estimator" or "estimator.part".
std::string to_string(const Source&);

/// "quantile(area.red, 0.5)", "slope(bias(wis))".
std::string to_string(const Quantity&);

/// The claim in one spelling: shortest round-trip numbers, one blank around a relation.
/// parse_claim(to_string(claim)) is the claim again; `text` is ignored.
std::string to_string(const Claim&);

/// Parses "estimator" or "estimator.part".
Source parse_source(std::string_view text, const Location& where);

/// True if a claim can use the name: a letter or `_`, then letters, digits, `_`, `-`, `/`.
bool is_estimator_name(std::string_view name);

}  // namespace assay::harness
