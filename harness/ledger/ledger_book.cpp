#include "harness/ledger/ledger_book.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "harness/base/text_file.h"
#include "harness/base/text_hash.h"
#include "harness/suite/yaml.h"
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

constexpr std::string_view escaped = "\"\\\n\t\r";
constexpr std::string_view letters = "\"\\ntr";

/// Writes the fields of a line from left to right.
class LineWriter {
 public:
  void word(std::string_view word) { text_.append(text_.empty() ? "" : " ").append(word); }
  bool either(std::string_view one, std::string_view other, bool is_one) {
    word(is_one ? one : other);
    return is_one;
  }
  void field(const std::string& text) { word(text); }
  void field(std::uint64_t count) { word(fmt::format("{}", count)); }
  void field(double number) { word(reports::round_trip(number)); }
  void quoted(const std::string& text) { word(in_quotes(text)); }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Reads the fields that LineWriter writes.
class LineReader {
 public:
  explicit LineReader(std::string_view line) : rest_(line) {}

  void word(std::string_view wanted) { note(taken() == wanted); }
  bool either(std::string_view one, std::string_view other, bool /*is_one*/) {
    const std::string_view word = taken();
    note(word == one || word == other);
    return word == one;
  }
  void field(std::string& text) {
    text = taken();
    note(!text.empty() && text.front() != '"');
  }
  template <class Number>
  void field(Number& number) {
    const std::string_view word = taken();
    const char* const end = word.data() + word.size();
    const auto [read, error] = std::from_chars(word.data(), end, number);
    note(error == std::errc() && read == end && std::isfinite(static_cast<double>(number)));
  }
  void quoted(std::string& text) {
    skip_blanks();
    std::size_t i = rest_.starts_with('"') ? 1 : rest_.size();
    for (; i < rest_.size() && rest_[i] != '"'; ++i) {
      const bool escape = rest_[i] == '\\' && i + 1 < rest_.size();
      const std::size_t at = escape ? letters.find(rest_[++i]) : 0;
      note(at != std::string_view::npos);
      text += escape ? escaped[std::min(at, escaped.size() - 1)] : rest_[i];
    }
    note(i < rest_.size());
    rest_.remove_prefix(std::min(i + 1, rest_.size()));
  }
  /// True if the line has these fields and no more.
  bool is_read() {
    skip_blanks();
    return sound_ && rest_.empty();
  }

 private:
  void note(bool sound) { sound_ = sound_ && sound; }
  void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size())); }
  std::string_view taken() {
    skip_blanks();
    const std::string_view word = rest_.substr(0, rest_.find(' '));
    rest_.remove_prefix(word.size());
    return word;
  }

  std::string_view rest_;
  bool sound_ = true;
};

template <class Line>
void named(Line& line, std::string_view name, auto& field) {
  line.word(name);
  line.field(field);
}

template <class Line>
void visit(Line& line, LedgerSeries& series) {
  named(line, "series", series.hash);
  if (line.either("estimates", "p-values", series.has_estimates())) {
    if (!series.reference_error) series.reference_error.emplace();
    named(line, "reference", *series.reference_error);
  }
  named(line, "weight", series.weight);
  line.quoted(series.test);
  line.quoted(series.channel);
}

/// `of` has the hash, the test and the channel of the night's series.
template <class Line>
void visit(Line& line, LedgerNight& night, LedgerSeries& of) {
  named(line, "night", night.date);
  named(line, "seed", night.seed);
  named(line, "commit", night.commit);
  named(line, "series", of.hash);
  const bool estimated = std::holds_alternative<stats::NightEstimate>(night.value);
  if (line.either("estimate", "log-p", estimated)) {
    if (!estimated) night.value = stats::NightEstimate{};
    auto& value = std::get<stats::NightEstimate>(night.value);
    line.field(value.difference);
    named(line, "error", value.standard_error);
    named(line, "observations", value.observations);
    named(line, "effective", value.effective);
  } else {
    if (estimated) night.value = NightPValue{};
    line.field(std::get<NightPValue>(night.value).log_p);
  }
  line.quoted(of.test);
  line.quoted(of.channel);
}

