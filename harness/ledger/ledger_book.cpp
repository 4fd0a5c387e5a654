#include "harness/ledger/ledger_book.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "harness/base/text_file.h"
#include "harness/base/text_hash.h"
#include "harness/suite/suite_keys.h"
#include "reports/words/number.h"

namespace assay::harness {
namespace {

constexpr const char* version_words = "assay-ledger 2 budget ";
constexpr const char* earlier_words = "assay-ledger 1 ";

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

std::string line_of(const LedgerSeries& series) {
  const std::string kind =
      series.has_estimates() ? "estimates reference " + reports::round_trip(*series.reference_error)
                             : "p-values";
  return fmt::format("series {} {} weight {} {} {}", series.hash, kind,
                     reports::round_trip(series.weight), in_quotes(series.test),
                     in_quotes(series.channel));
}

std::string text_of(const stats::NightEstimate& night) {
  return fmt::format("estimate {} error {} observations {} effective {}",
                     reports::round_trip(night.difference),
                     reports::round_trip(night.standard_error),
                     reports::round_trip(night.observations), reports::round_trip(night.effective));
}
std::string text_of(const NightPValue& night) {
  return "log-p " + reports::round_trip(night.log_p);
}

std::string line_of(const LedgerNight& night, const LedgerSeries& series) {
  const std::string value = std::visit([](const auto& each) { return text_of(each); }, night.value);
  return fmt::format("night {} seed {} commit {} series {} {} {} {}", night.date, night.seed,
                     night.commit, series.hash, value, in_quotes(series.test),
                     in_quotes(series.channel));
}

bool same_place(const LedgerSeries& a, const LedgerSeries& b) {
  return a.test == b.test && a.channel == b.channel;
}

constexpr std::string_view escaped = "\"\\\n\t\r";
constexpr std::string_view letters = "\"\\ntr";

template <class Value>
std::optional<Value> whole(std::string_view word) {
  Value value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace

LedgerBook::LedgerBook(double budget) : budget_(budget), check_(text_hash(header_of(budget))) {
  keep(header_of(budget));
  for (const char* line : introduction) keep(line);
}

std::vector<LedgerNight> LedgerBook::nights_of(std::size_t series) const {
  std::vector<LedgerNight> mine;
  for (const LedgerNight& night : nights_) {
    if (night.series == series) mine.push_back(night);
  }
  return mine;
}

const LedgerSeries* LedgerBook::open_series(const LedgerSeries& wanted) const {
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const bool same = series_[i].hash == wanted.hash && same_place(series_[i], wanted);
    if (same && !closed_[i]) return &series_[i];
  }
  return nullptr;
}

int LedgerBook::generation(std::size_t series) const {
  int count = 0;
  for (std::size_t i = 0; i <= series; ++i) count += same_place(series_[i], series_[series]);
  return count;
}

bool LedgerBook::has_seed(const LedgerSeries& of, std::uint64_t seed) const {
  return std::any_of(nights_.begin(), nights_.end(), [&](const LedgerNight& night) {
    return night.seed == seed && same_place(series_[night.series], of);
  });
}

std::size_t LedgerBook::open(const LedgerSeries& wanted) {
  if (const LedgerSeries* found = open_series(wanted)) {
    return static_cast<std::size_t>(found - series_.data());
  }
  series_.push_back(wanted);
  closed_.push_back(false);
  keep_checked(line_of(wanted));
  return series_.size() - 1;
}

void LedgerBook::add(const LedgerNight& night) {
  nights_.push_back(night);
  keep_checked(line_of(night, series_.at(night.series)));
}

void LedgerBook::begin(const std::string& test) {
  for (std::size_t i = 0; i < series_.size(); ++i) {
    if (series_[i].test == test) closed_[i] = true;
  }
  keep("begin " + in_quotes(test));
}

void LedgerBook::keep_checked(const std::string& line) {
  check_ = text_hash(line, check_);
  keep(with_check(line, check_));
}

std::string LedgerBook::text() const {
  std::string out;
  for (const std::string& line : lines_) out += line + "\n";
  return out + fmt::format("end {}\n", nights_.size());
}

class LedgerReader {
 public:
  LedgerReader(const std::string& text, std::string file)
      : file_(std::move(file)), lines_(lines_of(text)) {}

