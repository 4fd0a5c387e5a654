#include "reports/words/ledger.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "reports/words/number.h"

namespace assay::reports {
namespace {

/// "2026-11-18 02:00 UTC" of ISO 8601.
std::string minute(std::string date) {
  constexpr std::size_t length = 16;
  if (date.size() < length || date[10] != 'T') return date;
  date[10] = ' ';
  return date.substr(0, length) + " UTC";
}

/// theta and its standard error from the sums.
std::string theta_sentence(const LedgerSeries& series) {
  if (!series.estimate || !series.standard_error) return {};
  const double shared = series.reference_error.value_or(0);
  return fmt::format("{} {}, standard error {}{}, ", series.quantity,
                     with_sign(*series.estimate, series.relative),
                     magnitude(*series.standard_error, series.relative),
                     shared > 0 ? fmt::format(" of the nights and {} of the reference",
                                              magnitude(shared, series.relative))
                                : "");
}

/// True if theta need not have moved since the first night. The likeliest night alone says little:
/// it is the one whose estimates look largest.
bool may_be_from_the_first(const LedgerSeries& series) {
  if (series.nights.empty()) return false;
  const std::string& first = series.nights.front().date;
  return series.moved_from == first || series.moved == first;
}

/// Theta with its 95 % interval, by all nights if it need not have moved. Else by the nights since,
/// each with the weight of its own precision.
Effect effect_now(const LedgerSeries& series) {
  double weights = 0, sum = 0;
  for (const LedgerNight& night : series.nights) {
    const double half = (night.high.value_or(0) - night.low.value_or(0)) / 2;
    if (night.date < series.moved || !is_finite(night.estimate) || !(half > 0)) continue;
    weights += 1 / (half * half);
    sum += *night.estimate / (half * half);
  }
  constexpr double deviations = 1.959963984540054;  // of half a 95 % interval
  const bool all = may_be_from_the_first(series);
  Effect effect{.quantity = series.quantity, .confidence = 0.95, .relative = series.relative};
  effect.estimate = all ? series.estimate : weights > 0 ? sum / weights : Number();
  if (!effect.estimate) return effect;
  const double reach =
      std::hypot(all ? deviations * series.standard_error.value_or(0) : 1 / std::sqrt(weights),
                 deviations * series.reference_error.value_or(0));
  effect.low = *effect.estimate - reach;
  effect.high = *effect.estimate + reach;
  return effect;
}

double distance(const LedgerSeries& series) {
  return series.limit.value_or(0) - series.log_e().value_or(0);
}

}  // namespace

std::string ledger_title(const Ledger& ledger) {
  return fmt::format("Ledger {}: {} in {} (false alarms: at most {} a suite)", ledger.file,
                     counted(static_cast<std::uint64_t>(alarms(ledger)), "alarm", "alarms"),
                     counted(ledger.series.size(), "series", "series"), human(ledger.budget));
}

std::string series_name(const Ledger& ledger, const LedgerSeries& series) {
  const bool alone = std::ranges::count(ledger.series, series.test, &LedgerSeries::test) < 2;
  return alone ? series.test : fmt::format("{} [{}]", series.test, series.channel);
}

std::string e_text(const Number& log_e) {
  if (!log_e) return no_number;
  const double log10_e = *log_e / std::log(10.0);
  if (log10_e >= 2 && log10_e < 6) return fmt::format("{:.0f}", std::exp(*log_e));
  return std::abs(log10_e) < 4 ? human(std::exp(*log_e), 3) : scientific(log10_e);
}

std::string series_sentence(const LedgerSeries& series) {
  if (series.nights.empty()) return "no night yet";
  const std::string& first = series.nights.front().date;
  return fmt::format("{} since {}: {}e-value E = {}, alarm at {}",
                     counted(series.nights.size(), "night", "nights"),
                     first.substr(0, first.find('T')), theta_sentence(series),
                     e_text(series.log_e()), e_text(series.limit));
}

std::string alarm_sentence(const LedgerSeries& series) {
  if (!series.alarm) return {};
  const std::string range = series.moved_from == series.moved_to
                                ? std::string()
                                : fmt::format(" (90\u00A0% sure: {:.16} to {})",
                                              minute(series.moved_from), minute(series.moved_to));
  const Effect now = effect_now(series);
  return fmt::format(
      "{}{}{}. The nights together refute the claim since {}.",
      now.estimate ? fmt::format("The {} is {}. ", effect_name(now), named_effect_text(now)) : "",
      may_be_from_the_first(series)
          ? "It may have been so from the first night on"
          : fmt::format("It moved most likely on the night of {}, by Assay {}",
                        minute(series.moved), series.moved_commit),
      range, minute(series.since));
}

std::string changes(const LedgerSeries& series) {
  const auto moved = std::ranges::find(series.nights, series.moved, &LedgerNight::date);
  if (!series.alarm || moved == series.nights.end() || may_be_from_the_first(series)) return {};
  const std::string& before = std::prev(moved)->commit;
  if (before.empty() || before == moved->commit) return {};
  return fmt::format("git log --oneline {}..{}", before, moved->commit);
}

std::string quiet_sentence(const Ledger& ledger) {
  const LedgerSeries* highest = nullptr;
  std::uint64_t count = 0;
  std::size_t nights = 0;
  for (const LedgerSeries& series : ledger.series) {
    if (series.alarm || series.nights.empty()) continue;
    ++count;
    nights = std::max(nights, series.nights.size());
    if (highest == nullptr || distance(series) < distance(*highest)) highest = &series;
  }
  if (highest == nullptr) return {};
  return fmt::format(
      "{} of up to {} without an alarm; nearest to one is {}, e-value "
      "E = {}, alarm at {}",
      counted(count, "series", "series"), counted(nights, "night", "nights"),
      series_name(ledger, *highest), e_text(highest->log_e()), e_text(highest->limit));
}

std::vector<std::string> ledger_notes(const Ledger& ledger) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<std::string>> names;
  for (const LedgerSeries& series : ledger.series) {
    if (series.note.empty()) continue;
    if (!names.contains(series.note)) order.push_back(series.note);
    names[series.note].push_back(series_name(ledger, series));
  }
  for (std::string& note : order) {
    const std::vector<std::string>& its = names[note];
    const std::string more = its.size() > 1 ? fmt::format(" and {} more", its.size() - 1) : "";
    note = fmt::format("{}{}: {}", its.front(), more, note);
  }
  return order;
}

}  // namespace assay::reports
