#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "reports/report_formats.h"
#include "reports/words/describe.h"
#include "reports/words/display.h"
#include "reports/words/kill_matrix.h"
#include "reports/words/ledger.h"
#include "reports/words/number.h"
#include "reports/words/statements.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

constexpr int least_width = 40;
constexpr int label_width = 17;
constexpr std::size_t most_channels = 24;
constexpr int block_lines = 5;  // of a claim that is not as it should be
constexpr int block_indent = 4;

/// One test alone, as of `check`.
bool is_single(const Record& record) {
  return record.suites.size() == 1 && record.suites[0].tests.size() == 1;
}

std::string plain(const std::string& text) { return plain_spaces(one_line(text)); }

const char* colour_of(Outcome outcome) {
  constexpr const char* colours[] = {"\x1b[32m", "\x1b[1;31m", "\x1b[33m", "\x1b[2m"};
  return colours[static_cast<int>(outcome)];
}

/// One test as text, clean and without line feeds; no-break spaces keep numbers whole.
struct TestRow {
  std::string verdict;  ///< with its mark
  std::string name;
  std::string number;
  std::string cost;
};

/// Columns of a suite's table. If names have too little room, the cost goes first (width 0; the
/// suite's totals have it). Then the number moves below the name.
struct RowLayout {
  int verdict = 0;
  int name = 0;
  int number = 0;
  int cost = 0;
  bool number_below = false;
};

constexpr int row_indent = 2;
constexpr int row_gap = 2;
constexpr int least_row_name = 30;

template <class Member>
int widest(const std::vector<TestRow>& rows, Member member) {
  int result = 0;
  for (const TestRow& row : rows) result = std::max(result, columns(row.*member));
  return result;
}

int with_gap(int width) { return width > 0 ? width + row_gap : 0; }

int name_room(const RowLayout& layout, int width) {
  return width - row_indent - with_gap(layout.verdict) - with_gap(layout.cost) -
         (layout.number_below ? 0 : with_gap(layout.number));
}

