#include "harness/command/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "estimators/catalogue.h"
#include "estimators/core/flush_denormals.h"
#include "estimators/core/waiting.h"
#include "harness/base/record_file.h"
#include "harness/base/terminal.h"
#include "harness/command/help.h"
#include "harness/draws/sampler_setup.h"
#include "harness/ledger/ledger.h"
#include "harness/plan/plan.h"
#include "harness/question/question.h"
#include "harness/ranks/ranks.h"
#include "harness/run/evaluate.h"
#include "harness/run/planned_run.h"
#include "harness/sampling/checkpoint.h"
#include "harness/sampling/pool.h"
#include "harness/sampling/prepare.h"
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

/// Tells of the first doubtful margin. A single test tells it with its verdict.
void note_margins(const PlannedRun& planned) {
  std::vector<std::string> doubts;
  std::size_t tests = 0;
  for (const auto& run : planned.suites) {
    tests += run->tests.size();
    for (const TestWork& work : run->tests) {
      const std::string doubt = doubtful_margin(work.outcome.question, run->pilots);
      if (doubt.empty()) continue;
      doubts.push_back(fmt::format("`{}`: {}", work.outcome.question.test->id, doubt));
    }
  }
  if (doubts.empty() || tests == 1) return;
  const std::size_t others = doubts.size() - 1;
  notice(doubts[0] + (others > 0 ? fmt::format(" ({} other doubtful `detect`)", others) : ""));
}

/// Adds remarks on the ledger.
void note_ledger(reports::Record& record, const SuiteRuns& runs, const RunOptions& options) {
  std::size_t outside = 0;
  for (const auto& run : runs) {
    for (const TestWork& work : run->tests) outside += work.outcome.place.inside ? 0 : 1;
  }
  if (outside > 0) {
    add_note(record, fmt::format("{} test{} outside the ledger: mutants and expected failures",
                                 outside, outside == 1 ? " is" : "s are"));
  }
  if (!options.seed) {
    add_note(record,
             "no --seed was given: nights with the suite's own seed are all the same and count "
             "once; run nights with --seed random");
  }
}

/// Leaves out the tests that were not decided.
void leave_out(SuiteRun& run, const std::string& why) {
  for (const TestWork& work : run.tests) {
    if (work.outcome.decided) continue;
    run.untested.push_back({work.outcome.question.test, reports::Verdict::skipped, why});
  }
  std::ranges::sort(run.untested, {}, &Untested::test);
  std::erase_if(run.tests, [](const TestWork& work) { return !work.outcome.decided; });
}

