#include "harness/ledger/ledger_book.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "estimators/core/value.h"
#include "harness/base/identity.h"
#include "harness/base/text_file.h"
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

std::string line_of(const LedgerSeries& series) {
  const std::string kind =
      series.has_estimates() ? "estimates reference " + reports::round_trip(*series.reference_error)
                             : "p-values";
  return fmt::format("series {} {} weight {} {} {}", series.hash, kind,
                     reports::round_trip(series.weight), in_quotes(series.test),
                     in_quotes(series.channel));
}

std::string value_of(const stats::NightEstimate& night) {
  return fmt::format("estimate {} error {} observations {} effective {}",
                     reports::round_trip(night.difference),
                     reports::round_trip(night.standard_error),
                     reports::round_trip(night.observations), reports::round_trip(night.effective));
}

std::string value_of(const NightPValue& night) {
  return "log-p " + reports::round_trip(night.log_p);
}

std::string line_of(const LedgerNight& night, const LedgerSeries& of) {
  return fmt::format("night {} seed {} commit {} series {} {} {} {}", night.date, night.seed,
                     night.commit, of.hash,
                     std::visit([](const auto& value) { return value_of(value); }, night.value),
                     in_quotes(of.test), in_quotes(of.channel));
}

/// The words of a line, and its texts without their quotes. What no ledger writes gives any words.
class Words {
 public:
  explicit Words(std::string_view line) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == ' ') continue;
      std::string& word = words_.emplace_back();
      const char end = line[i] == '"' ? line[i++] : ' ';
      for (; i < line.size() && line[i] != end; ++i) {
        const bool escape = end == '"' && line[i] == '\\' && i + 1 < line.size();
        const std::size_t at = escape ? letters.find(line[++i]) : std::string_view::npos;
        word += at < escaped.size() ? escaped[at] : line[i];
      }
    }
  }

  std::size_t size() const { return words_.size(); }
  /// Empty beyond the last.
  std::string text(std::size_t i) const { return i < words_.size() ? words_[i] : ""; }
  /// Zero for anything else.
  template <class Number = double>
  Number number(std::size_t i) const {
    const std::string word = text(i);
    Number number{};
    std::from_chars(word.data(), word.data() + word.size(), number);
    return number;
  }

 private:
  std::vector<std::string> words_;
};

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
  keep(fmt::format("{} | {:08x}", line, check_ & 0xffffffffU));
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
    const std::optional<double> budget =
        parse_number(lines_[0].substr(std::string_view(version_words).size()));
    if (!budget || !is_error_rate(*budget)) {
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
        "this line, or one before it, was changed, moved, cut or taken out after it was written" +
        mend());
  }

  void take(std::string_view line) {
    if (line.empty() || line.starts_with("#")) return book_.keep(std::string(line));
    if (line.starts_with("begin ")) return take_begin(line);
    if (ended_) refuse("`end` must be the last line" + mend());
    if (line.starts_with("end ")) return take_end(line);
    line.starts_with("series ") ? take_series(Words(line)) : take_night(Words(line));
    if (book_.lines_.back() != line) changed();
  }

  void take_begin(std::string_view line) {
    const Words words(line);
    const std::string test = words.text(1);
    if (words.size() != 2 || line.find('"') == line.npos) {
      refuse("after `begin` stands the test's id in double quotes, as in the lines of its nights");
    }
    const auto known = [&](const LedgerSeries& series) { return series.test == test; };
    if (std::ranges::none_of(book_.series_, known)) {
      refuse(fmt::format("the ledger has no test {} before this line", in_quotes(test)));
    }
    book_.begin(test);
  }

  void take_end(std::string_view line) {
    if (line != fmt::format("end {}", book_.nights_.size())) {
      refuse(fmt::format("the ledger has {} nights before this line: lines were added or taken out",
                         book_.nights_.size()) +
             mend());
    }
    ended_ = true;
  }

  // Whatever a line says is added to the book. It is sound if the book then writes the same line.

  void take_series(const Words& words) {
    LedgerSeries series{.hash = words.text(1)};
    const bool estimates = words.text(2) == "estimates";
    if (estimates) series.reference_error = words.number(4);
    const std::size_t weight = estimates ? 6 : 4;
    series.weight = words.number(weight);
    series.test = words.text(weight + 1);
    series.channel = words.text(weight + 2);
    if (!(series.reference_error.value_or(0) >= 0 && series.weight > 0 && series.weight <= 1)) {
      changed();
    }
    book_.open(series);
  }

  void take_night(const Words& words) {
    LedgerNight night{.date = words.text(1),
                      .seed = words.number<std::uint64_t>(3),
                      .commit = words.text(5),
                      .value = NightPValue{words.number(9)}};
    const bool estimate = words.text(8) == "estimate";
    if (estimate) {
      night.value = stats::NightEstimate{.difference = words.number(9),
                                         .standard_error = words.number(11),
                                         .observations = words.number(13),
                                         .effective = words.number(15)};
    }
    const auto possible = [](const auto& value) { return is_possible(value); };
    if (!std::visit(possible, night.value)) changed();
    const std::size_t test = estimate ? 16 : 10;
    const LedgerSeries* const series = book_.open_series(
        {.hash = words.text(7), .test = words.text(test), .channel = words.text(test + 1)});
    if (series == nullptr) refuse("no open series above has this night's hash and test" + mend());
    if (series->has_estimates() != estimate) changed();
    night.series = static_cast<std::size_t>(series - book_.series_.data());
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
