#include "harness/command/cli.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "estimators/core/quoting.h"
#include "harness/base/version.h"
#include "harness/command/cli_options.h"
#include "harness/command/cli_values.h"
#include "harness/command/tables.h"
#include "harness/record/recorded_test.h"
#include "harness/suite/suite_entries.h"
#include "harness/suite/suite_keys.h"
#include "reports/report_formats.h"

namespace assay::harness {

namespace {

void require(const std::string& value, const char* what, const std::string& name) {
  if (value.empty()) {
    usage_error(fmt::format("`assay {}` needs {}; see `assay {} --help`", name, what, name));
  }
}

std::optional<std::string> if_given(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(text);
}

std::optional<std::uint64_t> count_if_given(const std::string& text, const char* option,
                                            std::uint64_t least) {
  return text.empty() ? std::nullopt : std::optional(parse_count(text, option, least));
}

void refuse_same_path(const std::vector<ReportRequest>& reports) {
  std::set<std::string> paths;
  for (const ReportRequest& report : reports) {
    if (paths.insert(report.path).second) continue;
    usage_error(report.path == "-" ? "two reports to standard output"
                                   : fmt::format("two reports to `{}`", report.path));
  }
}

Output output(const Given& given) {
  Output output{.quiet = given.quiet};
  for (const std::string& report : given.reports) output.reports.push_back(parse_report(report));
  refuse_same_path(output.reports);
  if (!given.github.empty()) output.github = parse_github(given.github);
  if (!given.colour.empty()) output.colour = parse_colour(given.colour);
  if (!given.inconclusive.empty()) output.inconclusive = parse_inconclusive(given.inconclusive);
  return output;
}

Selection selection(const Given& given) { return {.filters = given.filters, .tags = given.tags}; }

RunOptions options(const Given& given) {
  constexpr std::uint64_t most_threads = 4096;
  RunOptions options;
  if (!given.seed.empty()) options.seed = parse_seed(given.seed);
  if (!given.threads.empty()) {
    options.threads =
        static_cast<unsigned>(std::min(parse_count(given.threads, "--threads", 1), most_threads));
  }
  if (!given.alpha.empty()) options.alpha = parse_rate(given.alpha, "--alpha");
  if (!given.coarsen.empty()) options.coarsen = parse_positive(given.coarsen, "--coarsen");
  if (!given.shard.empty()) options.shard = parse_shard(given.shard);
  options.selection = selection(given);
  return options;
}

/// The command with the options that change sampling and verdicts. The record adds the seed and a
/// filter.
class Replayable {
 public:
  explicit Replayable(const std::string& command) : text_("assay " + command) {}

