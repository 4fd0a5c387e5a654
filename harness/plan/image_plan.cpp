#include "harness/plan/image_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/base/parallel.h"
#include "harness/image/image_pair.h"
#include "harness/plan/repeated_images.h"
#include "harness/plan/secondaries.h"
#include "harness/sampling/image_views.h"
#include "harness/theta/planned_channel.h"
#include "harness/theta/theta.h"
#include "stats/images/image_equivalence.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

double averaged(const Question& question, const Plan& plan, std::size_t subject) {
  const Subject& side = question.subjects[subject];
  return side.averages ? static_cast<double>(plan.primaries[subject]) : 1;
}

double factor_of(const Question& question, std::size_t subject) {
  return subject == 0 ? 1 : -question.factor;
}

const Pilot& pilot_at(const Question& question, std::size_t subject, const Pilots& pilots) {
  return pilots.at(question.subjects[subject].estimator->name);
}

bool all_pictured(const Question& question, const Pilots& pilots) {
  return std::all_of(question.subjects.begin(), question.subjects.end(), [&](const Subject& side) {
    const Pilot* pilot = pilot_of(side, pilots);
    return pilot != nullptr && pilot->image_count() >= stats::least_replicates;
  });
}

stats::AnyImageStack stack_of(const ImageViews& views, const stats::ImageExtent& extent) {
  if (views.single_precision()) return stats::ImageStack<float>{extent, views.images<float>()};
  return stats::ImageStack<double>{extent, views.images<double>()};
}

/// Noise and brightness of an image at one primary an element.
struct PilotImage {
  double noise = 0;         ///< sqrt(2 tr C^2), the deviation of R U; C is the elements' covariance
  double squared_norm = 0;  ///< Squared norm of the mean.
};

/// Both halves of a pilot have one law: their squared bias is noise alone, with covariance C (2 / R
/// + 2 / R).
template <class Real>
PilotImage pilot_image(const stats::ImageStack<Real>& pilot) {
  stats::ImageStack<Real> half[2] = {{pilot.extent, {}}, {pilot.extent, {}}};
  const std::size_t used = pilot.images.size() / 2 * 2;
  for (std::size_t r = 0; r < used; ++r) half[r % 2].images.push_back(pilot.images[r]);
  const stats::ImageDistance distance = stats::image_distance(half[0], half[1], on_all_threads);
  return {.noise = std::sqrt(distance.bias_variance) * static_cast<double>(used) / 4,
          .squared_norm = distance.squared_norm};
}

PilotImage pilot_image(const Subject& subject, const Pilot& pilot) {
  const ImageViews views(pilot.images, subject.channels);
  return std::visit([](const auto& stack) { return pilot_image(stack); },
                    stack_of(views, extent_of(*subject.image)));
}

/// The noise of differences, and the brightness of what is subtracted.
PilotImage pilot_of_differences(const Question& question, const Pilots& pilots) {
  std::vector<ChannelData> data(2);
  for (std::size_t s = 0; s < 2; ++s) {
    data[s].images =
        ImageViews(pilot_at(question, s, pilots).images, question.subjects[s].channels);
  }
  return with_pair(question, data, [](const auto& pair) {
    return PilotImage{.noise = pilot_image(pair.first()).noise,
                      .squared_norm = pilot_image(*pair.subtracted()).squared_norm};
  });
}

/// The noise of an observation, and the brightness that margins are relative to.
PilotImage planned_image(const Question& question, const Pilots& pilots, const Plan& plan) {
  if (question.test->paired) {
    PilotImage image = pilot_of_differences(question, pilots);
    image.noise /= averaged(question, plan, 0);
    return image;
  }
  PilotImage image;
  double noise = 0;
  for (std::size_t s = 0; s < question.subjects.size(); ++s) {
    image = pilot_image(question.subjects[s], pilot_at(question, s, pilots));
    const double factor = factor_of(question, s);
    noise += factor * factor * image.noise / averaged(question, plan, s);
  }
  image.noise = noise;
  image.squared_norm *= question.of_two() ? question.factor * question.factor : 1;
  return image;
}

/// The square of the margins' unit.
double squared_unit(const Question& question, const PilotImage& last) {
  if (!question.theta->is_relative(question, 0)) {
    return static_cast<double>(question.subjects[0].channels.size());
  }
  if (question.of_two()) return last.squared_norm;
  double sum = 0;
  for (const Constant& reference : question.references) {
    const double value = reference.value + question.offset;
    sum += value * value;
  }
  return sum;
}

}  // namespace

bool plans_replicates(const Question& question) {
  return question.test->detect || question.test->claim.relation == Relation::within;
}

std::uint64_t choose_for_image(const Question& question, const Pilots& pilots, std::uint64_t most,
                               Plan& plan) {
  if (const Pilot* const pilot = pilot_of(question.subjects[0], pilots)) plan.look = pilot->look;
  note_repeated_images(question, pilots, plan);
  const bool in_looks = plans_replicates(question) && !question.test->secondaries;
  if (!in_looks || !all_pictured(question, pilots)) return stats::least_replicates;
  return std::min<std::uint64_t>(stats::least_replicates, most);
}

std::optional<std::uint64_t> image_secondaries(const Question& question, const ErrorShare& share,
                                               const Pilots& pilots, const Plan& plan) {
  const Regions& regions = plan.regions[0];
  const bool within = regions.relation == Relation::within;
  if ((!within && !regions.detect) || !all_pictured(question, pilots)) return std::nullopt;
  const double margin = within ? regions.within : *regions.detect;
  const PilotImage image = planned_image(question, pilots, plan);
  const double unit = squared_unit(question, image);
  const double room = (margin * margin - regions.allow * regions.allow) * unit;
  if (!(room > 0)) return impossible_secondaries;
  std::uint64_t count = stats::least_replicates;
  while (count < impossible_secondaries) {
    const double n = static_cast<double>(count);
    const double t = -stats::student_t_quantile({stats::Tail::lower, std::log(share.beta)}, n - 1);
    if (2 * t * image.noise / n <= room) break;
    count += count / 8 + 1;
  }
  return std::min(count, impossible_secondaries);
}

std::string too_few_replicates(const Question& question, const Plan& plan) {
  const std::uint64_t fewest = fewest_secondaries(question, plan.most_secondaries());
  if (fewest >= stats::least_replicates) return "";
  const std::string mend =
      question.test->budget
          ? "give a larger `budget`, of which every pixel and component takes its `primaries`, or "
            "fewer of these"
          : fmt::format("take {} `secondaries` or more, with fewer `primaries` if need be",
                        stats::least_replicates);
  return fmt::format(
      "{} images are too few: each pixel's variance comes from them alone, and it takes {} of them "
      "to tell any pixel among {} from its reference; {}",
      fewest, stats::least_replicates, question.subjects[0].channels.size(), mend);
}

}  // namespace assay::harness
