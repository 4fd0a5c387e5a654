#include "stats/planning/boundary.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "stats/basics/check.h"
#include "stats/basics/scores.h"
#include "stats/tails/special.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

// Scores farther than this below their mean change a crossing by a part of 1e-9 at most. Low scores
// make later crossings less likely.
constexpr double reach = 6;
// Above the last bound, in standard deviations.
constexpr double headroom = 3;
// A path's score lies within this many deviations of what the next score lets expect.
constexpr double bridge_reach = 7;

// Gauss-Legendre rule on [-1, 1].
struct Rule {
  std::vector<double> places;
  std::vector<double> weights;
};

Rule gauss_legendre(std::size_t count) {
  Rule rule{std::vector<double>(count), std::vector<double>(count)};
  const auto n = static_cast<double>(count);
  for (std::size_t i = 0; 2 * i < count; ++i) {
    double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (n + 0.5));
    double slope = 1;
    for (int round = 0; round < 4; ++round) {
      double before = 1;
      double value = x;
      for (double degree = 2; degree <= n; ++degree) {
        const double next = ((2 * degree - 1) * x * value - (degree - 1) * before) / degree;
        before = std::exchange(value, next);
      }
      slope = n * (x * value - before) / (x * x - 1);
      x -= value / slope;
    }
    const double weight = 2 / ((1 - x * x) * slope * slope);
    rule.places[i] = -x;
    rule.weights[i] = weight;
    rule.places[count - 1 - i] = x;
    rule.weights[count - 1 - i] = weight;
  }
  return rule;
}

// From one analysis to the next: z' given z is normal with mean correlation z + shift.
struct Step {
  double correlation = 0;
  double deviation = 1;
  double shift = 0;
};

Step step_between(double time, double next, double drift) {
  const double correlation = std::sqrt(time / next);
  return {.correlation = correlation,
          .deviation = std::sqrt(1 - time / next),
          .shift = drift * (std::sqrt(next) - correlation * std::sqrt(time))};
}

// The paths that go on, on a grid of scores.
struct Paths {
  std::vector<double> scores;
  std::vector<double> masses;  // Density times the rule's weight.

  void add_grid(double low, double high, const Rule& rule) {
    if (!(low < high)) return;
    const double half = (high - low) / 2;
    for (std::size_t i = 0; i < rule.places.size(); ++i) {
      scores.push_back(low + half * (1 + rule.places[i]));
      masses.push_back(half * rule.weights[i]);
    }
  }
};

double upper_tail(double z) {
  return std::isinf(z) ? (z > 0 ? 0 : 1) : std::erfc(z * std::numbers::sqrt2 / 2) / 2;
}

double density(double z) {
  return std::exp(-z * z / 2) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
}

// Probabilities of the stops of one score whose law has this mean and deviation.
StopProbabilities stops(const StoppingLook& look, double mean, double deviation) {
  const auto above = [&](double bound) { return upper_tail((bound - mean) / deviation); };
  StopProbabilities found{.above = above(look.above)};
  if (std::isfinite(look.below)) found.below = upper_tail((mean - look.below) / deviation);
  if (look.from < look.to) found.between = above(look.from) - above(look.to);
  return found;
}

Paths grid_of(const StoppingLook& look, double mean, double last_above, const Rule& rule) {
  const double low = std::max(look.below, mean - reach);
  const double highest =
      std::isfinite(last_above) ? std::max(mean + reach, last_above + headroom) : mean + reach;
  const double high = std::min(look.above, highest);
  Paths paths;
  paths.add_grid(low, std::min(look.from, high), rule);
  paths.add_grid(std::max(look.to, low), high, rule);
  return paths;
}

void spread(const Paths& from, const Step& step, Paths& to) {
  const double scale = 1 / step.deviation;
  for (std::size_t j = 0; j < to.scores.size(); ++j) {
    const double z = to.scores[j] - step.shift;
    // Reversed, z is the bridge's mean, too.
    const double centre = step.correlation * z;
    double sum = 0;
    const double width = bridge_reach * step.deviation;
    const std::size_t end = count_below(from.scores, centre + width);
    for (std::size_t i = count_below(from.scores, centre - width); i < end; ++i) {
      const double x = (z - step.correlation * from.scores[i]) * scale;
      sum += from.masses[i] * std::exp(-x * x / 2);
    }
    to.masses[j] *= sum * scale * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
  }
}

// Enough nodes for the narrowest step: a Gaussian of deviation s on a width w needs w / s of them
// and some.
std::size_t nodes_for(std::span<const StoppingLook> looks) {
  double narrowest = 1;
  for (std::size_t k = 1; k < looks.size(); ++k)
    narrowest = std::min(narrowest, std::sqrt(1 - looks[k - 1].time / looks[k].time));
  const double above = looks.back().above;
  const double width = reach + (std::isfinite(above) ? std::max(reach, above + headroom) : reach);
  return 12 + static_cast<std::size_t>(std::min(500.0, 1.4 * width / narrowest));
}

void check_times(const char* function, std::span<const double> times) {
  check::at_least({function, "times"}, times.size(), 1);
  double before = 0;
  for (const double time : times) {
    if (!(time > before) || std::isinf(time))
      check::fail({function, "time"}, time, "finite and above the one before");
    before = time;
  }
}

void check_looks(std::span<const StoppingLook> looks, double drift) {
  std::vector<double> times;
  for (const StoppingLook& look : looks) {
    times.push_back(look.time);
    const bool in_order = look.below <= look.above && look.from <= look.to;
    if (!in_order) check::fail({"stop_probabilities", "bounds"}, look.above, "in order");
  }
  check_times("stop_probabilities", times);
  check::finite({"stop_probabilities", "drift"}, drift);
}

}  // namespace

