#include "metropolis/chain.h"

#include <algorithm>
#include <utility>

#include "metropolis/samplers.h"

namespace assay::metropolis {

namespace {

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

/// Shape and channels, common to both.
class ImageSetup : public Setup {
 public:
  explicit ImageSetup(const Target& target)
      : shape_(target.shape()), channels_(image_channels(target)) {
    // Points fall into one pixel or another, and a chain stays near where it was.
    shape_.independent = false;
  }
  std::vector<Channel> channels() const override { return channels_; }
  std::optional<ImageShape> image() const override { return shape_; }

 protected:
  ImageShape shape_;
  std::vector<Channel> channels_;
};

class ChainSetup final : public ImageSetup {
 public:
  explicit ChainSetup(Recipe recipe)
      : ImageSetup(*recipe.target), recipe_(std::make_shared<const Recipe>(std::move(recipe))) {
    channels_.push_back(
        {.name = "normaliser", .mean = channels_.back().mean, .low = 0, .diagnostic = true});
    channels_.push_back({.name = "acceptance", .low = 0, .high = 1, .diagnostic = true});
  }
  std::unique_ptr<Estimator> make() const override {
    return std::make_unique<ChainEstimator>(recipe_);
  }
  std::vector<NamedSampler> samplers() const override { return step_samplers(recipe_->step); }

 private:
  std::shared_ptr<const Recipe> recipe_;
};

class IndependentSetup final : public ImageSetup {
 public:
  explicit IndependentSetup(SharedTarget target)
      : ImageSetup(*target), target_(std::move(target)) {}
  std::unique_ptr<Estimator> make() const override {
    return std::make_unique<IndependentEstimator>(target_);
  }

 private:
  SharedTarget target_;
};

}  // namespace

std::unique_ptr<LazyCoordinates> lazy_coordinates(std::shared_ptr<const SmallStep> step) {
  return std::make_unique<LazyCoordinates>(std::move(step));
}

std::shared_ptr<const Setup> chain(Recipe recipe) {
  return std::make_shared<ChainSetup>(std::move(recipe));
}

std::shared_ptr<const Setup> independent(SharedTarget target) {
  return std::make_shared<IndependentSetup>(std::move(target));
}

}  // namespace assay::metropolis
