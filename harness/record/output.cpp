#include "harness/record/output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "estimators/core/quoting.h"
#include "estimators/parameters.h"
#include "harness/record/github.h"
#include "harness/record/image_record.h"
#include "harness/sampling/sample.h"
#include "harness/suite/files_read.h"
#include "reports/record/file.h"
#include "reports/report_formats.h"

namespace assay::harness {
namespace {

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

/// --color comes first, then NO_COLOR, then FORCE_COLOR, then the terminal's abilities.
bool use_colour(Colour colour, std::FILE* stream) {
  if (colour != Colour::automatic) return colour == Colour::always;
  if (is_set("NO_COLOR")) return false;
  if (is_set("FORCE_COLOR") || is_set("CLICOLOR_FORCE")) return true;
  const char* terminal = std::getenv("TERM");
  const bool dumb = terminal == nullptr || std::string(terminal) == "dumb";
  return !dumb && isatty(fileno(stream)) != 0;
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
    } catch (...) {  // a full disk does not stop the other reports
      failures += (failures.empty() ? "" : "\n") + words_of(std::current_exception());
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
    return reports::report_format(request.kind).of_record(record, colour);
  });
}

void report_run(reports::Record& record, const Output& output) {
  write_reports(record, output);
  // GitHub's runner reads both streams; other programs read reports from standard output.
  if (output.github) fmt::print(stderr, "{}", tell_github(record, system_environment));
}

int exit_code(const reports::Record& record, InconclusivePolicy policy) {
  const reports::Tally tally = reports::tally(record);
  const int undecided = policy == InconclusivePolicy::report ? tally.inconclusive : 0;
  const int failed = tally.failed + (policy == InconclusivePolicy::fail ? tally.inconclusive : 0);
  if (tally.passed + tally.failed + tally.inconclusive + tally.skipped == 0) return 4;
  if (failed > 0 || reports::alarms(record.ledger) > 0) return 1;
  if (undecided > 0) return 3;
  if (tally.passed + tally.inconclusive == 0) return 77;
  return 0;
}

}  // namespace assay::harness
