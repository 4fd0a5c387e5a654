#include "harness/command/program.h"

#include <fmt/format.h>

#include <cstdio>
#include <new>
#include <ranges>
#include <stdexcept>

#include "estimators/core/waiting.h"
#include "estimators/library_host.h"
#include "harness/base/interrupt.h"
#include "harness/base/terminal.h"
#include "harness/base/text_file.h"
#include "harness/command/commands.h"
#include "harness/ranks/ranks.h"
#include "harness/run/planned_run.h"
#include "harness/suite/suite.h"
#include "reports/words/text.h"

namespace assay::harness {

std::string failure_text(const InputError& error, const std::string& claim) {
  const Location& where = error.where();
  const bool in_claim = where.file == "claim" && where.line == 1 && !claim.empty();
  const bool is_own_claim = where.file == "claim" && claim.empty();
  std::string out = in_lines(reports::clean(is_own_claim ? error.message() : error.what())) +
                    (error.line() ? caret_below(*error.line(), where.column)
                     : in_claim   ? caret_below(claim, where.column)
                                  : excerpt(where));
  constexpr std::size_t most = 9;
  for (const InputError& other : error.others() | std::views::take(most)) {
    out += failure_text(other, claim);
  }
  const std::size_t all = error.others().size();
  return all > most ? out + fmt::format("assay: and {} more\n", all - most) : out;
}

namespace {

constexpr int trouble = 2;
constexpr int stopped = 130;

template <class Sampling>
int act(const Sampling& command) {
  const auto [suites, options] = loaded(command);
  return run_suites(suites, options, command.output);
}

int act(const PlanCommand& command) {
  const auto act = command.list_renders ? list_renders : plan_suites;
  return act(load_suites(command.suites, command.assignments), command.options,
             command.output.quiet);
}

int act(const ListCommand& command) {
  if (command.what == "tests") return list_tests(load_suites(command.suites), command.selection);
  if (command.what.empty()) return list_lists();
  return command.what == "plugins" ? list_plugins() : list_table(command.what);
}

int act(const SampleArguments& arguments) { return sample(arguments); }
int act(const DescribeCommand& command) { return describe(command.name); }
int act(const ReplayArguments& arguments) { return replay(arguments); }
int act(const ExplainArguments& arguments) { return explain(arguments); }
int act(const ReportCommand& command) { return report_saved_run(command.file, command.output); }
int act(const MergeCommand& command) { return merge_shards(command.records, command.output); }
int act(const CalibrateCommand& command) { return calibrate(command.arguments, command.output); }
int act(const InitArguments& arguments) { return write_example(arguments); }

int act(const TextCommand& command) {
  fmt::print("{}", command.text);
  return 0;
}

/// Failed output (a full disk, a closed pipe) must not look like success.
int flushed(int code) {
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return code;
  fmt::print(stderr, "assay: standard output could not be written\n");
  return code == 0 ? trouble : code;
}

void begin_process() {
  watch_interrupts();
  set_stop_question(interrupted);
  set_library_host("/proc/self/exe");
}

int guarded(const std::vector<std::string>& arguments, Command& command, Messages* ranks) {
  command = parse_command_line(arguments);
  begin_process();
  set_notice([](const std::string& sentence) { say_beside_progress(sentence); });
  if (auto* run = std::get_if<RunCommand>(&command)) run->options.ranks = ranks;
  if (auto* check = std::get_if<CheckCommand>(&command)) check->options.ranks = ranks;
  const int code = std::visit([](const auto& c) { return act(c); }, command);
  return interrupted() ? stopped : flushed(code);
}

}  // namespace

int program(const std::vector<std::string>& arguments, Messages* ranks) {
  // The program starts itself with this word, to keep a library's crash out of the run.
  if (!arguments.empty() && arguments.front() == library_host_word) {
    return host_library({arguments.begin() + 1, arguments.end()});
  }
  Command command;
  try {
    return guarded(arguments, command, ranks);
  } catch (const InputError& e) {
    const auto* const check = std::get_if<CheckCommand>(&command);
    fmt::print(stderr, "{}", failure_text(e, check != nullptr ? check->arguments.claim : ""));
  } catch (const std::runtime_error& e) {
    // An outside cause: a full disk, a vanished file.
    fmt::print(stderr, "{}", in_lines(e.what()));
  } catch (const std::bad_alloc&) {
    fmt::print(
        stderr, "{}",
        in_lines("there is not enough memory; give a test a `budget`, or run fewer at a time"));
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}", in_lines(fmt::format("internal error: {}", e.what())));
  } catch (...) {
    fmt::print(stderr, "assay: an estimator threw something that is no std::exception\n");
  }
  return interrupted() ? stopped : trouble;
}

int program_of_rank(const std::vector<std::string>& arguments, Messages& ranks) {
  begin_process();
  serve(ranks, [&](std::optional<std::uint64_t> seed) {
    Loaded all = loaded(parse_command_line(arguments));
    all.options.seed = seed;
    const auto run = std::make_shared<const PlannedRun>(prepare_run(all.suites, all.options));
    return PreparedRank{identity_of(all.suites, all.options), setups_of(*run),
                        threads_of_rank(all.options), run};
  });
  return 0;
}

}  // namespace assay::harness
