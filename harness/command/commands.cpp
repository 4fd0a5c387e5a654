#include "harness/command/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "estimators/catalogue.h"
#include "harness/base/interrupt.h"
#include "harness/base/record_file.h"
#include "harness/base/terminal.h"
#include "harness/command/describe.h"
#include "harness/ranks/ranks.h"
#include "harness/record/record_of.h"
#include "harness/run/planned_run.h"
#include "harness/sampling/checkpoint.h"
#include "reports/report_formats.h"
#include "reports/words/display.h"

namespace assay::harness {
namespace {

constexpr int nothing_ran = 4;

/// True, with a message, if a part of the selection selects no test.
bool selects_nothing(const std::vector<Suite>& suites, const Selection& selection) {
  const std::string why = unmatched(suites, selection);
  if (!why.empty()) fmt::print(stderr, "assay: {}", why);
  return !why.empty();
}

std::string digest_of(const std::string& file) {
  std::string text(std::size_t{1} << 20, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  std::error_code ignored;
  return fmt::format("{:x} of {} bytes", text_hash(text),
                     std::filesystem::file_size(file, ignored));
}

}  // namespace

unsigned threads_of_rank(const RunOptions& options) { return std::max(1U, options.threads); }

int run_suites(const std::vector<Suite>& suites, const RunOptions& options, const Output& output) {
  std::vector<std::string> kept = files_read(suites);
  if (!options.ledger.empty()) kept.push_back(options.ledger);
  if (!options.checkpoint.empty()) {
    kept.insert(kept.end(), {options.checkpoint, Checkpoint::kept_file(options.checkpoint)});
  }
  require_writable(output, kept);
  if (options.ranks != nullptr && options.shard) {
    refuse({}, "ranks draw one run together, and --shard makes several: leave one out");
  }
  if (selects_nothing(suites, options.selection)) return nothing_ran;
  const std::unique_ptr<Progress> progress = make_progress(output.quiet);
  std::string ledger_fault;
  std::set<std::string> told;  // ids
  std::map<std::string, std::string> errors;
  RunOptions drawn = options;
  std::shared_ptr<Ranks> ranks;
  if (options.ranks != nullptr) {
    drawn.threads = threads_of_rank(options);
    ranks = std::make_shared<Ranks>(*options.ranks, options.seed, identity_of(suites, options),
                                    drawn.threads);
    drawn.executor = ranks;
  }
  std::shared_ptr<Checkpoint> checkpoint;
  if (!options.checkpoint.empty()) {
    checkpoint = std::make_shared<Checkpoint>(
        options.checkpoint, std::chrono::duration<double>(options.checkpoint_every),
        identity_of(suites, options), executor_of(drawn));
    drawn.executor = checkpoint;
  }
  const auto broken = [&](const reports::Test& test) {
    reports::tell_once(test, errors, [&](const reports::Test& each) {
      if (tell_broken(each, output)) told.insert(each.id);
    });
  };
  reports::Record record = run(suites, drawn, *progress, broken, &ledger_fault);
  Output last = output;
  last.tells_code = output.tells_code && ledger_fault.empty() && !interrupted();
  write_run(record, last, told);
  keep_last_run(record, output.detail > 0);
  if (ranks && output.detail > 1) say_beside_progress(ranks->window_text());
  if (checkpoint && !interrupted()) checkpoint->remove();
  if (!ledger_fault.empty()) throw std::runtime_error(ledger_fault);
  const int code = exit_code(record, output.inconclusive);
  return code == nothing_ran && options.shard_of_runner ? 0 : code;
}

int plan_suites(const std::vector<Suite>& suites, const RunOptions& options, bool quiet) {
  if (selects_nothing(suites, options.selection)) return nothing_ran;
  const std::unique_ptr<Progress> progress = make_progress(quiet);
  const PlannedRun planned = plan_run(suites, options, *progress);
  fmt::print("{}", plan_text(planned));
  return plan_exit_code(planned);
}

int list_renders(const std::vector<Suite>& suites, const RunOptions& options, bool quiet) {
  if (selects_nothing(suites, options.selection)) return nothing_ran;
  const std::unique_ptr<Progress> progress = make_progress(quiet);
  for (const foreign::MissingFile& each : missing_files(suites, options, *progress)) {
    fmt::print("{}\t{}\t{}\n", each.command, each.seed, each.file);
  }
  return 0;
}

int list_plugins() {
  for (const Entry& entry : catalogue()) fmt::print("{}\n", entry.information.name);
  return 0;
}

int list_lists() {
  fmt::print("assay list plugins\nassay list tests SUITE...\n");
  for (const Table& table : tables()) fmt::print("assay list {}\n", table.plural);
  return 0;
}

int list_table(const std::string& plural) {
  fmt::print("{}", text_of(*std::ranges::find(tables(), plural, &Table::plural)));
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

int explain(const ExplainArguments& arguments) {
  const std::vector<std::string>& words = arguments.words;
  if (words.size() > 2) refuse({}, "`assay explain` takes a saved run and one test");
  const bool saved =
      words.size() == 2 || (words.size() == 1 && std::filesystem::is_regular_file(words.front()));
  const std::string file = saved ? words.front() : last_run();
  const reports::Record record = read_record(file);
  const Recorded found =
      find_test(record, saved ? file : the_last_run, words.size() > saved ? words.back() : "");
  if (!saved) fmt::print("The last run from this folder began at {}.\n\n", record.started);
  fmt::print("{}", reports::explain(found.suite, found.test, std::min(terminal_width(stdout), 100),
                                    record.ledger));
  return 0;
}

int report_saved_run(const std::string& file, const Output& output) {
  require_writable(output, {file});
  reports::Record record = read_record(file);
  Output quiet = output;
  quiet.github = quiet.tells_code = false;  // the run has told it
  write_run(record, quiet);
  return 0;
}

Identity identity_of(const std::vector<Suite>& suites, const RunOptions& options) {
  const reports::Tool tool = this_tool();
  const reports::Environment environment = this_environment(1);
  Identity identity{{"the version", fmt::format("{} ({})", tool.version, tool.commit)},
                    {"the compiler", environment.compiler},
                    {"the instruction set", environment.isa},
                    {"the seed", options.seed ? fmt::format("{}", *options.seed) : "the suite's"},
                    {"the command", options.command},
                    {"--filter", fmt::format("{}", options.selection.filters)},
                    {"--tag", fmt::format("{}", options.selection.tags)},
                    {"the shard", options.shard ? fmt::format("{}/{}", options.shard->first,
                                                              options.shard->second)
                                                : "the whole"},
                    {"--fail-fast", options.fail_fast ? "on" : "off"}};
  for (const std::string& file : files_read(suites)) {
    identity.emplace_back(fmt::format("the content of `{}`", file), digest_of(file));
  }
  return identity;
}

}  // namespace assay::harness
