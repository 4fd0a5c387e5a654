#include "harness/ledger/ledger.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "harness/base/identity.h"
#include "harness/base/text_file.h"
#include "harness/theta/theta.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

const ChannelOutcome* outcome_of(const TestOutcome& test, std::size_t channel) {
  const auto found = std::ranges::find(test.channels, channel, &ChannelOutcome::index);
  return found == test.channels.end() ? nullptr : &*found;
}

// The kurtosis of squared normal values, for families that do not tell.
constexpr double usual_kurtosis = 15;

/// The night's weight and number, by the first side that is drawn in this run.
stats::NightEstimate sized(const TestOutcome& test, const ThetaError& error) {
  const std::vector<Subject>& sides = test.question.subjects;
  const auto drawn = std::ranges::find_if_not(sides, is_recorded);
  const auto i = static_cast<std::size_t>(drawn - sides.begin());
  const double secondaries = static_cast<double>(test.secondaries(i));
  return {.difference = *error.estimate,
          .standard_error = error.drawn,
          .observations = secondaries * static_cast<double>(test.plan.primaries[i]),
          .effective = std::max(1.0, error.effective.value_or(secondaries / usual_kurtosis))};
}

/// The error that an interval shows; nullopt without two ends, or if it holds more than one run's.
std::optional<ThetaError> error_of_interval(const Question& question, std::size_t channel,
                                            const Evidence& evidence) {
  const bool shares = has_rows(question) || (!question.references.empty() &&
                                             question.references[channel].standard_error > 0);
  if (shares) return std::nullopt;
  constexpr double one_standard_deviation = 0.6826894921370859;
  const stats::Interval interval = evidence.interval(one_standard_deviation);
  const double half = (interval.high - interval.low) / 2;
  if (!std::isfinite(half)) return std::nullopt;
  return ThetaError{.drawn = half};
}

NightEvidence of_estimate(const DrawnTest& drawn, std::size_t channel) {
  const Question& question = drawn.outcome.question;
  const std::vector<ChannelData> data = data_of(drawn, channel);
  std::optional<ThetaError> error = question.theta->error({question, channel, data});
  const ChannelOutcome* outcome = outcome_of(drawn.outcome, channel);
  if (outcome != nullptr) {
    if (!error) error = error_of_interval(question, channel, outcome->evidence);
    if (error) error->estimate = outcome->evidence.estimate;
  }
  if (!error) return {.obstacle = "no error of its estimate is known"};
  if (!error->estimate) return {.obstacle = "its observations have no spread"};
  return {.value = sized(drawn.outcome, *error), .reference_error = error->fixed};
}

std::string margin_text(const std::optional<Margin>& margin) {
  return margin ? to_string(*margin) : "none";
}

std::string side_text(const TestWork& work, std::size_t subject, std::size_t channel) {
  const Subject& side = work.outcome.question.subjects[subject];
  const PreparedEstimator& estimator = *side.estimator;
  std::string text = fmt::format(
      "\n{} {} {} {}", estimator.entry->information.name, estimator.parameters,
      estimator.primaries ? fmt::format("{}", *estimator.primaries) : "auto", side.purpose);
  if (!is_recorded(side)) return text;
  const Sample sample = work.sample(subject);
  if (const Drawn* const rows = std::get_if<Drawn>(&sample)) {
    const stats::Moments moments = rows->summary().moments(side.channels[channel]);
    text += fmt::format(" {} {} {}", moments.count, moments.mean, moments.m2);
  }
  return text;
}

constexpr double zeta_3 = 1.2020569031595942;
constexpr double credibility = 0.9;

/// The values of nights, all of this kind.
template <class Kind>
std::vector<Kind> values_of(const std::vector<LedgerNight>& nights) {
  return mapped(nights, [](const LedgerNight& night) { return std::get<Kind>(night.value); });
}

