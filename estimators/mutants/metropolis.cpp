// Mutants of Metropolis light transport: a step, a decision, a weight, a start or the bookkeeping
// of lazy coordinates with one thing wrong. Biases are of the brightest pixel of `peak`, x2y0, and
// of the darkest, x0y0, after 500 steps from the default bootstrap, unless said otherwise. Most are
// simulated: no closed form is known; tests/tables/make_metropolis.py simulates the same mutants by
// other code.

#include <algorithm>
#include <utility>

#include "estimators/mutant.h"
#include "metropolis/chain.h"

namespace assay::plugins {

namespace {

using namespace metropolis;

struct Asymmetric final : SmallStep {
  using SmallStep::SmallStep;
  double step(Stream& random) const override {
    const double length = SmallStep::step(random);
    return length < 0 && random.uniform() < 0.5 ? -length : length;
  }
};

struct Clamped final : SmallStep {
  using SmallStep::SmallStep;
  std::optional<double> settled(double u) const override {
    return std::clamp(u, 0.0, std::nextafter(1.0, 0.0));
  }
};

struct InvertedRatio final : MeanValueRules {
  double acceptance(double proposed, double current) const override {
    return MeanValueRules::acceptance(current, proposed);
  }
};

struct UnboundedRatio final : MeanValueRules {
  double acceptance(double proposed, double current) const override {
    return current > 0 ? proposed / current : 1;
  }
};

struct RejectedNotCounted final : MeanValueRules {
  void record(const Step& step, Tally& tally) const override {
    if (!step.accepted) return;
    tally.add(step.proposed.pixel, step.normaliser / step.proposed.importance, step.proposed.value);
    ++tally.steps;
  }
};

struct CurrentDropped final : MeanValueRules {
  Weights weights(const Step& step) const override {
    return {MeanValueRules::weights(step).proposed, 0};
  }
};

template <class Sound>
struct CurrentPixel final : Sound {
  using Sound::Sound;
  void record(const Step& step, Tally& tally) const override {
    const Weights weight = this->weights(step);
    tally.add(step.current.pixel, weight.proposed, step.proposed.value);
    tally.add(step.current.pixel, weight.current, step.current.value);
    ++tally.steps;
  }
};

/// [large] replaced by a constant.
template <bool Always>
struct LargeFixed final : MultipleImportanceRules {
  using MultipleImportanceRules::MultipleImportanceRules;
  Weights weights(const Step& step) const override {
    Step altered = step;
    altered.large = Always;
    return MultipleImportanceRules::weights(altered);
  }
};

double scaled_normaliser(Walker& walker, std::uint64_t count) {
  return 1.05 * start_in_proportion(walker, count);
}

struct FirstRestored final : LazyCoordinates {
  using LazyCoordinates::LazyCoordinates;
  void reject() override {
    if (!saved_.empty()) restore(saved_.front());
  }
};

struct LargeNotSaved final : LazyCoordinates {
  using LazyCoordinates::LazyCoordinates;
  void set_aside(std::size_t index) override {
    if (!large_) LazyCoordinates::set_aside(index);
  }
};

struct LargeTimeOnRejection final : LazyCoordinates {
  using LazyCoordinates::LazyCoordinates;
  void reject() override {
    LazyCoordinates::reject();
    if (large_) date_large_step();
  }
};

struct NoCatchingUp final : LazyCoordinates {
  using LazyCoordinates::LazyCoordinates;
  void catch_up(Coordinate& coordinate) override {
    freshen(coordinate);
    coordinate.time = time_;
  }
};

struct NotFreshened final : LazyCoordinates {
  using LazyCoordinates::LazyCoordinates;
  void catch_up(Coordinate& coordinate) override {
    if (coordinate.time == 0) return freshen(coordinate);
    coordinate.time = time_;
  }
};

// The change that a mutant makes to a sound recipe.
using Defect = std::function<void(Recipe&)>;

template <class Mutant>
Defect steps() {
  return [](Recipe& recipe) { recipe.step = std::make_shared<Mutant>(recipe.boundary); };
}

template <class Mutant>
Defect rules() {
  return [](Recipe& recipe) {
    if constexpr (std::is_constructible_v<Mutant, double>) {
      recipe.rules = std::make_shared<Mutant>(recipe.p_large);
    } else {
      recipe.rules = std::make_shared<Mutant>();
    }
  };
}

Defect start(Start mutant) {
  return [mutant](Recipe& recipe) { recipe.start = mutant; };
}

template <class Mutant>
Defect bookkeeping() {
  return [](Recipe& recipe) {
    recipe.coordinates = [](std::shared_ptr<const SmallStep> step) {
      return std::make_unique<Mutant>(std::move(step));
    };
  };
}

Entry entry(const std::string& original, const char* name, const char* defect, Defect apply) {
  return mutant({std::string("metropolis_") + name, original, defect},
                [original, apply = std::move(apply)](Parameters& given) {
                  Recipe recipe = read_recipe(given, original != "metropolis/mean_value");
                  apply(recipe);
                  return chain(std::move(recipe));
                });
}

}  // namespace

std::vector<Entry> mutants_metropolis() {
  const std::string mean_value = "metropolis/mean_value";
  const std::string multiple = "metropolis/multiple_importance";
  return {
      entry(mean_value, "asymmetric",
            "steps up three times as often as down: -29 %, +11 %; the image's mean is right.",
            steps<Asymmetric>()),
      entry(mean_value, "clamped",
            "clamps coordinates to [0, 1) where it should wrap them: nothing where little lies at "
            "the border; +16 % in the first of 64 pixels of `boundary` at p_large 0.1.",
            steps<Clamped>()),
      entry(mean_value, "inverted_ratio", "accepts with min(1, I(x) / I(y)): -63 %, +1240 %.",
            rules<InvertedRatio>()),
      entry(mean_value, "unbounded_ratio",
            "weighs by a = I(y) / I(x) without the minimum with 1: +31 %, -200 %.",
            rules<UnboundedRatio>()),
      entry(mean_value, "rejected_not_counted",
            "averages over the states it moves to, as if those it stays in did not count: -24 %, "
            "+29 %; the image's mean is right.",
            rules<RejectedNotCounted>()),
      entry(mean_value, "current_dropped",
            "leaves out the part of the current state, (1 - a): -46 %, -1 %.",
            rules<CurrentDropped>()),
      entry(mean_value, "current_pixel",
            "adds what a proposal brings to the pixel of the current state: nothing in grey, where "
            "by detailed balance as much leaves a pixel as enters it; colours bleed, +122 % blue "
            "and -20 % red in the first pixel of `coloured_peak`.",
            rules<CurrentPixel<MeanValueRules>>()),
      entry(multiple, "current_pixel_multiple",
            "adds what a proposal brings to the pixel of the current state: +18 %, -29 %.",
            rules<CurrentPixel<MultipleImportanceRules>>()),
      entry(multiple, "large_omitted", "leaves [large] out of the weights: -10 %, -71 %.",
            rules<LargeFixed<false>>()),
      entry(multiple, "large_always",
            "takes every step's weight for that of a large one: +46 %, +15 %.",
            rules<LargeFixed<true>>()),
      entry(mean_value, "normaliser_scaled", "takes 1.05 b for b: +5 % everywhere.",
            start(scaled_normaliser)),
      entry(multiple, "normaliser_scaled_multiple", "takes 1.05 b for b: +5 %, +1 %.",
            start(scaled_normaliser)),
      entry(mean_value, "other_normaliser",
            "estimates b from other points than those that it starts from: -27 %, +8.5 % with 16 "
            "points and 100 steps; like 1 / bootstrap.",
            start([](Walker& walker, std::uint64_t count) {
              const double other = start_anywhere(walker, count);
              walker.current = {};
              return start_in_proportion(walker, count) > 0 ? other : 0;
            })),
      entry(mean_value, "first_restored",
            "puts only the first coordinate back when a proposal is rejected: -18 %, +9 %.",
            bookkeeping<FirstRestored>()),
      entry(mean_value, "large_not_saved",
            "sets coordinates aside before small steps but not before large ones: -20 %, +73 %.",
            bookkeeping<LargeNotSaved>()),
      entry(mean_value, "large_time_on_rejection",
            "dates the last large step even if it was rejected, so that the state is drawn "
            "afresh under the chain: -17 %, +32 %.",
            bookkeeping<LargeTimeOnRejection>()),
      entry(
          mean_value, "no_catching_up",
          "leaves out the small steps that a coordinate has missed: nothing where all paths look "
          "at the same coordinates; -4 % in the even of two pixels of `branches` at p_large 0.02.",
          bookkeeping<NoCatchingUp>()),
      entry(mean_value, "not_freshened",
            "forgets that a coordinate has missed anything, large steps too: nothing where all "
            "paths look at the same coordinates; -50 % or so in the even of two pixels of "
            "`branches` at p_large 0.02.",
            bookkeeping<NotFreshened>()),
  };
}

}  // namespace assay::plugins
