// A variable of a named law, X = shift + scale Y. Statistical methods are calibrated on these
// shapes.

#include "analytic/law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

#include "estimators/core/mapped.h"
#include "estimators/estimator.h"

namespace assay::analytic {

namespace {

bool is_probability(double p, double) { return p > 0 && p < 1; }
bool is_positive(double a, double) { return a > 0; }
bool has_scale(double, double s) { return s > 0; }

double draw_exponential(Stream& random) { return -std::log(random.uniform_open()); }

constexpr double root_two_pi = 2.5066282746310002;

}  // namespace

/// A family of laws. Messages show `signature`; `rule` says in words what `allows` tests.
struct Law::Family {
  const char* name;
  const char* signature;
  std::size_t numbers;
  const char* rule;
  bool (*allows)(double a, double b);
  double (*draw)(Stream& random, double a, double b);
  double (*density)(double x, double a, double b);  ///< null if there is none
  Facts (*facts)(double a, double b);
};

namespace {

// A family of one number has b = a.
constexpr std::array<Law::Family, 8> families{{
    {"bernoulli", "bernoulli(p)", 1, "p must lie between 0 and 1", is_probability,
     [](Stream& random, double p, double) { return random.uniform() < p ? 1.0 : 0.0; }, nullptr,
     [](double p, double) -> Law::Facts {
       return {p, p * (1 - p), 0, 1};
     }},
    {"exponential", "exponential(rate)", 1, "rate must be above 0", is_positive,
     [](Stream& random, double rate, double) { return draw_exponential(random) / rate; },
     [](double x, double rate, double) { return x < 0 ? 0 : rate * std::exp(-rate * x); },
     [](double rate, double) -> Law::Facts {
       return {1 / rate, 1 / (rate * rate), 0};
     }},
    {"lognormal", "lognormal(location, scale)", 2, "scale must be above 0", has_scale,
     [](Stream& random, double m, double s) {
       return std::exp(NormalLaw{m, s}(random));
     },
     [](double x, double m, double s) {
       const double z = (std::log(x) - m) / s;
       return x > 0 ? std::exp(-z * z / 2) / (s * root_two_pi * x) : 0;
     },
     [](double m, double s) -> Law::Facts {
       return {std::exp(m + s * s / 2), std::expm1(s * s) * std::exp(2 * m + s * s), 0};
     }},
    {"normal", "normal(mean, sd)", 2, "sd must be above 0", has_scale,
     [](Stream& random, double mean, double sd) {
       return NormalLaw{mean, sd}(random);
     },
     [](double x, double mean, double sd) {
       const double z = (x - mean) / sd;
       return std::exp(-z * z / 2) / (sd * root_two_pi);
     },
     [](double mean, double sd) -> Law::Facts {
       return {mean, sd * sd};
     }},
    {"pareto", "pareto(scale, shape)", 2, "scale and shape must be above 0",
     [](double s, double a) { return s > 0 && a > 0; },
     [](Stream& random, double s, double a) { return s * std::exp(draw_exponential(random) / a); },
     [](double x, double s, double a) { return x < s ? 0 : a / x * std::pow(s / x, a); },
     [](double s, double a) -> Law::Facts {
       const double mean = a * s / (a - 1);
       return {a > 1 ? std::optional(mean) : std::nullopt,
               a > 2 ? std::optional(mean * mean / a / (a - 2)) : std::nullopt, s};
     }},
    {"student_t", "student_t(freedom)", 1, "freedom must be above 0", is_positive,
     // Bailey (1994): sqrt(nu (u^(-2 / nu) - 1)) cos(2 pi v) has the law, for every nu.
     [](Stream& random, double nu, double) {
       const double radius = std::sqrt(nu * std::expm1(-2 / nu * std::log(random.uniform_open())));
       return radius * std::cos(2 * std::numbers::pi * random.uniform());
     },
     [](double x, double nu, double) {
       const double half = (nu + 1) / 2;
       const double log_constant =
           std::lgamma(half) - std::lgamma(nu / 2) - std::log(std::numbers::pi * nu) / 2;
       return std::exp(log_constant - half * std::log1p(x * x / nu));
     },
     [](double nu, double) -> Law::Facts {
       return {nu > 1 ? std::optional(0.0) : std::nullopt,
               nu > 2 ? std::optional(nu / (nu - 2)) : std::nullopt};
     }},
    {"uniform", "uniform(low, high)", 2, "low must be below high",
     [](double a, double b) { return a < b; },
     [](Stream& random, double a, double b) { return a + (b - a) * random.uniform(); },
     [](double x, double a, double b) { return x < a || x > b ? 0 : 1 / (b - a); },
     [](double a, double b) -> Law::Facts {
       return {(a + b) / 2, (b - a) * (b - a) / 12, a, b};
     }},
    {"zero_inflated", "zero_inflated(p)", 1, "p must lie between 0 and 1", is_probability,
     [](Stream& random, double p, double) {
       return random.uniform() < p ? draw_exponential(random) : 0;
     },
     nullptr,
     [](double p, double) -> Law::Facts {
       return {p, 2 * p - p * p, 0};
     }},
}};

std::string quoted(std::string_view text) { return "`" + std::string(text) + "`"; }

[[noreturn]] void refuse(const std::string& why) {
  const auto signature = [](const Law::Family& family) { return std::string(family.signature); };
  throw std::invalid_argument(why + "; there is " + listed(mapped(families, signature)));
}

std::vector<double> numbers_of(std::string_view text) {
  if (text.empty()) return {};
  return mapped(pieces_of(text, ','), [](const std::string& number) {
    if (number.empty()) refuse("a number of the law is missing");
    try {
      return Value::scalar(number).number("a number of the law");
    } catch (const InputError& error) {
      refuse(error.message());
    }
  });
}

}  // namespace

Law Law::parse(std::string_view text) {
  const std::size_t open = text.find('(');
  if (open == std::string_view::npos || text.back() != ')') {
    refuse(quoted(text) + " is no law with its numbers in brackets");
  }
  const std::string_view name = text.substr(0, open);
  const std::vector<double> numbers = numbers_of(text.substr(open + 1, text.size() - open - 2));
  for (const Family& family : families) {
    if (name != family.name) continue;
    if (numbers.size() != family.numbers) {
      refuse(quoted(text) + " has not the numbers of " + family.signature);
    }
    if (!family.allows(numbers.front(), numbers.back())) {
      refuse("in " + quoted(text) + " " + family.rule);
    }
    return {family, numbers.front(), numbers.back()};
  }
  refuse("no law is named " + quoted(name));
}

Law::Law(const Family& family, double a, double b)
    : family_(&family), a_(a), b_(b), facts_(family.facts(a, b)) {}

double Law::draw(Stream& random) const { return family_->draw(random, a_, b_); }

double Law::density(double x) const { return family_->density(x, a_, b_); }

bool Law::has_density() const { return family_->density != nullptr; }

Law law_of(Parameters& parameters) {
  try {
    return Law::parse(parameters.string("law"));
  } catch (const std::invalid_argument& error) {
    parameters.refuse("law", std::string("is no law: ") + error.what());
  }
}

Channel channel_of(const Variable& variable) {
  const auto& [law, shift, scale] = variable;
  // A scale of 0 makes a constant of any range.
  const auto at = [&](double y) { return scale == 0 ? shift : shift + scale * y; };
  Channel channel{.low = at(law.facts().low), .high = at(law.facts().high)};
  if (law.facts().mean) channel.mean = at(*law.facts().mean);
  if (law.facts().variance) channel.variance = scale * scale * *law.facts().variance;
  return channel;
}

NormalLaw normal_law(Parameters& parameters) {
  return {.mean = parameters.number("mean"), .deviation = parameters.number("deviation")};
}

}  // namespace assay::analytic

