#include "harness/plan/pilot_shape.h"

#include <algorithm>
#include <cmath>

#include "harness/question/question.h"
#include "harness/sampling/summary.h"
#include "harness/theta/gate.h"
#include "harness/theta/methods.h"

namespace assay::harness {
namespace {

// So few values beyond half the way to an end may be none in the test.
constexpr std::ptrdiff_t few_values = 32;

}  // namespace

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

}  // namespace assay::harness
