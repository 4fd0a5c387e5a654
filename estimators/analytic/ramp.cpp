// An image of known means: brightness grows from left to right.
//
// X(x, y, c) = m(x, c) (1 + s Z) in column x, row y and component c. Z = (Y - E[Y]) / sqrt(Var Y),
// Y of a named law. E[X] = m, Var X = (m s)^2. m(x, c) = (1 + 9 x / (width - 1)) (1, 0.8, 0.6)_c.

#include <array>
#include <cmath>

#include "analytic/law.h"
#include "estimators/estimator.h"

namespace assay::plugins {

namespace {

using analytic::Law;
using analytic::Variable;

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  constexpr std::array<double, 3> colour = {1, 0.8, 0.6};
  const std::size_t width = parameters.count("width");
  ImageParts<Variable> parts{.shape = {.width = width,
                                       .height = parameters.count("height"),
                                       .independent = !parameters.boolean("shared")}};
  if (parameters.boolean("colour")) parts.shape.components = {"red", "green", "blue"};
  const double spread = parameters.number("spread");
  const Law law = analytic::law_of(parameters);
  if (!law.facts().variance) parameters.refuse("law", "has no variance: nothing brings it to 1");
  for (std::size_t i = 0; i < width * parts.shape.components.size(); ++i) {
    const std::size_t component = i % parts.shape.components.size();
    const double column = static_cast<double>(i / parts.shape.components.size());
    const double mean = (1 + 9 * column / static_cast<double>(width - 1)) * colour[component];
    const double scale = mean * spread / std::sqrt(*law.facts().variance);
    const Variable pixel{law, mean - scale * *law.facts().mean, scale};
    parts.elements.push_back(channel_of(pixel));
    parts.primaries.push_back(pixel);
  }
  return imaging(std::move(parts));
}

ParameterInformation size(const char* name, const char* summary) {
  return count_parameter(name, summary, "16", {2, 4096});
}

}  // namespace

std::vector<Entry> analytic_ramp() {
  return {
      {{.name = "analytic/ramp",
        .summary = "An image of known means: a ramp with noise in proportion to the mean.",
        .description = "X = m (1 + spread Z), m growing from 1 to 10 from left to right, Z "
                       "of a law as `analytic/law` names it, brought to mean 0 and variance 1. "
                       "With `shared`, one Z serves all pixels of a primary: they are then fully "
                       "correlated. `assay calibrate image` measures the method on it.",
        .parameters =
            {size("width", "columns"), size("height", "rows"),
             boolean_parameter(
                 "colour", "three components, of brightness 1, 0.8 and 0.6, instead of one", false),
             number_parameter("spread", "standard deviation of a primary over its mean", "1",
                              {0, 1e100}),
             text_parameter("law", "law of Z, before it is shifted and scaled, as exponential(1)",
                            "normal(0, 1)"),
             boolean_parameter("shared", "whether all pixels get the same random numbers", false)}},
       prepare}};
}

}  // namespace assay::plugins