reports::Record run_in_arena(const std::vector<Suite>& suites, const RunOptions& options,
                             Progress& progress, const Broken& broken, std::string* ledger_fault) {
  const auto start = std::chrono::steady_clock::now();
  const std::string started = utc_now();
  if (!options.ledger.empty()) require_ledger(options.ledger);
  if (!options.ledger.empty() && options.shard) {
    refuse({}, "--ledger needs whole runs: leave out --shard and the environment's shards");
  }
  if (options.fail_fast && (!options.ledger.empty() || options.shard)) {
    refuse({}, "--fail-fast ends a run early: leave --ledger and --shard out");
  }
  const PlannedRun planned = plan_run(suites, options, progress);
  stop_if_interrupted();
  note_margins(planned);
  std::vector<TestWork*> tests;
  for (auto& run : planned.suites) {
    run->pilots.drop_drawn();
    for (TestWork& work : run->tests) tests.push_back(&work);
  }
  std::string first;  // id of the first broken claim
  const auto tell = [&](const SuiteRun& run, reports::Test test, const TestEntry& entry) {
    if (first.empty()) first = test.id;
    add_replay(entry, run, planned.suites, options, test);
    if (broken) broken(test);
  };
  const auto may_go_on = [&] { return !options.fail_fast || first.empty(); };
  for (const auto& run : planned.suites) {
    for (const Untested& each : run->untested) {
      const reports::Test test = record_of_untested(each, *run);
      if (reports::is_failed(reports::standing(test))) tell(*run, test, *each.test);
    }
  }
  const auto hear = [&](const TestWork& work) {
    for (const auto& run : planned.suites) {
      const bool its =
          std::ranges::any_of(run->tests, [&](const TestWork& x) { return &x == &work; });
      if (!its || !is_broken(work)) continue;
      tell(*run, record_of_test(work, run->suite.file), *work.outcome.question.test);
    }
    return may_go_on();
  };
  if (may_go_on()) {
    sample_in_looks(
        tests, planned.pools.all(),
        {.executor = executor_of(options), .cheapest_first = options.fail_fast, .decided = hear},
        progress);
  }
  const bool none =
      std::ranges::none_of(tests, [](const TestWork* x) { return x->outcome.decided; });
  if (none || !options.ledger.empty() || options.shard) stop_if_interrupted();
  for (auto& run : planned.suites) {
    // A family without some of its tests has no adjusted p-values.
    const bool all = run->tests.size() + run->untested.size() == run->suite.tests.size();
    run->adjusted =
        all && !options.shard &&
        std::ranges::all_of(run->tests, [](const TestWork& work) { return work.outcome.decided; });
    if (interrupted())
      leave_out(*run, "the run was interrupted before its verdict");
    else if (!may_go_on())
      leave_out(*run, fmt::format("the run ended early: `{}` is broken", first));
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  reports::Record record = record_of(planned.suites, options);
  record.started = started;
  record.seconds = elapsed.count();
  if (options.ledger.empty()) return record;
  try {
    record.ledger = add_to_ledger(options.ledger, record, planned.suites);
    note_ledger(record, planned.suites, options);
  } catch (const std::runtime_error& error) {
    if (ledger_fault == nullptr) throw;
    *ledger_fault = error.what();
    add_note(record, fmt::format("the ledger got no evidence: {}", error.what()));
  }
  return record;
}

constexpr std::uint64_t usual = 10;

/// A name as the plugin `recorded` reads it.
std::string in_header(const std::string& name) {
  if (name.find_first_of(" \t,;#\"") == std::string::npos) return name;
  return fmt::format("\"{}\"", boost::replace_all_copy(name, "\"", "\"\""));
}

}  // namespace

std::vector<Suite> load_suites(const std::vector<std::string>& files,
                               const std::vector<std::string>& assignments) {
  std::vector<Suite> suites;
  std::map<std::string, std::string> files_of;  // by stem
  Mistakes mistakes;
  for (const std::string& file : files) {
    mistakes.attempt([&] { suites.push_back(read_suite(file, mistakes)); });
    if (mistakes.any()) continue;
    const auto [first, is_new] = files_of.emplace(suites.back().stem, file);
    if (is_new) continue;
    const std::string both = fmt::format("`{}` and `{}`", first->second, file);
    if (std::filesystem::equivalent(first->second, file)) {
      refuse({}, both + " are one suite; give it once");
    }
    refuse({},
           "{} are two suites whose tests have the ids `{}/…`; rename one of the files, or run "
           "each by itself",
           both, first->first);
  }
  mistakes.refuse_any();
  for (const std::string& assignment : assignments) set_parameter(suites, assignment);
  return suites;
}

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
  if (options.ranks != nullptr) {
    drawn.threads = threads_of_rank(options);
    drawn.executor = std::make_shared<Ranks>(*options.ranks, options.seed,
                                             identity_of(suites, options), drawn.threads);
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
  if (checkpoint && !interrupted()) checkpoint->remove();
  if (!ledger_fault.empty()) throw std::runtime_error(ledger_fault);
  const int code = exit_code(record, output.inconclusive);
  return code == nothing_ran && options.shard_of_runner ? 0 : code;
}

int plan_suites(const PlanCommand& command) {
  const std::vector<Suite> suites = load_suites(command.suites, command.assignments);
  if (selects_nothing(suites, command.options.selection)) return nothing_ran;
  const std::unique_ptr<Progress> progress = make_progress(command.output.quiet);
  if (command.list_renders) {
    for (const foreign::MissingFile& each : missing_files(suites, command.options, *progress)) {
      fmt::print("{}\t{}\t{}\n", each.command, each.seed, each.file);
    }
    return 0;
  }
  const PlannedRun planned = plan_run(suites, command.options, *progress);
  fmt::print("{}", plan_text(planned));
  return plan_exit_code(planned);
}

