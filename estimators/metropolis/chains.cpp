// Metropolis light transport in primary sample space.
//
// The stationary density is I / integral of I. The chain's start and b come from the same points.
// Then E[b h(x_k)] = integral of h I for every k (Veach 1997, section 11.3.1), by induction: a step
// leaves this measure as it is. So the mean-value form is unbiased at every length.

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimators/core/mapped.h"
#include "metropolis/chain.h"

namespace assay::metropolis {

namespace {

double ratio(double numerator, double denominator) {
  return denominator > 0 ? numerator / denominator : 0;
}

/// The samplers of a step. One is `step`, the signed length, of density 1 / (2 |x| ln(largest /
/// smallest)). The other is `coordinate`, a uniform number after a small step; it stays if a step
/// is rejected. It is uniform again.
std::vector<NamedSampler> step_samplers(const std::shared_ptr<const SmallStep>& step) {
  const auto length_of = [step](Stream& random) { return Point{step->step(random), 0, 0}; };
  const auto density = [](const Point& point) {
    const double length = std::abs(point[0]);
    // Rounding may leave a step a hair outside.
    const double hair = 1 + 0x1p-40;
    if (length < SmallStep::smallest / hair || length > SmallStep::largest * hair) return 0.0;
    return 1 / (2 * length * std::log(SmallStep::largest / SmallStep::smallest));
  };
  const auto moved = [step](Stream& random) {
    const double before = random.uniform();
    return Point{step->moved(before, random).value_or(before), 0, 0};
  };
  // The gap between the smallest steps ends on the borders of parts.
  return {{"step", sampler_of({.domain = Domain::interval,
                               .point = length_of,
                               .density = density,
                               .bounds = {-SmallStep::largest, SmallStep::largest},
                               .panels = {.first = 32}})},
          {"coordinate", sampler_of({Domain::interval, moved, uniform_density(1)})}};
}

/// Writes an image of sums over `count` points, and the mean over its pixels.
void write_image(const ImageShape& shape, const Tally& tally, std::span<double> out) {
  const std::size_t components = shape.components.size();
  const auto pixels = static_cast<double>(shape.pixels());
  Rgb sum;
  for (std::size_t p = 0; p < shape.pixels(); ++p) {
    // A chain without a single state brings nothing.
    const Rgb value = tally.steps > 0 ? 1 / tally.steps * tally.pixels[p] : Rgb{};
    sum += value;
    for (std::size_t c = 0; c < components; ++c) {
      out[p * components + c] = pixels * value[c];
    }
  }
  out[shape.elements()] = components == 1 ? sum[0] : luminance(sum);
}

class ChainEstimator final : public Estimator {
 public:
  explicit ChainEstimator(std::shared_ptr<const Recipe> recipe)
      : recipe_(std::move(recipe)),
        shape_(recipe_->target->shape()),
        coordinates_(recipe_->coordinates(recipe_->step)) {}

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    coordinates_->restart();
    tally_.pixels.assign(shape_.pixels(), {});
    tally_.steps = tally_.acceptance = 0;
    Walker walker{*recipe_->target, *coordinates_, random, cost};
    const double normaliser = recipe_->start(walker, recipe_->bootstrap);
    // If all points of the start are black, b = 0 and the estimate is 0.
    if (normaliser > 0) {
      for (std::uint64_t i = 0; i < primaries; ++i) step(walker, normaliser);
    }
    write_image(shape_, tally_, out);
    out[shape_.elements() + 1] = normaliser;
    out[shape_.elements() + 2] = tally_.acceptance / static_cast<double>(primaries);
  }

 private:
  void step(Walker& walker, double normaliser) {
    const bool large = walker.random.uniform() < recipe_->p_large;
    const Contribution proposed = walker.propose(large);
    // Even from a black point, from which all else is accepted.
    const double a =
        walker.coordinates.inside()
            ? recipe_->rules->acceptance(proposed.importance, walker.current.importance)
            : 0;
    const bool accepted = walker.random.uniform() < a;
    recipe_->rules->record({.current = walker.current,
                            .proposed = proposed,
                            .acceptance = a,
                            .large = large,
                            .accepted = accepted,
                            .normaliser = normaliser},
                           tally_);
    tally_.acceptance += std::min(1.0, a);
    if (accepted) {
      walker.coordinates.accept();
      walker.current = proposed;
    } else {
      walker.coordinates.reject();
    }
  }