/// The null hypothesis at the nearest value that the claim allows.
stats::NullTheta nearest(const stats::Range& claimed, const stats::PooledNights& pooled,
                         const LedgerSeries& series) {
  return {.value = std::clamp(pooled.difference(), claimed.low, claimed.high),
          .reference_error = *series.reference_error};
}

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
void add_night(LedgerBook& book, const reports::Record& record, const Entry& entry,
               const LedgerSeries& series, const NightValue& value, reports::LedgerSeries& result) {
  if (book.has_seed(series, entry.run.seed)) {
    result.note = fmt::format(
        "nothing added: the ledger already has seed {}, so its numbers are not new; run with "
        "--seed random",
        entry.run.seed);
    return;
  }
  const std::optional<std::size_t> open = book.open_series(series);
  if (open && book.series()[*open].has_estimates() != series.has_estimates()) {
    result.note = "nothing added: its method this time gives evidence of another kind";
    return;
  }
  const std::size_t index = book.open(series);
  book.add({.date = record.started,
            .seed = entry.run.seed,
            .commit = record.tool.commit,
            .series = index,
            .value = value});
  result.added = true;
  if (open || book.generation(index) == 1) return;
  result.note = "the claim, its margins or parameters are new, or it was begun anew: a new series";
}

/// An estimate as the report shows it, added to those before it.
void read_estimate(reports::LedgerNight& result, const stats::NightEstimate& night,
                   stats::PooledNights& pooled) {
  pooled.add(night);
  result.mean = pooled.difference();
  const double reach = stats::upper_normal_quantile(0.025) * night.standard_error;
  result.estimate = night.difference;
  result.low = night.difference - reach;
  result.high = night.difference + reach;
}

void read_nights(reports::LedgerSeries& result, const LedgerBook& book, std::size_t index,
                 const Entry& entry) {
  const LedgerSeries& series = book.series()[index];
  const std::vector<LedgerNight> nights = book.nights_of(index);
  if (nights.empty()) return;
  const stats::Range claimed = entry.work.outcome.plan.regions[entry.channel].claimed();
  const std::vector<double> path = log_e_path(series, nights, claimed);
  // The weight stays as it was at the beginning: else a change of the suite would raise and lower
  // alarms of past nights.
  const double alpha = book.budget() * series.weight * generation_share(book.generation(index));
  stats::PooledNights pooled;
  for (std::size_t i = 0; i < nights.size(); ++i) {
    reports::LedgerNight& night = result.nights.emplace_back();
    night.date = nights[i].date;
    night.commit = nights[i].commit;
    night.log_e = path[i];
    if (const auto* const log_p = std::get_if<NightLogP>(&nights[i].value)) {
      night.log_p = *log_p;
    } else {
      read_estimate(night, std::get<stats::NightEstimate>(nights[i].value), pooled);
    }
  }
  result.limit = -std::log(alpha);
  if (series.has_estimates()) {
    result.estimate = pooled.difference();
    result.standard_error = std::sqrt(pooled.variance());
    result.reference_error = *series.reference_error;
  }
  if (const auto alarm = stats::first_alarm(path, alpha)) {
    const Moved change = moved(series, nights, claimed);
    result.alarm = true;
    result.since = nights[*alarm].date;
    result.moved = nights[change.night].date;
    result.moved_commit = nights[change.night].commit;
    result.moved_from = nights[change.from].date;
    result.moved_to = nights[change.to].date;
  }
}

reports::LedgerSeries keep(LedgerBook& book, const reports::Record& record, const Entry& entry) {
  const TestOutcome& test = entry.work.outcome;
  LedgerSeries series{.hash = series_hash(entry.work, entry.channel),
                      .weight = test.place.weight,
                      .test = test.question.test->id,
                      .channel = test.question.channel_name(entry.channel)};
  reports::LedgerSeries result{
      .test = series.test,
      .channel = series.channel,
      .series = series.hash,
      .relative = test.question.theta->is_relative(test.question, entry.channel)};
  if (!test.channels.empty() && !test.channels[0].evidence.distance)
    result.quantity = test.channels[0].effect.quantity;
  const NightEvidence night = night_evidence(entry.work, entry.channel);
  series.reference_error = night.reference_error;
  if (night.value) {
    add_night(book, record, entry, series, *night.value, result);
  } else {
    result.note = "nothing added: " + night.obstacle;
  }
  if (const auto open = book.open_series(series)) read_nights(result, book, *open, entry);
  return result;
}

}  // namespace

