#include "direct_light/combination.h"

#include <cmath>

#include "estimators/core/value.h"
#include "estimators/parameters.h"

namespace assay::direct_light {

namespace {

Heuristic named(Parameters& given, const std::string& name) {
  if (name == "balance") return Heuristic::balance();
  if (name == "power") return Heuristic::power(2);
  if (name == "maximum") return Heuristic::maximum();
  given.refuse("heuristic", "`" + name +
                                "` is none of balance, power, maximum, {power: exponent} and "
                                "{cutoff: threshold}");
}

}  // namespace

double Heuristic::of_smaller(double ratio) const {
  if (ratio < threshold_) return 0;
  if (exponent_ == 1) return ratio;
  return exponent_ == 2 ? ratio * ratio : std::pow(ratio, exponent_);
}

Pair Heuristic::operator()(const Pair& q) const {
  const bool light = q.light >= q.brdf;
  const double rest = of_smaller(light ? q.brdf / q.light : q.light / q.brdf);
  const double larger = 1 / (1 + rest);
  const double smaller = rest / (1 + rest);
  return light ? Pair{larger, smaller} : Pair{smaller, larger};
}

ParameterInformation heuristic_parameter() {
  return structure_parameter(
      "heuristic",
      "the weights: balance, power (of exponent 2), maximum, {power: exponent} with an exponent of "
      "1 or more, {cutoff: threshold} with a threshold in [0, 1]",
      "balance");
}

Heuristic read_heuristic(Parameters& given) {
  const Value& value = given.structure("heuristic");
  if (value.kind() == Value::Kind::scalar) return named(given, value.text());
  require_keys(value, "the heuristic", {"power", "cutoff"});
  given.require(value.members().size() == 1, "heuristic",
                "must have one of the keys `power` and `cutoff`");
  const auto& [kind, own] = value.members().front();
  const double number = own.number("the heuristic's " + kind);
  if (kind == "power") {
    own.require(number >= 1, "the heuristic's power must be 1 or more");
    return Heuristic::power(number);
  }
  own.require(number >= 0 && number <= 1, "the heuristic's cutoff must be in [0, 1]");
  return Heuristic::cutoff(number);
}

Counts read_counts(Parameters& given) {
  return {.light = given.count("light_samples"), .brdf = given.count("brdf_samples")};
}

Pair read_probabilities(Parameters& given) {
  const double light = given.number("light_probability");
  return {light, 1 - light};
}

}  // namespace assay::direct_light
