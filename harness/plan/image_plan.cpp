#include "harness/plan/image_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/base/parallel.h"
#include "harness/plan/critical.h"
#include "harness/plan/frozen.h"
#include "harness/plan/repeated_images.h"
#include "harness/plan/rows.h"
#include "harness/plan/secondaries.h"
#include "harness/sampling/difference_skewness.h"
#include "harness/sampling/image_views.h"
#include "harness/theta/planned_channel.h"
#include "harness/theta/theta.h"
#include "stats/images/image_cell_skewness.h"
#include "stats/images/image_equivalence.h"
#include "stats/pyramids/image_pyramid.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

// Limit for one replicate's pixels. A pilot's weights answer more skewness; else the test is
// invalid.
constexpr double most_skewed = 2;
// Largest first look; only the looks that follow take more.
constexpr std::uint64_t most_first_look = 1024;

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

// ---- Skewness

/// Mean over the varying elements of |skewness of one replicate's difference|. A side with more
/// replicates enters as the mean of several.
double mean_skewness(const Question& question, const Plan& plan, const Pilots& pilots,
                     std::uint64_t look) {
  if (plan.look) return plan.look->skewness;
  const std::size_t elements = question.subjects[0].channels.size();
  std::vector<const Pilot*> pilot;
  std::vector<double> in_one;
  for (std::size_t s = 0; s < question.subjects.size(); ++s) {
    pilot.push_back(&pilot_at(question, s, pilots));
    in_one.push_back(averaged(question, plan, s) * times_the_fewest(question, s, look));
  }
  double sum = 0;
  double varying = 0;
  for (std::size_t i = 0; i < elements; ++i) {
    std::vector<SkewedSide> sides;
    for (std::size_t s = 0; s < question.subjects.size(); ++s) {
      sides.push_back(
          {pilot[s]->moments(question.subjects[s].channels[i]), in_one[s], factor_of(question, s)});
    }
    const std::optional<double> skewness = difference_skewness(sides);
    sum += skewness.value_or(0);
    varying += skewness ? 1 : 0;
  }
  return varying > 0 ? sum / varying : 0;
}

/// A pilot's weights keep the mean of every sum at zero, and leaving out cells answers their
/// skewness. Halves that weigh each other see too little of skewed pixels for either.
void judge_skewness(const Question& question, const Pilots& pilots, std::uint64_t look,
                    Plan& plan) {
  const double skewness = mean_skewness(question, plan, pilots, look);
  const bool too_skewed = skewness > most_skewed;
  const bool answered = !plan.method.frozen.weights.empty();
  plan.gates.push_back(gate_of(reports::Gate{.name = "skewness of an image's pixels, pilot",
                                             .value = skewness,
                                             .limit = most_skewed,
                                             .state = !too_skewed ? "green"
                                                      : answered  ? "amber"
                                                                  : "red"}));
  if (!too_skewed || answered || question.test->method) return;
  plan.invalid = fmt::format(
      "the pixels of one image are too skewed ({:.2g} on average, limit {:g}) for sums over them "
      "to keep their level; take {:.2g} times as many samples a picture, with fewer pictures if "
      "need be",
      skewness, most_skewed, std::ceil(std::pow(skewness / most_skewed, 2) + 1));
}

// ---- Cells

std::string cells_text(std::uint32_t size, const ImageShape& shape) {
  if (size == 1) return "single pixels";
  if (size >= std::max(shape.width, shape.height)) return "the whole image";
  return fmt::format("cells of {0} x {0} pixels", size);
}

/// True if cells of a size keep their level. The pilot's own scatter does not count against them.
bool keeps_level(const stats::CellTails& tails, double limit = level_factor) {
  return tails.common <= limit && tails.factor <= limit + tails.scatter;
}

/// The factor that speaks more against cells of a size.
struct ShownFactor {
  double value;
  double limit;
};

ShownFactor shown_factor(const stats::CellTails& tails, double limit = level_factor) {
  if (tails.common > limit) return {tails.common, limit};
  return {tails.factor, limit + tails.scatter};
}

/// A mean of skewness g adds about g^2 to the mean of its studentised square: sqrt(2 elements) g^2
/// standard deviations of their sum. Few replicates underestimate g, so only a tenth is tolerated.
bool keeps_squares(const stats::CellTails& elements, std::size_t count) {
  const double skewness = elements.common_skewness;
  return std::sqrt(2 * static_cast<double>(count)) * skewness * skewness <= 0.1;
}

