#include "harness/ledger/ledger.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <ranges>
#include <sstream>

#include "harness/base/identity.h"
#include "harness/base/text_file.h"
#include "harness/suite/yaml.h"
#include "harness/theta/theta.h"
#include "reports/words/number.h"
#include "reports/words/text.h"
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

// ---- The ledger as text

constexpr const char* version_words = "assay-ledger 2 budget ";

constexpr const char* mend =
    "; restore the file from version control or a backup, or give its nights up: move it away, and "
    "the next run begins a new one";

constexpr const char* introduction[] = {
    "# Evidence of nights with fresh seeds about each claim (harness/README.md, \"The ledger\").",
    "# An alarm: E >= 1.202 k^3 / (budget x the test's share) in a test's k-th series, where E is "
    "the",
    "# likelihood ratio of all nights of the series. Nights are pooled by the observations they "
    "drew,",
    "# also those that stopped early. E is a martingale while the claim holds: the budget is kept "
    "however",
    "# often, and whenever, one looks.",
    "# Lines are checked: do not edit them. A line  begin \"suite/test\"  starts that test anew.",
    "#"};

std::string header_of(double budget) { return version_words + reports::round_trip(budget); }

constexpr reports::Form escapes[] = {
    {'"', "\\\""}, {'\\', "\\\\"}, {'\n', "\\n"}, {'\t', "\\t"}, {'\r', "\\r"}};

/// Reads a text that `in_quotes` wrote. The stream fails if there is none.
std::string unquoted(std::istream& in) {
  std::string text;
  char c = 0;
  if (in >> c && c != '"') in.setstate(std::ios::failbit);
  while (in.get(c) && c != '"') {
    const auto stands_for = [&](const reports::Form& form) { return form.written[1] == c; };
    const bool is_escape = c == '\\' && in.get(c);
    const auto* const form = std::ranges::find_if(escapes, stands_for);
    text += is_escape && form != std::end(escapes) ? form->character : c;
  }
  return text;
}

/// True if everything was read, and the stream has no more than blanks.
bool is_read(std::istream& in) { return in && (in >> std::ws).eof(); }

std::string text_of(const NightValue& value) {
  using reports::round_trip;
  const auto* const night = std::get_if<stats::NightEstimate>(&value);
  if (night == nullptr) return "log-p " + round_trip(std::get<NightLogP>(value));
  return fmt::format("estimate {} error {} observations {} effective {}",
                     round_trip(night->difference), round_trip(night->standard_error),
                     round_trip(night->observations), round_trip(night->effective));
}

std::string names_in_quotes(const LedgerSeries& series) {
  return in_quotes(series.test) + " " + in_quotes(series.channel);
}

std::string line_of(const LedgerSeries& series) {
  const std::string kind =
      series.has_estimates() ? "estimates reference " + reports::round_trip(*series.reference_error)
                             : "p-values";
  return fmt::format("series {} {} weight {} {}", series.hash, kind,
                     reports::round_trip(series.weight), names_in_quotes(series));
}

std::string line_of(const LedgerNight& night, const LedgerSeries& of) {
  return fmt::format("night {} seed {} commit {} series {} {} {}", night.date, night.seed,
                     night.commit, of.hash, text_of(night.value), names_in_quotes(of));
}

/// "line | 1a2b3c4d": the low 32 bits of a hash.
std::string with_check(std::string_view line, std::uint64_t hash) {
  return fmt::format("{} | {:08x}", line, hash & 0xffffffffU);
}

bool same_place(const LedgerSeries& a, const LedgerSeries& b) {
  return a.test == b.test && a.channel == b.channel;
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

LedgerBook::LedgerBook(double budget) : budget_(budget), check_(text_hash(header_of(budget))) {
  keep(header_of(budget));
  for (const char* line : introduction) keep(line);
}

std::vector<LedgerNight> LedgerBook::nights_of(std::size_t series) const {
  const auto is_its = [&](const LedgerNight& night) { return night.series == series; };
  return mapped(nights_ | std::views::filter(is_its), std::identity());
}

std::optional<std::size_t> LedgerBook::open_series(const LedgerSeries& wanted) const {
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const bool same = series_[i].hash == wanted.hash && same_place(series_[i], wanted);
    if (same && !series_[i].closed) return i;
  }
  return std::nullopt;
}

int LedgerBook::generation(std::size_t series) const {
  int count = 0;
  for (std::size_t i = 0; i <= series; ++i) count += same_place(series_[i], series_[series]);
  return count;
}

bool LedgerBook::has_seed(const LedgerSeries& of, std::uint64_t seed) const {
  return std::ranges::any_of(nights_, [&](const LedgerNight& night) {
    return night.seed == seed && same_place(series_[night.series], of);
  });
}

