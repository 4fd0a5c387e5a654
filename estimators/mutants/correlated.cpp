// Mutants of combined correlated and importance sampling: pairs, integrals or rules for lambda with
// one thing wrong. Biases are for the built-in rectangle, of J = 1.320523614, unless said
// otherwise.

#include <numbers>
#include <utility>

#include "correlated/estimators.h"
#include "estimators/mutant.h"
#include "luminaire/area.h"

namespace assay::plugins {

namespace {

using namespace correlated;

/// Another source's pairs with its colours or pairs changed.
class AlteredPairs : public PairSource {
 public:
  explicit AlteredPairs(SharedPairs source)
      : source_(std::move(source)), colours_(source_->colours()) {}

  const std::vector<Colour>& colours() const override { return colours_; }
  void draw(Stream& random, std::span<Pair> out, Cost& cost) const override {
    source_->draw(random, out, cost);
  }
  std::vector<NamedSampler> samplers() const override { return source_->samplers(); }

 protected:
  // The reference stays the original's; its variance is the original's alone.
  void forget_moments() {
    for (Colour& colour : colours_) colour.moments.reset();
  }
  void scale_integral(double factor) {
    for (Colour& colour : colours_) colour.control_integral *= factor;
    forget_moments();
  }

  SharedPairs source_;
  std::vector<Colour> colours_;
};

struct AddedTwice final : AlteredPairs {
  explicit AddedTwice(SharedPairs source) : AlteredPairs(std::move(source)) { forget_moments(); }
  void draw(Stream& random, std::span<Pair> out, Cost& cost) const override {
    source_->draw(random, out, cost);
    for (Pair& pair : out) {
      pair.control = -1 * pair.control;
    }
  }
};

struct WithoutPi final : AlteredPairs {
  explicit WithoutPi(SharedPairs source) : AlteredPairs(std::move(source)) {
    scale_integral(1 / std::numbers::pi);
  }
};

struct VisibleControl final : AlteredPairs {
  explicit VisibleControl(SharedPairs source) : AlteredPairs(std::move(source)) {
    forget_moments();
  }
  void draw(Stream& random, std::span<Pair> out, Cost& cost) const override {
    source_->draw(random, out, cost);
    for (Pair& pair : out) pair.control = pair.full;
  }
};

// Each f with the g of a point of its own: means stay, what the control was for is lost.
struct OtherPoints final : AlteredPairs {
  explicit OtherPoints(SharedPairs source) : AlteredPairs(std::move(source)) {}
  void draw(Stream& random, std::span<Pair> out, Cost& cost) const override {
    source_->draw(random, out, cost);
    std::vector<Pair> others(out.size());
    Cost uncounted;
    source_->draw(random, others, uncounted);
    for (std::size_t i = 0; i < out.size(); ++i) out[i].control = others[i].control;
  }
};

template <class Mutant>
std::shared_ptr<const Setup> altered(Parameters& given) {
  return fixed(std::make_shared<Mutant>(read_area_pairs(given)), given.number("lambda"));
}

struct GivenIntegral final : AlteredPairs {
  GivenIntegral(SharedPairs source, double integral) : AlteredPairs(std::move(source)) {
    forget_moments();
    colours_[0].control_integral = integral;
  }
};

std::shared_ptr<const Setup> unclipped_integral(Parameters& given) {
  const luminaire::SharedSetting setting = luminaire::read_setting(given);
  return fixed(std::make_shared<GivenIntegral>(read_area_pairs(given),
                                               luminaire::unclipped_irradiance(*setting)),
               given.number("lambda"));
}

std::shared_ptr<const Setup> without_radiance(Parameters& given) {
  const double radiance = luminaire::read_setting(given)->radiance();
  if (radiance == 0) given.refuse("scene", "the luminaire must have a radiance above 0");
  const SharedPairs pairs = read_area_pairs(given);
  return fixed(
      std::make_shared<GivenIntegral>(pairs, pairs->colours()[0].control_integral / radiance),
      given.number("lambda"));
}

// One integral, the mean of the colours', for all of them.
struct GreyIntegral final : AlteredPairs {
  explicit GreyIntegral(SharedPairs source) : AlteredPairs(std::move(source)) {
    double sum = 0;
    for (const Colour& colour : colours_) sum += colour.control_integral;
    for (Colour& colour : colours_) {
      colour.control_integral = sum / static_cast<double>(colours_.size());
    }
    forget_moments();
  }
};

// Sum f g, not about the means, over the spread of g about its mean.
double uncentred(const Sums& sums, double integral) {
  const double spread = sums.lack_squared - sums.lack * sums.lack / sums.count;
  return spread > 0 ? (integral * sums.full - sums.product) / spread : 0;
}

// These have a rule of their own, and the parameters only so that their streams are the original's.
void only_published_rule(Parameters& given) {
  if (given.string("centre") != "integral") given.refuse("centre", "must be `integral` here");
  if (given.boolean("clamped")) given.refuse("clamped", "must be false here");
}

Sums sums_of(const PairSource& pixel, std::uint64_t count, Stream& random, Cost& cost) {
  const double integral = pixel.colours()[0].control_integral;
  Sums all;
  for_each_pair(pixel, count, random, cost,
                [&](const Pair& pair) { all.add(pair.full[0], integral - pair.control[0]); });
  return all;
}

// One lambda for receivers side by side, from the very samples that it corrects. They are a
// fiftieth of the luminaire's width apart.
std::shared_ptr<const Setup> pooled_lambda(Parameters& given) {
  const auto own = read_area_pairs(given);
  luminaire::SceneDescription scene =
      luminaire::read_scene(given.structure("scene"), given.folder());
  const double step = render::diameter(std::get<render::Polygon>(scene.light.shape)) / 50;
  const render::Vector3 along = render::Frame::about(scene.receiver.normal).tangent;
  std::vector<SharedPairs> pixels{own};
  for (int k = 1; k < 3; ++k) {
    scene.receiver.position += step * along;
    pixels.push_back(area_pairs(scene, given.where("scene")));
  }
  only_published_rule(given);
  const auto estimate = [pixels](Stream& random, std::uint64_t primaries, std::span<double> out,
                                 Cost& cost) {
    const Sums first = sums_of(*pixels[0], primaries, random, cost);
    double covariation = first.covariation();
    double spread = first.lack_squared;
    for (std::size_t k = 1; k < pixels.size(); ++k) {
      Stream neighbour = random.substream(static_cast<std::uint32_t>(k));
      const Sums other = sums_of(*pixels[k], primaries, neighbour, cost);
      covariation += other.covariation();
      spread += other.lack_squared;
    }
    const double lambda = spread > 0 ? covariation / spread : 0;
    out[0] = first.estimate(lambda);
    out[1] = lambda;
  };
  return setup_of({channels_with_lambda(*own), estimating(estimate), own->samplers()});
}

}  // namespace

std::vector<Entry> mutants_correlated() {
  return {
      mutant({"control_added_twice", "correlated/area",
              "adds the control where it should be taken away, J + g: 2 lambda J too much."},
             altered<AddedTwice>),
      mutant({"control_unclipped", "correlated/area",
              "integrates the control over the whole polygon, that below the receiver's "
              "horizon too: nothing on `rectangle`, lambda (unclipped - clipped) where the "
              "luminaire crosses the horizon."},
             unclipped_integral),
      mutant({"control_without_pi", "correlated/area",
              "takes the form factor for the control's integral, J / pi: lambda J (1/pi - 1)."},
             altered<WithoutPi>),
      mutant({"control_without_radiance", "correlated/area",
              "leaves the luminaire's radiance L out of J: lambda J (1/L - 1), nothing at L = "
              "1."},
             without_radiance),
      mutant({"control_visible", "correlated/area",
              "lets occluders shade the control's samples but not its integral: lambda (J - "
              "I)."},
             altered<VisibleControl>),
      mutant({"control_elsewhere", "correlated/area",
              "evaluates the control at other points than the integrand: no bias, but the "
              "variance grows to Var f + lambda^2 Var g."},
             altered<OtherPoints>),
      mutant({"lambda_uncentred", "correlated/area_cross_fitted",
              "divides the sum of f g, not taken about the means, by the spread of g: lambda "
              "tends to (Cov + I J) / Var g; no bias, more variance."},
             [](Parameters& given) {
               only_published_rule(given);
               return cross_fitted(read_area_pairs(given), uncentred);
             }),
      mutant(
          {"lambda_own_half", "correlated/area_cross_fitted",
           "takes lambda from the samples that it corrects: where the part x < -0.5 of "
           "`rectangle` is seen, +7 % with 2 primaries, +4.6 % with 4, +1.1 % with 16."},
          [](Parameters& given) { return same_samples(read_area_pairs(given), read_rule(given)); }),
      mutant({"lambda_pooled", "correlated/area_cross_fitted",
              "takes one lambda from the samples of three receivers side by side and corrects "
              "those samples with it: about a third of the bias of one receiver alone."},
             pooled_lambda),
      mutant({"control_grey_integral", "correlated/sky",
              "has one J for all colours, the mean of theirs, beside a control in colour: lambda "
              "(mean J - J) in each, nothing under a grey sky."},
             [](Parameters& given) {
               return fixed(std::make_shared<GreyIntegral>(read_sky_pairs(given)),
                            given.number("lambda"));
             }),
  };
}

}  // namespace assay::plugins