NightEvidence night_evidence(const TestWork& work, std::size_t channel) {
  const TestOutcome& test = work.outcome;
  const std::vector<Subject>& sides = test.question.subjects;
  if (test.verdict == reports::Verdict::error) return {.obstacle = "its verdict is error"};
  if (!test.plan.invalid.empty()) return {.obstacle = "its pilots leave it invalid"};
  if (std::ranges::all_of(sides, is_recorded)) {
    return {.obstacle = "its data are recorded: the same in every run"};
  }
  const std::optional<DrawnTest> numbers = drawn(work);
  if (!numbers) return {.obstacle = "it was not drawn"};
  const ChannelOutcome* outcome = outcome_of(test, channel);
  if (outcome == nullptr || !outcome->evidence.distance) return of_estimate(*numbers, channel);
  if (std::ranges::any_of(sides, is_recorded)) {
    return {.obstacle =
                "one side is recorded, the same in every run, and distances from it do not add up"};
  }
  return {.value = outcome->decision.log_p_claimed};
}

std::string series_hash(const TestWork& work, std::size_t channel) {
  const Question& question = work.outcome.question;
  const TestEntry& entry = *question.test;
  std::string text = fmt::format("{}\nallow {} detect {}\nchannel {}", to_string(entry.claim),
                                 margin_text(entry.allow), margin_text(entry.detect),
                                 question.channel_name(channel));
  for (std::size_t i = 0; i < question.subjects.size(); ++i) text += side_text(work, i, channel);
  if (!question.references.empty()) {
    const Constant& reference = question.references[channel];
    // Twelve digits: quadratures may differ in the last ones between machines.
    text += fmt::format("\n{:.12g} {:.12g}", reference.value, reference.standard_error);
  }
  return fmt::format("{:016x}", text_hash(text));
}

std::vector<double> log_e_path(const LedgerSeries& series, const std::vector<LedgerNight>& nights,
                               const stats::Range& claimed) {
  if (series.has_estimates()) {
    stats::PooledNights pooled;
    return mapped(values_of<stats::NightEstimate>(nights), [&](const auto& night) {
      pooled.add(night);
      return stats::log_e_value(pooled, nearest(claimed, pooled, series));
    });
  }
  stats::PooledPValues pooled;
  return mapped(values_of<NightLogP>(nights), [&](double log_p) {
    pooled.add(log_p);
    return stats::log_e_value(pooled);
  });
}

Moved moved(const LedgerSeries& series, const std::vector<LedgerNight>& nights,
            const stats::Range& claimed) {
  const auto change = [&] {
    if (!series.has_estimates()) return stats::change_point(values_of<NightLogP>(nights));
    const auto estimates = values_of<stats::NightEstimate>(nights);
    stats::PooledNights pooled;
    for (const stats::NightEstimate& night : estimates) pooled.add(night);
    return stats::change_point(estimates, nearest(claimed, pooled, series));
  }();
  const std::vector<std::size_t> credible = stats::credible_nights(change, credibility);
  return {change.night, credible.front(), credible.back()};
}

double generation_share(int generation) { return 1 / (zeta_3 * std::pow(generation, 3)); }

void require_ledger(const std::string& file) {
  const std::filesystem::path path(file);
  if (path.has_parent_path() && !std::filesystem::is_directory(path.parent_path())) {
    refuse({.file = file}, "its folder does not exist; make it first");
  }
  read_ledger(file);
}

reports::Ledger add_to_ledger(const std::string& file, const reports::Record& record,
                              const SuiteRuns& runs) {
  const LockedFile lock(file);
  LedgerBook book = read_ledger(file);
  const bool is_new = std::filesystem::file_size(file) == 0;
  reports::Ledger result{.file = file, .budget = book.budget()};
  const std::size_t before = book.nights().size();
  for (const auto& run : runs) {
    for (const TestWork& work : run->tests) {
      if (!work.outcome.place.inside) continue;
      for (std::size_t channel = 0; channel < work.outcome.question.channel_count(); ++channel) {
        result.series.push_back(keep(book, record, {*run, work, channel}));
      }
    }
  }
  if (is_new || book.nights().size() > before) write_whole(file, book.text());
  return result;
}

}  // namespace assay::harness
