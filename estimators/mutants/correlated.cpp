// Mutants of combined correlated and importance sampling: pairs, integrals or rules for lambda with
// one thing wrong. Biases are for the built-in rectangle, of J = 1.320523614, unless said
// otherwise.

#include <algorithm>
#include <numbers>
#include <utility>

#include "correlated/estimators.h"
#include "estimators/mutant.h"
#include "luminaire/area.h"

namespace assay::plugins {

namespace {

using namespace correlated;

/// `change` changes pairs that have just been drawn.
SharedPairs with_other_pairs(const SharedPairs& source, const auto& change) {
  PairSource altered = *source;
  altered.draw = [source, change](Stream& random, std::span<Pair> out, Cost& cost) {
    source->draw(random, out, cost);
    change(random, out);
  };
  return std::make_shared<const PairSource>(std::move(altered));
}

// The reference stays the original's; its variance is the original's alone.
SharedPairs without_variance(const SharedPairs& source) {
  PairSource altered = *source;
  for (Colour& colour : altered.colours) colour.moments.reset();
  return std::make_shared<const PairSource>(std::move(altered));
}

SharedPairs changed(const SharedPairs& source, void (*change)(Pair&)) {
  return with_other_pairs(without_variance(source), [change](Stream&, std::span<Pair> out) {
    std::ranges::for_each(out, change);
  });
}

SharedPairs with_integral(const SharedPairs& source, double integral) {
  PairSource altered = *without_variance(source);
  for (Colour& colour : altered.colours) colour.control_integral = integral;
  return std::make_shared<const PairSource>(std::move(altered));
}

double integral_of(const SharedPairs& pairs) { return pairs->colours[0].control_integral; }

SharedPairs other_points(Parameters& given) {
  const SharedPairs sound = read_area_pairs(given);
  const auto exchange = [sound](Stream& random, std::span<Pair> out) {
    std::vector<Pair> others(out.size());
    sound->draw(random, others, Uncounted());
    for (std::size_t i = 0; i < out.size(); ++i) out[i].control = others[i].control;
  };
  return with_other_pairs(sound, exchange);
}

/// A mutant of the estimator with a given lambda, by other pairs.
Entry entry(const char* name, const char* original, const char* defect,
            SharedPairs (*pairs_of)(Parameters&)) {
  return mutant({name, original, defect}, [pairs_of](Parameters& given) {
    return fixed(pairs_of(given), given.number("lambda"));
  });
}

// These have a rule of their own, and the parameters only so that their streams are the original's.
void only_published_rule(Parameters& given) {
  given.require(given.string("centre") == "integral", "centre", "must be `integral` here");
  given.require(!given.boolean("clamped"), "clamped", "must be false here");
}

Sums sums_of(const PairSource& pixel, std::uint64_t count, Stream& random, Cost& cost) {
  const double integral = pixel.colours[0].control_integral;
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
  return setup_of({channels_with_lambda(*own), estimating(estimate), own->samplers});
}

}  // namespace

std::vector<Entry> mutants_correlated() {
  return {
      entry("control_added_twice", "correlated/area",
            "adds the control where it should be taken away, J + g: 2 lambda J too much.",
            [](Parameters& given) {
              return changed(read_area_pairs(given),
                             [](Pair& pair) { pair.control = -1 * pair.control; });
            }),
      entry("control_unclipped", "correlated/area",
            "integrates the control over the whole polygon, that below the receiver's "
            "horizon too: nothing on `rectangle`, lambda (unclipped - clipped) where the "
            "luminaire crosses the horizon.",
            [](Parameters& given) {
              const luminaire::SharedSetting setting = luminaire::read_setting(given);
              return with_integral(read_area_pairs(given),
                                   luminaire::unclipped_irradiance(*setting));
            }),
      entry("control_without_pi", "correlated/area",
            "takes the form factor for the control's integral, J / pi: lambda J (1/pi - 1).",
            [](Parameters& given) {
              const SharedPairs pairs = read_area_pairs(given);
              return with_integral(pairs, integral_of(pairs) * (1 / std::numbers::pi));
            }),
      entry("control_without_radiance", "correlated/area",
            "leaves the luminaire's radiance L out of J: lambda J (1/L - 1), nothing at L = "
            "1.",
            [](Parameters& given) {
              const double radiance = luminaire::read_setting(given)->radiance();
              given.require(radiance != 0, "scene", "the luminaire must have a radiance above 0");
              const SharedPairs pairs = read_area_pairs(given);
              return with_integral(pairs, integral_of(pairs) / radiance);
            }),
      entry("control_visible", "correlated/area",
            "lets occluders shade the control's samples but not its integral: lambda (J - "
            "I).",
            [](Parameters& given) {
              return changed(read_area_pairs(given), [](Pair& pair) { pair.control = pair.full; });
            }),
      entry("control_elsewhere", "correlated/area",
            "evaluates the control at other points than the integrand: no bias, but the "
            "variance grows to Var f + lambda^2 Var g.",
            other_points),
      mutant({"lambda_uncentred", "correlated/area_cross_fitted",
              "divides the sum of f g, not taken about the means, by the spread of g: lambda "
              "tends to (Cov + I J) / Var g; no bias, more variance."},
             [](Parameters& given) {
               only_published_rule(given);
               return cross_fitted(read_area_pairs(given), [](const Sums& sums, double integral) {
                 const double spread = sums.lack_squared - sums.lack * sums.lack / sums.count;
                 return spread > 0 ? (integral * sums.full - sums.product) / spread : 0;
               });
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
      entry("control_grey_integral", "correlated/sky",
            "has one J for all colours, the mean of theirs, beside a control in colour: lambda "
            "(mean J - J) in each, nothing under a grey sky.",
            [](Parameters& given) {
              const SharedPairs pairs = read_sky_pairs(given);
              double sum = 0;
              for (const Colour& colour : pairs->colours) sum += colour.control_integral;
              return with_integral(pairs, sum / static_cast<double>(pairs->colours.size()));
            }),
  };
}

}  // namespace assay::plugins