  LedgerBook read() {
    if (!lines_.empty() && lines_[0].starts_with(earlier_words)) {
      refuse(
          fmt::format("an earlier version of assay wrote this ledger, whose nights do not pool "
                      "with new ones; keep it under another name, and the next run begins anew: "
                      "mv {0} {0}.1",
                      file_));
    }
    if (lines_.empty() || !lines_[0].starts_with(version_words)) {
      refuse(
          "this is no ledger of this version: its first line must be `assay-ledger 2 budget B`; "
          "name another file for the ledger");
    }
    LineFields fields(lines_[0].substr(std::string_view(version_words).size()));
    const std::optional<double> budget = fields.number();
    if (!budget || !fields.at_end() || !is_error_rate(*budget)) {
      refuse("the budget must be a number from 1e-9 to 0.5");
    }
    book_ = LedgerBook(*budget);
    book_.lines_ = {std::string(lines_[0])};
    book_.check_ = text_hash(lines_[0]);
    for (number_ = 1; number_ < lines_.size(); ++number_) take(lines_[number_]);
    if (!ended_) {
      --number_;
      refuse("the ledger is cut short after this line: its last line must be `end N`" + mend());
    }
    return std::move(book_);
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError({file_, static_cast<int>(number_) + 1, 1}, why);
  }
  static std::string mend() {
    return "; restore the file from version control or a backup, or give its nights up: move it "
           "away, and the next run begins a new one";
  }
  [[noreturn]] void changed() const {
    refuse(
        "this line, or one before it, was changed, moved, cut or taken out after it was "
        "written" +
        mend());
  }

  void take(std::string_view line) {
    if (line.empty() || line.starts_with("#")) return book_.keep(std::string(line));
    if (line.starts_with("begin ")) return take_begin(line);
    if (ended_) refuse("`end` must be the last line" + mend());
    if (line.starts_with("end ")) return take_end(line);
    const auto [checked, check] = split_check(line);
    const std::uint64_t wanted = text_hash(checked, book_.check_);
    if (with_check(std::string(checked), wanted) != line) changed();
    LineFields fields(checked);
    if (line.starts_with("series ")) {
      take_series(fields);
    } else {
      take_night(fields);
    }
    if (!fields.at_end()) changed();
    book_.check_ = wanted;
    book_.keep(std::string(line));
  }

  void take_begin(std::string_view line) {
    LineFields fields(line);
    fields.word("begin");
    const std::optional<std::string> test = fields.text();
    if (!test || !fields.at_end()) {
      refuse("after `begin` stands the test's id in double quotes, as in the lines of its nights");
    }
    const auto known = [&](const LedgerSeries& series) { return series.test == *test; };
    if (std::none_of(book_.series_.begin(), book_.series_.end(), known)) {
      refuse(fmt::format("the ledger has no test {} before this line", in_quotes(*test)));
    }
    book_.begin(*test);
  }

  void take_end(std::string_view line) {
    LineFields fields(line);
    fields.word("end");
    const std::optional<std::uint64_t> count = fields.count();
    if (!count || !fields.at_end() || *count != book_.nights_.size()) {
      refuse(fmt::format("the ledger has {} nights before this line: lines were added or taken out",
                         book_.nights_.size()) +
             mend());
    }
    ended_ = true;
  }

  template <class Value>
  Value required(std::optional<Value> value) const {
    if (!value) changed();
    return *value;
  }
  double named(LineFields& fields, const char* name) const {
    if (!fields.word(name)) changed();
    return required(fields.number());
  }

  void take_series(LineFields& fields) {
    LedgerSeries series;
    fields.word("series");
    series.hash = required(fields.any_word());
    if (fields.word("estimates")) {
      series.reference_error = named(fields, "reference");
      if (!(*series.reference_error >= 0)) changed();
    } else if (!fields.word("p-values")) {
      changed();
    }
    series.weight = named(fields, "weight");
    if (!(series.weight > 0 && series.weight <= 1)) changed();
    series.test = required(fields.text());
    series.channel = required(fields.text());
    book_.series_.push_back(series);
    book_.closed_.push_back(false);
  }

