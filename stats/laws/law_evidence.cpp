#include "stats/laws/law_evidence.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>

#include "stats/means/binomial.h"

namespace assay::stats {
namespace {

/// Says which part decides: the estimate may be another's.
std::string decisive_part(const std::string& part, double difference) {
  std::ostringstream text;
  text << part << " decide: their shares are " << std::setprecision(4) << difference << " apart";
  return text.str();
}

/// Evidence about a sup distance, which is less than 1.
Evidence from_distance(double distance, const TestResult& equal,
                       const std::function<TestResult(double)>& margin) {
  const double largest = std::nextafter(1.0, 0.0);
  return distance_evidence({.quantity = "largest distance between distribution functions",
                            .estimate = distance,
                            .equal = equal,
                            .at = [=](double theta) { return margin(std::min(theta, largest)); },
                            .start = std::max(distance, 1e-9),
                            .largest = largest,
                            .beyond = 1});
}

/// The law's table leaves the distance uncertain by `error`.
Evidence from_law(const OneSampleDistance& measured, double error) {
  OneSampleDistance least = measured;
  OneSampleDistance most = measured;
  least.distance = std::max(0.0, measured.distance - error);
  most.distance = std::min(1.0, measured.distance + error);
  return from_distance(measured.distance, kolmogorov_smirnov(least), [=](double theta) {
    TestResult result = ks_margin(least, theta);
    result.log_p_lower = ks_margin(most, theta).log_p_lower;
    return result;
  });
}

Evidence from_samples(std::span<const double> x, std::span<const double> y) {
  const TwoSampleDistance distance = ks_distance(x, y);
  const TwoLawsTest at_none = two_part_ks(x, y, distance);
  Evidence evidence = from_distance(distance.distance(), at_none.result, [distance](double theta) {
    return ks_margin(distance, theta);
  });
  // The bound of a margin may reach 0 where the exact test rejects it. The interval is open there.
  evidence.interval = [closed = evidence.interval, at = evidence.at](double confidence) {
    Interval found = closed(confidence);
    if (found.low == 0 && at(0).log_p_upper < std::log((1 - confidence) / 2))
      found.low = std::numeric_limits<double>::min();
    return found;
  };
  if (at_none.common && at_none.common->decides) {
    std::ostringstream part;
    part << "the values at " << at_none.common->value;  // in 6 digits
    const std::string of_value = decisive_part(part.str(), at_none.common->difference);
    evidence.most_against = [of_value](double theta) { return theta <= 0 ? of_value : ""; };
  }
  return evidence;
}

TwoValued no_point_or_point(const Points& points) {
  return {.range = {0, 1}, .high = {.successes = points.missing(), .trials = points.draws}};
}

/// theta is the difference of the probabilities of no point.
Evidence from_probabilities(const Points& x, const Points& y) {
  const TwoValued one = no_point_or_point(x);
  const TwoValued other = no_point_or_point(y);
  const auto share = [](const Points& p) {
    return static_cast<double>(p.missing()) / static_cast<double>(p.draws);
  };
  return {.estimate = share(x) - share(y),
          .at =
              [=](double theta) {
                return two_valued_contrast(one, other, {.scale = 1, .offset = theta});
              },
          .interval =
              [=](double confidence) {
                return two_valued_difference_interval(one, other, confidence);
              }};
}

// Bound on the rounding of ln p.
constexpr double rounding_of_log_p = 1e-6;

/// theta = the larger distance, of points or of the masses without one. Bonferroni rejects "at
/// most" if either part does at half the level. Intersection of unions rejects "at least" if both
/// do.
Evidence larger_of(const Evidence& points, const Evidence& missing) {
  const auto at = [points, missing](double theta) {
    const TestResult one = points.at(theta);
    const TestResult other = missing.at(theta);
    TestResult result = other.log_p_upper < one.log_p_upper ? other : one;
    result.log_p_upper = std::min(0.0, result.log_p_upper + std::numbers::ln2);
    result.log_p_lower = std::max(one.log_p_lower, other.log_p_lower);
    return result;
  };
  const auto interval = [points, missing](double confidence) -> Interval {
    const double halved = 1 - (1 - confidence) / 2;
    Interval both{points.interval(halved).low, points.interval(confidence).high, confidence};
    // One test shows where the other interval cannot matter. To compute it takes some hundred.
    if (missing.at(both.low).log_p_upper <= std::log(1 - halved) + rounding_of_log_p) {
      both.low = std::max(both.low, missing.interval(halved).low);
    }
    if (missing.at(both.high).log_p_lower >= std::log((1 - confidence) / 2) - rounding_of_log_p) {
      both.high = std::max(both.high, missing.interval(confidence).high);
    }
    return both;
  };
  return {
      .estimate = std::max(points.estimate, missing.estimate),
      .at = at,
      .interval = interval,
      .most_against = [points, missing](double theta) -> std::string {
        const double of_masses = missing.at(theta).log_p_upper;
        return of_masses < points.at(theta).log_p_upper
                   ? decisive_part("the masses without a point", missing.estimate)
                   : "";
      },
      .quantity =
          "largest distance between distribution functions, or between the masses without a point",
      .distance = true};
}

void require_points(const Points& points) {
  if (points.sorted.empty()) {
    throw std::domain_error("no draw yielded a point: there is nothing to compare");
  }
}

}  // namespace

Evidence points_against_law(const Points& points, const DeclaredLaw& declared) {
  require_points(points);
  const Evidence rest = from_law(ks_distance(points.sorted, declared.law), declared.error);
  if (declared.missing == 0 && points.missing() == 0) return rest;
  const Successes missing{.successes = points.missing(), .trials = points.draws};
  const Evidence excess = probability_evidence(missing, -declared.missing, declared.missing_error);
  return larger_of(rest, absolute(excess));
}

Evidence points_against_points(const Points& x, const Points& y) {
  require_points(x);
  require_points(y);
  const Evidence rest = from_samples(x.sorted, y.sorted);
  if (!x.of_a_sampler && !y.of_a_sampler) return rest;
  return larger_of(rest, absolute(from_probabilities(x, y)));
}

}  // namespace assay::stats
