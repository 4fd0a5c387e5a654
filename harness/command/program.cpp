#include "harness/command/program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <new>
#include <ranges>
#include <stdexcept>

#include "estimators/core/waiting.h"
#include "estimators/library_host.h"
#include "harness/base/text_file.h"
#include "harness/base/work.h"
#include "harness/command/options.h"
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

int act(const PlanCommand& command) { return plan_suites(command); }
int act(const ListCommand& command) { return print_list(command); }
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
    const char* what = std::ferror(stdout) != 0 ? "standard output: " : "";
    fmt::print(stderr, "{}", in_lines(what + std::string(e.what())));
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

void take_shard_from(const Environment& environment, RunOptions& options) {
  if (options.shard) return;
  for (const std::string prefix : {"GTEST_", "TEST_"}) {
    const std::string total_name = prefix + "TOTAL_SHARDS";
    const std::string index_name = prefix + "SHARD_INDEX";
    const bool has_total = !environment(total_name).empty();
    const bool has_index = !environment(index_name).empty();
    if (has_total != has_index) {
      refuse({}, "{} is set and {} is not: set both, or neither",
             has_total ? total_name : index_name, has_total ? index_name : total_name);
    }
    if (has_total && !options.shard) {
      const unsigned total = read_part(environment(total_name), total_name, 1);
      const unsigned index = read_part(environment(index_name), index_name, 0);
      if (index >= total) {
        refuse({}, "{} is {}, but of {} shards the last is {}", index_name, index, total,
               total - 1);
      }
      options.shard = {index + 1, total};
      options.shard_of_runner = true;
    }
    const std::string status = environment(prefix + "SHARD_STATUS_FILE");
    if (!status.empty() && !std::ofstream(status, std::ios::app)) {
      refuse({.file = status}, "the status file that the environment names cannot be written");
    }
  }
  if (options.shard && options.shard->second == 1) options.shard.reset();
}

unsigned launched_tasks() {
  unsigned most = 1;
  // Open MPI; MPICH and its kin; srun, which says nothing of the kind to a batch script.
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"}) {
    most = std::max(most, read_as<unsigned>(system_environment(name)).value_or(1));
  }
  return most;
}

void join_tasks(const std::vector<std::string>& arguments) {
  const unsigned tasks = launched_tasks();
  const bool samples =
      !arguments.empty() && (arguments.front() == "run" || arguments.front() == "check");
  if (tasks == 1 || !samples) return;
  std::error_code failure;
  const auto program =
      std::filesystem::read_symlink("/proc/self/exe", failure).parent_path() / "assay-mpi";
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(pointers.front(), pointers.data());
  refuse({},
         "a launcher started {} tasks, and {} is missing, which joins them to one run: build Assay "
         "where CMake finds MPI (libopenmpi-dev), or start one task",
         tasks, program.string());
}

}  // namespace assay::harness
