#include "stats/bounded_process.h"

#include <algorithm>
#include <cmath>

#include "stats/check.h"
#include "stats/special.h"

namespace assay::stats {
namespace {

double width_of(Range range) { return range.high - range.low; }

// The first two moments of (x - low) / width.
Moments on_unit_scale(const Moments& x, Range range) {
  const double width = width_of(range);
  Moments unit;
  unit.count = x.count;
  unit.mean = std::clamp((x.mean - range.low) / width, 0.0, 1.0);
  unit.m2 = x.m2 / width / width;
  return unit;
}

// The imagined value before the first: 1/2, with the largest variance there is.
constexpr double prior_mean = 0.5;
constexpr double prior_variance = 0.25;

double forecast_mean(const Moments& seen) {
  const double n = static_cast<double>(seen.count);
  return (prior_mean + n * seen.mean) / (n + 1);
}

double forecast_variance(const Moments& seen) {
  return (prior_variance + seen.m2) / (static_cast<double>(seen.count) + 1);
}

}  // namespace

BoundedProcess::BoundedProcess(BoundedDesign design) : design_(design) {
  check::finite({"BoundedProcess", "low"}, design.range.low);
  check::finite({"BoundedProcess", "high"}, design.range.high);
  check::positive({"BoundedProcess", "high - low"}, width_of(design.range));
  check::inside_unit({"BoundedProcess", "error"}, design.error);
}

double BoundedProcess::next_bet(double block_count) const {
  const double n = static_cast<double>(seen_.count) + block_count;
  const double planned = static_cast<double>(design_.planned_count);
  const double horizon = planned > 0 ? std::max(n, planned) : n * std::log1p(n);
  const double bet =
      std::sqrt(2 * std::log(2 / design_.error) / (horizon * forecast_variance(seen_)));
  return std::min(0.5, bet);
}

void BoundedProcess::add(const Moments& block) {
  if (block.count == 0) return;
  const Range range = design_.range;
  if (!(block.minimum >= range.low)) {
    check::fail({"BoundedProcess::add", "minimum"}, block.minimum, "inside the range");
  }
  if (!(block.maximum <= range.high)) {
    check::fail({"BoundedProcess::add", "maximum"}, block.maximum, "inside the range");
  }
  const Moments unit = on_unit_scale(block, range);
  const double n = static_cast<double>(unit.count);
  const double bet = next_bet(n);
  const double surprise = unit.mean - forecast_mean(seen_);
  stakes_ += bet * n;
  winnings_ += bet * n * unit.mean;
  variation_ += (-std::log1p(-bet) - bet) * (unit.m2 + n * surprise * surprise);
  seen_.merge(unit);
}

double BoundedProcess::centre() const {
  if (seen_.count == 0) check::fail({"BoundedProcess", "count"}, seen_.count, "at least 1");
  return winnings_ / stakes_;
}

TestResult BoundedProcess::result(double null_mean) const {
  check::finite({"BoundedProcess::result", "null_mean"}, null_mean);
  const auto [low, high] = design_.range;
  const double drift = stakes_ * (centre() - (null_mean - low) / width_of(design_.range));
  const double mean = low + width_of(design_.range) * seen_.mean;
  TestResult result{mean - null_mean, {"bound", {}}, 0, 0, Exactness::exact};
  result.log_p_lower =
      null_mean > high ? special::lowest_log() : special::clamp_log(variation_ + drift);
  result.log_p_upper =
      null_mean < low ? special::lowest_log() : special::clamp_log(variation_ - drift);
  return result;
}

Interval BoundedProcess::interval(double confidence) const {
  check::inside_unit({"BoundedProcess::interval", "confidence"}, confidence);
  const double middle = centre();
  const double half = (variation_ - std::log((1 - confidence) / 2)) / stakes_;
  const auto [low, high] = design_.range;
  const double width = width_of(design_.range);
  return {std::max(low, low + width * (middle - half)),
          std::min(high, low + width * (middle + half)), confidence};
}

}  // namespace assay::stats
