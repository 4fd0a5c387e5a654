#include "harness/language/laws.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace assay::harness {

const std::vector<LawInformation>& laws() {
  static const std::vector<LawInformation> known{
      {"arcsine", {{"low"}, {"high"}}},
      {"beta", {{"alpha", true}, {"beta", true}}},
      {"cauchy", {{"location"}, {"scale", true}}},
      {"chi_squared", {{"freedom", true}}},
      {"exponential", {{"rate", true}}},
      {"extreme_value", {{"location"}, {"scale", true}}},
      {"fisher_f", {{"freedom1", true}, {"freedom2", true}}},
      {"gamma", {{"shape", true}, {"scale", true}}},
      {"inverse_gamma", {{"shape", true}, {"scale", true}}},
      {"inverse_gaussian", {{"mean", true}, {"scale", true}}},
      {"laplace", {{"location"}, {"scale", true}}},
      {"logistic", {{"location"}, {"scale", true}}},
      {"lognormal", {{"location"}, {"scale", true}}},
      {"normal", {{"mean"}, {"sd", true}}},
      {"pareto", {{"scale", true}, {"shape", true}}},
      {"rayleigh", {{"sigma", true}}},
      {"student_t", {{"freedom", true}}},
      {"triangular", {{"low"}, {"mode"}, {"high"}}},
      {"uniform", {{"low"}, {"high"}}},
      {"weibull", {{"shape", true}, {"scale", true}}},
  };
  return known;
}

const LawInformation* find_law(std::string_view name) {
  const auto found = std::ranges::find(laws(), name, &LawInformation::name);
  return found == laws().end() ? nullptr : &*found;
}

std::string signature(const LawInformation& law) {
  std::vector<std::string> names;
  for (const LawParameter& parameter : law.parameters) names.push_back(parameter.name);
  return fmt::format("{}({})", law.name, fmt::join(names, ", "));
}

void check_law(const Law& law) {
  const auto refuse = [&](const std::string& why) { throw InputError(law.where, why); };
  const LawInformation& known = *find_law(law.name);
  if (law.arguments.size() != known.parameters.size()) {
    refuse(fmt::format("`{}` has {} of its numbers; write {}", law.name, law.arguments.size(),
                       signature(known)));
  }
  for (std::size_t i = 0; i < law.arguments.size(); ++i) {
    if (known.parameters[i].positive && !(law.arguments[i] > 0)) {
      refuse(fmt::format("`{}` of {} must be above 0, but it is {}", known.parameters[i].name,
                         signature(known), law.arguments[i]));
    }
  }
  const bool interval = known.parameters.front().name == "low";
  if (interval && !std::ranges::is_sorted(law.arguments)) {
    refuse(fmt::format("the numbers of {} must ascend", signature(known)));
  }
  if (interval && law.arguments.front() == law.arguments.back()) {
    refuse(fmt::format("{} with equal ends has no density", signature(known)));
  }
}

}  // namespace assay::harness
