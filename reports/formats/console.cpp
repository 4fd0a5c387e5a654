#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>

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
constexpr int error_lines = 8;  // of one whose source has words of its own
constexpr int block_indent = 4;
constexpr int unlimited = std::numeric_limits<int>::max();

/// One test alone, as of `check`.
bool is_single(const Record& record) {
  return record.suites.size() == 1 && record.suites[0].tests.size() == 1;
}

std::string spaces(int count) {
  return std::string(static_cast<std::size_t>(std::max(0, count)), ' ');
}

std::string plain(const std::string& text) { return plain_spaces(one_line(text)); }

const char* colour_of(Standing standing) {
  constexpr const char* colours[] = {"\x1b[1;31m", "\x1b[1;31m", "\x1b[33m",
                                     "\x1b[32m",   "\x1b[32m",   "\x1b[2m"};
  return colours[static_cast<int>(standing)];
}

class Screen {
 public:
  explicit Screen(ConsoleOptions options) : options_(std::move(options)) {
    options_.width = std::max(options_.width, least_width);
  }

  /// Each level of detail adds to the one below it.
  void all(const Record& record, const std::set<std::string>& told) {
    if (is_single(record) && options_.detail > 0) options_.detail = 2;
    if (is_single(record) && !in_full()) {
      alone(record.suites[0]);
    } else {
      suites(record);
    }
    blank();
    std::map<std::string, std::string> errors;
    for (const Test* test : tests_of(record)) {
      if (!is_trouble(standing(*test)) || in_full()) continue;
      tell_once(*test, errors, [&](const Test& each) {
        if (!told.contains(each.id)) block(each);
      });
    }
    left_out(record);
    std::uint64_t retries = 0;
    for (const Suite& suite : record.suites) retries += suite.retries.size();
    if (retries > 0)
      paragraph(fmt::format("Programs that failed and were started again: {}.", retries));
    if (in_full()) statements(record);
    const bool of_nights = !record.ledger.file.empty();
    if (of_nights) write(record.ledger);
    if (!record.note.empty() && (in_full() || of_nights)) paragraph(record.note + ".");
  }

  /// A claim that is not as it should be: where, what, and what to do. If that takes too many
  /// lines, the last one says where to read all of it. The claim of `check` has no place.
  void block(const Test& test) {
    const Standing how = standing(test);
    const std::string verdict = verdict_text(test) + ": ";
    const int used = head(fmt::format("{} {}{}", mark(how), verdict, test.id), place(test), how);
    const std::vector<Step> all = steps(test);
    std::string told = trouble(test);
    if (told.starts_with(verdict)) told.erase(0, verdict.size());
    const int width = options_.width - block_indent;
    std::vector<std::string> text = wrapped(told, width);
    std::vector<std::string> next, last;
    // What a user is asked for is a step of its own.
    const bool asked = !all.empty() && all[0].label != "again";
    if (!all.empty()) next = step_lines(all[0]);
    const int most = place(test).empty()              ? unlimited
                     : test.verdict == Verdict::error ? error_lines
                                                      : block_lines;
    const auto room = [&](const std::vector<std::string>& others, int least) {
      return std::max(least, most - used - static_cast<int>(others.size() + last.size()));
    };
    if (test.verdict == Verdict::fail && asked && !test.replay.empty()) {
      last = step_lines(*std::ranges::find(all, "again", &Step::label));
      if (const int note = room(text, 1); std::ssize(next) > note) {
        const std::string rest = " (assay explain TEST)";
        next.resize(static_cast<std::size_t>(note));
        next.back() = shorten(next.back() + "…", options_.width - columns(rest)) + rest;
      }
    }
    if (std::ssize(text) > room(next, 2)) {
      if (!asked && test.verdict != Verdict::fail) next.clear();
      const std::vector<std::string> more = step_lines(explanation(test.id));
      last.insert(last.end(), more.begin(), more.end());
      text = cut(wrapped(told, width - 1), room(next, 2));
    }
    indented(text, unlimited);
    put(next);
    put(last);
    blank();
  }

