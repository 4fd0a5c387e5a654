#include "harness/theta/gate.h"

#include <algorithm>
#include <cmath>

namespace assay::harness {

const std::vector<GateKind>& gate_kinds() {
  static const std::vector<GateKind> table{
      {.name = "level factor by skewness",
       .sentence = "the observations are so skewed that false alarms on one side are {0} times as "
                   "frequent as they should be, limit {1}",
       .falls = Falls::by_its_logarithm},
      {.name = "effective observations",
       .sentence = "the error of the estimate is known only as well as from {0} normal values; {1} "
                   "are needed",
       .falls = Falls::inversely},
      {.name = "level factor after correction",
       .sentence = "the observations are so skewed that false alarms on one side are {0} times as "
                   "frequent as they should be, even after correction, limit {1}",
       .falls = Falls::by_its_logarithm},
      {.name = "share of one observation",
       .sentence = "one observation alone makes up {0} of the sum of squares, limit {1}",
       .falls = Falls::as_one_observation},
      {.name = "excess kurtosis",
       .sentence = "the observations are not normal enough for this test of their variance: their "
                   "excess kurtosis is {0}, limit {1}",
       .heavy_tail = true},
      {.name = "p of a power law",
       .sentence = "the points lie on no power law: the best one has p {0}, limit {1}; begin "
                   "`over` where one holds, often at larger values",
       .says_what_helps = true},
      {.name = "rounding",
       .sentence = "the values are rounded too coarsely for a continuous law: a step is {0} of the "
                   "distance that is rejected, limit {1}; write more digits",
       .says_what_helps = true},
      {.name = "correlation of successive values",
       .sentence = "each value depends on the one before: correlation {0}, limit {1}"},
      {.name = "variance of batch means",
       .sentence = "means of consecutive values vary too much for independent values: ratio {0}, "
                   "limit {1}"},
      {.name = "correlation of values some steps apart",
       .sentence = "values some steps apart depend on each other: correlation {0}, limit {1}"},
      {.name = "rank correlation of drawn observations",
       .sentence = "observations some steps apart have a rank correlation of {0}, limit {1}"},
      {.name = "variance of batch ranks of drawn observations",
       .sentence = "means of neighbours vary {0} times as much as means of independent "
                   "observations, limit {1}"},
      {.name = "variance of the mean, allowed for dependence",
       .sentence = "values look correlated, so the variance of their mean counts {0} times"},
      {.name = "longest repetition", .sentence = "a run of {0} values occurs twice"},
  };
  return table;
}

const GateKind& Gate::row() const {
  static const GateKind none{};
  const auto found = std::ranges::find(gate_kinds(), kind, &GateKind::name);
  return found == gate_kinds().end() ? none : *found;
}

double Gate::wanted_factor() const {
  if (!is_red() || !value) return 1;
  switch (row().falls) {
    case Falls::by_its_logarithm:
      // The level factor's logarithm falls like 1 / sqrt(n); it is green at a quarter.
      return std::pow(std::log(*value) / std::log(1.25), 2);
    case Falls::as_one_observation: {
      // The others' share of the sum of squares grows like n.
      constexpr double wanted_share = 0.1;
      return (1 / wanted_share - 1) / (1 / *value - 1);
    }
    case Falls::inversely:
      // In a heavy tail the effective number grows like the root of all; it is green at twice.
      return std::pow(2 * *limit / *value, 2);
    case Falls::not_known:
      break;
  }
  return 1;
}

bool Gate::shows_heavy_tail(double observations) const {
  return row().heavy_tail || (row().falls == Falls::inversely && wanted_factor() > most_wanted &&
                              *value * most_wanted < observations);
}

bool need_more(const std::vector<Gate>& gates) {
  return std::ranges::all_of(
      gates, [](const Gate& gate) { return !gate.is_red() || gate.row().needs_more(); });
}

Gate gate_of(const std::string& kind, double value, double limit, const char* state,
             const std::string& where) {
  return {{.name = kind + where, .value = value, .limit = limit, .state = state}, kind};
}

Gate gate_of(const stats::Gate& gate, const std::string& where) {
  constexpr const char* states[] = {"green", "amber", "red"};
  return gate_of(gate.name, gate.value, gate.limit, states[static_cast<int>(gate.state)], where);
}

}  // namespace assay::harness