/// The smallest cells that keep their level, as all larger ones do. Notes their gate and those of
/// smaller cells, which are left out.
std::uint32_t smallest_cell(const std::vector<stats::CellTails>& tails, const ImageShape& shape,
                            Plan& plan) {
  std::size_t kept = tails.size() - 1;
  while (kept > 0 && keeps_level(tails[kept - 1])) --kept;
  for (std::size_t i = 0; i <= kept; ++i) {
    const ShownFactor shown = shown_factor(tails[i]);
    plan.gates.push_back(gate_of(reports::Gate{
        .name = fmt::format("skewness of {}, pilot", cells_text(tails[i].size, shape)),
        .value = std::isfinite(shown.value) ? reports::Number(shown.value) : reports::Number(),
        .limit = shown.limit,
        .state = keeps_level(tails[i]) ? "green" : "amber"}));
  }
  return tails[kept].size;
}

/// A margin is shown by the unbiased squared bias: products of two replicates' differences, summed
/// over N elements. Let V be the variance of a mean, g its skewness. The sum has variance 2 N V^2
/// and third cumulant N V^3 (8 + 4 g^2). Rare lights leave it near zero until two fall on one
/// element. To its skewness g adds 4 g^2 / sqrt(8 N). At the critical value x that may raise the
/// tail by the level factor, exp(skewness x^3 / 3).
bool keeps_margin(const stats::CellTails& elements, std::size_t count, double critical) {
  const double skewness = elements.common_skewness;
  const double added = 4 * skewness * skewness / std::sqrt(8 * static_cast<double>(count));
  return added * critical * critical * critical / 3 <= std::log(level_factor);
}

/// Makes the claim invalid if not even the whole image's sum keeps its level. The sum has a share
/// of the level: its limit lets the family's false alarms grow by a quarter.
void require_whole_image(const stats::CellTails& whole, const stats::ImageExtent& extent,
                         Plan& plan) {
  const double limit = 1 + (level_factor - 1) / stats::whole_image_share(extent);
  if (keeps_level(whole, limit) || !plan.gates_invalidate || !plan.invalid.empty()) return;
  const ShownFactor shown = shown_factor(whole, limit);
  plan.gates.back().value =
      std::isfinite(shown.value) ? reports::Number(shown.value) : reports::Number();
  plan.gates.back().limit = shown.limit;
  plan.gates.back().state = "red";
  plan.invalid =
      "rare bright pixels (fireflies) carry so much of the images that not even their sums over "
      "all pixels keep their level: take more samples a picture, or more pictures";
}

void refuse_margin(Plan& plan) {
  if (!plan.gates_invalidate || !plan.invalid.empty()) return;
  plan.invalid =
      "rare bright pixels (fireflies) carry so much of the images that these would seem to agree "
      "until two of them fall on one pixel: take more samples a picture, or more pictures; without "
      "`detect` or `within` differences alone are looked for";
}

stats::AnyImageStack stack_of(const ImageViews& views, const stats::ImageExtent& extent) {
  if (views.single_precision()) return stats::ImageStack<float>{extent, views.images<float>()};
  return stats::ImageStack<double>{extent, views.images<double>()};
}

/// The pilots as sides of a comparison of one replicate, or as many as are set.
class PilotSides {
 public:
  PilotSides(const Question& question, const Plan& plan, const Pilots& pilots) {
    for (std::size_t s = 0; s < question.subjects.size(); ++s) {
      const Subject& subject = question.subjects[s];
      images_.emplace_back(pilot_at(question, s, pilots).images, subject.channels);
      averaged_.push_back(averaged(question, plan, s));
      sides_.push_back({.stack = stack_of(images_.back(), extent_of(*subject.image)),
                        .factor = factor_of(question, s),
                        .replicates = averaged_.back()});
    }
  }
  PilotSides(const PilotSides&) = delete;  // spans point inside
  PilotSides& operator=(const PilotSides&) = delete;

  void set_replicates(const Question& question, std::uint64_t look) {
    for (std::size_t s = 0; s < sides_.size(); ++s) {
      sides_[s].replicates =
          static_cast<double>(question.subjects[s].secondaries(look)) * averaged_[s];
    }
  }
  std::span<const stats::CellPilot> sides() const { return sides_; }

