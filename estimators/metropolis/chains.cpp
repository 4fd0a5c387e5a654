// Metropolis light transport in primary sample space (Kelemen, Szirmay-Kalos, Antal and Csonka
// 2002).
//
// A state is a point u of [0, 1)^infinity, the random numbers of a path. F(u) is the light that the
// path brings to pixel p(u), I(u) its luminance. Each step proposes a new point y: all coordinates
// fresh with probability p_large, else each moved a little. It goes there with a = min(1, I(y) /
// I(x)), so the stationary density is I / integral of I.
//
// The chain starts from one of N independent points drawn in proportion to I. b is the mean of I
// over the same points. Then E[b h(x_k)] = integral of h I for every k (Veach 1997, section
// 11.3.1), by induction: a step leaves this measure as it is. So the mean-value form is unbiased at
// every length.

#include "metropolis/chain.h"
#include "metropolis/parameters.h"

namespace assay::plugins {

namespace {

using namespace metropolis;

const std::string of_chains =
    "Integrates F over the unit cube of a path's random numbers, pixel by pixel, by one Markov "
    "chain "
    "an observation; `primaries` is its number of steps. A large step draws all coordinates "
    "afresh, a "
    "small one moves each by s2 e^(-ln(s2 / s1) xi) to either side, s1 = 1/1024, s2 = 1/64; "
    "proposal y "
    "is accepted with a = min(1, I(y) / I(x)), I the luminance of F (Kelemen, Szirmay-Kalos, Antal "
    "and "
    "Csonka 2002, A simple and robust mutation strategy for the Metropolis light transport "
    "algorithm). "
    "Coordinates carry time stamps and are mutated when they are looked at. ";

const std::string of_channels =
    " The image's elements are its channels; `image_mean`, `normaliser` (b) and `acceptance` (mean "
    "of "
    "a) are diagnostic. Samplers: step (of a coordinate, with its sign) and coordinate (a uniform "
    "one "
    "after a step). Cost: samples are path evaluations, the bootstrap's included; rays are the "
    "paths'.";

std::vector<ParameterInformation> with(std::vector<ParameterInformation> list,
                                       ParameterInformation more) {
  list.push_back(std::move(more));
  return list;
}

Entry mean_value() {
  return {
      {.name = "metropolis/mean_value",
       .summary = "Metropolis light transport, both ends of a step by the expected value.",
       .description =
           of_chains +
           "A step adds a b F(y) / I(y) to the pixel of y and (1 - a) b F(x) / I(x) to that of x "
           "(Veach and Guibas 1997). The chain starts at one of `bootstrap` independent points, "
           "drawn in proportion to I, with b the mean of I over the same points: E[b h(x_k)] is "
           "the integral of h I for every step k, so that the image is unbiased however short "
           "the chain." +
           of_channels,
       .parameters = chain_parameters(),
       .averages = false},
      [](Parameters& given) {
        return chain(recipe(read_ingredients(given), std::make_shared<MeanValueRules>()));
      }};
}

Entry multiple_importance() {
  return {{.name = "metropolis/multiple_importance",
           .summary = "Metropolis light transport, large steps combined as uniform samples.",
           .description =
               of_chains +
               "Large steps are uniform samples, too: a step adds F(y) (a + [large]) / (I(y) / b + "
               "p_large) to the pixel of y and F(x) (1 - a) / (I(x) / b + p_large) to that of x, "
               "multiple importance sampling of the two. The start is that of "
               "metropolis/mean_value. The "
               "weights are not linear in b, so the image is biased, like 1 / bootstrap however "
               "long the "
               "chain." +
               of_channels,
           .parameters = chain_parameters(),
           .bias = BiasClass::inverse_bootstrap,
           .averages = false},
          [](Parameters& given) {
            const Ingredients parts = read_ingredients(given);
            return chain(recipe(parts, std::make_shared<MultipleImportanceRules>(parts.p_large)));
          }};
}

Entry uniform_start() {
  return {
      {.name = "metropolis/uniform_start",
       .summary = "Metropolis light transport from a uniform point, which it has to forget.",
       .description =
           of_chains +
           "The first state is a uniform point instead of one drawn in proportion to I; b is the "
           "mean of I over `bootstrap` others. The chain has a start-up bias, which large steps "
           "and length make smaller. Weights as in metropolis/mean_value or "
           "metropolis/multiple_importance." +
           of_channels,
       .parameters = with(chain_parameters(), weights_parameter()),
       .bias = BiasClass::start_up,
       .averages = false},
      [](Parameters& given) {
        const Ingredients parts = read_ingredients(given);
        Recipe list = recipe(parts, read_rules(given, parts.p_large));
        list.start = std::make_shared<UniformStart>(parts.bootstrap);
        return chain(std::move(list));
      }};
}

Entry independent_points() {
  return {
      {.name = "metropolis/independent",
       .summary = "The image of a Metropolis target by independent points.",
       .description =
           "The plain Monte Carlo estimate of what the chains of this family integrate: the mean "
           "of F over independent uniform points of the primary sample space, each in its pixel. "
           "Trusted, and what the chains' variance is held against at equal path evaluations. "
           "Channels: the image's elements and the diagnostic `image_mean`.",
       .parameters = target_parameters()},
      [](Parameters& given) { return independent(read_target(given)); }};
}

}  // namespace

std::vector<Entry> metropolis_chains() {
  return {mean_value(), multiple_importance(), uniform_start(), independent_points()};
}

}  // namespace assay::plugins