  std::shared_ptr<const Recipe> recipe_;
  ImageShape shape_;
  std::unique_ptr<LazyCoordinates> coordinates_;
  Tally tally_;
};

std::vector<Channel> elements_of(const std::vector<double>& means) {
  return mapped(means, [](double mean) { return Channel{.mean = mean, .low = 0}; });
}

Channel image_mean(const ImageShape& shape, const std::vector<double>& means) {
  double sum = 0;
  const std::size_t components = shape.components.size();
  for (std::size_t i = 0; i < means.size(); i += components) {
    sum += components == 1 ? means[i] : render::luminance({means[i], means[i + 1], means[i + 2]});
  }
  return {.name = "image_mean",
          .mean = sum / static_cast<double>(shape.pixels()),
          .low = 0,
          .diagnostic = true};
}

/// A secondary estimate is the image of `primaries` independent points: what chains are held
/// against. Channels: the image's elements and `image_mean`.
std::shared_ptr<const Setup> independent(SharedTarget target) {
  const auto estimate = [target, shape = target->shape(), tally = Tally{}](
                            Stream& random, std::uint64_t primaries, std::span<double> out,
                            Cost& cost) mutable {
    tally.pixels.assign(shape.pixels(), {});
    for (std::uint64_t i = 0; i < primaries; ++i) {
      IndependentCoordinates point(random);
      const Contribution found = target->at(point, cost);
      tally.add(found.pixel, 1, found.value);
    }
    tally.steps = static_cast<double>(primaries);
    cost.samples += primaries;
    write_image(shape, tally, out);
  };
  const std::vector<double> means = target->means();
  return setup_of({.channels = {image_mean(target->shape(), means)},
                   .make = estimating(estimate),
                   .image = target->shape(),
                   .elements = elements_of(means)});
}

std::vector<ParameterInformation> chain_parameters() {
  std::vector<ParameterInformation> list = target_parameters();
  list.push_back({.name = "p_large",
                  .summary = "probability of a large step, in which every coordinate is drawn "
                             "afresh; the others move each by 1/1024 to 1/64",
                  .fallback = "0.5",
                  .range = {.low = 0, .high = 1, .low_excluded = true},
                  .reason = "without large steps a chain never leaves the region that it began in, "
                            "and what it brings is not the integral"});
  list.push_back(
      {.name = "bootstrap",
       .type = ParameterType::count,
       .summary =
           "number of independent points before the chain, whose mean importance normalises it",
       .unit = "path evaluations",
       .fallback = "256",
       .range = {.low = 1, .high = 4294967295.0},
       .reason = "without any there is no normaliser b and no first state"});
  list.push_back(text_parameter("boundary",
                                "what becomes of a coordinate that steps out of [0, 1): it comes "
                                "in at the other end, is turned back, or the proposal is rejected",
                                "wrap", {"wrap", "reflect", "reject"}));
  return list;
}

}  // namespace

double Rules::acceptance(double proposed, double current) const {
  return current > 0 ? std::min(1.0, proposed / current) : 1;
}

void Rules::record(const Step& step, Tally& tally) const {
  const Weights weight = weights(step);
  tally.add(step.proposed.pixel, weight.proposed, step.proposed.value);
  tally.add(step.current.pixel, weight.current, step.current.value);
  ++tally.steps;
}

// If I = 0, F = 0 and any weight will do.
Weights MeanValueRules::weights(const Step& step) const {
  return {ratio(step.acceptance * step.normaliser, step.proposed.importance),
          ratio((1 - step.acceptance) * step.normaliser, step.current.importance)};
}

Weights MultipleImportanceRules::weights(const Step& step) const {
  const auto density = [&](double importance) { return importance / step.normaliser + p_large_; };
  return {(step.acceptance + (step.large ? 1 : 0)) / density(step.proposed.importance),
          (1 - step.acceptance) / density(step.current.importance)};
}

Contribution Walker::propose(bool large) {
  coordinates.propose(large, random);
  const Contribution proposed = target.at(coordinates, cost);
  ++cost.samples;
  return coordinates.inside() ? proposed : Contribution{};
}

// A reservoir of one: the state is replaced with probability I / (sum of I so far).
double start_in_proportion(Walker& walker, std::uint64_t count) {
  double sum = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const Contribution candidate = walker.propose(true);
    sum += candidate.importance;
    if (walker.random.uniform() * sum < candidate.importance) {
      walker.coordinates.accept();
      walker.current = candidate;
    } else {
      walker.coordinates.reject();
    }
  }
  return sum / static_cast<double>(count);
}

double start_anywhere(Walker& walker, std::uint64_t count) {
  double sum = 0;
  for (std::uint64_t i = 0; i <= count; ++i) {
    walker.current = walker.propose(true);
    walker.coordinates.accept();
    if (i < count) sum += walker.current.importance;
  }
  return sum / static_cast<double>(count);
}

std::shared_ptr<const Setup> chain(Recipe recipe) {
  const std::vector<double> means = recipe.target->means();
  const Channel whole = image_mean(recipe.target->shape(), means);
  const Channel normaliser{.name = "normaliser", .mean = whole.mean, .low = 0, .diagnostic = true};
  const Channel acceptance{.name = "acceptance", .low = 0, .high = 1, .diagnostic = true};
  const auto shared = std::make_shared<const Recipe>(std::move(recipe));
  return setup_of({.channels = {whole, normaliser, acceptance},
                   .make = [shared] { return std::make_unique<ChainEstimator>(shared); },
                   .samplers = step_samplers(shared->step),
                   .image = shared->target->shape(),
                   .elements = elements_of(means)});
}