 private:
  std::vector<ImageViews> images_;
  std::vector<double> averaged_;  // Primaries of an image's pixel.
  std::vector<stats::CellPilot> sides_;
};

struct Replicates {
  std::uint64_t first = 0;
  std::uint64_t most = 0;
};

/// Chooses the cells that take part; the whole image always does. Returns the replicates of the
/// first look: `first`, or in looks as many more as the whole image's sum needs.
std::uint64_t choose_cells(const Question& question, const FamilyPlace& place, const Pilots& pilots,
                           const Replicates& replicates, Plan& plan) {
  const auto note = [&](const std::vector<stats::CellTails>& tails) {
    plan.smallest_cell = smallest_cell(tails, *question.subjects[0].image, plan);
    plan.symmetric = keeps_squares(tails.front(), question.subjects[0].channels.size());
    require_whole_image(tails.back(), extent_of(*question.subjects[0].image), plan);
  };
  if (plan.look) {
    note(plan.look->tails);
    return replicates.first;
  }
  const double level = smallest_level(question, place);
  const double critical = critical_value(smallest_share(question, place.share.beta), false);
  const auto from = plan.method.frozen.weights.empty() ? stats::WeightsFrom::halves_of_the_test
                                                       : stats::WeightsFrom::pilot;
  PilotSides pilot(question, plan, pilots);
  for (std::uint64_t count = replicates.first;; count *= 2) {
    pilot.set_replicates(question, count);
    const std::vector<stats::CellTails> tails =
        stats::cell_tails(pilot.sides(), level, from, on_all_threads);
    const bool shows = !plans_replicates(question) ||
                       keeps_margin(tails.front(), question.subjects[0].channels.size(), critical);
    if ((keeps_level(tails.back()) && shows) || 2 * count > replicates.most) {
      note(tails);
      if (!shows) refuse_margin(plan);
      return count;
    }
  }
}

// ---- Replicates

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

/// The square of the margins' unit.
double squared_unit(const Question& question, const PilotImage& last) {
  if (!question.theta->is_relative(question, 0)) {
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

std::vector<double> image_weights(const Question& question, const Pilots& pilots,
                                  const Plan& plan) {
  if (has_rows(question) || !all_pictured(question, pilots)) return {};
  // Both sides have as many replicates: the number is a common factor.
  return stats::cell_weights(PilotSides(question, plan, pilots).sides());
}

bool plans_replicates(const Question& question) {
  return question.test->detect || question.test->claim.relation == Relation::within;
}

std::uint64_t usual_replicates(const Question& question, std::uint64_t most) {
  const std::uint64_t size =
      plans_replicates(question) ? stats::least_replicates : classical_replicates;
  return std::min(question.test->secondaries.value_or(size), most);
}

std::uint64_t choose_for_image(const Question& question, const FamilyPlace& place,
                               const Pilots& pilots, std::uint64_t most, Plan& plan) {
  if (const Pilot* const pilot = pilot_of(question.subjects[0], pilots)) plan.look = pilot->look;
  if (!all_pictured(question, pilots)) return stats::least_replicates;
  const std::uint64_t size = usual_replicates(question, most);
  freeze(question, pilots, plan);
  note_repeated_images(question, pilots, plan);
  judge_skewness(question, pilots, largest_look(question, most), plan);
  const bool in_looks = plans_replicates(question) && !question.test->secondaries;
  const std::uint64_t largest = in_looks ? std::min(most, most_first_look) : size;
  const std::uint64_t first =
      choose_cells(question, place, pilots, {.first = size, .most = largest}, plan);
  return in_looks ? first : stats::least_replicates;
}

std::optional<std::uint64_t> image_secondaries(const Question& question, const ErrorShare& share,
                                               const Pilots& pilots, const Plan& plan) {
  const Regions& regions = plan.regions[0];
  const bool within = regions.relation == Relation::within;
  if ((!within && !regions.detect) || !all_pictured(question, pilots)) return std::nullopt;
  const double margin = within ? regions.within : *regions.detect;
  double noise = 0;
  PilotImage last;
  for (std::size_t s = 0; s < question.subjects.size(); ++s) {
    last = pilot_image(question.subjects[s], pilot_at(question, s, pilots));
    const double factor = factor_of(question, s);
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
