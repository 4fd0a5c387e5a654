#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "harness/command/commands.h"
#include "harness/command/help.h"
#include "harness/plan/plan.h"
#include "harness/run/planned_run.h"
#include "harness/theta/theta.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::harness {
namespace {

constexpr const char* unknown = "-";

constexpr std::size_t column_count = 7;
using Cells = std::array<std::string, column_count>;
const Cells headings{"primaries", "looks", "last", "in all", "rays", "CPU time", "effect"};

struct Row {
  std::string name;
  Cells cells;
  std::vector<std::string> notes;
  double not_ok = 0;
};

std::string count_of(auto count) {
  const auto whole = std::llround(static_cast<double>(count));
  return reports::plain_spaces(reports::count_text(static_cast<std::uint64_t>(whole)));
}

/// The cost of a test's last look, or of several streams.
struct Total {
  double primaries = 0;
  double rays = 0;
  double seconds = 0;
  bool known = true;  ///< rays and seconds are complete

  void add(const Subject& side, std::uint64_t primaries_each, std::uint64_t secondaries,
           const Pilots& pilots) {
    const auto count = static_cast<double>(secondaries);
    primaries += count * static_cast<double>(primaries_of_observation(*side.setup, primaries_each));
    if (const auto cost = observation_cost(side, primaries_each, pilots)) {
      rays += count * cost->rays;
      seconds += count * cost->seconds;
    } else if (!side.setup->observations()) {
      known = false;
    }
  }
};

/// One number, both if the subjects differ, or a sweep's least and most.
std::string primaries_text(const Plan& plan) {
  const auto [least, most] = std::ranges::minmax_element(plan.primaries);
  if (*least == *most) return count_of(*most);
  if (plan.primaries.size() > 2) return count_of(*least) + " to " + count_of(*most);
  return count_of(plan.primaries[0]) + " + " + count_of(plan.primaries[1]);
}

std::string effect_text(const TestOutcome& test, const Forecast& forecast) {
  const Regions& regions = test.plan.regions[0];
  std::optional<double> effect = regions.detect;
  // Given data may find less than `detect` asks for.
  const TestEntry& entry = *test.question.test;
  if (!effect || entry.secondaries || entry.budget || has_rows(test.question)) {
    effect = forecast.detectable;
  }
  if (!effect) return unknown;
  const std::string text = reports::plain_spaces(reports::margin_text(
      *effect, {.quantity = test.question.is().logarithm ? "ln(ratio)" : "",
                .relative = test.question.theta->is_relative(test.question, 0)}));
  constexpr std::string_view factor = "a factor of ";
  return text.starts_with(factor) ? "×" + text.substr(factor.size()) : text;
}

std::string per_cent(double probability) {
  return fmt::format("{} %", reports::human(100 * std::round(1e6 * probability) / 1e6, 3));
}

std::string outlook_text(const char* when, const stats::Outlook& outlook) {
  return fmt::format("{}: pass {}, fail {}, inconclusive {}, draws {:.0f} % of its observations",
                     when, per_cent(outlook.pass), per_cent(outlook.fail),
                     per_cent(outlook.inconclusive), 100 * outlook.drawn);
}

/// Probability that the test ends otherwise than the suite expects: the claim holds, or is off by
/// its `detect` where it is expected to fail. Without an outlook it errs as often as planned.
double not_ok(const TestOutcome& test, const Forecast& foreseen) {
  const bool fails = test.question.test->expect == reports::Verdict::fail;
  const std::optional<stats::Outlook>& outlook = fails ? foreseen.if_off : foreseen.if_true;
  if (outlook) return 1 - (fails ? outlook->fail : outlook->pass);
  const double beta = test.plan.regions[0].has_forbidden() ? test.place.share.beta : 0;
  return static_cast<double>(test.question.channel_count()) * (test.place.share.alpha + beta);
}

/// Why the test will be an error; "" if that is not known.
std::string trouble_of(const TestOutcome& test) {
  return test.plan.error.empty() ? test.plan.pilot_error : test.plan.error;
}

Row row_of(const TestOutcome& test, const Pilots& pilots) {
  const Plan& plan = test.plan;
  Total total;
  for (std::size_t i = 0; i < test.question.subjects.size(); ++i) {
    const Subject& side = test.question.subjects[i];
    total.add(side, plan.primaries[i], side.secondaries(plan.most_secondaries()), pilots);
  }
  const Forecast expected = forecast(test, pilots);
  const std::string by = plan.method.name.empty() ? "" : ", by " + plan.method.name;
  Row row{.name = test.question.test->name + by, .not_ok = not_ok(test, expected)};
  row.cells = {primaries_text(plan),
               fmt::format("{}", plan.looks.sizes.size()),
               count_of(plan.most_secondaries()),
               count_of(total.primaries),
               total.known ? count_of(total.rays) : unknown,
               total.known ? reports::plain_spaces(reports::duration(total.seconds)) : unknown,
               effect_text(test, expected)};
  if (plan.invalid.empty() && expected.if_true) {
    row.notes.push_back(outlook_text("if it holds", *expected.if_true));
  }
  if (plan.invalid.empty() && expected.if_off) {
    const char* off = plan.regions[0].proof() ? "if it is barely wrong" : "if off by `detect`";
    row.notes.push_back(outlook_text(off, *expected.if_off));
  }
  for (const Gate& gate : plan.gates) {
    if (gate.state != "green") row.notes.push_back(gate.state + ": " + gate_sentence(gate));
  }
  if (!plan.caution.empty()) row.notes.push_back(plan.caution);
  if (!plan.invalid.empty()) row.notes.push_back("invalid: " + plan.invalid.text);
  if (const std::string trouble = trouble_of(test); !trouble.empty()) {
    row.notes.push_back("error: " + trouble);
  }
  return row;
}

std::string on_page(const std::string& text, std::size_t indent = 0) {
  return reports::plain_spaces(wrapped(reports::one_line(text), indent));
}

std::string line_of(const Cells& cells, const std::array<int, column_count>& widths) {
  std::string line = "  ";
  for (std::size_t c = 0; c < column_count; ++c) {
    const auto blanks = static_cast<std::size_t>(2 + widths[c] - reports::columns(cells[c]));
    line += std::string(blanks, ' ') + cells[c];
  }
  return line + "\n";
}

/// True if a program that the suite needs is missing.
bool is_skipped(const SuiteRun& run) {
  return !run.untested.empty() && run.untested.front().verdict == reports::Verdict::skipped;
}

void write(std::string& page, const SuiteRun& run) {
  const Suite& suite = run.suite;
  page += on_page(suite.name + (suite.file.empty() ? "" : " (" + suite.file + ")"));
  page += on_page(fmt::format("alpha {}, beta {}, seed {}", suite.alpha, suite.beta, run.seed));
  page += "\n";
  if (is_skipped(run)) {
    page += on_page("Its tests will be skipped: " + run.untested.front().message + ".") + "\n";
    return;
  }
  for (const Untested& each : run.untested) {
    page += on_page(each.test->name, 2);
    page += on_page("error: " + each.message, 6);
  }
  if (run.tests.empty()) {
    if (run.untested.empty()) page += on_page("No test of this suite is selected.");
    page += "\n";
    return;
  }
  std::vector<Row> rows;
  const char* planted = "";
  for (const TestWork& work : run.tests) {
    rows.push_back(row_of(work.outcome, run.pilots));
    if (work.outcome.question.test->expect != reports::Verdict::fail) continue;
    planted = " and every planted bug is as large as its `detect`";
  }
  std::array<int, column_count> widths{};
  for (std::size_t c = 0; c < column_count; ++c) {
    widths[c] = reports::columns(headings[c]);
    for (const Row& row : rows) widths[c] = std::max(widths[c], reports::columns(row.cells[c]));
  }
  page += line_of(headings, widths);
  double not_ok = 0;
  for (const Row& row : rows) {
    page += on_page(row.name, 2);
    page += line_of(row.cells, widths);
    for (const std::string& note : row.notes) page += on_page(note, 6);
    not_ok += row.not_ok;
  }
  page += "\n";
  page += on_page(fmt::format(
      "If every claim holds exactly{}, some claim fails or stays undecided with probability about "
      "{}. A test without a forecast counts with its alpha and beta.",
      planted, per_cent(std::min(1.0, not_ok))));
  page += "\n";
}

/// The cost of all tests, each stream drawn to the largest of its tests' sizes.
template <class SizeOf>
Total total_of(const PlannedRun& planned, const SizeOf& size_of) {
  std::map<const Pool*, Total> streams;
  for (const auto& run : planned.suites) {
    for (const TestWork& work : run->tests) {
      const TestOutcome& test = work.outcome;
      const std::uint64_t size = size_of(test, run->pilots);
      for (std::size_t i = 0; i < work.pools.size(); ++i) {
        const Subject& side = test.question.subjects[i];
        Total whole;
        whole.add(side, test.plan.primaries[i], side.secondaries(size), run->pilots);
        Total& most = streams[work.pools[i].get()];
        if (whole.primaries > most.primaries) most = whole;
      }
    }
  }
  Total total;
  for (const auto& [pool, each] : streams) {
    total.primaries += each.primaries;
    total.rays += each.rays;
    total.seconds += each.seconds;
  }
  return total;
}

std::string total_text(const Total& total) {
  return fmt::format("{} primaries, {} rays, {} of CPU time", count_of(total.primaries),
                     count_of(total.rays), reports::plain_spaces(reports::duration(total.seconds)));
}

void write_totals(std::string& page, const PlannedRun& planned) {
  const auto most = [](const TestOutcome& test, const Pilots& /*pilots*/) {
    const std::vector<std::uint64_t>& postponed = test.plan.postponed;
    return postponed.empty() ? test.plan.most_secondaries() : postponed.back();
  };
  double of_pilots = 0;
  for (const auto& run : planned.suites) of_pilots += run->pilots.primaries();
  const std::string expected = total_text(total_of(planned, expected_secondaries));
  const std::string highest = total_text(total_of(planned, most));
  page += on_page(fmt::format(
      "Tests of one estimator share observations: the run draws about {} if every claim holds "
      "exactly.{} Its pilots draw {} primaries before.",
      expected,
      highest == expected ? "" : fmt::format(" Heavy tails may raise this to {}.", highest),
      count_of(of_pilots)));
  page += on_page(
      "last: observations of each source at the last look. in all, rays, CPU time: what all "
      "sources draw up to it, estimated from the pilot. effect: what the test finds, or proves for "
      "`within`, `<` and `>`, with probability 1 - beta. draws: the mean fraction of that. All "
      "this "
      "assumes that the pilot's spread is true and that no test becomes invalid.");
}

}  // namespace

std::string plan_text(const PlannedRun& planned) {
  std::string page;
  for (const auto& run : planned.suites) write(page, *run);
  write_totals(page, planned);
  return page;
}

int plan_exit_code(const PlannedRun& planned) {
  bool any = false;
  bool bad = false;
  bool skipped = false;
  for (const auto& run : planned.suites) {
    skipped = skipped || is_skipped(*run);
    for (const Untested& each : run->untested) {
      if (each.verdict != reports::Verdict::error) continue;
      any = true;
      bad = bad || each.test->expect != reports::Verdict::error;
    }
    for (const TestWork& work : run->tests) {
      const TestOutcome& test = work.outcome;
      any = true;
      const reports::Verdict expect = test.question.test->expect;
      bad = bad || (!trouble_of(test).empty() && expect != reports::Verdict::error) ||
            (!test.plan.invalid.empty() && expect != reports::Verdict::invalid);
    }
  }
  if (!any) return skipped ? 77 : 4;
  return bad ? 1 : 0;
}

}  // namespace assay::harness