  void add(const std::string& argument) { text_ += " " + shell_quoted(argument); }
  void add(const char* option, const std::string& value) {
    if (!value.empty()) text_ += fmt::format(" {} {}", option, shell_quoted(value));
  }
  void add(const char* option, const Texts& values) {
    for (const std::string& value : values) add(option, value);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string replayable_run(const Given& given) {
  Replayable line("run");
  for (const std::string& suite : given.suites) line.add(suite);
  line.add("--set", given.sets);
  line.add("--alpha", given.alpha);
  line.add("--coarsen", given.coarsen);
  return line.text();
}

std::string replayable_check(const Given& given) {
  Replayable line("check");
  line.add(given.claim);
  line.add("--estimator", given.estimators);
  line.add("--detect", given.detect);
  line.add("--allow", given.allow);
  line.add("--test", given.method);
  line.add("--over", given.over);
  line.add("--reference", given.reference);
  line.add("--cost", given.cost);
  line.add("--budget", given.budget);
  line.add("--primaries", given.primaries);
  line.add("--secondaries", given.secondaries);
  line.add("--alpha", given.alpha);
  return line.text();
}

std::string replayable_images(const Given& given) {
  Replayable line("images");
  line.add("--candidate", given.candidate);
  line.add("--reference", given.pictures);
  line.add("--channels", given.channels);
  line.add("--pixels", given.pixels);
  line.add("--samples", given.picture_samples);
  line.add("--detect", given.detect);
  line.add("--allow", given.allow);
  line.add("--within", given.within);
  line.add("--alpha", given.alpha);
  return line.text();
}

void require_suites(const Given& given, const std::string& name) {
  require(given.suites.empty() ? "" : given.suites[0], "a suite file", name);
  for (const std::string& suite : given.suites) {
    if (suite.ends_with(".json"))
      usage_error("a suite is a YAML file; a saved run is shown by `assay report " + suite + "`");
  }
}

Command run_command(const Given& given, const std::string& name) {
  require_suites(given, name);
  RunCommand command{given.suites, given.sets, options(given), output(given)};
  command.options.ledger = given.ledger;
  command.options.command = replayable_run(given);
  return command;
}

Command plan_command(const Given& given, const std::string& name) {
  require_suites(given, name);
  return PlanCommand{given.suites, given.sets, options(given), given.quiet};
}

Command check_command(const Given& given, const std::string& name) {
  require(given.claim, "a claim", name);
  if (given.claim.ends_with(".yaml"))
    usage_error("`assay check` tests one claim; a suite is run by `assay run " + given.claim + "`");
  // Assigned, not initialised in one expression: GCC 12 destroys the members of a nested aggregate
  // twice when a later one throws. options() throws at a wrong value.
  CheckCommand command;
  command.options = options(given);
  command.output = output(given);
  command.arguments.claim = given.claim;
  command.arguments.estimators = given.estimators;
  command.arguments.detect = if_given(given.detect);
  command.arguments.allow = if_given(given.allow);
  command.arguments.method = if_given(given.method);
  command.arguments.over = if_given(given.over);
  command.arguments.reference = if_given(given.reference);
  command.arguments.cost = if_given(given.cost);
  command.arguments.budget = if_given(given.budget);
  command.arguments.primaries = count_if_given(given.primaries, "--primaries", 1);
  command.arguments.secondaries = count_if_given(given.secondaries, "--secondaries", 2);
  if (command.options.alpha) command.arguments.alpha = *command.options.alpha;
  command.options.command = replayable_check(given);
  return command;
}

Command images_command(const Given& given, const std::string& name) {
  require(given.candidate, "--candidate, a pattern of OpenEXR files", name);
  require(given.pictures, "--reference, a pattern of OpenEXR files or one file", name);
  ImagesCommand command;
  command.options = options(given);
  command.output = output(given);
  ImagesArguments& arguments = command.arguments;
  arguments.candidate = given.candidate;
  arguments.reference = given.pictures;
  if (!given.channels.empty()) arguments.channels = given.channels;
  if (!given.pixels.empty()) {
    arguments.independent_pixels =
        choice(Value::scalar(given.pixels), "--pixels", {"dependent", "independent"}) == 1;
  }
  arguments.samples = if_given(given.picture_samples);
  arguments.detect = if_given(given.detect);
  arguments.allow = if_given(given.allow);
  arguments.within = if_given(given.within);
  command.options.command = replayable_images(given);
  return command;
}

Command calibrate_command(const Given& given) {
  CalibrateCommand command;
  command.output = output(given);
  for (const ReportRequest& report : command.output.reports) {
    if (reports::report_format(report.kind).of_calibration == nullptr) {
      usage_error(fmt::format("a calibration has no {} report", report.kind));
    }
  }
  CalibrateArguments& arguments = command.arguments;
  arguments.threads = options(given).threads;
  arguments.methods = given.methods;
  arguments.laws = given.laws;
  for (const std::string& alpha : given.alphas) {
    arguments.alphas.push_back(parse_rate(alpha, "--alpha"));
  }
  arguments.runs = count_if_given(given.runs, "--runs", 1).value_or(arguments.runs);
  arguments.samples = count_if_given(given.samples, "--samples", 2);
  if (!given.seed.empty()) arguments.seed = parse_seed(given.seed);
  return command;
}

Command sample_command(const Given& given, const std::string& name) {
  require(given.source, "an estimator", name);
  SampleArguments arguments{.source = given.source, .estimators = given.estimators};
  arguments.secondaries = count_if_given(given.secondaries, "--secondaries", 1);
  arguments.primaries = count_if_given(given.primaries, "--primaries", 1).value_or(1);
  if (!given.seed.empty()) arguments.seed = parse_seed(given.seed);
  return arguments;
}

Command list_command(const Given& given, const std::string& name) {
  std::vector<std::string> lists{"plugins", "tests"};
  for (const Table& table : tables()) lists.push_back(table.plural);
  require(given.what, ("one of " + listed(lists)).c_str(), name);
  const std::size_t what = choice(Value::scalar(given.what), "what is listed", lists);
  const bool tests = lists[what] == "tests";
  if (tests) require(given.suites.empty() ? "" : given.suites[0], "a suite file", name);
  if (!tests && !given.suites.empty()) {
    usage_error(fmt::format("`assay list {}` takes no suite", given.what));
  }
  if (!tests && !selection(given).empty()) {
    usage_error(fmt::format("`assay list {}` takes no --filter and no --tag; they select tests",
                            given.what));
  }
  return ListCommand{lists[what], given.suites, selection(given)};
}

Command replay_command(const Given& given, const std::string& name) {
  require(given.record, "a saved run", name);
  require(given.test, "a test, as `assay list tests SUITE` prints them", name);
  return ReplayArguments{given.record, given.test,
                         count_if_given(given.observation, "the observation", 0)};
}

Command report_command(const Given& given, const std::string& name) {
  require(given.record, "a saved run", name);
  return ReportCommand{given.record, output(given)};
}

Command merge_command(const Given& given, const std::string& name) {
  require(given.records.empty() ? "" : given.records[0], "the records of all shards", name);
  return MergeCommand{{given.records}, output(given)};
}

Command describe_command(const Given& given, const std::string& name) {
  require(given.plugin, "a plugin, a method, a quantity or a law", name);
  return DescribeCommand{given.plugin};
}

Command command_of(const Given& given, const std::string& name) {
  if (name == "run") return run_command(given, name);
  if (name == "plan") return plan_command(given, name);
  if (name == "check") return check_command(given, name);
  if (name == "images") return images_command(given, name);
  if (name == "calibrate") return calibrate_command(given);
  if (name == "sample") return sample_command(given, name);
  if (name == "list") return list_command(given, name);
  if (name == "describe") return describe_command(given, name);
  if (name == "replay") return replay_command(given, name);
  if (name == "merge") return merge_command(given, name);
  return report_command(given, name);
}

}  // namespace

Command parse_command_line(const std::vector<std::string>& arguments) {
  const SortedWords words = sorted_words(arguments);
  if (words.version) return TextCommand{fmt::format("assay {} ({})\n", version(), commit())};
  if (words.command.empty()) return TextCommand{words.help};
  return command_of(words.given, words.command);
}

}  // namespace assay::harness
