#include "metropolis/samplers.h"

#include <cmath>
#include <utility>

namespace assay::metropolis {

namespace {

using SharedStep = std::shared_ptr<const SmallStep>;

class StepSampler final : public Sampler {
 public:
  explicit StepSampler(SharedStep step) : step_(std::move(step)) {}

  Domain domain() const override { return Domain::interval; }
  std::array<double, 2> bounds() const override {
    return {-SmallStep::largest, SmallStep::largest};
  }
  SamplerDraw sample(Stream& random) const override {
    const Point point = {step_->step(random), 0, 0};
    return {.point = point, .density = density(point), .weight = 1};
  }
  double density(const Point& point) const override {
    const double length = std::abs(point[0]);
    // Rounding may leave a step a hair outside.
    const double hair = 1 + 0x1p-40;
    if (length < SmallStep::smallest / hair || length > SmallStep::largest * hair) return 0;
    return 1 / (2 * length * std::log(SmallStep::largest / SmallStep::smallest));
  }
  double evaluate(const Point& point) const override { return density(point); }
  // The gap between the smallest steps ends on the borders of parts.
  Panels panels() const override { return {.first = 32}; }

 private:
  SharedStep step_;
};

class CoordinateSampler final : public Sampler {
 public:
  explicit CoordinateSampler(SharedStep step) : step_(std::move(step)) {}

  Domain domain() const override { return Domain::interval; }
  SamplerDraw sample(Stream& random) const override {
    const double before = random.uniform();
    return {
        .point = {step_->moved(before, random).value_or(before), 0, 0}, .density = 1, .weight = 1};
  }
  double density(const Point&) const override { return 1; }
  double evaluate(const Point&) const override { return 1; }

 private:
  SharedStep step_;
};

}  // namespace

std::vector<NamedSampler> step_samplers(const SharedStep& step) {
  return {{"step", std::make_shared<StepSampler>(step)},
          {"coordinate", std::make_shared<CoordinateSampler>(step)}};
}

}  // namespace assay::metropolis