std::string trimmed(std::string text) {
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

RowLayout layout_of(const std::vector<TestRow>& rows, int width) {
  RowLayout layout{.verdict = widest(rows, &TestRow::verdict),
                   .number = widest(rows, &TestRow::number),
                   .cost = widest(rows, &TestRow::cost)};
  if (name_room(layout, width) < least_row_name) layout.cost = 0;
  layout.number_below = name_room(layout, width) < least_row_name;
  layout.name = name_room(layout, width);
  return layout;
}

/// The lines of one row, none wider than the width that the layout was made for.
std::vector<std::string> row_lines(const TestRow& row, const RowLayout& layout) {
  const std::string margin(static_cast<std::size_t>(row_indent + with_gap(layout.verdict)), ' ');
  const std::vector<std::string> name = wrap(row.name, layout.name);
  std::string first = std::string(row_indent, ' ') +
                      pad_right(row.verdict, with_gap(layout.verdict)) +
                      pad_right(name.front(), with_gap(layout.name));
  if (!layout.number_below) first += pad_right(row.number, with_gap(layout.number));
  if (layout.cost > 0) first += row.cost;
  std::vector<std::string> lines = {trimmed(first)};
  for (std::size_t i = 1; i < name.size(); ++i) lines.push_back(margin + name[i]);
  if (layout.number_below && !row.number.empty()) {
    for (const std::string& part : wrap(row.number, layout.name)) lines.push_back(margin + part);
  }
  return lines;
}

/// The confidence of most of a suite's intervals, as "99.98 %": it is said once, above the table.
std::string common_confidence(const Suite& suite) {
  std::map<std::string, int> counts;
  for (const Test& test : suite.tests) {
    const Effect effect = deciding_channel(test).effect;
    if (is_evidence(test) && effect.estimate && !interval_text(effect).empty())
      ++counts[confidence_text(effect.confidence)];
  }
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? std::string() : most->first;
}

/// The row of a test in a suite whose common confidence is given.
TestRow row_of(const Test& test, const std::string& common) {
  const Effect effect = deciding_channel(test).effect;
  std::string number = is_evidence(test) ? effect_text(effect) : std::string();
  if (!is_evidence(test)) {
    // The number rests on a violated assumption; the record has it.
  } else if (number.empty()) {
    number = headline_p(test).text();
  } else if (!interval_text(effect).empty() && confidence_text(effect.confidence) != common) {
    number += fmt::format(" at {}", confidence_text(effect.confidence));
  }
  return {.verdict = mark(outcome(test)) + " " + verdict_text(test),
          .name = one_line(test.name),
          .number = one_line(number),
          .cost = one_line(cost_text(total_cost(test)))};
}

class Screen {
 public:
  explicit Screen(ConsoleOptions options) : options_(std::move(options)) {
    options_.width = std::max(options_.width, least_width);
  }

  void all(const Record& record) {
    for (const Suite& suite : record.suites) write(suite, is_single(record));
    if (!record.note.empty()) paragraph(record.note);
    statements(record);
    if (!record.ledger.file.empty()) write(record.ledger);
    blank();
    if (const std::string verdicts = verdict_counts(record); !verdicts.empty())
      paragraph("Verdicts: " + verdicts + ".");
    paragraph(error_rates(record));
  }

  void brief(const Record& record, const std::set<std::string>& told) {
    if (is_single(record)) {
      alone(record.suites[0]);
    } else {
      suites(record);
    }
    blank();
    for (const Suite& suite : record.suites) {
      for (const Test& test : suite.tests) {
        const Standing how = standing(test);
        const bool shown = how == Standing::broken || how == Standing::undecided;
        if (shown && !told.contains(test.id)) block(suite.name, test);
      }
    }
    left_out(record);
    std::uint64_t retries = 0;
    for (const Suite& suite : record.suites) retries += suite.retries.size();
    if (retries > 0)
      paragraph(fmt::format("Programs that failed and were started again: {}.", retries));
    if (!record.ledger.file.empty()) alarms_of(record);
  }

  /// A claim that is not as it should be: where, what, and what to do. If that takes too many
  /// lines, the last one says where to read all of it. The claim of `check` has no place.
  void block(const std::string& suite, const Test& test) {
    const Outcome how = outcome(test);
    const int used = head(fmt::format("{} {}: {}", mark(how), suite, test.name), place(test), how);
    std::vector<Step> next = steps(test);
    next.resize(std::min<std::size_t>(next.size(), 1));
    std::vector<std::string> text = wrapped(trouble(test), options_.width - block_indent);
    std::erase(text, "");
    const auto below = [&] {
      return next.empty() ? 0 : static_cast<int>(step_lines(next[0]).size());
    };
    int most = std::max(1, block_lines - used - below());
    if (place(test).empty()) {
      most = static_cast<int>(text.size());
    } else if (most < static_cast<int>(text.size()) && test.verdict != Verdict::fail) {
      next = {explanation(test)};
      most = std::max(1, block_lines - used - below());
    }
    indented(text, most);
    for (const Step& step : next) paste(step);
    blank();
  }

  void end(const Record& record) {
    slowest(record);
    blank();
    const Outcome how = alarms(record.ledger) > 0 ? Outcome::failed : worst(tally(record));
    std::string text = mark(how) + " " + run_sentence(record);
    if (record.seconds > 0) text += " in " + time(record.seconds);
    text += ".";
    if (const std::string rate = false_alarms(record); !rate.empty()) text += " " + rate;
    paragraph(text, colour_of(how));
    if (!options_.report.empty()) out_ += "  " + plain(options_.report) + "\n";
  }
  std::string take() { return std::move(out_); }

 private:
  void line(const std::string& text, const char* style = "") {
    out_ += options_.colour && *style != '\0' ? style + shorten(text, options_.width) + "\x1b[0m\n"
                                              : shorten(text, options_.width) + "\n";
  }

  // Lines that are empty in the text say nothing on a terminal.
  void paragraph(const std::string& text, const char* style = "") {
    for (const std::string& part : wrapped(text, options_.width)) {
      if (!part.empty()) line(part, style);
    }
  }

  // One empty line, never two.
  void blank() {
    if (!out_.empty() && !out_.ends_with("\n\n")) out_ += "\n";
  }

  // No-break spaces keep numbers and units together until the lines are made.
  static std::vector<std::string> wrapped(const std::string& text, int width) {
    std::vector<std::string> lines = wrap(clean(text), width);
    for (std::string& part : lines) part = plain_spaces(part);
    return lines;
  }

  // The lines, the first after the label, the others as far to the right.
  static std::vector<std::string> beside(std::string label, std::vector<std::string> lines) {
    for (std::string& part : lines) {
      part.insert(0, label);
      label.assign(static_cast<std::size_t>(columns(label)), ' ');
    }
    return lines;
  }

  static std::string in_column(const std::string& label) {
    return pad_right("      " + label, label_width + 6);
  }

  // A command is never cut, because it is meant to be pasted.
  void command(const std::string& label, const std::string& text) {
    for (const std::string& part : beside(in_column(label), wrap_command(text, beside_width())))
      out_ += part + "\n";
  }

  int beside_width() const { return options_.width - label_width - 6; }

  void fact(const std::string& label, const std::string& text) {
    std::vector<std::string> lines = wrapped(text, beside_width());
    std::erase(lines, "");
    for (const std::string& part : beside(in_column(label), lines)) line(part);
  }

  /// Seconds as a reader of a summary wants them: "0.4 s", "25 s".
  static std::string time(double seconds) {
    constexpr double few = 10, minute = 60;
    if (seconds < few) return fmt::format("{:.1f} s", seconds);
    return seconds < minute ? fmt::format("{:.0f} s", seconds) : plain(duration(seconds));
  }

  /// The name of a block, with its place beside it or below. Returns the number of lines.
  int head(const std::string& name, const std::string& where, Outcome how) {
    constexpr int least = 28;  // of a name that gives way to its place
    const int room = options_.width - columns(where) - 2;
    const bool beside = !where.empty() && room >= std::min(least, columns(plain(name)));
    const std::string left = beside ? shorten(plain(name), room) : plain(name);
    line(beside ? pad_right(left, room + 2) + plain(where) : left, colour_of(how));
    if (!beside && !where.empty()) line(std::string(block_indent, ' ') + plain(where));
    return beside || where.empty() ? 1 : 2;
  }

  /// So many lines at most; what is cut ends in an ellipsis.
  void indented(std::vector<std::string> text, int most) {
    std::erase(text, "");
    if (text.size() > static_cast<std::size_t>(most)) {
      text.resize(static_cast<std::size_t>(most));
      text.back() = shorten(text.back() + "…", options_.width - block_indent);
    }
    for (const std::string& part : text) line(std::string(block_indent, ' ') + part);
  }
  void indented(const std::string& text, int most) {
    indented(wrapped(text, options_.width - block_indent), most);
  }

  /// A step to paste. It is never cut, but for a test's id: a part of it selects the test too.
  std::vector<std::string> step_lines(const Step& step) const {
    const std::string label = step.label + ": ";
    const int room = options_.width - block_indent - columns(label);
    std::string text = plain(step.paste);
    for (const auto& [lead, end] : {std::pair(" --filter '", "*'"), std::pair(" explain '", "'")}) {
      const std::size_t at = text.rfind(lead);
      if (at == std::string::npos || columns(text.substr(at + 1)) <= room - 2) continue;
      std::string id = shorten(text.substr(at + 1), room - 3);
      id.erase(id.size() - std::string_view("…").size());
      id.erase(id.find_last_not_of("'\\") + 1);  // no half of a quoted quote
      text = text.substr(0, at + 1) + id + end;
    }
    return beside(label, wrap_command(text, room));
  }

  void paste(const Step& step) {
    for (const std::string& part : step_lines(step))
      out_ += std::string(block_indent, ' ') + part + "\n";
  }

  /// "72 hold, 2 planted bugs caught", "14 as they should be, 1 broken", in short "14 ok, 1
  /// broken".
  static std::string standing_text(const Suite& suite, bool in_short) {
    std::map<Standing, std::uint64_t> count;
    for (const Test& test : suite.tests) ++count[standing(test)];
    const std::uint64_t held = count[Standing::holds], caught = count[Standing::caught];
    std::string text;
    const auto add = [&](std::uint64_t some, const char* words) {
      if (some > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", some, words);
    };
    if (held + caught == suite.tests.size()) {
      add(held, held == 1 ? "holds" : "hold");
      add(caught, caught == 1 ? "planted bug caught" : "planted bugs caught");
      return text;
    }
    add(held + caught, in_short             ? "ok"
                       : held + caught == 1 ? "as it should be"
                                            : "as they should be");
    add(count[Standing::broken], "broken");
    add(count[Standing::undecided], "undecided");
    add(count[Standing::not_run], "not run");
    return text;
  }

  static Outcome worst(const Tally& counts) {
    return counts.failed > 0         ? Outcome::failed
           : counts.inconclusive > 0 ? Outcome::inconclusive
           : counts.passed > 0       ? Outcome::passed
                                     : Outcome::skipped;
  }

  /// A line a suite; beside it the CPU time of its draws.
  void suites(const Record& record) {
    constexpr int gap = 4;  // two columns before the mark, two with it
    constexpr int least_name = 12;
    const auto spent = [](const Suite& suite) {
      return time(total_cost(costs_of_draws(suite)).seconds) + " CPU";
    };
    int longest = 0, text_width = 0, short_width = 0, time_width = 0;
    for (const Suite& suite : record.suites) {
      longest = std::max(longest, columns(plain(suite.name)));
      text_width = std::max(text_width, columns(standing_text(suite, false)));
      short_width = std::max(short_width, columns(standing_text(suite, true)));
      time_width = std::max(time_width, columns(spent(suite)) + 2);
    }
    constexpr int usual_name = 20;
    const bool in_short = std::min(longest, usual_name) + gap + text_width > options_.width;
    if (in_short) text_width = short_width;
    if (longest + gap + text_width + time_width > options_.width) time_width = 0;
    const int room = std::max(least_name, options_.width - gap - text_width);
    const int name_width = std::min(room, longest);
    for (const Suite& suite : record.suites) {
      if (suite.tests.empty()) continue;
      const Outcome how = worst(tally(suite));
      const bool marked = how == Outcome::failed || how == Outcome::inconclusive;
      std::string text = pad_right(shorten(plain(suite.name), name_width), name_width) + "  " +
                         (marked ? mark(how) : " ") + " " + standing_text(suite, in_short);
      if (time_width > 0) {
        const int before = name_width + gap + text_width + time_width - columns(spent(suite));
        text = pad_right(text, before) + spent(suite);
      }
      line(text, marked ? colour_of(how) : "");
      if (options_.detail > 0) rows(suite);
    }
  }

  /// A line a test.
  void rows(const Suite& suite) {
    const std::string confidence = common_confidence(suite);
    std::vector<TestRow> all;
    int name = 0, number = 0, cost = 0;
    for (const Test& test : suite.tests) {
      all.push_back(row_of(test, confidence));
      name = std::max(name, columns(all.back().name));
      number = std::max(number, columns(all.back().number));
      cost = std::max(cost, columns(all.back().cost));
    }
    constexpr int margin = 4, gap = 2;
    if (margin + name + gap + number + gap + cost > options_.width) cost = 0;
    const int end =
        std::min(options_.width, margin + name + gap + number + (cost > 0 ? gap + cost : 0));
    for (std::size_t i = 0; i < all.size(); ++i) {
      std::string right = all[i].number;
      if (cost > 0)
        right += std::string(static_cast<std::size_t>(gap + cost - columns(all[i].cost)), ' ') +
                 all[i].cost;
      const int room = end - margin - gap - columns(right);
      const Outcome how = outcome(suite.tests[i]);
      const std::string left = shorten(all[i].name, room);
      line(fmt::format("  {} {}", mark(how),
                       right.empty() ? left : pad_right(left, room + gap) + plain_spaces(right)),
           colour_of(how));
    }
    if (!confidence.empty()) line(fmt::format("  Brackets: {} intervals.", plain(confidence)));
    blank();
  }

  /// One test alone: a pass says what it excludes, and how to repeat it.
  void alone(const Suite& suite) {
    const Test& test = suite.tests[0];
    if (outcome(test) != Outcome::passed) return;
    rows(suite);
    out_.erase(out_.size() - 1);  // no empty line between
    indented(test.message, block_lines);
    for (const Step& step : steps(test)) paste(step);
  }

  /// Tests that were left out, those of one reason together.
  void left_out(const Record& record) {
    std::map<std::string, std::uint64_t> why;
    for (const Test* test : tests_of(record)) {
      if (standing(*test) == Standing::not_run) ++why[trouble(*test)];
    }
    for (const auto& [reason, count] : why) {
      head(fmt::format("{} {} not run", mark(Outcome::skipped), counted(count, "claim", "claims")),
           "", Outcome::skipped);
      indented(reason, block_lines - 1);
      blank();
    }
  }

  void alarms_of(const Record& record) {
    const Ledger& ledger = record.ledger;
    for (const LedgerSeries& series : ledger.series) {
      if (!series.alarm) continue;
      head(fmt::format("{} ledger alarm: {}", mark(Outcome::failed), series_name(ledger, series)),
           ledger.file, Outcome::failed);
      indented(alarm_sentence(series), block_lines - 2);
      blank();
    }
    paragraph(one_line(ledger_title(ledger)) + ".");
    for (const std::string& note : ledger_notes(ledger)) paragraph(one_line(note) + ".");
    if (!record.note.empty()) paragraph(record.note + ".");
  }

  void slowest(const Record& record) {
    std::vector<std::pair<double, const Test*>> all;
    for (const Test* test : tests_of(record)) all.emplace_back(total_cost(*test).seconds, test);
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    all.resize(std::min<std::size_t>(all.size(), options_.slowest));
    if (all.empty()) return;
    blank();
    line("Slowest, by CPU time of their draws:");
    for (const auto& [seconds, test] : all)
      line(fmt::format("{:>12}  {}", time(seconds), plain(test->id)));
  }

  void write(const Suite& suite, bool alone) {
    const std::string file = suite.file.empty() ? "" : " (" + suite.file + ")";
    paragraph(one_line(suite.name + file), "\x1b[1m");
    paragraph(suite.about);
    paragraph(levels_text(suite));
    const std::string confidence = common_confidence(suite);
    if (!confidence.empty())
      paragraph(
          fmt::format("Brackets are {} intervals unless another confidence is given.", confidence));
    blank();
    if (alone) estimators(suite);
    std::vector<TestRow> rows;
    for (const Test& test : suite.tests) rows.push_back(row_of(test, confidence));
    const RowLayout layout = layout_of(rows, options_.width);
    for (std::size_t i = 0; i < rows.size(); ++i)
      write(suite.tests[i], row_lines(rows[i], layout), alone);
    blank();
    if (layout.cost == 0 && !rows.empty()) cost_of(suite);
    kills(suite);
  }

  void write(const Test& test, const std::vector<std::string>& lines, bool alone) {
    const Outcome result = outcome(test);
    for (const std::string& part : lines) line(plain_spaces(part), colour_of(result));
    if (result == Outcome::failed || result == Outcome::inconclusive || alone) explain(test);
  }

  // The answers stand in a column, with the statement and its tests beside them.
  void statements(const Record& record) {
    if (statement_count(record) == 0) return;
    blank();
    line("Statements", "\x1b[1m");
    for (const Suite& suite : record.suites) {
      for (const Statement& statement : suite.statements) write(suite, statement);
    }
    paragraph(statement_totals(record));
  }

  void write(const Suite& suite, const Statement& statement) {
    const Answer given = answer(suite, statement);
    const Outcome outcome = given == Answer::contradicted ? Outcome::failed
                            : given == Answer::open       ? Outcome::inconclusive
                                                          : Outcome::passed;
    const std::vector<std::string> text =
        wrapped(one_line(statement.text + " (" + statement.source + ")"), beside_width());
    const std::string label = pad_right("  " + answer_text(given), label_width + 6);
    for (const std::string& part : beside(label, text)) line(part, colour_of(outcome));
    if (given == Answer::only_if) fact("only if", one_line(statement.condition));
    if (!statement.holds.empty()) fact("it holds", one_line(findings(suite, statement.holds)));
    if (!statement.fails.empty()) fact("it does not", one_line(findings(suite, statement.fails)));
  }

  // Which method sees which defect.
  void kills(const Suite& suite) {
    const KillMatrix matrix = kill_matrix(suite);
    if (!is_worth_showing(matrix)) return;
    for (const std::string& text : kill_lines(matrix, options_.width)) line(plain(text));
    blank();
    paragraph(matrix.totals);
    paragraph(matrix.legend);
    blank();
  }

  // The table had no room for what each test cost.
  void cost_of(const Suite& suite) {
    if (const std::string cost = cost_text(costs_of_draws(suite)); !cost.empty()) {
      paragraph("All observations of the suite: " + cost + ".");
      blank();
    }
  }

  void explain(const Test& test) {
    for (const auto& [label, sentence] : facts(test)) fact(label, sentence);
    fact("cost", cost_text(total_cost(test)));
    fact("where", place(test));
    if (!test.replay.empty()) command("replay", plain(test.replay));
    blank();
  }

  void estimators(const Suite& suite) {
    for (const EstimatorSummary& estimator : suite.estimators) {
      paragraph(one_line("  " + estimator.name + "  " + estimator.plugin + "  " +
                         cost_text(estimator.cost)));
      const std::string of =
          estimator.variance_of.empty() ? "" : " of one " + estimator.variance_of;
      std::size_t shown = 0;
      for (const EstimatorChannel& channel : estimator.channels) {
        if (++shown > most_channels) break;
        fact(one_line(shorten(clean(channel.name), label_width - 1)),
             fmt::format("mean {}, variance{} {}{}", interval(channel.mean), of,
                         interval(channel.variance),
                         channel.mean.low
                             ? fmt::format(" ({} intervals)", confidence_text(estimator.confidence))
                             : std::string()));
      }
      if (shown > most_channels) {
        fact("…", fmt::format("{} more channels; a report (--report html=FILE) has all of them",
                              estimator.channels.size() - most_channels));
      }
    }
    if (!suite.estimators.empty()) blank();
  }

  static std::string interval(const Estimate& estimate) {
    const bool known = estimate.value && !std::isnan(*estimate.value);
    const std::string value = known ? human(*estimate.value) : "none";
    if (!estimate.low || !estimate.high) return value;
    return fmt::format("{} [{}, {}]", value, human(estimate.low), human(estimate.high));
  }

  void write(const Ledger& ledger) {
    blank();
    const Outcome result = alarms(ledger) > 0 ? Outcome::failed : Outcome::passed;
    paragraph(one_line(ledger_title(ledger)), colour_of(result));
    for (const LedgerSeries& series : ledger.series) {
      if (!series.alarm) continue;
      for (const std::string& part :
           wrapped(one_line("ALARM " + series_name(ledger, series)), options_.width - 2)) {
        line("  " + part);
      }
      fact("nights", series_sentence(series));
      fact("alarm", alarm_sentence(series));
    }
    if (const std::string text = quiet_sentence(ledger); !text.empty())
      paragraph(one_line(text) + ".");
    for (const std::string& note : ledger_notes(ledger)) paragraph(one_line(note) + ".");
  }

  ConsoleOptions options_;
  std::string out_;
};

}  // namespace

std::string Console::broken(const Suite& suite, const Test& test) {
  told_.insert(test.id);
  Screen screen(options_);
  screen.block(suite.name, test);
  return screen.take();
}

std::string Console::rest(const Record& record) const {
  Screen screen(options_);
  if (options_.detail > 1) {
    screen.all(record);
  } else {
    screen.brief(record, told_);
  }
  screen.end(record);
  return screen.take();
}

std::string console(const Record& record, const ConsoleOptions& options) {
  return Console(options).rest(record);
}

}  // namespace assay::reports