  void end(const Record& record) {
    slowest(record);
    blank();
    if (in_full()) paragraph("Claims: " + counts_text(standings(record)) + ".");
    Standings count = standings(record);
    Standing how = alarms(record.ledger) > 0 ? Standing::broken : worst(count);
    if (!is_trouble(how) && count[Standing::not_run] > 0) how = Standing::not_run;
    std::string text = mark(how) + " " + run_sentence(record);
    if (record.seconds > 0) text += " in " + time(record.seconds);
    text += ".";
    const std::string rates = in_full() ? error_rates(record) : false_alarms(record);
    for (const std::string& more : {rates, options_.ending})
      text += (more.empty() ? "" : " ") + more;
    paragraph(text, colour_of(how));
    if (!options_.report.empty()) out_ += "  " + plain(options_.report) + "\n";
  }
  std::string take() { return std::move(out_); }

 private:
  /// All numbers are asked for.
  bool in_full() const { return options_.detail > 1; }

  void line(std::string text, const char* style = "") {
    text.erase(text.find_last_not_of(' ') + 1);
    text = shorten(text, options_.width);
    out_ += options_.colour && *style != '\0' ? style + text + "\x1b[0m\n" : text + "\n";
  }

  void paragraph(const std::string& text, const char* style = "") {
    for (const std::string& part : wrapped(text, options_.width)) line(part, style);
  }

  // Lines to paste are never cut.
  void put(const std::vector<std::string>& lines) {
    for (const std::string& part : lines) out_ += part + "\n";
  }

  // One empty line, never two.
  void blank() {
    if (!out_.empty() && !out_.ends_with("\n\n")) out_ += "\n";
  }

