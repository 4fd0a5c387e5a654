#include "harness/image_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/critical.h"
#include "harness/sample_size.h"
#include "stats/image_equivalence.h"
#include "stats/image_pyramid.h"
#include "stats/tails.h"

namespace assay::harness {
namespace {

constexpr double level_factor = 1.25;

double averaged(const Question& question, const Plan& plan, std::size_t subject) {
  const Subject& side = question.subjects[subject];
  return side.averages ? static_cast<double>(plan.primaries[subject]) : 1;
}

const Pilot& pilot_at(const Question& question, std::size_t subject, const Pilots& pilots) {
  return pilots.at(question.subjects[subject].estimator->name);
}

bool all_piloted(const Question& question, const Pilots& pilots) {
  return std::all_of(question.subjects.begin(), question.subjects.end(), [&](const Subject& side) {
    const Pilot* pilot = pilot_of(side, pilots);
    return pilot != nullptr && pilot->images.size() >= 2 * stats::least_replicates;
  });
}

// ---- Single elements

struct Cumulants {
  double variance = 0;
  double third = 0;
};

/// Of one element's mean over `count` primaries, times the factor.
Cumulants cumulants_of(const stats::Moments& pilot, double count, double factor) {
  if (pilot.count < 3 || !(pilot.m2 > 0)) return {};
  const double variance = pilot.variance();
  const double third = pilot.skewness() * std::pow(variance, 1.5);
  return {factor * factor * variance / count, factor * factor * factor * third / (count * count)};
}

/// The factor by which both tails of Welch's T at x together depart from nominal:
/// cosh(g x^3 / 3), g the skewness of the numerator (stats/assumption_gates.h). The mean over the
/// elements, since their false alarms add up.
double element_factor(const Question& question, const Plan& plan, const Pilots& pilots,
                      std::uint64_t replicates, double x) {
  const std::size_t elements = question.subjects[0].channels.size();
  double sum = 0;
  for (std::size_t i = 0; i < elements; ++i) {
    Cumulants total;
    for (std::size_t s = 0; s < question.subjects.size(); ++s) {
      const Subject& side = question.subjects[s];
      const double count = static_cast<double>(replicates) * averaged(question, plan, s);
      const Cumulants part = cumulants_of(pilot_at(question, s, pilots).channels[side.channels[i]],
                                          count, s == 0 ? 1 : -question.factor);
      total.variance += part.variance;
      total.third += part.third;
    }
    const double skewness = total.variance > 0 ? total.third / std::pow(total.variance, 1.5) : 0;
    sum += std::cosh(skewness * x * x * x / 3);
  }
  return sum / static_cast<double>(elements);
}

/// Where one element must be to be found, at the smallest level of a look.
double element_critical(const Question& question, const FamilyPlace& place) {
  const double elements = static_cast<double>(question.subjects[0].channels.size());
  const double share = stats::whole_image_share(extent_of(*question.subjects[0].image)) / 2;
  return critical_value(smallest_level(question, place) * share / elements, true);
}

// ---- Sizes

/// The images of a pilot, the subject's elements of each.
std::vector<std::vector<double>> images_of(const Subject& subject, const Pilot& pilot) {
  std::vector<std::vector<double>> images;
  for (const std::vector<double>& whole : pilot.images) {
    std::vector<double>& image = images.emplace_back();
    for (const std::size_t channel : subject.channels) image.push_back(whole[channel]);
  }
  return images;
}

/// Noise and brightness of an image at one primary an element.
struct PilotImage {
  double noise = 0;         ///< sqrt(2 tr C^2), C the elements' covariance: R U has it as deviation
  double squared_norm = 0;  ///< of its mean
};

/// The two halves of a pilot have one law: their squared bias is noise alone, of the covariance
/// C (2 / R + 2 / R) in all.
PilotImage pilot_image(const Subject& subject, const Pilot& pilot) {
  const std::vector<std::vector<double>> images = images_of(subject, pilot);
  const stats::ImageExtent extent = extent_of(*subject.image);
  stats::ImageStack<double> halves[2] = {{extent, {}}, {extent, {}}};
  for (std::size_t r = 0; r < images.size() / 2 * 2; ++r) halves[r % 2].images.push_back(images[r]);
  const stats::ImageDistance distance = stats::image_distance(halves[0], halves[1]);
  const double replicates = static_cast<double>(images.size() / 2 * 2);
  return {.noise = std::sqrt(distance.bias_variance) * replicates / 4,
          .squared_norm = distance.squared_norm};
}

/// What margins are in units of, squared.
double squared_unit(const Question& question, const PilotImage& last) {
  if (!is_relative(question, 0)) {
    return static_cast<double>(question.subjects[0].channels.size());
  }
  if (question.of_two()) return question.factor * question.factor * last.squared_norm;
  double sum = 0;
  for (const Constant& reference : question.references) {
    const double value = reference.value + question.offset;
    sum += value * value;
  }
  return sum;
}

}  // namespace

std::uint64_t choose_for_image(const Question& question, const FamilyPlace& place,
                               const Pilots& pilots, std::uint64_t most, Plan& plan) {
  if (!all_piloted(question, pilots)) return stats::least_replicates;
  const bool planned = question.test->detect || question.test->claim.relation == Relation::within;
  std::uint64_t size = planned ? stats::least_replicates : classical_replicates;
  size = std::min(question.test->secondaries.value_or(size), most);
  const double x = element_critical(question, place);
  const double factor = element_factor(question, plan, pilots, size, x);
  plan.single_elements = factor <= level_factor;
  plan.gates.push_back(
      {.name = "skewness of single pixels, pilot",
       .value = std::isfinite(factor) ? reports::Number(factor) : reports::Number(),
       .limit = level_factor,
       // Answered by leaving them out.
       .state = plan.single_elements ? "green" : "amber"});
  return stats::least_replicates;
}

std::optional<std::uint64_t> image_secondaries(const Question& question, const ErrorShare& share,
                                               const Pilots& pilots, const Plan& plan) {
  const Regions& regions = plan.regions[0];
  const bool within = regions.relation == Relation::within;
  if ((!within && !regions.detect) || !all_piloted(question, pilots)) return std::nullopt;
  const double margin = within ? regions.within : *regions.detect;
  double noise = 0;
  PilotImage last;
  for (std::size_t s = 0; s < question.subjects.size(); ++s) {
    last = pilot_image(question.subjects[s], pilot_at(question, s, pilots));
    const double factor = s == 0 ? 1 : question.factor;
    noise += factor * factor * last.noise / averaged(question, plan, s);
  }
  const double unit = squared_unit(question, last);
  const double room = (margin * margin - regions.allow * regions.allow) * unit;
  if (!(room > 0)) return impossible_secondaries;
  std::uint64_t count = stats::least_replicates;
  while (count < impossible_secondaries) {
    const double n = static_cast<double>(count);
    const double t = -stats::student_t_quantile({stats::Tail::lower, std::log(share.beta)}, n - 1);
    if (2 * t * noise / n <= room) break;
    count += count / 8 + 1;
  }
  return std::min(count, impossible_secondaries);
}

std::string too_few_replicates(const Question& question, const Plan& plan) {
  const std::uint64_t most = plan.most_secondaries();
  if (question.kind != QuestionKind::image || most >= stats::least_replicates) return "";
  return fmt::format(
      "{} images are too few: each pixel's variance comes from them alone, and it takes {} of them "
      "to tell any pixel among {} from its reference; take {} `secondaries` or more, with fewer "
      "`primaries` if need be",
      most, stats::least_replicates, question.subjects[0].channels.size(), stats::least_replicates);
}

}  // namespace assay::harness
