#include "harness/run/image_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/plan/critical.h"
#include "stats/pyramids/image_pyramid.h"

namespace assay::harness {
namespace {

/// Indices of a window's elements in a question.
std::vector<std::size_t> elements_of(const stats::ImageFinding& finding, const ImageShape& shape) {
  std::vector<std::size_t> elements;
  const stats::Rectangle& window = finding.window;
  for (std::size_t y = window.y; y < window.y + window.height; ++y) {
    for (std::size_t x = window.x; x < window.x + window.width; ++x) {
      elements.push_back((y * shape.width + x) * shape.components.size() + finding.channel);
    }
  }
  return elements;
}

double mean_over(const DrawnTest& test, std::size_t subject,
                 const std::vector<std::size_t>& elements) {
  const Summary& summary = test.samples[subject].summary();
  const std::vector<std::size_t>& channels = test.outcome.question.subjects[subject].channels;
  double sum = 0;
  for (const std::size_t i : elements) sum += summary.moments(channels[i]).mean;
  return sum / static_cast<double>(elements.size());
}

double reference_over(const Question& question, const std::vector<std::size_t>& elements) {
  double sum = 0;
  for (const std::size_t i : elements) sum += question.references[i].value + question.offset;
  return sum / static_cast<double>(elements.size());
}

}  // namespace

ImageTest image_test(const DrawnTest& test) {
  const TestOutcome& outcome = test.outcome;
  const std::vector<Subject>& subjects = outcome.question.subjects;
  return {.share = outcome.share(),
          .smallest_cell = outcome.plan.smallest_cell,
          .weights = outcome.plan.method.frozen.weights,
          .symmetric = outcome.plan.symmetric,
          .independent = std::all_of(subjects.begin(), subjects.end(),
                                     [](const Subject& s) { return s.image->independent; }),
          .flips = test.samples[0].pool().key(),
          .look = outcome.plan.look.get()};
}

ImageViews images_of(const DrawnTest& test, std::size_t subject) {
  return {test.samples[subject].observations(), test.outcome.question.subjects[subject].channels};
}

Gate own_skewness_gate(const ImageOutcome& images) {
  // Normal data exceed it about once in 1e5 tests.
  constexpr double limit = 2;
  const double factor = images.level_factor;
  return gate_of(
      reports::Gate{.name = "skewness of the images, theirs alone",
                    .value = std::isfinite(factor) ? reports::Number(factor) : reports::Number(),
                    .limit = limit,
                    .state = factor <= limit ? "green" : "red"});
}

std::string means_where_it_differs(const DrawnTest& test) {
  const TestOutcome& outcome = test.outcome;
  const Question& question = outcome.question;
  if (outcome.verdict != reports::Verdict::fail || !outcome.channels[0].image) return "";
  const stats::ImageFinding& winner = outcome.channels[0].image->family.winner;
  if (winner.statistic != stats::ImageStatistic::window || winner.window.width == 0) return "";
  const std::vector<std::size_t> elements = elements_of(winner, *question.subjects[0].image);
  const double mean = mean_over(test, 0, elements);
  const double other = question.of_two()
                           ? question.factor * mean_over(test, 1, elements) + question.offset
                           : reference_over(question, elements);
  const std::string part =
      other == 0 ? "" : fmt::format(", {:+.3g} %", 100 * (mean - other) / std::abs(other));
  return fmt::format("; the mean at that place is {:.5g} against {:.5g}{}", mean, other, part);
}

std::optional<double> detectable_uniformly(const TestOutcome& outcome, const TestSize& size,
                                           const ChannelOutcome& channel) {
  if (channel.regions.relation == Relation::within || channel.regions.allow > 0) return {};
  const stats::ImageExtent extent = extent_of(*outcome.question.subjects[0].image);
  const double part = stats::whole_image_share(extent) / static_cast<double>(extent.channels);
  const double z =
      critical_value(size.share.alpha * part, true) + critical_value(size.share.beta, false);
  const double shrunk =
      std::sqrt(static_cast<double>(outcome.secondaries()) / static_cast<double>(size.secondaries));
  const double found = z * channel.image->uniform_error * shrunk;
  if (!std::isfinite(found)) return {};
  return found;
}

}  // namespace assay::harness