std::vector<StopProbabilities> stop_probabilities(std::span<const StoppingLook> looks,
                                                  double drift) {
  check_looks(looks, drift);
  const double last_above = looks.back().above;
  // Who searches for a bound asks for the same few rules.
  thread_local std::map<std::size_t, Rule> rules;
  const auto [place, is_new] = rules.try_emplace(looks.size() > 1 ? nodes_for(looks) : 0);
  const auto& [nodes, rule] = *place;
  if (is_new) place->second = gauss_legendre(nodes);
  std::vector<StopProbabilities> found{stops(looks[0], drift * std::sqrt(looks[0].time), 1)};
  Paths paths;
  for (std::size_t k = 1; k < looks.size(); ++k) {
    const double mean = drift * std::sqrt(looks[k - 1].time);
    Paths next = grid_of(looks[k - 1], mean, last_above, rule);
    if (k == 1) {
      for (std::size_t i = 0; i < next.scores.size(); ++i)
        next.masses[i] *= density(next.scores[i] - mean);
    } else {
      spread(paths, step_between(looks[k - 2].time, looks[k - 1].time, drift), next);
    }
    paths = std::move(next);
    const Step step = step_between(looks[k - 1].time, looks[k].time, drift);
    StopProbabilities sum;
    for (std::size_t i = 0; i < paths.scores.size(); ++i) {
      const StopProbabilities part =
          stops(looks[k], step.correlation * paths.scores[i] + step.shift, step.deviation);
      sum.below += paths.masses[i] * part.below;
      sum.between += paths.masses[i] * part.between;
      sum.above += paths.masses[i] * part.above;
    }
    found.push_back(sum);
  }
  return found;
}

WangTsiatis::WangTsiatis(std::span<const double> times, double delta)
    : times_(times.begin(), times.end()) {
  check_times("WangTsiatis", times);
  if (!(delta >= 0 && delta <= 0.5)) check::fail({"WangTsiatis", "delta"}, delta, "in [0, 1/2]");
  for (double& time : times_) {
    time /= times.back();
    shape_.push_back(std::pow(time, delta - 0.5));
  }
}

double WangTsiatis::log_crossing(double constant) const {
  check::finite({"log_crossing", "constant"}, constant);
  constexpr double far = 16;
  if (times_.size() == 1) return normal_upper(constant);
  if (constant > far) {
    std::vector<double> logs;
    for (const double shape : shape_) logs.push_back(normal_upper(constant * shape));
    return special::log_sum_of(logs);
  }
  std::vector<StoppingLook> looks;
  for (std::size_t k = 0; k < times_.size(); ++k)
    looks.push_back({.time = times_[k], .above = constant * shape_[k]});
  double sum = 0;
  for (const StopProbabilities& stop : stop_probabilities(looks)) sum += stop.above;
  return std::min(0.0, std::log(sum));
}

double WangTsiatis::constant(double level) const {
  check::inside_unit({"WangTsiatis::constant", "level"}, level);
  if (times_.size() == 1) return upper_normal_quantile(level);
  const auto excess = [&](double constant) { return std::log(level) - log_crossing(constant); };
  // Times that grow by sqrt 2 count as so many independent ones.
  const double guess = upper_normal_quantile(level / (1 + std::pow(level, 0.2)));
  double old = excess(guess);
  double step = -old * upper_tail(guess) / density(guess);
  double at = guess + step;
  double before = 1e-3 * at;
  // Secants: each error is a small part of the product of the last two steps.
  for (int round = 0; round < 8 && !(std::abs(step * before) <= 1e-13 * at * at); ++round) {
    const double value = excess(at);
    before = std::exchange(step, -value * step / (value - old));
    old = value;
    at += step;
  }
  return at;
}

StoppingLook stopping_look(const TestedRegions& regions, double error, double alpha, double beta) {
  const auto z = [](double level) {
    constexpr double least = 1e-300;
    return upper_normal_quantile(std::max(level, least));
  };
  const bool two = regions.two_sided;
  StoppingLook look{.time = 1 / (error * error),
                    .above = regions.claimed / error + z(two ? alpha / 2 : alpha)};
  const double passes = regions.forbidden ? *regions.forbidden / error - z(beta) : look.above;
  if (two) look.below = -look.above;
  if (two && passes <= 0) return look;
  look.from = two ? std::max(-passes, look.below) : look.below;
  look.to = std::min(passes, look.above);
  return look;
}

Outlook outlook_at(std::span<const StoppingLook> looks, double theta,
                   std::span<const std::uint64_t> sizes) {
  Outlook outlook{.inconclusive = 1, .drawn = 0};
  std::uint64_t before = 0;
  const std::vector<StopProbabilities> stops = stop_probabilities(looks, theta);
  for (std::size_t k = 0; k < stops.size(); ++k) {
    outlook.drawn += outlook.inconclusive * static_cast<double>(sizes[k] - before);
    before = sizes[k];
    outlook.fail += stops[k].above + stops[k].below;
    outlook.pass += stops[k].between;
    outlook.inconclusive = std::max(0.0, 1 - outlook.fail - outlook.pass);
  }
  outlook.drawn /= static_cast<double>(sizes.back());
  return outlook;
}

Outlook together(std::span<const Outlook> channels) {
  Outlook all{.drawn = 0};
  for (const Outlook& each : channels) {
    all.fail += each.fail;
    all.inconclusive += each.inconclusive;
    all.drawn = std::max(all.drawn, each.drawn);
  }
  all.fail = std::min(1.0, all.fail);
  all.inconclusive = std::min(1 - all.fail, all.inconclusive);
  all.pass = 1 - all.fail - all.inconclusive;
  return all;
}

}  // namespace assay::stats
