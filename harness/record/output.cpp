#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "estimators/core/quoting.h"
#include "estimators/parameters.h"
#include "harness/base/text_file.h"
#include "harness/record/record_of.h"
#include "harness/suite/suite.h"
#include "reports/words/display.h"

namespace assay::harness {
namespace {

bool is_set(const char* variable) { return !system_environment(variable).empty(); }

/// --color comes first, then NO_COLOR, then FORCE_COLOR, then the terminal's abilities.
bool use_colour(Colour colour, std::FILE* stream) {
  if (colour != Colour::automatic) return colour == Colour::always;
  if (is_set("NO_COLOR")) return false;
  if (is_set("FORCE_COLOR") || is_set("CLICOLOR_FORCE")) return true;
  return is_set("TERM") && system_environment("TERM") != "dumb" && isatty(fileno(stream)) != 0;
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

/// The exit code of a run without a fail that is not wholly decided; "" of any other.
std::string code_text(const reports::Record& record, InconclusivePolicy policy) {
  constexpr int undecided = 3;
  if (exit_code(record, InconclusivePolicy::report) != undecided) return "";
  const int code = exit_code(record, policy);
  return fmt::format("Exit code {}: {}.", code,
                     code == undecided ? "nothing failed, but not all is decided"
                     : code == 0       ? "undecided claims count as passed"
                                       : "undecided claims count as failed");
}

// Less room would hold no readable summary.
constexpr std::size_t least_summary = 2048;

/// The error, or "" if the summary was written.
std::string append_summary(const reports::Record& record, const std::string& file) {
  std::error_code none;
  const std::uintmax_t there =
      std::filesystem::exists(file, none) ? std::filesystem::file_size(file, none) : 0;
  if (there + least_summary > reports::markdown_limit) {
    return "the step's summary is full: this run has none there";
  }
  const std::size_t room = reports::markdown_limit - static_cast<std::size_t>(there);
  std::ofstream stream(file, std::ios::app | std::ios::binary);
  stream << reports::markdown(record, room) << '\n' << std::flush;
  return stream ? "" : "the step's summary cannot be written";
}

/// The file of the last run from this folder; "" if there is no place for it.
std::string last_run_file() {
  std::string folder = system_environment("XDG_CACHE_HOME");
  const std::string home = system_environment("HOME");
  if (folder.empty() && !home.empty()) folder = home + "/.cache";
  std::error_code gone;
  const std::string here = std::filesystem::current_path(gone).string();
  return folder.empty()
             ? ""
             : fmt::format("{}/assay/last_run/{:x}.json", folder, std::hash<std::string>()(here));
}

}  // namespace

void require_writable(const Output& output, const std::vector<std::string>& kept) {
  for (const ReportRequest& request : output.reports) {
    if (request.path == "-") continue;
    refuse_overwriting(request.path, kept);
    const std::filesystem::path path(request.path);
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    std::error_code failure;
    const bool is_there = std::filesystem::is_directory(folder, failure);
    if (failure == std::errc::permission_denied) {
      refuse({.file = request.path}, "cannot be written: {}", failure.message());
    }
    if (!is_there) {
      refuse({.file = request.path}, "its folder does not exist; make it by `mkdir -p {}`",
             shell_quoted(folder.string()));
    }
    if (std::filesystem::is_directory(path, failure)) {
      refuse({.file = request.path}, "is a folder; name the file to write");
    }
  }
}

void write_reports(const Output& output, const ReportWriter& written) {
  std::string to_stdout;
  std::string failures;
  Output done = output;  // without what could not be written, which the console does not name
  std::vector<ReportRequest> consoles_last = output.reports;
  std::ranges::stable_sort(consoles_last, {}, [](const ReportRequest& each) {
    return each.path == "-" ? 2 : each.kind == "console" ? 1 : 0;
  });
  for (const ReportRequest& request : consoles_last) {
    const bool standard = request.path == "-";
    try {
      const std::string text = written(request, console_options(done, standard ? stdout : nullptr));
      if (standard) {
        to_stdout += text;
      } else {
        write_whole(request.path, text);
      }
    } catch (...) {  // a full disk does not stop the other reports
      failures += (failures.empty() ? "" : "\n") + words_of(std::current_exception());
      std::erase_if(done.reports, [&](const auto& each) { return each.path == request.path; });
    }
  }
  if (std::ranges::count(output.reports, "console", &ReportRequest::kind) == 0) {
    std::FILE* stream = console_stream(output);
    fmt::print(stream, "{}",
               written({.kind = "console", .path = "-"}, console_options(done, stream)));
  }
  fmt::print("{}", to_stdout);
  if (!failures.empty()) throw std::runtime_error(failures);
}

bool tell_broken(const reports::Test& test, const Output& output) {
  std::FILE* const stream = console_stream(output);
  if (stream == nullptr) return false;
  write_beside_progress(reports::broken_claim(test, console_options(output, stream)), stream);
  return true;
}

void write_run(reports::Record& record, const Output& output, const std::set<std::string>& told) {
  write_reports(output, [&](const ReportRequest& request, const reports::ConsoleOptions& options) {
    if (request.kind == "console" && request.path == "-") {
      reports::ConsoleOptions with_code = options;
      if (output.tells_code) with_code.ending = code_text(record, output.inconclusive);
      return reports::console(record, with_code, told);
    }
    if (request.kind == "json" && request.path != "-") write_maps(record, request.path);
    return reports::report_format(request.kind).of_record(record, options);
  });
  // GitHub's runner reads both streams; other programs read reports from standard output.
  if (output.github) fmt::print(stderr, "{}", tell_github(record, system_environment));
}

int exit_code(const reports::Record& record, InconclusivePolicy policy) {
  using reports::Standing;
  reports::Standings count = reports::standings(record);
  const int undecided = count[Standing::undecided];
  const int failed = count[Standing::broken] + count[Standing::no_verdict];
  const int passed = count[Standing::holds] + count[Standing::caught];
  if (failed + undecided + passed + count[Standing::not_run] == 0) return 4;
  if (failed > 0 || reports::alarms(record.ledger) > 0) return 1;
  if (undecided > 0 && policy == InconclusivePolicy::fail) return 1;
  if (undecided > 0 && policy == InconclusivePolicy::report) return 3;
  if (passed + undecided == 0) return 77;
  return 0;
}

std::string tell_github(const reports::Record& record, const Environment& environment) {
  if (environment("GITHUB_ACTIONS") != "true") return "";
  std::string text = reports::annotations(record);
  const std::string file = environment("GITHUB_STEP_SUMMARY");
  if (file.empty()) return text;
  const std::string trouble = append_summary(record, file);
  if (!trouble.empty()) text += fmt::format("::warning title=assay::{}\n", trouble);
  return text;
}

std::string last_run() {
  const std::string file = last_run_file();
  if (std::filesystem::exists(file)) return file;
  refuse({},
         "there is no last run from this folder; `assay run SUITE` makes one, or give a saved run "
         "first");
}

void keep_last_run(reports::Record record, bool says_failure) {
  const std::filesystem::path file = last_run_file();
  if (file.empty()) return;
  for (reports::Suite& suite : record.suites) {
    for (reports::Test& test : suite.tests) test.maps.clear();
  }
  try {
    std::filesystem::create_directories(file.parent_path());
    write_whole(file, reports::compact_json(record));
  } catch (...) {
    if (says_failure) {
      say_beside_progress("`assay explain` will not have this run: " +
                          words_of(std::current_exception()));
    }
  }
}

}  // namespace assay::harness
