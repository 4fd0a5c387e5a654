#include "harness/record/output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "estimators/core/quoting.h"
#include "estimators/parameters.h"
#include "harness/base/terminal.h"
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

/// The stream that the console goes to; null if a file has it.
std::FILE* console_stream(const Output& output) {
  std::FILE* stream = stdout;
  for (const ReportRequest& request : output.reports) {
    if (request.kind == "console") return request.path == "-" ? stdout : nullptr;
    if (request.path == "-") stream = stderr;
  }
  return stream;
}

/// The options of a console that is written to a stream, or to a file if there is none.
reports::ConsoleOptions console_options(const Output& output, std::FILE* stream) {
  const auto page = std::ranges::find(output.reports, "html", &ReportRequest::kind);
  reports::ConsoleOptions options{
      .detail = output.detail,
      .slowest = output.slowest,
      .report = page == output.reports.end() || page->path == "-" ? "" : page->path};
  if (stream == nullptr) return options;
  options.colour = use_colour(output.colour, stream);
  options.width = terminal_width(stream);
  return options;
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
    try {
      const std::string text =
          written(request, console_options(output, standard ? stdout : nullptr));
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
    std::FILE* stream = console_stream(output);
    fmt::print(stream, "{}",
               written({.kind = "console", .path = "-"}, console_options(output, stream)));
  }
  fmt::print("{}", to_stdout);
  if (!failures.empty()) throw std::runtime_error(failures);
}

RunReports::RunReports(const Output& output)
    : output_(output),
      stream_(console_stream(output)),
      console_(console_options(output, stream_)) {}

void RunReports::tell(const reports::Suite& suite, const reports::Test& broken) {
  if (stream_ != nullptr) write_beside_progress(console_.broken(suite, broken), stream_);
}

void RunReports::write(reports::Record& record) const {
  write_reports(output_, [&](const ReportRequest& request, const reports::ConsoleOptions& options) {
    if (request.kind == "console" && request.path == "-") return console_.rest(record);
    if (request.kind == "json" && request.path != "-") write_maps(record, request.path);
    return reports::report_format(request.kind).of_record(record, options);
  });
}

void RunReports::write_and_annotate(reports::Record& record) const {
  write(record);
  // GitHub's runner reads both streams; other programs read reports from standard output.
  if (output_.github) fmt::print(stderr, "{}", tell_github(record, system_environment));
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