namespace assay::plugins {

namespace {

using namespace analytic;

ParameterInformation law_parameter() {
  return text_parameter("law", "the law with its numbers, as lognormal(0, 0.5)", "normal(0, 1)");
}

/// Draws X with its density, on an interval of 12 standard deviations about the mean, cut by the
/// range. Values outside are missing mass.
std::shared_ptr<const Sampler> sampler(const Variable& v) {
  const double reach = 6 * std::sqrt(*v.law.facts().variance);
  const double low = v.shift + v.scale * std::max(v.law.facts().low, *v.law.facts().mean - reach);
  const double high = v.shift + v.scale * std::min(v.law.facts().high, *v.law.facts().mean + reach);
  const auto point = [v, low, high](Stream& random) {
    const double x = v(random);
    return x < low || x > high ? std::nullopt : std::optional(Point{x});
  };
  const auto density = [v](const Point& p) {
    return v.law.density((p[0] - v.shift) / v.scale) / v.scale;
  };
  return sampler_of({.domain = Domain::interval,
                     .point = point,
                     .density = density,
                     .bounds = {low, high},
                     .panels = {.first = 64}});
}

std::shared_ptr<const Setup> law(Parameters& parameters) {
  const Law law = law_of(parameters);
  const Variable variable{law, parameters.number("shift"), parameters.number("scale")};
  std::vector<NamedSampler> samplers;
  if (law.has_density() && law.facts().variance) samplers.push_back({"x", sampler(variable)});
  return averaging(channel_of(variable), variable, std::move(samplers));
}

// X of a named law costs 1 + floor(r |X|) shadow rays: large values are dear, as long paths are.
// E[X] is the law's.

std::shared_ptr<const Setup> costly_law(Parameters& parameters) {
  const Variable variable{law_of(parameters), 0, 1};
  const double rays = parameters.number("rays");
  return averaging(channel_of(variable), [=](Stream& random, Cost& cost) {
    const double x = variable(random);
    // So many as fit a counter: of a law that reaches so far no claim on costs is answered.
    cost.shadow_rays += 1 + static_cast<std::uint64_t>(std::min(rays * std::abs(x), 0x1p40));
    return x;
  });
}

// An image of known means: brightness grows from left to right.
//
// X(x, y, c) = m(x, c) (1 + s Z) in column x, row y and component c. Z = (Y - E[Y]) / sqrt(Var Y),
// Y of a named law. E[X] = m, Var X = (m s)^2. m(x, c) = (1 + 9 x / (width - 1)) (1, 0.8, 0.6)_c.

std::shared_ptr<const Setup> ramp(Parameters& parameters) {
  constexpr std::array<double, 3> colour = {1, 0.8, 0.6};
  const std::size_t width = parameters.count("width");
  ImageParts<Variable> parts{.shape = {.width = width,
                                       .height = parameters.count("height"),
                                       .independent = !parameters.boolean("shared")}};
  if (parameters.boolean("colour")) parts.shape.components = {"red", "green", "blue"};
  const double spread = parameters.number("spread");
  const Law law = law_of(parameters);
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

std::vector<Entry> analytic_law() {
  return {
      {{.name = "analytic/law",
        .summary = "A variable of a named law.",
        .description =
            "Estimates the mean of shift + scale Y, Y of the law: bernoulli(p), "
            "exponential(rate), lognormal(location, scale), normal(mean, sd), pareto(scale, "
            "shape), student_t(freedom), uniform(low, high), zero_inflated(p), which is "
            "exponential(1) with probability p and else 0. Mean, variance and range are "
            "declared where they exist. A law with a density has the sampler `x`, within 6 "
            "standard deviations of the mean. `assay calibrate` measures the methods on it.",
        .parameters = {law_parameter(),
                       number_parameter("shift", "what is added", "0", {-1e150, 1e150}),
                       number_parameter("scale", "what Y is multiplied by", "1",
                                        {0, 1e150, true})}},
       law},
      {{.name = "analytic/normal",
        .summary = "A normal variable.",
        .description = "Estimates mu by mu + sigma Z, Z standard normal (Box and Muller).",
        .parameters = {number_parameter("mean", "mu", "0", {-1e300, 1e300}),
                       number_parameter("deviation", "sigma", "1", {0, 1e150})}},
       [](Parameters& given) {
         const NormalLaw law = normal_law(given);
         return averaging(Channel{.mean = law.mean, .variance = law.deviation * law.deviation},
                          law);
       }},
      {{.name = "analytic/costly_law",
        .summary = "A variable of a named law that costs rays in proportion to its size.",
        .description =
            "Estimates the mean of X, one of the laws of `analytic/law`, by X, which costs 1 + "
            "floor(r |X|) shadow rays: a cost that is random and depends on the value. `assay "
            "calibrate` measures claims on costs and efficiencies on it.",
        .parameters = {law_parameter(),
                       number_parameter("rays", "r, rays a unit of |X|", "100", {0, 1e6})}},
       costly_law},
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
       ramp}};
}

}  // namespace assay::plugins
