#include "harness/ledger/ledger_book.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <ranges>
#include <sstream>

#include "harness/base/identity.h"
#include "harness/base/text_file.h"
#include "harness/suite/yaml.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

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
    std::istringstream fields(std::string(lines_[0].substr(std::strlen(version_words))));
    double budget = 0;
    fields >> budget;
    if (!is_read(fields) || !is_error_rate(budget)) {
      refuse("the budget must be a number from 1e-9 to 0.5");
    }
    book_ = LedgerBook(budget);
    book_.lines_ = {std::string(lines_[0])};
    book_.check_ = text_hash(lines_[0]);
    for (number_ = 1; number_ < lines_.size(); ++number_) take(std::string(lines_[number_]));
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

  /// A series or a night is sound if adding what was read of it writes the line again.
  void take(const std::string& line) {
    if (line.empty() || line.starts_with("#")) return book_.keep(line);
    if (line.starts_with("begin ")) return take_begin(line);
    if (ended_) refuse("`end` must be the last line" + mend());
    if (line.starts_with("end ")) return take_end(line);
    const std::string checked = line.substr(0, line.rfind(" | "));
    if (with_check(checked, text_hash(checked, book_.check_)) != line) changed();
    line.starts_with("series ") ? take_series(checked) : take_night(checked);
    if (book_.lines_.back() != line) changed();
  }

  void take_begin(const std::string& line) {
    std::istringstream fields(line.substr(std::strlen("begin")));
    const std::string test = unquoted(fields);
    if (!is_read(fields)) {
      refuse("after `begin` stands the test's id in double quotes, as in the lines of its nights");
    }
    if (std::ranges::count(book_.series_, test, &LedgerSeries::test) == 0) {
      refuse(fmt::format("the ledger has no test {} before this line", in_quotes(test)));
    }
    book_.begin(test);
  }

  void take_end(const std::string& line) {
    if (line != fmt::format("end {}", book_.nights_.size())) {
      refuse(fmt::format("the ledger has {} nights before this line: lines were added or taken out",
                         book_.nights_.size()) +
             mend());
    }
    ended_ = true;
  }

  void take_series(const std::string& line) {
    std::istringstream fields(line);
    LedgerSeries series;
    std::string word;
    fields >> word >> series.hash >> word;
    if (word == "estimates") fields >> word >> series.reference_error.emplace();
    fields >> word >> series.weight;
    series.test = unquoted(fields);
    series.channel = unquoted(fields);
    if (!(series.reference_error.value_or(0) >= 0) || !(series.weight > 0 && series.weight <= 1)) {
      changed();
    }
    book_.open(series);
  }

  void take_night(const std::string& line) {
    std::istringstream fields(line);
    LedgerNight night;
    LedgerSeries of;
    std::string word;
    fields >> word >> night.date >> word >> night.seed >> word >> night.commit >> word >> of.hash;
    fields >> word;
    bool is_possible = false;
    if (word == "estimate") {
      auto& value = night.value.emplace<stats::NightEstimate>();
      fields >> value.difference >> word >> value.standard_error >> word >> value.observations;
      fields >> word >> value.effective;
      is_possible = value.standard_error >= 0 && value.observations > 0 && value.effective >= 1;
    } else {
      auto& log_p = night.value.emplace<NightLogP>();
      fields >> log_p;
      is_possible = log_p <= 0;
    }
    of.test = unquoted(fields);
    of.channel = unquoted(fields);
    if (!is_possible) changed();
    const auto series = book_.open_series(of);
    if (!series) refuse("no open series above has this night's hash and test" + mend());
    night.series = *series;
    if (book_.series_[night.series].has_estimates() !=
        std::holds_alternative<stats::NightEstimate>(night.value)) {
      changed();
    }
    book_.add(night);
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
  return "\"" + reports::escape(text, escapes) + "\"";
}

}  // namespace assay::harness
