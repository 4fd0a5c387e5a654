#pragma once

// Gates: assumptions of a test as numbers with limits.

#include <string>
#include <vector>

#include "reports/record/record.h"
#include "stats/gates/assumption_gates.h"

namespace assay::harness {

/// How a red gate's value falls with the number of observations, towards its limit.
/// `inversely`: it is a number of observations itself.
enum class Falls { not_known, by_its_logarithm, as_one_observation, inversely };

/// A row of the table of gates. A gate without a row is shown by its name.
struct GateKind {
  std::string name;
  std::string sentence = "";     ///< if it is red; {0} is its value, {1} its limit
  bool heavy_tail = false;       ///< more observations may only show more of the tail
  bool says_what_helps = false;  ///< its sentence does
  Falls falls = Falls::not_known;

  /// If it is red the test goes on, and ends inconclusive.
  bool needs_more() const { return falls != Falls::not_known; }
};

const std::vector<GateKind>& gate_kinds();

/// A sample that one observation makes up tells no larger factor.
inline constexpr double most_wanted = 100;

/// A gate as reports show it, with its kind. Its name may go on with a channel or an estimator.
struct Gate : reports::Gate {
  std::string kind;

  bool is_red() const { return state == "red"; }
  /// The row of the table, or an empty one.
  const GateKind& row() const;
  /// Factor on the observations that would turn the gate green, with room for what more of them
  /// show; 1 if it is not known.
  double wanted_factor() const;
  /// True if more than these observations may only show more of the tail.
  bool shows_heavy_tail(double observations) const;
};

/// True if more observations mend all red gates.
bool need_more(const std::vector<Gate>& gates);

/// `where` follows the kind in its name.
Gate gate_of(const std::string& kind, double value, double limit, const char* state,
             const std::string& where = "");
Gate gate_of(const stats::Gate& gate, const std::string& where);

}  // namespace assay::harness
