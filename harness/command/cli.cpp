#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "estimators/catalogue.h"
#include "harness/base/refuse.h"
#include "harness/command/help.h"
#include "harness/command/options.h"
#include "harness/command/program.h"
#include "harness/language/claim.h"
#include "reports/report_formats.h"

namespace assay::harness {

namespace {

Texts plugin_names() {
  return mapped(catalogue(), [](const Entry& entry) { return entry.information.name; });
}

std::string read_suite(const std::string& text, const std::string& /*option*/) {
  const bool is_run = text.ends_with(".json");
  const bool is_claim = text.find('(') != std::string::npos && !std::filesystem::exists(text);
  if (text == "-") refuse({}, "a suite is a file, so that its tests can be repeated: write one");
  if (!is_run && !is_claim) return text;
  refuse({}, is_run ? "a suite is a YAML file; a saved run is shown by `assay report " + text + "`"
                    : "`" + text + "` is a claim, not a suite file; `assay check` tests one claim");
}

std::string read_claim(const std::string& text, const std::string& /*option*/) {
  if (!text.ends_with(".yaml")) return text;
  refuse({}, "`assay check` tests one claim; a suite is run by `assay run " + text + "`");
}

/// Reads a report that goes to another place than those before it.
auto report_beside(const std::vector<ReportRequest>& others) {
  return [&others](const std::string& text, const std::string& option) {
    ReportRequest report = read_report(text, option);
    if (std::ranges::find(others, report.path, &ReportRequest::path) == others.end()) return report;
    refuse({}, report.path == "-" ? "two reports to standard output"
                                  : fmt::format("two reports to `{}`", report.path));
  };
}

// Rows of several commands.

void add_report(Options& options, Output& output, const std::string& kinds) {
  Texts words = mapped(reports::report_formats(), &reports::ReportFormat::kind);
  for (std::string& word : words) word += '=';
  options.add(
      {"--report", "KIND=PATH", Replay::no, "", words}, output.reports,
      report_beside(output.reports),
      kinds +
          ", to a file or, as -, to standard output; repeatable; default console=-, which moves to "
          "standard error if another report takes standard output; console=/dev/null silences it");
}

void add_output(Options& options, Output& output) {
  add_report(options, output, "console, json, junit, markdown, html or metrics (OpenMetrics)");
  options.add(
      {"--color", "WHEN", Replay::no}, output.colour,
      OneOf<Colour>{
          {{"auto", Colour::automatic}, {"always", Colour::always}, {"never", Colour::never}}},
      "auto, always or never; default auto: on a terminal, unless NO_COLOR or FORCE_COLOR is set");
  options.flag({"-v", "", Replay::no},
               "print a line for each test; -vv, or -v of a single test, prints all numbers of "
               "tests that need attention; default a line for each suite",
               [&output] { ++output.detail; });
  options.add({"--durations", "N", Replay::no}, output.slowest, at_least(1),
              "name the N slowest tests; default none");
}

void add_inconclusive(Options& options, Output& output) {
  options.add({"--inconclusive", "fail|pass", Replay::no}, output.inconclusive,
              OneOf<InconclusivePolicy>{
                  {{"fail", InconclusivePolicy::fail}, {"pass", InconclusivePolicy::pass}}},
              "count undecided tests as failed or passed; default neither: exit code 3, and "
              "skipped in junit");
  options.add({"--github", "auto|never", Replay::no}, output.github,
              OneOf<bool>{{{"auto", true}, {"never", false}}},
              "annotations and job summary of GitHub Actions; default auto: if GITHUB_ACTIONS is "
              "true");
}

void add_threads(Options& options, unsigned& threads) {
  options.add({"--threads", "N", Replay::no}, threads, read_threads,
              "threads; default one for each core");
}

void add_quiet(Options& options, Output& output) {
  options.flag({"--quiet", "", Replay::no}, "no progress on standard error; default shown",
               [&output] { output.quiet = true; });
}

/// Commands that sample and judge differ in what seed and alpha are of.
void add_sampling(Options& options, SamplingCommand& command, const char* seed, const char* alpha) {
  options.add({"--seed", "N|random", Replay::no, "", {"random"}}, command.options.seed, read_seed,
              seed);
  add_threads(options, command.options.threads);
  options.add({"--alpha", "A"}, command.options.alpha, read_error_rate, alpha);
  add_quiet(options, command.output);
}

void add_running(Options& options, SamplingCommand& command, const char* seed, const char* alpha) {
  add_sampling(options, command, seed, alpha);
  add_inconclusive(options, command.output);
  add_output(options, command.output);
  options.repeat_by(command.options.command);
}

void add_estimators(Options& options, Texts& estimators) {
  options.add({"--estimator", "NAME=PLUGIN[,key=value]..."}, estimators,
              "an estimator with parameters; repeatable; default the plugin of that name");
}

void add_selection(Options& options, Selection& selection) {
  options.add({"--filter", "GLOB", Replay::no}, selection.filters,
              "only tests whose id, suite/name, matches; '-GLOB' leaves out those that match; * "
              "and ? are wildcards; repeatable; default all");
  options.add({"--tag", "TAG", Replay::no}, selection.tags,
              "only tests with this tag; repeatable: tests with any of them; default all");
}

void add_suites(Options& options, SuitesCommand& command) {
  options.add(
      {.name = "SUITE", .replay = Replay::no, .needed = "a suite file", .words = {"*.yaml"}},
      command.suites, read_suite, "suite files");
  add_selection(options, command.options.selection);
  options.add({"--set", "estimator.key=value"}, command.assignments,
              "set a parameter of an estimator; repeatable; default as in the suite");
  options.add({"--coarsen", "F"}, command.options.coarsen, read_positive,
              "multiply every `detect` by F, above 0; that of a law is at most 0.5; default 1");
}

constexpr const char* seed_of_suites =
    "seed of all random numbers; random: a fresh one; default the suite's, else 1";
constexpr const char* alpha_of_suites =
    "greatest probability that a suite of true claims fails, in [1e-9, 0.5]; default the suite's, "
    "else 0.01";

// The commands.

void define_run(Options& options, RunCommand& command) {
  add_suites(options, command);
  options.add(
      {"--shard", "I/N", Replay::no}, command.options.shard, read_shard,
      "only the I-th of N parts of the tests, which `assay merge` joins; default all, or as "
      "GTEST_TOTAL_SHARDS or TEST_TOTAL_SHARDS says");
  options.flag({"--fail-fast", "", Replay::no},
               "stop at the first broken claim; default run all claims",
               [&command] { command.options.fail_fast = true; });
  options.add({"--checkpoint", "FILE", Replay::no, "", {"*"}}, command.options.checkpoint,
              "keep what was drawn in FILE and FILE.kept; after a kill or Ctrl-C the same command "
              "continues from them; removed at the end; default none");
  options.add({"--checkpoint-every", "S", Replay::no}, command.options.checkpoint_every,
              read_positive, "seconds between two writes of the checkpoint; default 60");
  options.add({"--ledger", "FILE", Replay::no, "", {"*"}}, command.options.ledger,
              "add the run's evidence to that of earlier runs with fresh seeds; fail if all "
              "together refute a claim; default none");
  add_running(options, command, seed_of_suites, alpha_of_suites);
}

void define_plan(Options& options, PlanCommand& command) {
  add_suites(options, command);
  options.flag({"--list-renders", "", Replay::no},
               "print the missing renders instead of the plan, one a line: command, seed and "
               "file, separated by tabs; first of the pilots, then of the tests; default the plan",
               [&command] { command.list_renders = true; });
  add_sampling(options, command, seed_of_suites, alpha_of_suites);
}

void define_check(Options& options, CheckCommand& command) {
  CheckArguments& given = command.arguments;
  options.add({.name = "CLAIM", .needed = "a claim"}, given.claim, read_claim,
              "the claim, in quotes");
  add_estimators(options, given.estimators);
  options.add_key(
      {"--detect", "X"}, given.keys,
      "the effect that must not pass, as 0.5% or 0.002; default none: 1000 observations; "
      "for laws 0.05, but none for rows of a file");
  options.add_key({"--allow", "X"}, given.keys,
                  "the tolerated effect, as 0.5% or 0.002; default 0");
  options.add_key(
      {"--test", "METHOD", Replay::yes, "", method_names()}, given.keys,
      "force a method, one of " + listed(method_names()) + "; default chosen from the pilot");
  options.add_key(
      {"--over", "SWEEP"}, given.keys,
      "for a slope: a parameter and its values, as '{primaries: [8, 16, 32]}'; default none");
  options.add_key(
      {"--reference", "R"}, given.keys,
      "for a bias or an efficiency: the truth, as 6.36, '6.36 +- 0.01' or an estimator; "
      "default what the plugin knows");
  options.add_key({"--cost", "KIND"}, given.keys, "rays, samples or seconds; default rays");
  options.choice("--paired",
                 "for means of two images: draw both with the same random numbers and test their "
                 "differences; default independent draws",
                 [&given] { given.keys["paired"] = "true"; });
  options.add_key(
      {"--budget", "B"}, given.keys,
      "the most it may cost: 1e7 primaries with those of the pilot, or 30s of CPU time, "
      "which does not count waiting programs; default none");
  options.add({"--primaries", "N"}, given.primaries, at_least(1),
              "primary estimates of an observation; default chosen from the pilot");
  options.add_key({"--secondaries", "M"}, given.keys,
                  "number of observations, 2 or more; default what --detect needs");
  add_running(options, command, "seed of all random numbers; random: a fresh one; default 1",
              "greatest probability that a true claim fails, in [1e-9, 0.5]; default 0.01");
}

void define_images(Options& options, ImagesCommand& command) {
  ImagesArguments& given = command.arguments;
  options.add({.name = "--candidate",
               .value = "GLOB",
               .needed = "--candidate, a pattern of pictures",
               .words = {"*"}},
              given.candidate,
              "the pictures to test, 16 or more, each rendered with a seed of its own");
  options.add({.name = "--reference",
               .value = "GLOB",
               .needed = "--reference, a pattern of pictures or one file",
               .words = {"*"}},
              given.reference,
              "the pictures to compare with: 16 or more, or one that is exact or has its variance "
              "(channels `Variance.*` or `m2_*`)");
  options.add({"--channels", "GLOB"}, given.channels,
              "the channels to test, as 'ViewLayer.DiffInd.*'; commas separate several; default R, "
              "G and B, or what stands for them, and an alpha that is not 1");
  options.add({"--ignore", "KIND"}, given.ignores_nonfinite, OneOf<bool>{{{"nonfinite", true}}},
              "nonfinite: leave out pixels that are not finite in some picture; default an error");
  options.add({"--mask", "FILE", Replay::yes, "", {"*"}}, given.mask,
              "a picture; pixels where it is 0 are left out; default none");
  options.add({"--pixels", "KIND"}, given.independent_pixels,
              OneOf<bool>{{{"dependent", false}, {"independent", true}}},
              "independent, as under a box filter one pixel wide, or dependent; default dependent");
  options.add({"--samples", "N"}, given.samples,
              "samples in a single reference with its variance, or the channel that counts them; "
              "default what its file says");
  options.choice("--means", "test if the means are equal; the default", [] {});
  options.choice("--paired",
                 "test differences of pictures with equal seeds, which finds far smaller effects; "
                 "a pair's names agree in the parts that vary within a side",
                 [&given] { given.keys["paired"] = "true"; });
  options.choice("--law",
                 "test if the sides have one law, as from one renderer; exact for any noise",
                 [&given] { given.quantity = "distribution"; });
  options.add_key(
      {"--detect", "X"}, given.keys,
      "the root mean square difference over all pixels that must not pass, as 0.5% or 0.002; "
      "default none");
  options.add_key({"--allow", "X"}, given.keys,
                  "the tolerated root mean square difference over all pixels, as 0.5% or 0.002; it "
                  "also tolerates a wrong pixel; default 0");
  options.add({"--within", "X"}, given.within,
              "prove that the pictures differ by less, as 1% or 0.002; default test for equality");
  add_running(options, command, "seed of the random signs in tests of dependent pixels; default 1",
              "greatest probability that equal pictures fail, in [1e-9, 0.5]; default 0.01");
}

void define_sample(Options& options, SampleArguments& given) {
  options.add({.name = "SOURCE", .needed = "an estimator", .words = plugin_names()}, given.source,
              "an estimator, or a part of it");
  add_estimators(options, given.estimators);
  options.add({"--primaries", "N"}, given.primaries, at_least(1),
              "primary estimates of an observation; default 1");
  options.add({"--secondaries", "M"}, given.secondaries, at_least(1),
              "number of observations; default 10");
  options.add({"--seed", "N|random", Replay::yes, "", {"random"}}, given.seed, read_seed,
              "seed of the stream, or a fresh one; default 1");
}

void define_calibrate(Options& options, CalibrateCommand& command) {
  CalibrateArguments& given = command.arguments;
  Output& output = command.output;
  options.add({.name = "METHOD", .words = method_names()}, given.methods, "methods; default all");
  options.add(
      {"--law", "LAW"}, given.laws,
      "a law to draw from, as exponential or 'student_t(3)'; repeatable; default eight laws");
  options.add({"--alpha", "A"}, given.alphas, read_error_rate,
              "nominal level, in [1e-9, 0.5]; repeatable; default 0.05, 0.01 and 0.001");
  options.add({"--runs", "N"}, given.runs, at_least(1), "runs of each cell; default 1000");
  options.add({"--samples", "N"}, given.samples, at_least(2),
              "observations of every test, in one look, 2 or more; default planned with looks; for "
              "a method alone 1000, or 64 images");
  options.add({"--seed", "N|random", Replay::yes, "", {"random"}}, given.seed, read_seed,
              "seed of the first run, from which the others count on; default 1");
  add_threads(options, given.threads);
  add_quiet(options, output);
  add_report(options, output, "console, json, markdown or html");
  options.afterwards([&output] {
    for (const ReportRequest& report : output.reports) {
      if (reports::report_format(report.kind).of_calibration != nullptr) continue;
      refuse({}, "a calibration has no {} report", report.kind);
    }
  });
}

void define_list(Options& options, ListCommand& command) {
  Texts lists{"plugins", "tests"};
  for (const Table& table : tables()) lists.push_back(table.plural);
  options.add(
      {.name = "WHAT", .words = lists}, command.what,
      [lists](const std::string& text, const std::string& /*option*/) {
        return lists[choice(Value::scalar(text), "what is listed", lists)];
      },
      "plugins, tests, methods, quantities, laws, gates or reports; default a list of these");
  options.add({.name = "SUITE", .words = {"*.yaml"}}, command.suites,
              "suite files whose tests are listed");
  add_selection(options, command.selection);
  options.afterwards([&command] {
    const std::string list = "`assay list " + command.what + "`";
    if (command.what == "tests") {
      if (!command.suites.empty() && !command.suites[0].empty()) return;
      refuse({}, "`assay list` needs a suite file; see `assay list --help`");
    }
    if (!command.suites.empty()) refuse({}, list + " takes no suite");
    if (command.selection.empty()) return;
    refuse({}, list + " takes no --filter and no --tag; they select tests");
  });
}

void define_describe(Options& options, DescribeCommand& command) {
  Texts words = plugin_names();
  for (const Table& table : tables())
    std::ranges::copy(mapped(table.rows, &TableRow::name), std::back_inserter(words));
  options.add(
      {.name = "NAME",
       .needed = "a plugin or a family, a method, a quantity, a law, a gate or a report",
       .words = words},
      command.name,
      "a plugin, a method, a quantity, a law, a gate or a report, as `assay list` prints them");
}

/// "[RUN.json] TEST [OBSERVATION]".
void read_words(Texts words, ReplayArguments& given) {
  if (words.size() > 2 || words.front().ends_with(".json")) {
    given.record = words.front();
    words.erase(words.begin());
  }
  if (words.empty()) refuse({}, "`assay replay` needs a test of `{}`", given.record);
  if (words.size() > 2) refuse({}, "`{}` is one argument too many", words[2]);
  given.test = words[0];
  if (words.size() > 1) given.observation = at_least(0)(words[1], "the observation");
}

void define_replay(Options& options, ReplayArguments& given) {
  const auto words = std::make_shared<Texts>();
  options.add({.name = "TEST",
               .value = "[RUN.json] TEST [OBSERVATION]",
               .needed = "a test, as `assay list tests SUITE` prints them",
               .words = {"*.json"}},
              *words,
              "a saved run, default the last one; a test's id or name; an observation, counted "
              "from 0, default all");
  options.afterwards([words, &given] { read_words(*words, given); });
}

void define_explain(Options& options, ExplainArguments& given) {
  options.add(
      {.name = "TEST", .value = "[RUN.json] TEST"}, given.words,
      "a saved run, default the last one; a test's id or a part of it, if the run has several");
}

void define_merge(Options& options, MergeCommand& command) {
  options.add({.name = "SHARD.json", .needed = "the records of all shards", .words = {"*.json"}},
              command.records, "the records of all shards, in any order");
  add_inconclusive(options, command.output);
  add_output(options, command.output);
}

void define_report(Options& options, ReportCommand& command) {
  options.add({.name = "RUN.json", .needed = "a saved run", .words = {"*.json"}}, command.file,
              "a saved run");
  add_output(options, command.output);
}

void define_init(Options& options, InitArguments& given) {
  const Texts kinds = kinds_of_example();
  options.add({.name = "KIND",
               .value = "KIND [FOLDER]",
               .needed = "one of " + listed(kinds),
               .words = kinds},
              given.words, listed(kinds) + "; then a folder, default this one");
}

void define_completion(Options& options, TextCommand& command) {
  const Texts shells{"bash", "fish", "zsh"};
  options.add(
      {.name = "SHELL", .needed = "one of bash, fish, zsh", .words = shells}, command.text,
      [shells](const std::string& text, const std::string& option) {
        const std::string& shell = shells[choice(Value::scalar(text), option, shells)];
        return std::string(carried_text("completion/assay." + shell));
      },
      "bash, fish or zsh");
}

const std::vector<CommandRow>& command_rows();

void define_man(Options& options, TextCommand& command) {
  options.afterwards([&command] { command.text = man_page(texts_of(command_rows())); });
}

template <class Kind>
CommandRow command(const char* name, const char* summary, void (*define)(Options&, Kind&)) {
  return {name, summary, [define](Options& options) {
            const auto kind = std::make_shared<Kind>();
            define(options, *kind);
            return [kind] { return Command(*kind); };
          }};
}

const std::vector<CommandRow>& command_rows() {
  static const std::vector<CommandRow> rows{
      command("init", "write a small example: a suite, a plugin, a program, a job of CI",
              define_init),
      command("run", "test the claims of suite files", define_run),
      command("plan", "print what a run would do and cost; draws only the pilots", define_plan),
      command("check", "test one claim", define_check),
      command("images", "compare rendered pictures, without a suite", define_images),
      command("calibrate", "measure how often the methods err on known laws", define_calibrate),
      command("sample", "print observations of an estimator", define_sample),
      command("list", "list plugins, tests of suites, methods, quantities, laws, gates, reports",
              define_list),
      command("describe", "print the manual of a plugin, a method, a quantity, a law or a gate",
              define_describe),
      command("replay", "draw the numbers of a recorded test again", define_replay),
      command("explain", "explain a test of the last run from this folder, or of a saved run",
              define_explain),
      command("merge", "join the records of shards into one", define_merge),
      command("report", "make reports from a saved run", define_report),
      command("completion", "print a script that completes commands in a shell", define_completion),
      command("man", "print the manual page", define_man)};
  return rows;
}

}  // namespace

Command parse_command_line(const std::vector<std::string>& arguments) {
  // The scripts of `assay completion` ask with this word.
  if (!arguments.empty() && arguments.front() == "__complete") {
    return TextCommand{
        completions(texts_of(command_rows()), {arguments.begin() + 1, arguments.end()})};
  }
  if (arguments == Texts{"help", "all"}) return TextCommand{help_of_all(texts_of(command_rows()))};
  if (arguments == Texts{"help", "claims"}) {
    return TextCommand{help_of_claims(carried_text("claims.md"))};
  }
  return parsed(arguments, command_rows());
}

Loaded loaded(const Command& command) {
  if (const auto* run = std::get_if<RunCommand>(&command)) {
    Loaded all{load_suites(run->suites, run->assignments), run->options};
    all.options.assigns = !run->assignments.empty();
    take_shard_from(system_environment, all.options);
    return all;
  }
  if (const auto* check = std::get_if<CheckCommand>(&command)) {
    return {{suite_of_claim(check->arguments)}, check->options};
  }
  if (const auto* images = std::get_if<ImagesCommand>(&command)) {
    // Freed memory stays in the process. Pictures allocate and free tens of megabytes, and new
    // pages from the system would cost more than the work on them.
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, -1);
    return {{suite_of_images(images->arguments)}, images->options};
  }
  refuse({}, "this command runs no test");
}

}  // namespace assay::harness
