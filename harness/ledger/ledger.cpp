#include "harness/ledger/ledger.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <variant>

#include "harness/base/locked_file.h"
#include "harness/base/text_file.h"
#include "harness/ledger/ledger_book.h"
#include "harness/ledger/night_evidence.h"
#include "harness/theta/theta.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

LedgerBook read_ledger(const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return LedgerBook();
  const std::string text = read_text_file(file);
  // A run that ended before its first night was written leaves an empty file.
  if (text.empty()) return LedgerBook();
  return LedgerBook::parse(text, file);
}

struct Entry {
  const SuiteRun& run;
  const TestWork& work;
  std::size_t channel;
};

/// Adds a night to the open series, or to one that it opens.
void add_night(LedgerBook& book, const LedgerRun& ledger, const Entry& entry,
               const LedgerSeries& series, const NightValue& value, reports::LedgerSeries& result) {
  if (book.has_seed(series, entry.run.seed)) {
    result.note = fmt::format(
        "nothing added: seed {} is in the ledger already and its numbers are "
        "no news; run with --seed random",
        entry.run.seed);
    return;
  }
  const LedgerSeries* open = book.open_series(series);
  if (open != nullptr && open->has_estimates() != series.has_estimates()) {
    result.note = "nothing added: its method this time gives evidence of another kind";
    return;
  }
  const bool begins = open == nullptr;
  const std::size_t index = book.open(series);
  book.add({.date = ledger.date,
            .seed = entry.run.seed,
            .commit = ledger.commit,
            .series = index,
            .value = value});
  result.added = true;
  if (!begins || book.generation(index) == 1) return;
  result.note = "the claim, its margins or parameters are new, or it was begun anew: a new series";
}

void read_moved(reports::LedgerSeries& result, const LedgerSeries& series,
                const std::vector<LedgerNight>& nights, const ThetaRange& claimed) {
  const Moved change = moved(series, nights, claimed);
  result.moved = nights[change.night].date;
  result.moved_commit = nights[change.night].commit;
  result.moved_from = nights[change.from].date;
  result.moved_to = nights[change.to].date;
}

/// A night as the report shows it.
void read_value(reports::LedgerNight& result, const stats::NightEstimate& night) {
  const double reach = stats::upper_normal_quantile(0.025) * night.standard_error;
  result.estimate = night.difference;
  result.low = night.difference - reach;
  result.high = night.difference + reach;
}
void read_value(reports::LedgerNight& result, const NightPValue& night) {
  result.log_p = night.log_p;
}

void read_nights(reports::LedgerSeries& result, const LedgerBook& book, std::size_t index,
                 const Entry& entry) {
  const LedgerSeries& series = book.series()[index];
  const std::vector<LedgerNight> nights = book.nights_of(index);
  if (nights.empty()) return;
  const ThetaRange claimed = entry.work.outcome.plan.regions[entry.channel].claimed();
  const std::vector<double> path = log_e_path(series, nights, claimed);
  // The weight stays as it was at the beginning: else a change of the suite would raise and lower
  // alarms of past nights.
  const double alpha = book.budget() * series.weight * generation_share(book.generation(index));
  for (std::size_t i = 0; i < nights.size(); ++i) {
    reports::LedgerNight& night = result.nights.emplace_back();
    night.date = nights[i].date;
    night.commit = nights[i].commit;
    night.log_e = path[i];
    std::visit([&](const auto& value) { read_value(night, value); }, nights[i].value);
  }
  result.limit = -std::log(alpha);
  if (series.has_estimates()) {
    const stats::PooledNights pooled = pooled_nights(nights);
    result.estimate = pooled.difference();
    result.standard_error = std::sqrt(pooled.variance());
    result.reference_error = *series.reference_error;
  }
  if (const auto alarm = stats::first_alarm(path, alpha)) {
    result.alarm = true;
    result.since = nights[*alarm].date;
    read_moved(result, series, nights, claimed);
  }
}

/// The name of theta, if the test has one.
std::string quantity_of(const TestOutcome& test) {
  if (test.channels.empty() || test.channels[0].evidence.distance) return "";
  return test.channels[0].effect.quantity;
}

reports::LedgerSeries keep(LedgerBook& book, const LedgerRun& ledger, const Entry& entry) {
  const TestOutcome& test = entry.work.outcome;
  LedgerSeries series{.hash = series_hash(entry.work, entry.channel),
                      .weight = test.place.weight,
                      .test = test.question.test->id,
                      .channel = test.question.channel_name(entry.channel)};
  reports::LedgerSeries result{
      .test = series.test,
      .channel = series.channel,
      .series = series.hash,
      .quantity = quantity_of(test),
      .relative = test.question.theta->is_relative(test.question, entry.channel)};
  const auto night = night_evidence(entry.work, entry.channel);
  if (const auto* none = std::get_if<NoEvidence>(&night)) {
    result.note = "nothing added: " + none->why;
  } else {
    const auto& evidence = std::get<NightEvidence>(night);
    if (std::holds_alternative<stats::NightEstimate>(evidence.value)) {
      series.reference_error = evidence.reference_error;
    }
    add_night(book, ledger, entry, series, evidence.value, result);
  }
  if (const LedgerSeries* open = book.open_series(series)) {
    read_nights(result, book, static_cast<std::size_t>(open - book.series().data()), entry);
  }
  return result;
}

}  // namespace

void require_ledger(const std::string& file, const std::vector<Suite>& suites) {
  std::set<std::string> stems;
  for (const Suite& suite : suites) {
    if (stems.insert(suite.stem).second) continue;
    throw InputError({.file = suite.file},
                     fmt::format("two suites are named `{}`: a ledger could not tell their tests "
                                 "apart; rename one, or run them with ledgers of their own",
                                 suite.stem));
  }
  const std::filesystem::path path(file);
  if (path.has_parent_path() && !std::filesystem::is_directory(path.parent_path())) {
    throw InputError({.file = file}, "its folder does not exist; make it first");
  }
  read_ledger(file);
}

reports::Ledger add_to_ledger(const LedgerRun& ledger,
                              const std::vector<std::unique_ptr<SuiteRun>>& runs) {
  const LockedFile lock(ledger.file);
  LedgerBook book = read_ledger(ledger.file);
  const bool is_new = std::filesystem::file_size(ledger.file) == 0;
  reports::Ledger result{.file = ledger.file, .budget = book.budget()};
  const std::size_t before = book.nights().size();
  for (const auto& run : runs) {
    for (const TestWork& work : run->tests) {
      if (!work.outcome.place.inside) continue;
      for (std::size_t channel = 0; channel < work.outcome.question.channel_count(); ++channel) {
        result.series.push_back(keep(book, ledger, {*run, work, channel}));
      }
    }
  }
  if (is_new || book.nights().size() > before) lock.replace(book.text());
  return result;
}

}  // namespace assay::harness