int print_list(const ListCommand& command) {
  if (command.what == "tests") {
    const std::vector<Suite> suites = load_suites(command.suites);
    if (selects_nothing(suites, command.selection)) return nothing_ran;
    for (const Suite& suite : suites) {
      for (const TestEntry& test : suite.tests) {
        if (selects(command.selection, test)) fmt::print("{}\n", test.id);
      }
    }
  } else if (command.what == "plugins") {
    for (const Entry& entry : catalogue()) fmt::print("{}\n", entry.information.name);
  } else if (command.what.empty()) {
    fmt::print("assay list plugins\nassay list tests SUITE...\n");
    for (const Table& table : tables()) fmt::print("assay list {}\n", table.plural);
  } else {
    fmt::print("{}", text_of(*std::ranges::find(tables(), command.what, &Table::plural)));
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

reports::Record run(const std::vector<Suite>& suites, const RunOptions& options, Progress& progress,
                    const Broken& broken, std::string* ledger_fault) {
  reports::Record record;
  with_threads(options.threads,
               [&] { record = run_in_arena(suites, options, progress, broken, ledger_fault); });
  return record;
}

int sample(const SampleArguments& arguments) {
  const Source source = parse_source(arguments.source, {arguments.source, 0, 0});
  const std::vector<EstimatorEntry> entries = estimators_of(
      {source}, arguments.estimators, arguments.primaries, "assay sample " + arguments.source);
  const Estimators estimators{{source.estimator, prepare(entries.front(), ".")}};
  Subject sampled = values(source, estimators);
  if (source.part.empty()) sampled.channels = {0, 1, sampled.setup->channel_count()};
  const PreparedEstimator& estimator = *sampled.estimator;
  const auto rows = sampled.setup->observations();
  if (sampled.setup->is_reference()) {
    refuse(source.where, "`{}` is a reference, a mean without observations", source.estimator);
  }
  if (as_recorded_run(*sampled.setup) != nullptr) {
    refuse({}, "`{}` has the moments of a run, not its observations", source.estimator);
  }
  if (rows && arguments.secondaries.value_or(0) > *rows) {
    refuse({}, "--secondaries {}: `{}` has {} rows", *arguments.secondaries, source.estimator,
           *rows);
  }
  const std::uint64_t count = arguments.secondaries.value_or(std::min(usual, rows.value_or(usual)));
  const StreamKey key = key_of(estimator, arguments.seed, 0, sampled.purpose);

  std::vector<std::string> names;
  for (const Channel& column : sampled.declared()) names.push_back(in_header(column.name));
  fmt::print("# {} {} of {} primaries, seed {}\n", estimator.entry->information.name,
             estimator.parameters, arguments.primaries, arguments.seed);
  fmt::print("# stream: {:016x}\n# columns: {}\n", key.bits, fmt::join(names, " "));
  if (const auto* draws = dynamic_cast<const SamplerSetup*>(sampled.setup.get())) {
    fmt::print("# a draw without a point: {}\n",
               fmt::join(mapped(draws->marginals(), no_point), " "));
  }
  const std::unique_ptr<Estimator> worker = sampled.setup->make();
  const FlushDenormals flush;
  std::vector<double> out(sampled.setup->channel_count());
  worker->announce({.key = key, .first = 0, .last = count});
  for (std::uint64_t row = 0; row < count && !interrupted(); ++row) {
    Stream random(key, row);
    Cost unused;
    worker->secondary(random, arguments.primaries, out, unused);
    std::string line;
    for (const std::size_t column : sampled.channels.all()) {
      line += fmt::format("{}{}", line.empty() ? "" : " ", out[column]);
    }
    fmt::print("{}\n", line);
  }
  return 0;
}

}  // namespace assay::harness