  NightValue value(LineFields& fields) const {
    if (fields.word("log-p")) {
      const NightPValue night{.log_p = required(fields.number())};
      if (!(night.log_p <= 0)) changed();
      return night;
    }
    stats::NightEstimate night;
    night.difference = named(fields, "estimate");
    night.standard_error = named(fields, "error");
    night.observations = named(fields, "observations");
    night.effective = named(fields, "effective");
    const bool possible =
        night.standard_error >= 0 && night.observations > 0 && night.effective >= 1;
    if (!possible) changed();
    return night;
  }

  void take_night(LineFields& fields) {
    LedgerNight night;
    if (!fields.word("night")) changed();
    night.date = required(fields.any_word());
    if (!fields.word("seed")) changed();
    night.seed = required(fields.count());
    if (!fields.word("commit")) changed();
    night.commit = required(fields.any_word());
    if (!fields.word("series")) changed();
    LedgerSeries of{.hash = required(fields.any_word())};
    night.value = value(fields);
    of.test = required(fields.text());
    of.channel = required(fields.text());
    const LedgerSeries* series = book_.open_series(of);
    if (series == nullptr) refuse("no open series above has this night's hash and test" + mend());
    if (series->has_estimates() != std::holds_alternative<stats::NightEstimate>(night.value)) {
      changed();
    }
    night.series = static_cast<std::size_t>(series - book_.series_.data());
    book_.nights_.push_back(night);
  }

  std::string file_;
  std::vector<std::string_view> lines_;
  std::size_t number_ = 0;
  bool ended_ = false;
  LedgerBook book_;
};

LedgerBook LedgerBook::parse(const std::string& text, const std::string& file) {
  return LedgerReader(text, file).read();
}

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const std::size_t at = escaped.find(c);
    if (at == std::string_view::npos) {
      out += c;
    } else {
      out += std::string("\\") + letters[at];
    }
  }
  return out + "\"";
}

std::string with_check(const std::string& line, std::uint64_t hash) {
  return fmt::format("{} | {:08x}", line, hash & 0xffffffffU);
}

std::pair<std::string_view, std::string_view> split_check(std::string_view line) {
  const std::size_t bar = line.rfind(" | ");
  if (bar == std::string_view::npos) return {line, {}};
  return {line.substr(0, bar), line.substr(bar + 3)};
}

void LineFields::skip_blanks() {
  rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
}

std::string_view LineFields::next() {
  skip_blanks();
  return rest_.substr(0, rest_.find(' '));
}

bool LineFields::word(std::string_view wanted) {
  if (next() != wanted) return false;
  rest_.remove_prefix(wanted.size());
  return true;
}

std::optional<std::string> LineFields::any_word() {
  const std::string_view found = next();
  if (found.empty() || found.front() == '"') return std::nullopt;
  rest_.remove_prefix(found.size());
  return std::string(found);
}

std::optional<std::uint64_t> LineFields::count() {
  const std::string_view found = next();
  rest_.remove_prefix(found.size());
  return whole<std::uint64_t>(found);
}

std::optional<double> LineFields::number() {
  const std::string_view found = next();
  rest_.remove_prefix(found.size());
  const std::optional<double> value = whole<double>(found);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<std::string> LineFields::text() {
  skip_blanks();
  if (!rest_.starts_with('"')) return std::nullopt;
  std::string out;
  for (std::size_t i = 1; i < rest_.size(); ++i) {
    if (rest_[i] == '"') {
      rest_.remove_prefix(i + 1);
      return out;
    }
    if (rest_[i] != '\\') {
      out += rest_[i];
      continue;
    }
    const std::size_t at = ++i < rest_.size() ? letters.find(rest_[i]) : std::string_view::npos;
    if (at == std::string_view::npos) return std::nullopt;
    out += escaped[at];
  }
  return std::nullopt;
}

bool LineFields::at_end() {
  skip_blanks();
  return rest_.empty();
}

}  // namespace assay::harness
