#include "metropolis/rules.h"

#include <algorithm>

namespace assay::metropolis {

namespace {

double ratio(double numerator, double denominator) {
  return denominator > 0 ? numerator / denominator : 0;
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
double ResampledStart::operator()(Walker& walker) const {
  double sum = 0;
  for (std::uint64_t i = 0; i < count_; ++i) {
    const Contribution candidate = walker.propose(true);
    sum += candidate.importance;
    if (walker.random.uniform() * sum < candidate.importance) {
      walker.coordinates.accept();
      walker.current = candidate;
    } else {
      walker.coordinates.reject();
    }
  }
  return sum / static_cast<double>(count_);
}

double UniformStart::operator()(Walker& walker) const {
  double sum = 0;
  for (std::uint64_t i = 0; i <= count_; ++i) {
    walker.current = walker.propose(true);
    walker.coordinates.accept();
    if (i < count_) sum += walker.current.importance;
  }
  return sum / static_cast<double>(count_);
}

}  // namespace assay::metropolis
