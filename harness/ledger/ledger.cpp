#include "harness/ledger/ledger.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "harness/base/locked_file.h"
#include "harness/base/text_file.h"
#include "harness/ledger/ledger_book.h"
#include "harness/ledger/ledger_reading.h"
#include "harness/ledger/night_evidence.h"
#include "harness/theta/theta.h"

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

struct Added {
  bool added = false;
  std::string note;
};

Added add_night(LedgerBook& book, const LedgerRun& ledger, const Entry& entry,
                const LedgerSeries& series, const NightEvidence& night) {
  if (!night.missing.empty()) return {false, "nothing added: " + night.missing};
  if (book.has_seed(series, entry.run.seed)) {
    return {false,
            fmt::format("nothing added: seed {} is in the ledger already and its numbers are "
                        "no news; run with --seed random",
                        entry.run.seed)};
  }
  const std::size_t before = book.series().size();
  const std::size_t index = book.open(series);
  book.add({.date = ledger.date,
            .seed = entry.run.seed,
            .commit = ledger.commit,
            .series = index,
            .evidence = night.evidence,
            .log_e = night.log_e});
  const bool begins = book.series().size() > before && book.generation(index) > 1;
  return {true, begins ? "the claim, its margins or parameters are new, or it was begun anew: a "
                         "new series"
                       : ""};
}

void read_moved(reports::LedgerSeries& result, const LedgerSeries& series,
                const std::vector<LedgerNight>& nights) {
  const Moved change = moved(series, nights);
  result.moved = nights[change.night].date;
  result.moved_commit = nights[change.night].commit;
  result.moved_from = nights[change.from].date;
  result.moved_to = nights[change.to].date;
}

void read_nights(reports::LedgerSeries& result, const LedgerBook& book, std::size_t index,
                 const Entry& entry) {
  const LedgerSeries& series = book.series()[index];
  const std::vector<LedgerNight> nights = book.nights_of(index);
  if (nights.empty()) return;
  const TestOutcome& test = entry.work.outcome;
  const std::vector<double> path =
      log_e_path(series, nights, claimed_range(test.plan.regions[entry.channel]));
  // The weight stays as it was at the beginning: else a change of the suite would raise and lower
  // alarms of past nights.
  const double weight = series.weight > 0 ? series.weight : test.place.weight;
  const double alpha = book.budget() * weight * generation_share(book.generation(index));
  result.nights = nights.size();
  result.first = nights.front().date;
  result.last = nights.back().date;
  result.log_e = path.back();
  result.limit = -std::log(alpha);
  if (series.kind == EvidenceKind::score) {
    stats::Evidence total;
    for (const LedgerNight& night : nights) total += night.evidence;
    result.score = total.score;
    result.information = total.information;
    result.reference_error = series.prior.reference_error;
  }
  if (const auto alarm = stats::first_alarm(path, alpha)) {
    result.alarm = true;
    result.since = nights[*alarm].date;
    read_moved(result, series, nights);
  }
}

reports::LedgerSeries keep(LedgerBook& book, const LedgerRun& ledger, const Entry& entry) {
  const TestOutcome& test = entry.work.outcome;
  NightEvidence night = night_evidence(entry.work, entry.channel, entry.run.pilots);
  const EvidenceKind kind = evidence_kind(test);
  const bool of_moments = kind == EvidenceKind::score;
  LedgerSeries series{.hash = series_hash(entry.work, entry.channel),
                      .kind = kind,
                      .prior = night.prior,
                      .weight = test.place.weight,
                      .test = test.question.test->id,
                      .channel = test.question.channel_name(entry.channel)};
  // The pilot chose the method, so leaving the night out does not bias the series.
  LedgerSeries other = series;
  other.kind = of_moments ? EvidenceKind::log_e : EvidenceKind::score;
  if (book.open_series(series) == nullptr && book.open_series(other) != nullptr) {
    night.missing = fmt::format("its method this time, {}, gives evidence of another kind",
                                test.plan.method.name);
    series.kind = other.kind;
  }
  const Added added = add_night(book, ledger, entry, series, night);
  reports::LedgerSeries result{
      .test = series.test,
      .channel = series.channel,
      .series = series.hash,
      .quantity = of_moments ? test.channels.empty() ? "" : test.channels[0].effect.quantity : "",
      .relative = test.question.theta->is_relative(test.question, entry.channel),
      .added = added.added,
      .note = added.note};
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