template <class... Parts>
std::string line_of(Parts... parts) {
  LineWriter line;
  visit(line, parts...);
  return line.text();
}

/// "line | 1a2b3c4d": the low 32 bits of a hash.
std::string with_check(std::string_view line, std::uint64_t hash) {
  return fmt::format("{} | {:08x}", line, hash & 0xffffffffU);
}

bool is_possible(const stats::NightEstimate& night) {
  return night.standard_error >= 0 && night.observations > 0 && night.effective >= 1;
}

bool is_possible(const NightPValue& night) { return night.log_p <= 0; }

bool same_place(const LedgerSeries& a, const LedgerSeries& b) {
  return a.test == b.test && a.channel == b.channel;
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
  return std::ranges::any_of(nights_, [&](const LedgerNight& night) {
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
      refuse(fmt::format(
          "an earlier version of assay wrote this ledger, whose nights do not pool with new ones; "
          "keep it under another name, and the next run begins anew: mv {0} {0}.1",
          file_));
    }
    if (lines_.empty() || !lines_[0].starts_with(version_words)) {
      refuse(
          "this is no ledger of this version: its first line must be `assay-ledger 2 budget B`; "
          "name another file for the ledger");
    }
    LineReader fields(lines_[0].substr(std::string_view(version_words).size()));
    double budget = 0;
    fields.field(budget);
    if (!fields.is_read() || !is_error_rate(budget)) {
      refuse("the budget must be a number from 1e-9 to 0.5");
    }
    book_ = LedgerBook(budget);
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
        "this line, or one before it, was changed, moved, cut or taken out after it was written" +
        mend());
  }

  void take(std::string_view line) {
    if (line.empty() || line.starts_with("#")) return book_.keep(std::string(line));
    if (line.starts_with("begin ")) return take_begin(line);
    if (ended_) refuse("`end` must be the last line" + mend());
    if (line.starts_with("end ")) return take_end(line);
    const std::string_view checked = line.substr(0, line.rfind(" | "));
    const std::uint64_t wanted = text_hash(checked, book_.check_);
    if (with_check(checked, wanted) != line) changed();
    line.starts_with("series ") ? take_series(checked) : take_night(checked);
    book_.check_ = wanted;
    book_.keep(std::string(line));
  }

  void take_begin(std::string_view line) {
    LineReader fields(line);
    std::string test;
    fields.word("begin");
    fields.quoted(test);
    if (!fields.is_read()) {
      refuse("after `begin` stands the test's id in double quotes, as in the lines of its nights");
    }
    const auto known = [&](const LedgerSeries& series) { return series.test == test; };
    if (std::ranges::none_of(book_.series_, known)) {
      refuse(fmt::format("the ledger has no test {} before this line", in_quotes(test)));
    }
    book_.begin(test);
  }

  void take_end(std::string_view line) {
    LineReader fields(line);
    std::uint64_t count = 0;
    fields.word("end");
    fields.field(count);
    if (!fields.is_read() || count != book_.nights_.size()) {
      refuse(fmt::format("the ledger has {} nights before this line: lines were added or taken out",
                         book_.nights_.size()) +
             mend());
    }
    ended_ = true;
  }

  void take_series(std::string_view line) {
    LedgerSeries series;
    LineReader fields(line);
    visit(fields, series);
    if (!fields.is_read() || !(series.reference_error.value_or(0) >= 0) ||
        !(series.weight > 0 && series.weight <= 1)) {
      changed();
    }
    book_.series_.push_back(series);
    book_.closed_.push_back(false);
  }

  void take_night(std::string_view line) {
    LedgerNight night;
    LedgerSeries of;
    LineReader fields(line);
    visit(fields, night, of);
    const auto possible = [](const auto& value) { return is_possible(value); };
    if (!fields.is_read() || !std::visit(possible, night.value)) changed();
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

}  // namespace assay::harness
