#include <fmt/format.h>

#include <algorithm>

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

constexpr std::size_t cell_limit = 300;
constexpr std::size_t paragraph_limit = 4000;

std::string cell(const std::string& text, std::size_t limit = cell_limit) {
  return escape_markdown(cap(clean(text), limit));
}

// A fence that the text cannot close.
std::string code_block(const std::string& text) {
  std::size_t longest = 0, run = 0;
  for (const char c : text) {
    run = c == '`' ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  const std::string fence(std::max<std::size_t>(3, longest + 1), '`');
  return fmt::format("{}sh\n{}\n{}\n", fence, text, fence);
}

std::string problem(const Test& test) {
  std::string out =
      fmt::format("### {} {}: {}\n\n", mark(standing(test)), verdict_text(test), cell(test.name));
  for (const auto& [label, sentence] : facts(test))
    out += fmt::format("- {}: {}\n", label, cell(sentence, paragraph_limit));
  if (!test.replay.empty())
    out += fmt::format("\n{}", code_block(cap(one_line(test.replay), paragraph_limit)));
  return out + "\n";
}

std::string row(const Test& test) {
  return fmt::format("| {} {} | {} | {} | {} | {} |\n", mark(standing(test)), verdict_text(test),
                     cell(test.name), cell(key_number(test)), cell(cost_text(test)),
                     duration(total_cost(test).seconds));
}

// Which method sees which defect.
std::string kill_section(const Suite& suite) {
  const KillMatrix matrix = kill_matrix(suite);
  if (!is_worth_showing(matrix)) return {};
  std::string out =
      fmt::format("### Which method sees which defect\n\n{}\n\n{}\n\n| mutant |",
                  cell(matrix.totals, paragraph_limit), cell(matrix.legend, paragraph_limit));
  for (const std::string& method : matrix.methods) out += fmt::format(" {} |", cell(method));
  out += "\n|---|";
  for (std::size_t m = 0; m < matrix.methods.size(); ++m) out += "---|";
  out += "\n";
  for (const KillRow& row : matrix.rows) {
    out += fmt::format("| {} |", cell(row.mutant));
    for (const auto& one : row.cells) out += fmt::format(" {} |", one ? cell(one->text) : "");
    out += "\n";
  }
  return out + "\n";
}

// Pieces up to a limit that leaves room for the note on what is missing.
class Page {
 public:
  explicit Page(std::size_t limit) : limit_(limit > note_room ? limit - note_room : 0) {}

  /// Adds the piece, or what is missing without it to a count.
  bool add(const std::string& piece, std::size_t& missing, std::size_t lost = 1) {
    const bool fits = text_.size() + piece.size() <= limit_;
    if (fits) text_ += piece;
    if (!fits) missing += lost;
    return fits;
  }
  std::string take() { return std::move(text_); }

  static constexpr std::size_t note_room = 256;

 private:
  std::string text_;
  std::size_t limit_;
};

std::string title(const Record& record) {
  std::string out = fmt::format("# {}\n\n", run_sentence(record));
  out += cell(fmt::format("{} {} {}, seed {}, {}", record.tool.name, record.tool.version,
                          record.tool.commit, record.seed, record.started)) +
         "\n\n";
  if (const std::string counts = counts_text(standings(record)); !counts.empty())
    out += cell(counts + ". " + error_rates(record)) + "\n\n";
  if (!record.note.empty()) out += cell(record.note, paragraph_limit) + "\n\n";
  return out;
}

std::string ledger_section(const Ledger& ledger) {
  std::string out = fmt::format("## {}\n\n", cell(ledger_title(ledger)));
  for (const LedgerSeries& series : ledger.series) {
    if (!series.alarm) continue;
    out += fmt::format("- {} **alarm** {}: {} {}.\n", mark(Standing::broken),
                       cell(series_name(ledger, series)),
                       cell(alarm_sentence(series), paragraph_limit),
                       cell(series_sentence(series), paragraph_limit));
  }
  if (const std::string text = quiet_sentence(ledger); !text.empty())
    out += fmt::format("- {}\n", cell(text, paragraph_limit));
  for (const std::string& note : ledger_notes(ledger))
    out += fmt::format("- {}\n", cell(note, paragraph_limit));
  return out + "\n";
}

// The answers to the suites' statements.
std::string statements_section(const Record& record) {
  if (statement_count(record) == 0) return {};
  std::string out = fmt::format(
      "## Statements\n\n{}\n\n| statement | answer | tests that answer it |\n|---|---|---|\n",
      cell(statement_totals(record)));
  for (const Suite& suite : record.suites) {
    for (const Statement& statement : suite.statements) {
      const bool both = !statement.holds.empty() && !statement.fails.empty();
      std::string tests = findings(suite, statement.holds);
      if (both) tests = "it holds: " + tests + ". It does not: ";
      tests += findings(suite, statement.fails);
      out +=
          fmt::format("| {} ({}) | **{}** | {} |\n", cell(statement.text), cell(statement.source),
                      cell(whole_answer(suite, statement)), cell(tests, 4 * cell_limit));
    }
  }
  return out + "\n";
}

void add_table(const Suite& suite, Page& page, std::size_t& missing) {
  std::string head = fmt::format("## {}\n\n", cell(suite.name));
  if (!suite.about.empty()) head += cell(suite.about, paragraph_limit) + "\n\n";
  head += cell(levels_text(suite)) +
          "\n\n| verdict | test | effect [interval] | cost | CPU time |\n|---|---|---|---|---|\n";
  if (suite.tests.empty() || !page.add(head, missing, suite.tests.size())) return;
  for (const Test& test : suite.tests) page.add(row(test), missing);
  page.add("\n", missing, 0);
  page.add(kill_section(suite), missing);
}

}  // namespace

std::string markdown(const Record& record, std::size_t limit) {
  Page page(limit);
  std::size_t problems = 0, rows = 0;
  page.add(title(record), rows, 0);
  page.add(statements_section(record), rows, statement_count(record));
  if (!record.ledger.file.empty()) page.add(ledger_section(record.ledger), rows, 0);
  std::vector<const Test*> tests = tests_of(record);
  std::ranges::stable_partition(tests, is_failed, [](const Test* test) { return standing(*test); });
  for (const Test* test : tests) {
    if (is_trouble(standing(*test))) page.add(problem(*test), problems);
  }
  for (const Suite& suite : record.suites) add_table(suite, page, rows);
  std::string out = page.take();
  if (problems > 0 || rows > 0)
    out += fmt::format(
        "\nCut to fit: {} descriptions and {} table rows are missing here; the JSON "
        "record has them all.\n",
        problems, rows);
  return out;
}

}  // namespace assay::reports
