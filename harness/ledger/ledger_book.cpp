#include "harness/ledger/ledger_book.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <charconv>
#include <cmath>
#include <regex>

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

/// The text that stands in quotes.
std::string unquoted(std::string_view quoted) {
  std::string text;
  for (std::size_t i = 1; i + 1 < quoted.size(); ++i) {
    text += quoted[i] == '\\' ? escaped[letters.find(quoted[++i])] : quoted[i];
  }
  return text;
}

/// "line | 1a2b3c4d": the low 32 bits of a hash.
std::string with_check(std::string_view line, std::uint64_t hash) {
  return fmt::format("{} | {:08x}", line, hash & 0xffffffffU);
}

/// A pattern of a line. A blank is one or more. The fields are %, a text in quotes, and #, another
/// word.
std::regex pattern_of(std::string pattern) {
  boost::replace_all(pattern, " ", " +");
  boost::replace_all(pattern, "%", R"(("(?:[^"\\]|\\["\\ntr])*"))");
  boost::replace_all(pattern, "#", R"(([^ "]\S*))");
  return std::regex(pattern + " *");
}

/// A number in one word; nullopt if it is none, or not finite.
template <class Value>
std::optional<Value> number_in(const std::csub_match& word) {
  Value value{};
  const auto [end, error] = std::from_chars(word.first, word.second, value);
  const bool whole = error == std::errc() && end == word.second;
  return whole && std::isfinite(static_cast<double>(value)) ? std::optional(value) : std::nullopt;
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
    const auto budget = is(lines_[0], header_line_) ? number_in<double>(field_[1]) : std::nullopt;
    if (!budget || !is_error_rate(*budget)) refuse("the budget must be a number from 1e-9 to 0.5");
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

  /// Reads the line's fields, if it has the pattern.
  bool is(std::string_view line, const std::regex& pattern) {
    return std::regex_match(line.data(), line.data() + line.size(), field_, pattern);
  }
  template <class Value = double>
  Value number(std::size_t field) const {
    const std::optional<Value> value = number_in<Value>(field_[field]);
    if (!value) changed();
    return *value;
  }

  void take(std::string_view line) {
    if (line.empty() || line.starts_with("#")) return book_.keep(std::string(line));
    if (line.starts_with("begin ")) return take_begin(line);
    if (ended_) refuse("`end` must be the last line" + mend());
    if (line.starts_with("end ")) return take_end(line);
    const std::string_view checked = line.substr(0, line.rfind(" | "));
    const std::uint64_t check = text_hash(checked, book_.check_);
    if (with_check(checked, check) != line) changed();
    if (is(checked, series_line_)) {
      take_series();
    } else if (is(checked, night_line_)) {
      take_night();
    } else {
      changed();
    }
    book_.check_ = check;
    book_.keep(std::string(line));
  }

  void take_begin(std::string_view line) {
    if (!is(line, begin_line_)) {
      refuse("after `begin` stands the test's id in double quotes, as in the lines of its nights");
    }
    const std::string test = unquoted(field_.str(1));
    if (!std::ranges::count(book_.series_, test, &LedgerSeries::test)) {
      refuse(fmt::format("the ledger has no test {} before this line", in_quotes(test)));
    }
    book_.begin(test);
  }

  void take_end(std::string_view line) {
    ended_ = is(line, end_line_) && number_in<std::size_t>(field_[1]) == book_.nights_.size();
    if (ended_) return;
    refuse(fmt::format("the ledger has {} nights before this line: lines were added or taken out",
                       book_.nights_.size()) +
           mend());
  }

  void take_series() {
    LedgerSeries series{.hash = field_.str(1),
                        .weight = number(3),
                        .test = unquoted(field_.str(4)),
                        .channel = unquoted(field_.str(5))};
    if (field_[2].matched) series.reference_error = number(2);
    book_.series_.push_back(std::move(series));
    book_.closed_.push_back(false);
  }

  void take_night() {
    const LedgerSeries* series = book_.open_series({.hash = field_.str(4),
                                                    .test = unquoted(field_.str(10)),
                                                    .channel = unquoted(field_.str(11))});
    if (series == nullptr) refuse("no open series above has this night's hash and test" + mend());
    if (series->has_estimates() == field_[5].matched) changed();
    LedgerNight night{.date = field_.str(1),
                      .seed = number<std::uint64_t>(2),
                      .commit = field_.str(3),
                      .series = static_cast<std::size_t>(series - book_.series_.data())};
    if (field_[5].matched) {
      night.value = NightPValue{.log_p = number(5)};
    } else {
      night.value = stats::NightEstimate{.difference = number(6),
                                         .standard_error = number(7),
                                         .observations = number(8),
                                         .effective = number(9)};
    }
    book_.nights_.push_back(std::move(night));
  }

  std::string file_;
  std::vector<std::string_view> lines_;
  std::size_t number_ = 0;
  bool ended_ = false;
  const std::regex header_line_ = pattern_of("assay-ledger 2 budget #");
  const std::regex series_line_ =
      pattern_of("series # (?:estimates reference #|p-values) weight # % %");
  const std::regex night_line_ = pattern_of(
      "night # seed # commit # series # "
      "(?:log-p #|estimate # error # observations # effective #) % %");
  const std::regex begin_line_ = pattern_of("begin %");
  const std::regex end_line_ = pattern_of("end #");
  std::cmatch field_;  ///< of the line that was read last
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

}  // namespace assay::harness