Recipe read_recipe(Parameters& given, bool combined) {
  const double p_large = given.number("p_large");
  const auto boundary = given.choice<Boundary>("boundary");
  std::shared_ptr<const Rules> rules = std::make_shared<MeanValueRules>();
  if (combined) rules = std::make_shared<MultipleImportanceRules>(p_large);
  return {.target = read_target(given),
          .p_large = p_large,
          .boundary = boundary,
          .step = std::make_shared<SmallStep>(boundary),
          .rules = std::move(rules),
          .bootstrap = given.count("bootstrap"),
          .coordinates = [](std::shared_ptr<const SmallStep> step) {
            return std::make_unique<LazyCoordinates>(std::move(step));
          }};
}

}  // namespace assay::metropolis

namespace assay::plugins {

namespace {

using namespace metropolis;

const std::string of_chains =
    "Integrates F over the unit cube of a path's random numbers, pixel by pixel, by one Markov "
    "chain an observation; `primaries` is its number of steps. A large step draws all coordinates "
    "afresh, a small one moves each by s2 e^(-ln(s2 / s1) xi) to either side, s1 = 1/1024, s2 = "
    "1/64; proposal y is accepted with a = min(1, I(y) / I(x)), I the luminance of F (Kelemen, "
    "Szirmay-Kalos, Antal and Csonka 2002, A simple and robust mutation strategy for the "
    "Metropolis light transport algorithm). Coordinates carry time stamps and are mutated when "
    "they are looked at. ";

const std::string of_channels =
    " The image's elements are its channels; `image_mean`, `normaliser` (b) and `acceptance` (mean "
    "of a) are diagnostic. Samplers: step (of a coordinate, with its sign) and coordinate (a "
    "uniform one after a step). Cost: samples are path evaluations, the bootstrap's included; rays "
    "are the paths'.";

}  // namespace

std::vector<Entry> metropolis_chains() {
  return {
      {{.name = "metropolis/mean_value",
        .summary = "Metropolis light transport, both ends of a step by the expected value.",
        .description = of_chains +
                       "A step adds a b F(y) / I(y) to the pixel of y and (1 - a) b F(x) / I(x) "
                       "to that of x (Veach and Guibas 1997). The chain starts at one of "
                       "`bootstrap` independent points, drawn in proportion to I, with b the "
                       "mean of I over the same points: E[b h(x_k)] is the integral of h I for "
                       "every step k, so that the image is unbiased however short the chain." +
                       of_channels,
        .parameters = chain_parameters(),
        .averages = false},
       [](Parameters& given) { return chain(read_recipe(given, false)); }},
      {{.name = "metropolis/multiple_importance",
        .summary = "Metropolis light transport, large steps combined as uniform samples.",
        .description = of_chains +
                       "Large steps are uniform samples, too: a step adds F(y) (a + [large]) / "
                       "(I(y) / b + p_large) to the pixel of y and F(x) (1 - a) / (I(x) / b + "
                       "p_large) to that of x, multiple importance sampling of the two. The "
                       "start is that of metropolis/mean_value. The weights are not linear in "
                       "b, so the image is biased, like 1 / bootstrap however long the chain." +
                       of_channels,
        .parameters = chain_parameters(),
        .bias = BiasClass::inverse_bootstrap,
        .averages = false},
       [](Parameters& given) { return chain(read_recipe(given, true)); }},
      {{.name = "metropolis/uniform_start",
        .summary = "Metropolis light transport from a uniform point, which it has to forget.",
        .description = of_chains +
                       "The first state is a uniform point instead of one drawn in proportion "
                       "to I; b is the mean of I over `bootstrap` others. The chain has a "
                       "start-up bias, which large steps and length make smaller. Weights as in "
                       "metropolis/mean_value or metropolis/multiple_importance." +
                       of_channels,
        .parameters =
            joined(chain_parameters(),
                   {text_parameter("weights",
                                   "what the two ends of a step count for: by the expected "
                                   "value (mean_value), or combined with "
                                   "the large steps as uniform samples (multiple_importance)",
                                   "mean_value", {"mean_value", "multiple_importance"})}),
        .bias = BiasClass::start_up,
        .averages = false},
       [](Parameters& given) {
         Recipe recipe = read_recipe(given, given.string("weights") != "mean_value");
         recipe.start = start_anywhere;
         return chain(std::move(recipe));
       }},
      {{.name = "metropolis/independent",
        .summary = "The image of a Metropolis target by independent points.",
        .description =
            "The plain Monte Carlo estimate of what the chains of this family integrate: the "
            "mean of F over independent uniform points of the primary sample space, each in its "
            "pixel. It is trusted: the chains' variance is compared with it at equal path "
            "evaluations. Channels: the image's elements and the diagnostic `image_mean`.",
        .parameters = target_parameters()},
       [](Parameters& given) { return independent(read_target(given)); }}};
}

}  // namespace assay::plugins
