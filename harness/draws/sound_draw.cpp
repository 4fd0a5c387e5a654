#include "harness/draws/sound_draw.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>

#include "reports/words/number.h"
#include "stats/basics/adaptive_quadrature.h"

namespace assay::harness {
namespace {

// Ample for single precision and fast reciprocal roots; a direction that was never normalised is
// off by more.
constexpr double least_length_slack = 1e-4;
// About ten roundings of single precision.
constexpr double least_slack = 1e-6;
constexpr double single_rounding = std::numeric_limits<float>::epsilon();

std::string in_words(const Sampler& sampler, const Point& p) {
  if (sampler.domain() == Domain::interval) return fmt::format("{}", p[0]);
  return fmt::format("({})", fmt::join(std::span(p).first(coordinates(sampler.domain())), ", "));
}

std::string domain_in_words(const Sampler& sampler) {
  const auto [low, high] = sampler.bounds();
  if (sampler.domain() == Domain::interval) return fmt::format("interval [{}, {}]", low, high);
  constexpr const char* others[] = {"square (u and v from 0 to 1)",
                                    "triangle (u >= 0, v >= 0, u + v <= 1)", "hemisphere (z >= 0)",
                                    "sphere"};
  return others[static_cast<int>(sampler.domain()) - 1];
}

/// Moves a coordinate that is at most `slack` outside the range to its border. False if it is
/// farther out.
bool settle(double& x, stats::Span range, double slack) {
  if (!(x >= range.low - slack && x <= range.high + slack)) return false;
  x = std::clamp(x, range.low, range.high);
  return true;
}

/// Settles all coordinates of a point. u + v may exceed 1 by rounding: cells allow for it.
bool settle(Point& p, const Sampler& sampler) {
  const double slack = std::max(least_slack, sampler.rounding());
  const Domain domain = sampler.domain();
  if (domain == Domain::interval) {
    const auto [low, high] = sampler.bounds();
    // Single precision rounds the bounds themselves.
    const double rounding = single_rounding * std::max(std::abs(low), std::abs(high));
    return settle(p[0], {low, high}, slack * (high - low) + rounding);
  }
  if (domain == Domain::sphere) return true;
  if (domain == Domain::hemisphere) return settle(p[2], {0, 2}, slack);
  if (domain == Domain::triangle && !(p[0] + p[1] <= 1 + slack)) return false;
  return settle(p[0], {0, 1}, slack) && settle(p[1], {0, 1}, slack);
}

[[noreturn]] void refuse_draw(const NamedSampler& named, const std::string& words) {
  throw std::runtime_error(fmt::format("sampler `{}` drew {}", named.name, words));
}

/// True for nearly all draws. The closer look asks the sampler questions that may cost more than
/// the draw. |length - 1| <= |length^2 - 1|.
bool is_plainly_sound(Domain domain, const SamplerDraw& draw) {
  if (draw.lobe != 0 || !(draw.density >= 0)) return false;
  const auto& [x, y, z] = draw.point;
  if (has_directions(domain)) {
    return (z >= 0 || domain == Domain::sphere) &&
           std::abs(x * x + y * y + z * z - 1) <= least_length_slack;
  }
  const bool in_square = x >= 0 && x <= 1 && y >= 0 && y <= 1;
  return domain != Domain::interval && in_square && (domain == Domain::square || x + y <= 1);
}

}  // namespace

SamplerDraw sound(const NamedSampler& named, SamplerDraw draw) {
  const Sampler& sampler = *named.sampler;
  if (is_plainly_sound(sampler.domain(), draw)) return draw;
  const int lobes = sampler.lobes();
  if (draw.lobe < 0 || draw.lobe >= lobes) {
    refuse_draw(named, fmt::format("from lobe {}, and declares {}", draw.lobe, lobes));
  }
  if (!draw.valid) return draw;
  const Point drawn = draw.point;
  const auto& [x, y, z] = drawn;
  const double length = has_directions(sampler.domain()) ? std::sqrt(x * x + y * y + z * z) : 1;
  if (!(std::abs(length - 1) <= std::max(least_length_slack, sampler.rounding()))) {
    refuse_draw(named, fmt::format("{}, whose length is {:.6g}: a direction must have length 1",
                                   in_words(sampler, drawn), length));
  }
  if (!settle(draw.point, sampler)) {
    refuse_draw(named, fmt::format("{}, outside its {}", in_words(sampler, drawn),
                                   domain_in_words(sampler)));
  }
  if (draw.density < 0 && !(sampler.point_mass(draw.lobe) > 0)) {
    refuse_draw(named, fmt::format("{} with density {}: a density must be >= 0",
                                   in_words(sampler, draw.point), reports::human(draw.density, 3)));
  }
  return draw;
}

double sound_density(const NamedSampler& named, const Point& point, double density) {
  if (density >= 0 && std::isfinite(density)) return density;
  throw std::domain_error(fmt::format(
      "sampler `{}` declares the density {} at {}: a density must be non-negative and finite",
      named.name, reports::human(density, 3), in_words(*named.sampler, point)));
}

}  // namespace assay::harness
