#include "harness/image_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimators/stream.h"
#include "harness/inversion.h"
#include "harness/parallel.h"
#include "stats/errors.h"
#include "stats/image_equivalence.h"
#include "stats/image_pyramid.h"
#include "stats/image_sign_flip.h"
#include "stats/image_sums.h"
#include "stats/moments.h"
#include "stats/tails.h"

namespace assay::harness {
namespace {

// This share of the level goes to elements that never varied.
constexpr double unseen_share = 0.02;
// Sign vectors are enumerated for so few replicates, some milliseconds' work; for more of them a
// random choice is looked at, and never of more vectors or longer ones: an eighth of a second's
// work. So many that reach the sum of squares tell its p-value to a tenth.
constexpr std::size_t most_enumerated = 18;
constexpr double most_flips = 0x1p19;
constexpr std::size_t most_flipped = 64;
constexpr std::uint64_t enough_flips = 100;

// ---- theta = 0

using Images = std::vector<std::vector<double>>;

/// Means of the images r, r + count, r + 2 count, …: as good as the images themselves for flipping
/// signs, and there are at most `count` of them.
template <class Real>
Images grouped(const stats::ImageStack<Real>& stack, std::size_t count) {
  const std::size_t groups = std::min(count, stack.images.size());
  Images means(groups, std::vector<double>(stack.extent.elements()));
  for (std::size_t g = 0; g < groups; ++g) {
    const std::size_t members = (stack.images.size() - g + groups - 1) / groups;
    const std::span<const Real> first = stack.images[0];
    for (std::size_t r = g; r < stack.images.size(); r += groups) {
      for (std::size_t i = 0; i < means[g].size(); ++i) {
        // From the first image on: the mean of a constant is that constant, without rounding.
        const double difference = double{stack.images[r][i]} - double{first[i]};
        means[g][i] += difference / static_cast<double>(members);
      }
    }
    for (std::size_t i = 0; i < means[g].size(); ++i) means[g][i] += first[i];
  }
  return means;
}

stats::ImageStack<double> stack_of(const stats::ImageExtent& extent, const Images& images) {
  stats::ImageStack<double> stack{extent, {}};
  for (const std::vector<double>& image : images) stack.images.emplace_back(image);
  return stack;
}

template <class Real>
stats::FlipMatrix flips_of(const stats::ImageStack<Real>& a, const stats::ImageReference& b) {
  if (a.images.size() <= most_flipped) return stats::flip_matrix(a, b, on_all_threads);
  const Images first = grouped(a, most_flipped);
  return stats::flip_matrix(stack_of(a.extent, first), b, on_all_threads);
}

template <class Real>
stats::FlipMatrix flips_of(const stats::ImageStack<Real>& a, const stats::ImageStack<Real>& b) {
  if (std::max(a.images.size(), b.images.size()) <= most_flipped) {
    return stats::flip_matrix(a, b, on_all_threads);
  }
  const Images first = grouped(a, most_flipped);
  const Images second = grouped(b, most_flipped);
  return stats::flip_matrix(stack_of(a.extent, first), stack_of(b.extent, second), on_all_threads);
}

template <class Real>
bool has_error(const stats::ImageStack<Real>&) {
  return false;
}
bool has_error(const stats::ImageReference& b) { return !b.standard_error.empty(); }

/// The smallest p-value that flips of signs can have.
double least_log_p(std::size_t replicates, double flips) {
  return replicates <= most_enumerated ? -std::log(2.0) * static_cast<double>(replicates - 1)
                                       : -std::log1p(flips);
}

/// The sum of squares of correlated elements joins the family by flips of signs; or takes no part,
/// where so few replicates, or so small a level, leave nothing to reject, and where other sums say
/// more than any flips could.
template <class Real>
void add_flipped_energy(const VaryingPart<Real>& varying, const ImageTest& test,
                        ImageOutcome& outcome) {
  // A reference's error does not flip with the replicates: cells alone are left.
  if (varying.with([](const auto&, const auto& b) { return has_error(b); })) return;
  const double share = test.share.alpha * stats::energy_share;
  const std::size_t replicates = std::min(most_flipped, varying.first().images.size());
  const double flips = std::ceil(4 / share);
  if (static_cast<double>(replicates) < 2 + std::log2(1 / share)) return;
  if (replicates > most_enumerated && flips > most_flips) return;
  if (least_log_p(replicates, flips) >= stats::energy_notice(outcome.family)) return;
  const stats::FlipMatrix matrix =
      varying.with([](const auto& a, const auto& b) { return flips_of(a, b); });
  Stream random(stream_key(test.flips.bits, "sign flips", "", 0), varying.first().images.size());
  random.draw_ahead();
  const stats::FlipPlan plan{share, static_cast<std::uint64_t>(flips), enough_flips};
  const stats::SignFlip flip = replicates <= most_enumerated
                                   ? stats::sign_flip(matrix, share)
                                   : stats::sign_flip(matrix, plan, random);
  outcome.by_sign_flips = true;
  stats::add_energy(outcome.family, varying.first().extent, flip.log_p);
}

template <class Real>
void look_at_family(const VaryingPart<Real>& varying, const ImageTest& test,
                    ImageOutcome& outcome) {
  outcome.z.resize(varying.first().extent.elements());
  const stats::PyramidOptions options{.energy = test.independent,
                                      .smallest = test.smallest_cell,
                                      .weights = test.weights,
                                      .z = outcome.z,
                                      .for_each = on_all_threads};
  outcome.family = varying.with(
      [&](const auto& a, const auto& b) { return stats::image_pyramid(a, b, options); });
  if (!test.independent) add_flipped_energy(varying, test, outcome);
}

stats::ImageFinding finding_of(const UnseenElement& unseen, const stats::ImageExtent& extent) {
  stats::ImageFinding finding = stats::certain_finding(extent, unseen.element, unseen.sign);
  finding.log_p = unseen.log_p;
  finding.z = z_of(unseen);
  const double elements = static_cast<double>(extent.elements());
  finding.adjusted_log_p = std::min(0.0, unseen.log_p + std::log(elements / unseen_share));
  return finding;
}

/// The elements that never varied join the family, at the share that was set aside for them.
void add_unseen(const stats::ImageExtent& extent, ImageOutcome& outcome) {
  stats::ImageFamily& family = outcome.family;
  for (stats::ImageFinding& group : family.groups) {
    group.adjusted_log_p = std::min(0.0, group.adjusted_log_p - std::log1p(-unseen_share));
  }
  const auto least = std::min_element(
      outcome.unseen.begin(), outcome.unseen.end(),
      [](const UnseenElement& a, const UnseenElement& b) { return a.log_p < b.log_p; });
  if (least != outcome.unseen.end()) family.groups.push_back(finding_of(*least, extent));
  stats::decide(family);
}

// ---- theta beyond 0

template <class Real>
stats::ImageDistance distance_of(const ImagePair<Real>& pair, bool relative) {
  const stats::ImageDistance distance = pair.with([](const auto& first, const auto& second) {
    return stats::image_distance(first, second, on_all_threads);
  });
  if (!relative) {
    return stats::with_norm(distance, static_cast<double>(pair.extent().elements()));
  }
  if (!(distance.squared_norm > 0)) {
    throw std::domain_error(
        "the image that it is held against is zero within its noise, and a margin in per cent of "
        "it means nothing; give the margin as a number");
  }
  return distance;
}

double mean_over(std::span<const double> image) {
  double sum = 0;
  for (const double value : image) sum += value;
  return sum / static_cast<double>(image.size());
}

template <class Real>
stats::Moments means_of(const stats::ImageStack<Real>& stack) {
  const double elements = static_cast<double>(stack.extent.elements());
  stats::Moments moments;
  for (const double sum : stats::image_sums(stack, on_all_threads)) moments.add(sum / elements);
  return moments;
}

/// Standard error of theta for a difference that is the same, or in proportion, everywhere.
template <class Real>
double uniform_error(const ImagePair<Real>& pair, bool relative) {
  double error = means_of(pair.first()).standard_error();
  double mean = 0;
  if (pair.of_two()) {
    const stats::Moments second = means_of(pair.second());
    error = std::hypot(error, second.standard_error());
    mean = second.mean;
  } else {
    mean = mean_over(pair.reference().value);
  }
  return relative ? error / std::abs(mean) : error;
}

/// Replicates at which theta would be excluded from `margin` on: the squared bias's standard error
/// falls like 1 / R while it is noise, like 1 / sqrt R where there is a bias.
double wanted_replicates(const stats::ImageDistance& distance, double margin, const ImageTest& test,
                         double replicates) {
  const double estimate = std::max(0.0, distance.squared_bias / distance.squared_norm);
  const double room = margin * margin - estimate;
  if (!(room > 0)) return 0;
  const double t =
      -stats::student_t_quantile({stats::Tail::lower, std::log(test.share.beta)}, distance.degrees);
  const double needed = (t + 1) * std::sqrt(distance.bias_variance) / distance.squared_norm / room;
  return replicates * std::max({1.1, needed, estimate > 0 ? needed * needed : 0.0});
}

/// Tests of a squared margin. An estimate below zero excludes no more than one of zero would: a
/// bias smaller than none is excluded by no one.
stats::TestResult at_squared_margin(const stats::ImageDistance& distance, double margin) {
  stats::ImageDistance at_least_zero = distance;
  at_least_zero.squared_bias = std::max(0.0, distance.squared_bias);
  stats::TestResult result = stats::squared_margin_test(distance, margin);
  result.log_p_lower = stats::squared_margin_test(at_least_zero, margin).log_p_lower;
  return result;
}

stats::Interval interval_of(const stats::ImageDistance& distance, double confidence) {
  const double step = std::sqrt(distance.bias_variance) / distance.squared_norm;
  const stats::Interval squared = interval_by_inversion(
      [&](double margin) { return at_squared_margin(distance, margin); },
      {.estimate = distance.squared_bias / distance.squared_norm, .step = step}, confidence);
  return {std::sqrt(std::max(0.0, squared.low)), std::sqrt(std::max(0.0, squared.high)),
          confidence};
}

/// What the pair shows, and how far it is apart.
template <class Real>
stats::ImageDistance look_at(const Question& question, const ImageTest& test,
                             const ImagePair<Real>& pair, ImageOutcome& outcome) {
  stats::check::replicates("image", pair.replicates());
  const bool relative = is_relative(question, 0);
  const stats::ImageDistance distance = distance_of(pair, relative);
  const VaryingPart varying(question, pair);
  if (!varying.any() || !(distance.bias_variance > 0)) {
    throw stats::ZeroVariance(
        "every replicate of both images is the same: without spread nothing can be said of what "
        "was never seen; take fewer `primaries`, or more observations");
  }
  outcome.unseen = varying.unseen();
  outcome.replicates = pair.replicates();
  outcome.smallest_cell = test.smallest_cell;
  look_at_family(varying, test, outcome);
  for (const UnseenElement& unseen : outcome.unseen) outcome.z[unseen.element] = z_of(unseen);
  add_unseen(pair.extent(), outcome);
  outcome.uniform_error = uniform_error(pair, relative);
  return distance;
}

std::string range_text(std::uint32_t first, std::uint32_t count, const char* name) {
  if (count == 1) return fmt::format("{} {}", name, first);
  return fmt::format("{}s {}-{}", name, first, first + count - 1);
}

}  // namespace

std::string place_text(const stats::ImageFinding& finding, const ImageShape& shape) {
  const std::string component =
      shape.components.size() > 1 ? " of " + shape.components[finding.channel] : "";
  const std::string z = fmt::format("z = {:+.3g}", finding.z);
  const stats::Rectangle& window = finding.window;
  switch (finding.statistic) {
    case stats::ImageStatistic::energy:
      return fmt::format("the sum of squares over the whole image{}, {}", component, z);
    case stats::ImageStatistic::alternating: {
      constexpr const char* patterns[] = {"columns in turn", "rows in turn", "a checkerboard"};
      return fmt::format("the whole image{} with alternating signs ({}), {}", component,
                         patterns[static_cast<int>(finding.alternation)], z);
    }
    case stats::ImageStatistic::window:
      break;
  }
  if (window.width == 1 && window.height == 1) {
    return fmt::format("pixel x {}, y {}{}, {}", window.x, window.y, component, z);
  }
  if (window.width == shape.width && window.height == shape.height) {
    return fmt::format("the whole image{}, {}", component, z);
  }
  return fmt::format("{}, {}{} ({} x {} pixels), {}", range_text(window.x, window.width, "column"),
                     range_text(window.y, window.height, "row"), component, window.width,
                     window.height, z);
}

ImageEvidence evidence_of_images(const Question& question, const ImageTest& test,
                                 std::span<const ChannelData> data) {
  const bool relative = is_relative(question, 0);
  ImageEvidence result;
  const stats::ImageDistance distance = with_pair(question, data, [&](const auto& pair) {
    return look_at(question, test, pair, result.outcome);
  });
  const TestEntry& entry = *question.test;
  const bool within = entry.claim.relation == Relation::within;
  if (within || entry.detect) {
    const double margin = within ? entry.claim.margin.value : entry.detect->value;
    result.outcome.wanted =
        wanted_replicates(distance, margin, test, static_cast<double>(result.outcome.replicates));
  }
  const stats::ImageFamily& family = result.outcome.family;
  const stats::TestResult equal{
      .statistic = family.winner.z,
      .distribution = {"image-family", {static_cast<double>(family.tested)}},
      .log_p_lower = 0,
      .log_p_upper = family.log_p,
      .exactness = stats::Exactness::asymptotic};
  result.evidence = {
      .estimate = std::sqrt(std::max(0.0, distance.squared_bias / distance.squared_norm)),
      .at =
          [distance, equal](double theta) {
            return theta > 0 ? at_squared_margin(distance, theta * theta) : equal;
          },
      .interval = [distance](double confidence) { return interval_of(distance, confidence); },
      .quantity = relative ? "relative root mean square difference of the images"
                           : "root mean square difference of the images",
      .relative = relative,
      .distance = true};
  return result;
}

}  // namespace assay::harness
