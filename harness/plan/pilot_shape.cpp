#include "harness/plan/pilot_shape.h"

#include <algorithm>
#include <cmath>

#include "harness/question/question.h"
#include "harness/sampling/summary.h"
#include "harness/theta/constant.h"
#include "harness/theta/gate.h"
#include "harness/theta/methods.h"

namespace assay::harness {
namespace {

// 64 pilot points of both sides to a cell.
constexpr stats::CellNumbers plane_cells{.bands = 16, .cuts = 16};
constexpr stats::CellNumbers line_cells{.bands = 64, .cuts = 1};

std::vector<double> pilot_values(const TestOutcome& test, std::size_t subject, std::size_t channel,
                                 const Pilots& pilots) {
  const Subject& side = test.question.subjects[subject];
  if (pilot_of(side, pilots) == nullptr) return {};
  // Rows choose only if no side has a pilot of its own.
  if (is_recorded(side) && !std::ranges::all_of(test.question.subjects, is_recorded)) return {};
  return as_secondaries(side, pilot_channel(test.question, subject, channel, pilots).values,
                        test.plan.primaries[subject]);
}

/// Both sides' pilot points, without draws that yield none.
std::vector<stats::PlanePoint> pilot_points(const TestOutcome& test, const Pilots& pilots) {
  std::vector<stats::PlanePoint> points;
  for (std::size_t subject = 0; subject < test.question.subjects.size(); ++subject) {
    const Subject& side = test.question.subjects[subject];
    const std::vector<double> first = pilot_values(test, subject, 0, pilots);
    const std::vector<double> second = side.channels.size() > 1
                                           ? pilot_values(test, subject, 1, pilots)
                                           : std::vector<double>(first.size(), 0);
    const std::optional<double> none = no_point_of(side);
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (first[i] != none && std::isfinite(first[i]) && std::isfinite(second[i])) {
        points.push_back({first[i], second[i]});
      }
    }
  }
  return points;
}

// So few values beyond half the way to an end may be none in the test.
constexpr std::ptrdiff_t few_values = 32;

}  // namespace

std::string unusable_pilot(const Question& question, const Pilots& pilots) {
  if (question.is().of_single_values) return "";
  for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
    const Subject& side = question.subjects[subject];
    const Pilot* pilot = pilot_of(side, pilots);
    if (pilot == nullptr || pilot->sums->elements || !side.purpose.empty()) continue;
    for (std::size_t channel = 0; channel < side.channels.size(); ++channel) {
      const stats::Moments moments = pilot->moments(side.channels[channel]);
      const std::string reason = beyond_doubles(moments, side.estimator->name);
      if (!reason.empty() && !is_constant(question, subject, channel, moments)) return reason;
    }
  }
  return "";
}

std::vector<Known> known_channels(const TestOutcome& test, const Pilots& pilots) {
  const Question& question = test.question;
  std::vector<Known> all;
  for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
    const Subject& side = question.subjects[subject];
    const Pilot* pilot = pilot_of(side, pilots);
    if (pilot == nullptr || !side.purpose.empty()) continue;
    for (std::size_t channel = 0; channel < side.channels.size(); ++channel) {
      const PilotChannel data = pilot_channel(side, *pilot, channel);
      if (is_constant(question, subject, channel, data.moments)) continue;
      all.push_back({.subject = subject,
                     .channel = channel,
                     .pilot = data,
                     .averaged = side.averaged(test.plan.primaries[subject]),
                     .rows = side.setup->observations().has_value(),
                     .label = ", pilot of " + side.name_of(channel)});
    }
  }
  return all;
}

std::vector<double> as_secondaries(const Subject& side, std::span<const double> values,
                                   std::uint64_t primaries) {
  const std::uint64_t each = side.averages && !is_recorded(side) ? primaries : 1;
  std::vector<double> means;
  for (std::size_t i = 0; i + each <= values.size(); i += each) {
    double sum = 0;
    for (std::uint64_t k = 0; k < each; ++k) sum += values[i + k];
    means.push_back(sum / static_cast<double>(each));
  }
  return means;
}

void note(Plan& plan, const Known& known, const stats::Gate& gate) {
  if (!known.rows) plan.gates.push_back(gate_of(gate, known.label));
}

stats::Gate near_normal_gate(const Known& known) {
  // At the floor of evidence it moves a tail of one per cent by a fifth.
  constexpr double near_normal = 0.3;
  // Normal data exceed the allowance with this probability.
  constexpr double unlikely = 0.01;
  const stats::Moments& moments = known.pilot.moments;
  const double root = std::sqrt(known.averaged);
  const double value = std::abs(moments.skewness()) / root;
  const double allowance =
      stats::normal_skewness_quantile(static_cast<double>(moments.count), unlikely) / root;
  const double limit = std::max(near_normal, allowance);
  return {.name = "skewness of an observation",
          .value = value,
          .low = value,
          .limit = limit,
          .state = value <= limit ? stats::GateState::green : stats::GateState::amber};
}

bool hides(std::span<const double> values, double mean, double end) {
  const double half = mean + (end - mean) / 2;
  return std::ranges::count_if(values, [&](double value) {
           return end > mean ? value >= half : value <= half;
         }) < few_values;
}

bool bets_on_range(const Question& question, const Pilots& pilots) {
  if (question.test->method) return find_method(question, *question.test->method).is.in_range;
  // To reject "too much" takes the low end.
  const Regions regions{.relation = question.test->claim.relation};
  const bool both =
      question.of_two() || regions.two_sided() || (!regions.proof() && question.test->detect);
  const bool needs_high = both || regions.bounds_above() == regions.proof();
  const bool needs_low = both || !needs_high;
  bool hidden = false;
  for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
    const Subject& side = question.subjects[subject];
    const Pilot* const pilot = pilot_of(side, pilots);
    if (pilot == nullptr || !side.purpose.empty() || is_recorded(side)) return false;
    for (std::size_t channel = 0; channel < side.channels.size(); ++channel) {
      const PilotChannel seen = pilot_channel(question, subject, channel, pilots);
      const stats::Range range = range_of(question, subject, channel, seen.moments);
      const bool low = needs_low && !std::isfinite(range.low);
      const bool high = needs_high && !std::isfinite(range.high);
      const bool constant = is_constant(question, subject, channel, seen.moments);
      if (low || high || !(range.low < range.high)) return false;
      // A pilot without finite values shows no mean.
      if (seen.moments.count == 0 || (seen.values.empty() && !constant)) return false;
      if (question.of_two() && !constant) return false;
      const double mean = seen.moments.mean;
      hidden = hidden || constant || (needs_low && hides(seen.values, mean, range.low)) ||
               (needs_high && hides(seen.values, mean, range.high));
    }
  }
  return hidden;
}

void freeze(TestOutcome& test, const Pilots& pilots) {
  if (test.plan.method.keeps != Keeps::points) return;
  std::vector<stats::PlanePoint> points = pilot_points(test, pilots);
  if (points.empty()) {
    test.plan.invalid = Reason("the pilots gave no point to choose cells by");
    return;
  }
  const bool plane = test.question.subjects[0].channels.size() > 1;
  test.plan.method.frozen.cells = std::make_shared<const stats::SampledCells>(
      stats::sampled_cells(std::move(points), plane ? plane_cells : line_cells));
}

}  // namespace assay::harness
