#include "metropolis/chain.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "metropolis/small_step.h"

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

/// The samplers of a step. One is `step`, the signed length, of density 1 / (2 |x| ln(largest /
/// smallest)). The other is `coordinate`, a uniform number after a small step; it stays if a step
/// is rejected. It is uniform again.
std::vector<NamedSampler> step_samplers(const SharedStep& step) {
  return {{"step", std::make_shared<StepSampler>(step)},
          {"coordinate", std::make_shared<CoordinateSampler>(step)}};
}

double luminance_of(const Spectrum& s, std::size_t components) {
  return components == 1 ? s.red : paths::luminance(s);
}

/// Writes an image of sums over `count` points, and the mean over its pixels.
void write_image(const ImageShape& shape, const Tally& tally, std::span<double> out) {
  const std::size_t components = shape.components.size();
  const auto pixels = static_cast<double>(shape.pixels());
  Spectrum sum;
  for (std::size_t p = 0; p < shape.pixels(); ++p) {
    // A chain without a single state brings nothing.
    const Spectrum value = tally.steps > 0 ? 1 / tally.steps * tally.pixels[p] : Spectrum{};
    sum += value;
    for (std::size_t c = 0; c < components; ++c) {
      out[p * components + c] = pixels * component(value, c);
    }
  }
  out[shape.elements()] = luminance_of(sum, components);
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
    const double normaliser = (*recipe_->start)(walker);
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

class IndependentEstimator final : public Estimator {
 public:
  explicit IndependentEstimator(SharedTarget target)
      : target_(std::move(target)), shape_(target_->shape()) {}

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    tally_.pixels.assign(shape_.pixels(), {});
    for (std::uint64_t i = 0; i < primaries; ++i) {
      IndependentCoordinates point(random);
      const Contribution found = target_->at(point, cost);
      tally_.add(found.pixel, 1, found.value);
    }
    tally_.steps = static_cast<double>(primaries);
    cost.samples += primaries;
    write_image(shape_, tally_, out);
  }

 private:
  SharedTarget target_;
  ImageShape shape_;
  Tally tally_;
};

std::vector<Channel> image_channels(const Target& target) {
  const ImageShape shape = target.shape();
  const std::vector<double> means = target.means();
  std::vector<Channel> channels;
  double sum = 0;
  for (std::size_t i = 0; i < shape.elements(); ++i) {
    Channel channel{.name = element_name(shape, i), .low = 0};
    if (!means.empty()) channel.mean = means[i];
    channels.push_back(std::move(channel));
  }
  const std::size_t components = shape.components.size();
  for (std::size_t i = 0; i < means.size(); i += components) {
    sum += components == 1 ? means[i] : paths::luminance({means[i], means[i + 1], means[i + 2]});
  }
  Channel whole{.name = "image_mean", .low = 0, .diagnostic = true};
  if (!means.empty()) whole.mean = sum / static_cast<double>(shape.pixels());
  channels.push_back(std::move(whole));
  return channels;
}

/// Points fall into one pixel or another, and a chain stays near where it was.
ImageShape dependent(ImageShape shape) {
  shape.independent = false;
  return shape;
}

}  // namespace

std::unique_ptr<LazyCoordinates> lazy_coordinates(std::shared_ptr<const SmallStep> step) {
  return std::make_unique<LazyCoordinates>(std::move(step));
}

std::shared_ptr<const Setup> chain(Recipe recipe) {
  std::vector<Channel> channels = image_channels(*recipe.target);
  channels.push_back(
      {.name = "normaliser", .mean = channels.back().mean, .low = 0, .diagnostic = true});
  channels.push_back({.name = "acceptance", .low = 0, .high = 1, .diagnostic = true});
  const auto shared = std::make_shared<const Recipe>(std::move(recipe));
  return setup_of({.channels = std::move(channels),
                   .make = [shared] { return std::make_unique<ChainEstimator>(shared); },
                   .samplers = step_samplers(shared->step),
                   .image = dependent(shared->target->shape())});
}

std::shared_ptr<const Setup> independent(SharedTarget target) {
  return setup_of({.channels = image_channels(*target),
                   .make = [target] { return std::make_unique<IndependentEstimator>(target); },
                   .image = dependent(target->shape())});
}

}  // namespace assay::metropolis
