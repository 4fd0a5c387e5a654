#include "correlated/estimators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "estimators/core/mapped.h"
#include "estimators/parameters.h"

namespace assay::correlated {

namespace {

using ColourSums = std::array<Sums, 3>;

std::optional<double> best_lambda(const Colour& colour) {
  if (!colour.moments || !colour.integral) return {};
  const double j = colour.control_integral;
  const double spread = colour.moments->control - j * j;
  if (spread < 1e-6 * j * j) return {};
  return (colour.moments->product - *colour.integral * j) / spread;
}

// Values that differ by rounding alone: what the control lacks is a difference of numbers near J.
double rounding(const Colour& colour, double lambda) {
  return (1 + std::abs(lambda)) * colour.control_integral * 0x1p-40;
}

Channel irradiance(const Colour& colour) {
  return {.name = colour.name, .mean = colour.integral, .mean_error = colour.integral_error};
}

Channel channel_of(const Colour& colour, double lambda) {
  Channel channel = irradiance(colour);
  channel.rounding = rounding(colour, lambda);
  if (!colour.moments || !colour.integral) return channel;
  const Moments& m = *colour.moments;
  const double j = colour.control_integral;
  const double i = *colour.integral;
  const double v =
      m.full - i * i + lambda * lambda * (m.control - j * j) - 2 * lambda * (m.product - i * j);
  // Fewer than some eight digits left by the differences count as unknown, nothing left as zero.
  if (v > 1e-6 * (m.full + lambda * lambda * m.control)) channel.variance = v;
  return channel;
}

ColourSums draw_sums(const PairSource& source, std::uint64_t count, Stream& random, Cost& cost) {
  const auto& colours = source.colours;
  ColourSums sums;
  for_each_pair(source, count, random, cost, [&](const Pair& pair) {
    for (std::size_t c = 0; c < colours.size(); ++c) {
      sums[c].add(pair.full[c], colours[c].control_integral - pair.control[c]);
    }
  });
  return sums;
}

std::vector<ParameterInformation> rule_parameters() {
  return {text_parameter("centre",
                         "what the spread of g/p is measured about: its integral J or its mean",
                         "integral", {"integral", "mean"}),
          boolean_parameter("clamped", "whether lambda is moved into [0, 1]", false)};
}

}  // namespace

LambdaRule estimated_lambda(Centre centre) {
  return [centre](const Sums& sums, double integral) {
    const double mean_lack = sums.lack / sums.count;
    const double about_mean = sums.lack_squared - mean_lack * sums.lack;
    const double spread = centre == Centre::integral ? sums.lack_squared : about_mean;
    const double least = integral * 0x1p-40;
    return spread <= sums.count * least * least ? 0 : sums.covariation() / spread;
  };
}

LambdaRule clamped_lambda(Centre centre) {
  return [rule = estimated_lambda(centre)](const Sums& sums, double integral) {
    return std::clamp(rule(sums, integral), 0.0, 1.0);
  };
}

std::vector<Channel> channels_with_lambda(const PairSource& source) {
  const auto& colours = source.colours;
  std::vector<Channel> channels;
  for (const Colour& colour : colours) {
    channels.push_back(irradiance(colour));
    channels.back().rounding = rounding(colour, 1);
  }
  for (const Colour& colour : colours) {
    channels.push_back({.name = colours.size() == 1 ? "lambda" : "lambda_" + colour.name,
                        .mean = best_lambda(colour),
                        .diagnostic = true});
  }
  return channels;
}

std::shared_ptr<const Setup> fixed(SharedPairs source, double lambda) {
  std::vector<Channel> channels =
      mapped(source->colours, [&](const Colour& colour) { return channel_of(colour, lambda); });
  const auto estimate = [source, lambda](Stream& random, std::uint64_t primaries,
                                         std::span<double> out, Cost& cost) {
    const auto& colours = source->colours;
    Rgb sum;
    for_each_pair(*source, primaries, random, cost, [&](const Pair& pair) {
      for (std::size_t c = 0; c < colours.size(); ++c) {
        sum[c] += pair.full[c] + lambda * (colours[c].control_integral - pair.control[c]);
      }
    });
    for (std::size_t c = 0; c < colours.size(); ++c) {
      out[c] = sum[c] / static_cast<double>(primaries);
    }
  };
  return setup_of({std::move(channels), estimating(estimate), source->samplers});
}

std::shared_ptr<const Setup> same_samples(SharedPairs source, LambdaRule rule) {
  const auto estimate = [source, rule](Stream& random, std::uint64_t primaries,
                                       std::span<double> out, Cost& cost) {
    const auto& colours = source->colours;
    const ColourSums sums = draw_sums(*source, primaries, random, cost);
    for (std::size_t c = 0; c < colours.size(); ++c) {
      const double lambda = rule(sums[c], colours[c].control_integral);
      out[c] = sums[c].estimate(lambda);
      out[colours.size() + c] = lambda;
    }
  };
  return setup_of({channels_with_lambda(*source), estimating(estimate), source->samplers});
}

std::shared_ptr<const Setup> cross_fitted(SharedPairs source, LambdaRule rule) {
  const auto estimate = [source, rule](Stream& random, std::uint64_t primaries,
                                       std::span<double> out, Cost& cost) {
    const auto lambda = [&](const Sums& sums, double integral) {
      return sums.count < 2 ? 0 : rule(sums, integral);
    };
    const auto& colours = source->colours;
    const std::uint64_t half = primaries / 2;
    const ColourSums first = draw_sums(*source, half, random, cost);
    const ColourSums second = draw_sums(*source, primaries - half, random, cost);
    for (std::size_t c = 0; c < colours.size(); ++c) {
      const double of_first = lambda(first[c], colours[c].control_integral);
      const double of_second = lambda(second[c], colours[c].control_integral);
      out[c] =
          (first[c].full + of_second * first[c].lack + second[c].full + of_first * second[c].lack) /
          static_cast<double>(primaries);
      out[colours.size() + c] = (of_first + of_second) / 2;
    }
  };
  return setup_of({channels_with_lambda(*source), estimating(estimate), source->samplers});
}

std::shared_ptr<const Setup> ratio(SharedPairs source) {
  std::vector<Channel> channels = mapped(source->colours, irradiance);
  const auto estimate = [source](Stream& random, std::uint64_t primaries, std::span<double> out,
                                 Cost& cost) {
    const auto& colours = source->colours;
    Rgb full, control;
    for_each_pair(*source, primaries, random, cost, [&](const Pair& pair) {
      full += pair.full;
      control += pair.control;
    });
    for (std::size_t c = 0; c < colours.size(); ++c) {
      out[c] = control[c] == 0 ? 0 : colours[c].control_integral * full[c] / control[c];
    }
  };
  return setup_of({std::move(channels), estimating(estimate), source->samplers});
}

LambdaRule read_rule(Parameters& given) {
  const auto centre = given.choice<Centre>("centre");
  return given.boolean("clamped") ? clamped_lambda(centre) : estimated_lambda(centre);
}

std::vector<Entry> entries(const Family& family) {
  return {
      {{.name = family.name,
        .summary = family.integral + " with a control of known integral, lambda given.",
        .description = family.description +
                       " Estimates I = the integral of f by f/p + lambda (J - g/p) (Szecsi, "
                       "Sbert and Szirmay-Kalos 2004): lambda = 0 is importance sampling, 1 "
                       "correlated sampling. Unbiased for every lambda; the variance Var(f/p) + "
                       "lambda^2 Var(g/p) - 2 lambda Cov(f/p, g/p) is least at lambda* = "
                       "Cov(f/p, g/p) / Var(g/p), which may lie outside [0, 1].",
        .parameters = joined(
            family.parameters,
            {number_parameter("lambda",
                              "weight of the control: 0 importance sampling, 1 correlated sampling",
                              "1")})},
       [read = family.read](Parameters& given) {
         return fixed(read(given), given.number("lambda"));
       }},
      {{.name = family.name + "_same_samples",
        .summary = family.integral + " with a control, lambda from the same samples.",
        .description =
            family.description +
            " Estimates I by the mean of f/p + lambda (J - g/p) over M primaries with lambda = "
            "sum d (mean f/p - f/p) / sum d^2, d = J - g/p, from the same primaries. Consistent, "
            "not unbiased: the bias times M tends to -E[(f - I - lambda* (g - J)) (g - J)^2] / "
            "Var g (f, g over p). With `centre: mean` the spread in the denominator is taken "
            "about the samples' mean, as by least squares; where f = g this gives I exactly, "
            "`centre: integral` does not. With one primary, and where g/p does not vary (to "
            "2^-40 of J), lambda is 0.",
        .parameters = joined(family.parameters, rule_parameters()),
        .bias = BiasClass::inverse_primaries,
        .averages = false},
       [read = family.read](Parameters& given) {
         return same_samples(read(given), read_rule(given));
       }},
      {{.name = family.name + "_cross_fitted",
        .summary = family.integral + " with a control, lambda from the other half.",
        .description =
            family.description +
            " Estimates I by the mean of f/p + lambda (J - g/p) over M primaries in two halves, "
            "each with the lambda that the other half gives (see the estimator of the same "
            "samples): lambda is independent of what it multiplies, so the estimate is "
            "unbiased. Fewer than two samples in a half give lambda = 0.",
        .parameters = joined(family.parameters, rule_parameters()),
        .averages = false},
       [read = family.read](Parameters& given) {
         return cross_fitted(read(given), read_rule(given));
       }},
      {{.name = family.name + "_ratio",
        .summary = family.integral + " by weighted importance sampling.",
        .description = family.description +
                       " Estimates I by J sum(f/p) / sum(g/p) over M primaries: the same two "
                       "sums put to use as a ratio. Consistent; biased like 1/M.",
        .parameters = family.parameters,
        .bias = BiasClass::inverse_primaries,
        .averages = false},
       [read = family.read](Parameters& given) { return ratio(read(given)); }}};
}

}  // namespace assay::correlated
