#include "reports/formats/console.h"

#include <fmt/format.h>

#include <algorithm>

#include "reports/formats/console_rows.h"
#include "reports/words/columns.h"
#include "reports/words/describe.h"
#include "reports/words/kill_matrix.h"
#include "reports/words/kill_text.h"
#include "reports/words/ledger.h"
#include "reports/words/number.h"
#include "reports/words/statement_text.h"
#include "reports/words/summary.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

constexpr int least_width = 60;
constexpr int label_width = 17;
constexpr std::size_t most_channels = 24;

// A terminal renders a no-break space in its own way: copied text should hold plain ones.
std::string plain_spaces(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const char32_t c = next_code_point(text, i);
    append_code_point(result, c == 0xA0 ? U' ' : c);
  }
  return result;
}

std::string plain(const std::string& text) { return plain_spaces(one_line(text)); }

const char* colour_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::passed:
      return "\x1b[32m";
    case Outcome::failed:
      return "\x1b[1;31m";
    case Outcome::inconclusive:
      return "\x1b[33m";
    case Outcome::skipped:
      break;
  }
  return "\x1b[2m";
}

class Screen {
 public:
  explicit Screen(ConsoleOptions options) : options_(options) {
    options_.width = std::max(options_.width, least_width);
  }

  void run(const Record& record) {
    for (const Suite& suite : record.suites) write(suite);
    if (!record.note.empty()) paragraph(record.note);
    statements(record);
    if (!record.ledger.file.empty()) write(record.ledger);
    summary(record);
  }
  std::string take() { return std::move(out_); }

 private:
  void line(const std::string& text) { out_ += shorten(text, options_.width) + "\n"; }

  void line(const std::string& text, const char* style) {
    out_ += options_.colour ? style + shorten(text, options_.width) + "\x1b[0m\n"
                            : shorten(text, options_.width) + "\n";
  }

  // Lines that are empty in the text say nothing on a terminal.
  void paragraph(const std::string& text) {
    for (const std::string& part : wrapped(text, options_.width)) {
      if (!part.empty()) line(part);
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

  // A label in a column of its own, then lines beside it.
  void beside(const std::string& label, const std::vector<std::string>& lines) {
    std::string first = pad_right("      " + label, label_width + 6);
    for (const std::string& part : lines) {
      line(first + part);
      first.assign(static_cast<std::size_t>(label_width + 6), ' ');
    }
  }

  // A command is never cut, because it is meant to be pasted.
  void command(const std::string& label, const std::string& text) {
    std::string first = pad_right("      " + label, label_width + 6);
    for (const std::string& part : wrap_command(text, beside_width())) {
      out_ += first + part + "\n";
      first.assign(static_cast<std::size_t>(label_width + 6), ' ');
    }
  }

  int beside_width() const { return options_.width - label_width - 6; }

  void fact(const std::string& label, const std::string& text) {
    std::vector<std::string> lines = wrapped(text, beside_width());
    std::erase(lines, "");
    beside(label, lines);
  }

  void write(const Suite& suite) {
    const std::string file = suite.file.empty() ? "" : " (" + suite.file + ")";
    for (const std::string& part : wrapped(one_line(suite.name + file), options_.width))
      line(part, "\x1b[1m");
    paragraph(suite.about);
    paragraph(levels_text(suite));
    const std::string confidence = common_confidence(suite);
    if (!confidence.empty())
      paragraph(
          fmt::format("Brackets are {} intervals unless another confidence is given.", confidence));
    blank();
    if (options_.verbose) estimators(suite);
    std::vector<TestRow> rows;
    for (const Test& test : suite.tests) rows.push_back(row_of(test, confidence));
    const RowLayout layout = layout_of(rows, options_.width);
    for (std::size_t i = 0; i < rows.size(); ++i) write(suite.tests[i], row_lines(rows[i], layout));
    blank();
    if (layout.cost == 0 && !rows.empty()) cost_of(suite);
    kills(suite);
  }

  void write(const Test& test, const std::vector<std::string>& lines) {
    const Outcome result = outcome(test);
    for (const std::string& part : lines) line(plain_spaces(part), colour_of(result));
    if (result == Outcome::failed || result == Outcome::inconclusive || options_.verbose)
      explain(test);
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
    std::string first = pad_right("  " + answer_text(given), label_width + 6);
    for (const std::string& part : text) {
      line(first + part, colour_of(outcome));
      first.assign(static_cast<std::size_t>(label_width + 6), ' ');
    }
    if (given == Answer::only_if) fact("only if", one_line(statement.condition));
    if (!statement.holds.empty()) fact("it holds", one_line(findings(suite, statement.holds)));
    if (!statement.fails.empty()) fact("it does not", one_line(findings(suite, statement.fails)));
  }

  // Which method sees which defect.
  void kills(const Suite& suite) {
    const KillMatrix matrix = kill_matrix(suite);
    if (!is_worth_showing(matrix)) return;
    for (const std::string& text : kill_lines(suite, matrix, options_.width)) line(plain(text));
    blank();
    paragraph(kill_totals(suite, matrix));
    paragraph(kill_matrix_legend);
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
    const std::string value = data_text(estimate.value);
    if (!estimate.low || !estimate.high) return value;
    return fmt::format("{} [{}, {}]", value, human(estimate.low), human(estimate.high));
  }

  void write(const Ledger& ledger) {
    blank();
    const Outcome result = alarms(ledger) > 0 ? Outcome::failed : Outcome::passed;
    for (const std::string& part : wrapped(one_line(ledger_title(ledger)), options_.width)) {
      line(part, colour_of(result));
    }
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

  void list(const Record& record, Outcome kind, const std::string& heading) {
    bool first = true;
    for (const Suite& suite : record.suites) {
      for (const Test& test : suite.tests) {
        if (outcome(test) != kind) continue;
        if (first) line(heading, colour_of(kind));
        first = false;
        const std::string name = one_line(test.id.empty() ? test.name : test.id);
        for (const std::string& part :
             wrapped(verdict_text(test) + ": " + name, options_.width - 2))
          line("  " + part);
      }
    }
  }

  void summary(const Record& record) {
    const Tally counts = tally(record);
    blank();
    list(record, Outcome::failed, "Not ok:");
    list(record, Outcome::inconclusive, "Undecided:");
    const std::string took =
        record.seconds > 0 ? " in " + plain(duration(record.seconds)) : std::string();
    const std::string verdicts = verdict_counts(record);
    if (const std::string alarm = alarm_count(record); !alarm.empty()) {
      line("Not ok: " + alarm, colour_of(Outcome::failed));
    }
    paragraph(tally_sentence(counts) + took + "." +
              (verdicts.empty() ? "" : " Verdicts: " + verdicts + "."));
    paragraph(error_rates(record));
    paragraph(last_line_note(record));
    out_ += fmt::format("{} passed, {} failed, {} skipped\n", counts.passed, counts.failed,
                        counts.skipped + counts.inconclusive);
  }

  ConsoleOptions options_;
  std::string out_;
};

}  // namespace

std::string console(const Record& record, ConsoleOptions options) {
  Screen screen(options);
  screen.run(record);
  return screen.take();
}

}  // namespace assay::reports
