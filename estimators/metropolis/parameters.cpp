#include "metropolis/parameters.h"

#include <utility>

namespace assay::metropolis {

namespace {

Boundary boundary_of(const std::string& name) {
  if (name == "wrap") return Boundary::wrap;
  return name == "reflect" ? Boundary::reflect : Boundary::reject;
}

}  // namespace

std::vector<ParameterInformation> chain_parameters() {
  std::vector<ParameterInformation> list = target_parameters();
  list.push_back({.name = "p_large",
                  .summary = "probability of a large step, in which every coordinate is drawn "
                             "afresh; the others move each by 1/1024 to 1/64",
                  .fallback = "0.5",
                  .low = 0,
                  .high = 1,
                  .low_excluded = true,
                  .reason = "without large steps a chain never leaves the region that it began "
                            "in, and what it brings is not the integral"});
  list.push_back({.name = "bootstrap",
                  .type = ParameterType::count,
                  .summary = "number of independent points before the chain, whose mean "
                             "importance normalises it",
                  .unit = "path evaluations",
                  .fallback = "256",
                  .low = 1,
                  .high = 4294967295.0,
                  .reason = "without any there is no normaliser b and no first state"});
  list.push_back({.name = "boundary",
                  .type = ParameterType::string,
                  .summary =
                      "what becomes of a coordinate that steps out of [0, 1): it comes in at "
                      "the other end, is turned back, or the proposal is rejected",
                  .fallback = "wrap",
                  .choices = {"wrap", "reflect", "reject"}});
  return list;
}

ParameterInformation weights_parameter() {
  return {.name = "weights",
          .type = ParameterType::string,
          .summary =
              "what the two ends of a step count for: by the expected value (mean_value), or "
              "combined with the large steps as uniform samples (multiple_importance)",
          .fallback = "mean_value",
          .choices = {"mean_value", "multiple_importance"}};
}

Ingredients read_ingredients(Parameters& given) {
  return {.target = read_target(given),
          .p_large = given.number("p_large"),
          .bootstrap = given.count("bootstrap"),
          .boundary = boundary_of(given.string("boundary"))};
}

std::shared_ptr<const Rules> read_rules(Parameters& given, double p_large) {
  if (given.string("weights") == "mean_value") return std::make_shared<MeanValueRules>();
  return std::make_shared<MultipleImportanceRules>(p_large);
}

Recipe recipe(const Ingredients& ingredients, std::shared_ptr<const Rules> rules) {
  return {.target = ingredients.target,
          .p_large = ingredients.p_large,
          .step = std::make_shared<SmallStep>(ingredients.boundary),
          .rules = std::move(rules),
          .start = std::make_shared<ResampledStart>(ingredients.bootstrap),
          .coordinates = lazy_coordinates};
}

}  // namespace assay::metropolis
