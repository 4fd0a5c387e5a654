#include "harness/commands.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "estimators/catalogue.h"
#include "harness/files_read.h"
#include "harness/github.h"
#include "harness/image_record.h"
#include "harness/plan_table.h"
#include "harness/progress_terminal.h"
#include "harness/replay.h"
#include "harness/shell.h"
#include "reports/console.h"
#include "reports/file.h"
#include "reports/html.h"
#include "reports/json.h"
#include "reports/junit.h"
#include "reports/markdown.h"
#include "reports/metrics.h"

namespace assay::harness {
namespace {

constexpr int nothing_ran = 4;

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

/// --color wins; then NO_COLOR, FORCE_COLOR; then whether it is a terminal that knows colours.
bool use_colour(Colour colour, std::FILE* stream) {
  if (colour != Colour::automatic) return colour == Colour::always;
  if (is_set("NO_COLOR")) return false;
  if (is_set("FORCE_COLOR") || is_set("CLICOLOR_FORCE")) return true;
  const char* terminal = std::getenv("TERM");
  const bool dumb = terminal == nullptr || std::string(terminal) == "dumb";
  return !dumb && isatty(fileno(stream)) != 0;
}

/// One test alone, as of `check`, is shown in full.
bool is_single(const reports::Record& record) {
  return record.suites.size() == 1 && record.suites[0].tests.size() == 1;
}

std::string written(const reports::Record& record, const std::string& kind, bool colour) {
  if (kind == "json") return reports::json(record);
  if (kind == "junit") return reports::junit(record);
  if (kind == "metrics") return reports::metrics(record);
  if (kind == "markdown") return reports::markdown(record);
  if (kind == "html") return reports::html(record);
  return reports::console(record, {.colour = colour, .verbose = is_single(record)});
}

}  // namespace

void require_writable(const Output& output, const std::vector<std::string>& kept) {
  for (const ReportRequest& request : output.reports) {
    if (request.path == "-") continue;
    refuse_overwriting(request.path, kept);
    const std::filesystem::path path(request.path);
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    if (!std::filesystem::is_directory(folder)) {
      throw InputError({.file = request.path},
                       fmt::format("its folder does not exist; make it by `mkdir -p {}`",
                                   shell_quoted(folder.string())));
    }
    if (std::filesystem::is_directory(path)) {
      throw InputError({.file = request.path}, "is a folder; name the file to write");
    }
  }
}

void write_reports(const Output& output, const ReportWriter& written) {
  std::string to_stdout;
  std::string failures;
  bool console_placed = false;
  for (const ReportRequest& request : output.reports) {
    console_placed = console_placed || request.kind == "console";
    const bool standard = request.path == "-";
    const bool colour = standard && use_colour(output.colour, stdout);
    try {
      const std::string text = written(request, colour);
      if (standard) {
        to_stdout += text;
      } else {
        reports::write_whole(request.path, text);
      }
    } catch (const std::runtime_error& error) {  // a full disk takes no other report with it
      failures += (failures.empty() ? "" : "\n") + std::string(error.what());
    }
  }
  if (!console_placed) {
    std::FILE* stream = to_stdout.empty() ? stdout : stderr;
    fmt::print(stream, "{}",
               written({.kind = "console", .path = "-"}, use_colour(output.colour, stream)));
  }
  fmt::print("{}", to_stdout);
  if (!failures.empty()) throw std::runtime_error(failures);
}

void write_reports(reports::Record& record, const Output& output) {
  write_reports(output, [&](const ReportRequest& request, bool colour) {
    if (request.kind == "json" && request.path != "-") write_maps(record, request.path);
    return written(record, request.kind, colour);
  });
}

namespace {

/// Says so where a part of the selection selects no test.
bool selects_nothing(const std::vector<Suite>& suites, const Selection& selection) {
  const std::string why = unmatched(suites, selection);
  if (!why.empty()) fmt::print(stderr, "assay: {}", why);
  return !why.empty();
}

}  // namespace

void report_run(reports::Record& record, const Output& output) {
  write_reports(record, output);
  // The runner reads commands from both streams, other programs the reports from standard output.
  if (output.github) fmt::print(stderr, "{}", tell_github(record, system_environment));
}

int run_suites(const std::vector<Suite>& suites, const RunOptions& options, const Output& output) {
  std::vector<std::string> kept = files_read(suites);
  if (!options.ledger.empty()) kept.push_back(options.ledger);
  require_writable(output, kept);
  if (selects_nothing(suites, options.selection)) return nothing_ran;
  const std::unique_ptr<Progress> progress = make_progress(output.quiet);
  std::string ledger_fault;
  reports::Record record = run(suites, options, *progress, &ledger_fault);
  report_run(record, output);
  if (!ledger_fault.empty()) throw std::runtime_error(ledger_fault);
  const int code = exit_code(record, output.inconclusive);
  return code == nothing_ran && options.shard_of_runner ? 0 : code;
}

int plan_suites(const std::vector<Suite>& suites, const RunOptions& options, bool quiet) {
  if (selects_nothing(suites, options.selection)) return nothing_ran;
  const std::unique_ptr<Progress> progress = make_progress(quiet);
  const PlannedRun planned = plan_run(suites, options, *progress);
  const UnitCosts costs = measure_costs(planned, options.threads, *progress);
  fmt::print("{}", plan_text(planned, costs));
  return plan_exit_code(planned, costs);
}

int list_plugins() {
  for (const Entry& entry : catalogue()) fmt::print("{}\n", entry.information.name);
  return 0;
}

int list_tests(const std::vector<Suite>& suites, const Selection& selection) {
  if (selects_nothing(suites, selection)) return nothing_ran;
  for (const Suite& suite : suites) {
    for (const TestEntry& test : suite.tests) {
      if (selects(selection, test)) fmt::print("{}\n", test.id);
    }
  }
  return 0;
}

int report_saved_run(const std::string& file, const Output& output) {
  require_writable(output, {file});
  reports::Record record = read_record(file);
  write_reports(record, output);
  return 0;
}

}  // namespace assay::harness