std::size_t LedgerBook::open(const LedgerSeries& wanted) {
  if (const auto found = open_series(wanted)) return *found;
  series_.push_back(wanted);
  keep_checked(line_of(wanted));
  return series_.size() - 1;
}

void LedgerBook::add(const LedgerNight& night) {
  nights_.push_back(night);
  keep_checked(line_of(night, series_.at(night.series)));
}

void LedgerBook::begin(const std::string& test) {
  for (LedgerSeries& each : series_) each.closed |= each.test == test;
  keep("begin " + in_quotes(test));
}

void LedgerBook::keep_checked(const std::string& line) {
  check_ = text_hash(line, check_);
  keep(with_check(line, check_));
}

std::string LedgerBook::text() const {
  std::string out;
  for (const std::string& line : lines_) out += line + "\n";
  return out + end() + "\n";
}

void LedgerBook::take_begin(const std::string& line, const Location& at) {
  std::istringstream fields(line.substr(std::strlen("begin")));
  const std::string test = unquoted(fields);
  if (!is_read(fields)) {
    refuse(at,
           "after `begin` stands the test's id in double quotes, as in the lines of its nights");
  }
  if (std::ranges::count(series_, test, &LedgerSeries::test) == 0) {
    refuse(at, "the ledger has no test {} before this line", in_quotes(test));
  }
  begin(test);
}

void LedgerBook::take_series(const std::string& line) {
  std::istringstream fields(line);
  LedgerSeries series;
  std::string word;
  fields >> word >> series.hash >> word;
  if (word == "estimates") fields >> word >> series.reference_error.emplace();
  fields >> word >> series.weight;
  series.test = unquoted(fields);
  series.channel = unquoted(fields);
  open(series);
}

void LedgerBook::take_night(const std::string& line, const Location& at) {
  std::istringstream fields(line);
  LedgerNight night;
  LedgerSeries of;
  std::string word;
  fields >> word >> night.date >> word >> night.seed >> word >> night.commit >> word >> of.hash;
  fields >> word;
  if (word == "estimate") {
    auto& value = night.value.emplace<stats::NightEstimate>();
    fields >> value.difference >> word >> value.standard_error >> word >> value.observations;
    fields >> word >> value.effective;
  } else {
    fields >> night.value.emplace<NightLogP>();
  }
  of.test = unquoted(fields);
  of.channel = unquoted(fields);
  const auto series = open_series(of);
  if (!series) refuse(at, "no open series above has this night's hash and test{}", mend);
  night.series = *series;
  add(night);
}

/// A series or a night is sound if its check is right, and adding what was read of it writes the
/// line again.
void LedgerBook::take_checked(const std::string& line, const Location& at) {
  const std::string checked = line.substr(0, line.rfind(" | "));
  bool sound = with_check(checked, text_hash(checked, check_)) == line;
  if (sound) {
    checked.starts_with("series ") ? take_series(checked) : take_night(checked, at);
    sound = lines_.back() == line;
  }
  if (sound) return;
  refuse(at,
         "this line, or one before it, was changed, moved, cut or taken out after it was written{}",
         mend);
}

LedgerBook LedgerBook::parse(const std::string& text, const std::string& file) {
  Location at{file, 1, 1};
  const std::vector<std::string_view> lines = lines_of(text);
  if (lines.empty() || !lines[0].starts_with(version_words)) {
    refuse(at,
           "this is no ledger of this version: its first line must be `assay-ledger 2 budget B`; "
           "name another file for the ledger");
  }
  const std::string header(lines[0]);
  std::istringstream fields(header.substr(std::strlen(version_words)));
  double budget = 0;
  fields >> budget;
  if (!is_read(fields) || !is_error_rate(budget)) {
    refuse(at, "the budget must be a number from 1e-9 to 0.5");
  }
  LedgerBook book(budget);
  book.lines_ = {header};
  book.check_ = text_hash(header);
  bool ended = false;
  for (const std::string_view each : lines | std::views::drop(1)) {
    const std::string line(each);
    ++at.line;
    if (line.empty() || line.starts_with("#")) {
      book.keep(line);
    } else if (line.starts_with("begin ")) {
      book.take_begin(line, at);
    } else if (ended) {
      refuse(at, "`end` must be the last line{}", mend);
    } else if (!line.starts_with("end ")) {
      book.take_checked(line, at);
    } else if (line == book.end()) {
      ended = true;
    } else {
      refuse(at, "the ledger has {} nights before this line: lines were added or taken out{}",
             book.nights_.size(), mend);
    }
  }
  if (ended) return book;
  refuse(at, "the ledger is cut short after this line: its last line must be `end N`{}", mend);
}

std::string in_quotes(std::string_view text) {
  return "\"" + reports::escape(text, escapes) + "\"";
}

}  // namespace assay::harness
