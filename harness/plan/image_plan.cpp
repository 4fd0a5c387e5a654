#include "harness/plan/image_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/base/parallel.h"
#include "harness/image/image_pair.h"
#include "harness/plan/independence.h"
#include "harness/plan/sizes.h"
#include "harness/sampling/image_views.h"
#include "harness/theta/theta.h"
#include "stats/images/image_covariance.h"
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

// Standard errors above the estimate of tr C^2: pilots of heavy noise differ.
constexpr double errors_above = 2;

template <class Real>
PlannedImage pilot_image(const stats::ImageStack<Real>& pilot) {
  const stats::ImageCovariance found = stats::image_covariance(pilot, on_all_threads);
  const double square = found.squared_trace + errors_above * found.squared_trace_error;
  return {.trace = found.trace,
          .root = std::min(found.trace, std::sqrt(square)),
          .squared_norm = found.squared_mean};
}

PlannedImage pilot_image(const Subject& subject, const Pilot& pilot) {
  const ImageViews views(pilot.images, subject.channels);
  return std::visit([](const auto& stack) { return pilot_image(stack); },
                    stack_of(views, extent_of(*subject.image)));
}

/// The noise of differences, and the brightness of what is subtracted.
PlannedImage pilot_of_differences(const Question& question, const Pilots& pilots) {
  std::vector<ChannelData> data(2);
  for (std::size_t s = 0; s < 2; ++s) {
    data[s].images =
        ImageViews(pilot_at(question, s, pilots).images, question.subjects[s].channels);
  }
  return with_pair(question, data, [](const auto& pair) {
    PlannedImage image = pilot_image(pair.first());
    image.squared_norm = stats::image_squared_mean(*pair.subtracted());
    return image;
  });
}

/// The noise of an observation, and the brightness that margins are relative to. The root of two
/// sides is at most the sum of theirs.
PlannedImage planned_image(const Question& question, const Pilots& pilots, const Plan& plan) {
  if (question.is().of_pairs) {
    PlannedImage image = pilot_of_differences(question, pilots);
    image.trace /= averaged(question, plan, 0);
    image.root /= averaged(question, plan, 0);
    return image;
  }
  PlannedImage all;
  for (std::size_t s = 0; s < question.subjects.size(); ++s) {
    const PlannedImage image = pilot_image(question.subjects[s], pilot_at(question, s, pilots));
    const double square = factor_of(question, s) * factor_of(question, s);
    all.trace += square * image.trace / averaged(question, plan, s);
    all.root += square * image.root / averaged(question, plan, s);
    all.squared_norm = square * image.squared_norm;
  }
  return all;
}

/// The squared distance that `n` images exclude with probability 1 - beta if there is none. Let
/// noise have rank d, and s = root / sqrt(d) / n. The squared distance is then s (chi^2 - d), and
/// its jackknife error 2 s chi.
double excluded_square(const PlannedImage& image, double beta, double n) {
  if (!(image.root > 0)) return 0;
  const double degrees = std::pow(image.trace / image.root, 2);
  const double t = -stats::student_t_quantile({stats::Tail::lower, std::log(beta)}, n - 1);
  const double square = stats::chi_square_quantile({stats::Tail::upper, std::log(beta)}, degrees);
  return image.root / std::sqrt(degrees) / n * (square - degrees + 2 * t * std::sqrt(square));
}

/// The square of the margins' unit.
double squared_unit(const Question& question, const PlannedImage& last) {
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
  const bool in_looks = plans_replicates(question) && !question.test->secondaries;
  if (!in_looks || !all_pictured(question, pilots)) return stats::least_replicates;
  // Rows have one look, whose size nothing plans.
  if (!has_rows(question)) plan.image = planned_image(question, pilots, plan);
  return std::min<std::uint64_t>(stats::least_replicates, most);
}

std::optional<std::uint64_t> image_secondaries(const Question& question, const ErrorShare& share,
                                               const Plan& plan) {
  if (!plan.image) return std::nullopt;
  const Regions& regions = plan.regions[0];
  const double margin = *regions.detect;
  const double unit = squared_unit(question, *plan.image);
  const double room = (margin * margin - regions.allow * regions.allow) * unit;
  if (!(room > 0)) return impossible_secondaries;
  std::uint64_t count = stats::least_replicates;
  while (count < impossible_secondaries) {
    if (excluded_square(*plan.image, share.beta, static_cast<double>(count)) <= room) break;
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