  // No-break spaces keep numbers and units together until the lines are made. Lines that are empty
  // in the text say nothing on a terminal.
  static std::vector<std::string> wrapped(const std::string& text, int width) {
    std::vector<std::string> lines = wrap(clean(text), width);
    for (std::string& part : lines) part = plain_spaces(part);
    std::erase(lines, "");
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

  int beside_width() const { return options_.width - label_width - 6; }

  void fact(const std::string& label, const std::string& text) {
    for (const std::string& part : beside(in_column(label), wrapped(text, beside_width())))
      line(part);
  }

  /// Seconds as a reader of a summary wants them: "0.4 s", "25 s".
  static std::string time(double seconds) {
    constexpr double few = 10, minute = 60;
    if (seconds < few) return fmt::format("{:.1f} s", seconds);
    return seconds < minute ? fmt::format("{:.0f} s", seconds) : plain(duration(seconds));
  }

  /// The name of a block, with its place beside it or below. Returns the number of lines.
  int head(const std::string& name, const std::string& where, Standing how) {
    constexpr int least = 28;  // of a name that gives way to its place
    const int room = options_.width - columns(where) - 2;
    const bool beside = !where.empty() && room >= std::min(least, columns(plain(name)));
    const std::string left = beside ? shorten(plain(name), room) : plain(name);
    line(beside ? pad_right(left, room + 2) + plain(where) : left, colour_of(how));
    if (!beside && !where.empty()) line(spaces(block_indent) + plain(where));
    return beside || where.empty() ? 1 : 2;
  }

  /// So many lines at most; what is cut ends in an ellipsis.
  void indented(const std::vector<std::string>& text, int most) {
    for (const std::string& part : cut(text, most)) line(spaces(block_indent) + part);
  }
  void indented(const std::string& text, int most = unlimited) {
    indented(wrapped(text, options_.width - block_indent), most);
  }

  /// The first so many lines, and two more if brackets hold an interval there. If that leaves some
  /// out, "…" ends the last.
  static std::vector<std::string> cut(std::vector<std::string> lines, int most) {
    bool inside = false;
    std::size_t end = 0;
    for (; end < lines.size() && static_cast<int>(end) - (inside ? 2 : 0) < most; ++end) {
      const std::size_t bracket = lines[end].find_last_of("()");
      if (bracket != std::string::npos) inside = lines[end][bracket] == '(';
    }
    if (end == lines.size()) return lines;
    lines.resize(end);
    if (end > 0) lines.back() += "…";
    return lines;
  }

  /// A test's id to paste may be cut: a part of it selects the test too.
  std::vector<std::string> step_lines(const Step& step) const {
    const std::string label = step.label + ": ";
    const int room = options_.width - block_indent - columns(label);
    if (step.paste.empty()) return beside(spaces(block_indent) + label, wrapped(step.words, room));
    std::string text = plain(step.paste);
    for (const auto& [lead, end] : {std::pair(" --filter '", "*'"), std::pair(" explain '", "'")}) {
      const std::size_t at = text.rfind(lead);
      if (at == std::string::npos || columns(text.substr(at + 1)) <= room - 2) continue;
      std::string id = shorten(text.substr(at + 1), room - 3);
      id.erase(id.size() - std::string_view("…").size());
      id.erase(id.find_last_not_of("'\\") + 1);  // no half of a quoted quote
      text = text.substr(0, at + 1) + id + end;
    }
    return beside(spaces(block_indent) + label, wrap_command(text, room));
  }

  static Standing worst(const Standings& counts) {
    return counts.empty() ? Standing::not_run : counts.begin()->first;
  }

  /// The ids of its tests begin with this.
  static std::string name_of(const Suite& suite) {
    const std::string id = suite.tests.empty() ? suite.name : suite.tests[0].id;
    return plain(id.substr(0, id.find('/')));
  }

  /// A line a suite; beside it the CPU time of its draws, if there is room.
  void suites(const Record& record) {
    constexpr int gap = 4;  // two columns before the mark, two with it
    constexpr int least_name = 12;
    const auto spent = [](const Suite& suite) {
      return "  " + time(total_cost(suite).seconds) + " CPU";
    };
    int name = 0, text = 0, cost = 0;
    for (const Suite& suite : record.suites) {
      name = std::max(name, columns(name_of(suite)));
      text = std::max(text, columns(counts_text(standings(suite))));
      cost = std::max(cost, columns(spent(suite)));
    }
    if (name + gap + text + cost > options_.width) cost = 0;
    name = std::min(name, std::max(least_name, options_.width - gap - text));
    for (const Suite& suite : record.suites) {
      if (suite.tests.empty()) continue;
      const Standing how = worst(standings(suite));
      const bool marked = is_trouble(how);
      const std::string left =
          fmt::format("{}  {} {}", pad_right(shorten(name_of(suite), name), name),
                      marked ? mark(how) : " ", counts_text(standings(suite)));
      const std::string right = cost > 0 ? spent(suite) : std::string();
      line(pad_right(left, name + gap + text + cost - columns(right)) + right,
           marked ? colour_of(how) : "");
      if (in_full()) {
        indented(suite.about);
        indented(levels_text(suite) + (suite.file.empty() ? "" : ", file " + suite.file));
        if (suite.tests.size() == 1) estimators(suite);
      }
      if (options_.detail > 0) rows(suite);
      if (in_full()) kills(suite);
    }
  }

  /// A line a test. In full the names are whole, and claims that need a look have all their facts.
  void rows(const Suite& suite) {
    struct Row {
      std::string name, number, cost;  // no-break spaces keep numbers whole
    };
    std::vector<Row> all;
    int name = 0, number = 0, cost = 0;
    for (const Test& test : suite.tests) {
      const TestDisplay words = display(test);  // the numbers of the page
      std::string text = words.effect.empty() ? words.verdict : words.effect;
      if (!words.interval.empty()) text += fmt::format(" ({})", words.interval);
      if (is_evidence(test) && test.channels.size() > 1)
        text += " of " + deciding_channel(test).name;
      all.push_back({one_line(test.name), one_line(text), one_line(cost_text(test))});
      name = std::max(name, columns(all.back().name));
      number = std::max(number, columns(all.back().number));
      cost = std::max(cost, columns(all.back().cost));
    }
    constexpr int margin = 4, gap = 2;
    if (margin + name + gap + number + gap + cost > options_.width) cost = 0;
    const bool below = cost == 0 && all.size() == 1;
    const int end =
        std::min(options_.width, margin + name + gap + number + (cost > 0 ? gap + cost : 0));
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Test& test = suite.tests[i];
      std::string right = all[i].number;
      if (cost > 0) right += spaces(gap + cost - columns(all[i].cost)) + all[i].cost;
      const int room = end - margin - gap - columns(right);
      const std::vector<std::string> left =
          in_full() ? wrap(all[i].name, room) : std::vector{shorten(all[i].name, room)};
      const std::string first = pad_right(left[0], room + gap) + right;
      const char* const style = colour_of(standing(test));
      line(fmt::format("  {} {}", mark(standing(test)), plain_spaces(first)), style);
      for (std::size_t part = 1; part < left.size(); ++part)
        line(spaces(margin) + plain_spaces(left[part]), style);
      if (below) indented(all[i].cost);
      if (in_full() && (is_trouble(standing(test)) || all.size() == 1)) explain(test);
    }
    blank();
  }

  /// One test alone: a pass says what it excludes, and how to repeat it.
  void alone(const Suite& suite) {
    const Test& test = suite.tests[0];
    if (const Standing how = standing(test); is_trouble(how) || how == Standing::not_run) return;
    rows(suite);
    out_.erase(out_.size() - 1);  // no empty line between
    if (!test.message.empty()) indented(trouble(test));
    for (const Step& step : steps(test)) put(step_lines(step));
  }

  /// Tests that were left out, those of one reason together.
  void left_out(const Record& record) {
    std::map<std::string, std::uint64_t> why;
    for (const Test* test : tests_of(record)) {
      if (standing(*test) == Standing::not_run) ++why[trouble(*test)];
    }
    for (const auto& [reason, count] : why) {
      head(fmt::format("{} {} not run", mark(Standing::not_run), counted(count, "claim", "claims")),
           "", Standing::not_run);
      indented(reason);
      blank();
    }
  }

  void write(const Ledger& ledger) {
    for (const LedgerSeries& series : ledger.series) {
      if (!series.alarm) continue;
      const int used = head(
          fmt::format("{} ledger alarm: {}", mark(Standing::broken), series_name(ledger, series)),
          ledger.file, Standing::broken);
      indented(alarm_sentence(series), in_full() ? unlimited : block_lines - used);
      if (in_full()) indented(series_sentence(series));
      put(step_lines(explanation(series.test)));
      blank();
    }
    paragraph(one_line(ledger_title(ledger)) + ".");
    if (const std::string text = quiet_sentence(ledger); in_full() && !text.empty())
      paragraph(one_line(text) + ".");
    for (const std::string& note : ledger_notes(ledger)) paragraph(one_line(note) + ".");
  }

  void slowest(const Record& record) {
    const auto seconds = [](const Test* test) { return total_cost(*test).seconds; };
    std::vector<const Test*> all = tests_of(record);
    std::ranges::stable_sort(all, std::greater(), seconds);
    all.resize(std::min<std::size_t>(all.size(), options_.slowest));
    if (all.empty()) return;
    blank();
    line("Slowest, by CPU time of their draws:");
    for (const Test* test : all)
      line(fmt::format("{:>12}  {}", time(seconds(test)), plain(test->id)));
  }

  // The answers stand in a column, with the statement and its tests beside them.
  void statements(const Record& record) {
    if (statement_count(record) == 0) return;
    blank();
    line("Statements", "\x1b[1m");
    for (const Suite& suite : record.suites) {
      for (const Statement& statement : suite.statements) {
        fact(answer_text(answer(suite, statement)),
             one_line(statement.text + " (" + statement.source + ")"));
        fact("only if", one_line(statement.condition));
        fact("it holds", one_line(findings(suite, statement.holds)));
        fact("it does not", one_line(findings(suite, statement.fails)));
      }
    }
    paragraph(statement_totals(record));
    blank();
  }

  /// Which method sees which defect: a line a mutant.
  void kills(const Suite& suite) {
    const KillMatrix matrix = kill_matrix(suite);
    if (!is_worth_showing(matrix)) return;
    for (const KillRow& row : matrix.rows) {
      std::vector<std::string> parts;
      for (std::size_t m = 0; m < row.cells.size(); ++m) {
        if (row.cells[m]) parts.push_back(matrix.methods[m] + " " + row.cells[m]->text);
      }
      indented(one_line(fmt::format("{}: {}", row.mutant, fmt::join(parts, ", "))));
    }
    blank();
    paragraph(matrix.totals);
    paragraph(matrix.legend);
    blank();
  }

  void explain(const Test& test) {
    for (const auto& [label, sentence] : facts(test)) fact(label, sentence);
    if (!test.replay.empty())
      put(beside(in_column("replay"), wrap_command(plain(test.replay), beside_width())));
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
    return fmt::format("{} ({} to {})", value, human(estimate.low), human(estimate.high));
  }

  ConsoleOptions options_;
  std::string out_;
};

}  // namespace

std::string broken_claim(const Test& test, const ConsoleOptions& options) {
  Screen screen(options);
  screen.block(test);
  return screen.take();
}

std::string console(const Record& record, const ConsoleOptions& options,
                    const std::set<std::string>& told) {
  Screen screen(options);
  screen.all(record, told);
  screen.end(record);
  return screen.take();
}

}  // namespace assay::reports
