#include "estimators/stream.h"
#include "harness/base/version.h"
#include "harness/command/help.h"
#include "harness/command/program.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

template <class Kind>
Kind parsed(const std::vector<std::string>& arguments) {
  return std::get<Kind>(parse_command_line(arguments));
}

/// Why the command is refused, as it is read or by what it is made into.
std::string refused(const std::vector<std::string>& arguments) {
  return refusal([&] {
    const Command command = parse_command_line(arguments);
    if (const auto* run = std::get_if<RunCommand>(&command)) {
      std::vector<Suite> suites(1);
      suites[0].estimators = {parse_estimator_option("area=luminaire/area")};
      for (const std::string& each : run->assignments) set_parameter(suites, each);
    }
    if (const auto* check = std::get_if<CheckCommand>(&command)) suite_of_claim(check->arguments);
    if (const auto* sampled = std::get_if<SampleArguments>(&command)) sample(*sampled);
    if (const auto* described = std::get_if<DescribeCommand>(&command)) describe(described->name);
    if (const auto* calibrated = std::get_if<CalibrateCommand>(&command)) {
      calibration(calibrated->arguments, silence);
    }
  });
}

/// The words of a line, of which those with blanks stand in quotes.
std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream stream(line);
  for (std::string word; stream >> std::quoted(word, '\'');) words.push_back(word);
  return words;
}

TEST(CommandLine, RunsSuitesWithEveryOption) {
  const auto command = parsed<RunCommand>(
      words_of("run a.yaml b.yaml --filter */mean* --seed 7 --threads 2 --alpha 0.05 --coarsen 4 "
               "--set x.n=1 --set 'x.v=[1, 2]' --shard 2/5 --report json=run.json --report html=- "
               "--inconclusive fail "
               "--color never --quiet --fail-fast -vv --durations 3 --ledger n.ledger"));
  EXPECT_THAT(command.suites, ElementsAre("a.yaml", "b.yaml"));
  EXPECT_THAT(command.assignments, ElementsAre("x.n=1", "x.v=[1, 2]"));
  EXPECT_TRUE(command.options.fail_fast);
  EXPECT_EQ(command.output.detail, 2);
  EXPECT_EQ(command.output.slowest, 3U);
  EXPECT_THAT(command.options.selection.filters, ElementsAre("*/mean*"));
  EXPECT_EQ(command.options.seed, 7U);
  EXPECT_EQ(command.options.threads, 2U);
  EXPECT_EQ(command.options.alpha, 0.05);
  EXPECT_EQ(command.options.coarsen, 4);
  EXPECT_EQ(command.options.shard, (std::pair{2U, 5U}));
  ASSERT_EQ(command.output.reports.size(), 2U);
  EXPECT_EQ(command.output.reports[0].kind, "json");
  EXPECT_EQ(command.output.reports[1].path, "-");
  EXPECT_EQ(command.output.inconclusive, InconclusivePolicy::fail);
  EXPECT_EQ(command.output.colour, Colour::never);
  EXPECT_TRUE(command.output.quiet);
  EXPECT_EQ(command.options.ledger, "n.ledger");
  // Each test's replay names the test, and adds to no ledger.
  EXPECT_EQ(command.options.command,
            "assay run --set x.n=1 --set 'x.v=[1, 2]' --coarsen 4 --alpha 0.05");
}

TEST(CommandLine, PlansSuitesAsTheyWouldRun) {
  const auto command = parsed<PlanCommand>({"plan", "a.yaml", "b.yaml", "--filter", "a/*",
                                            "--alpha", "0.05", "--coarsen", "2", "--set", "x.n=1",
                                            "--seed", "3", "--threads", "1", "--quiet"});
  EXPECT_THAT(command.suites, ElementsAre("a.yaml", "b.yaml"));
  EXPECT_THAT(command.assignments, ElementsAre("x.n=1"));
  EXPECT_THAT(command.options.selection.filters, ElementsAre("a/*"));
  EXPECT_EQ(command.options.coarsen, 2);
  EXPECT_TRUE(command.output.quiet);
}

TEST(CommandLine, OneReportOptionTakesSeveralReports) {
  const auto paths = [](const std::vector<std::string>& words) {
    std::string all;
    const auto command = parsed<RunCommand>(words);
    for (const ReportRequest& each : command.output.reports) {
      all += each.kind + ">" + each.path + " ";
    }
    for (const std::string& suite : command.suites) all += suite + " ";
    return all;
  };
  EXPECT_EQ(paths({"run", "s.yaml", "--report", "json=a", "console=b"}),
            "json>a console>b s.yaml ");
  EXPECT_EQ(paths({"run", "--report", "json=a", "html=b", "s.yaml"}), "json>a html>b s.yaml ");
  EXPECT_EQ(paths({"run", "--report=json=a", "html=b", "s.yaml", "t.yaml"}),
            "json>a html>b s.yaml t.yaml ");
  EXPECT_EQ(paths({"run", "--report", "json=a", "s.yaml"}), "json>a s.yaml ");
  EXPECT_EQ(paths({"run", "--report", "console", "html=b", "s.yaml"}), "console>- html>b s.yaml ");
  EXPECT_EQ(paths({"run", "s.yaml", "--report", "json=a", "--report", "html=b", "junit=c"}),
            "json>a html>b junit>c s.yaml ");
  // A word that follows no report is an argument.
  EXPECT_EQ(paths({"run", "json=a"}), "json=a ");
}

TEST(CommandLine, SelectsByFiltersAndTags) {
  const auto run = parsed<RunCommand>({"run", "a.yaml", "--filter", "*/mean*", "--filter",
                                       "-*slow*", "--tag", "fast", "--tag", "nightly"});
  EXPECT_THAT(run.options.selection.filters, ElementsAre("*/mean*", "-*slow*"));
  EXPECT_THAT(run.options.selection.tags, ElementsAre("fast", "nightly"));
  EXPECT_THAT(parsed<PlanCommand>({"plan", "a.yaml", "--tag", "x"}).options.selection.tags,
              ElementsAre("x"));
  const auto list = parsed<ListCommand>({"list", "tests", "a.yaml", "--tag", "x", "--filter=-b"});
  EXPECT_THAT(list.selection.tags, ElementsAre("x"));
  EXPECT_THAT(list.selection.filters, ElementsAre("-b"));
}

TEST(CommandLine, ChecksAClaim) {
  const auto command = parsed<CheckCommand>(
      {"check", "mean(a) == analytic", "--estimator", "a=luminaire/area,scene={x: [1, 2]}",
       "--detect", "0.5%", "--allow", "1e-6", "--test", "t", "--primaries", "1e2", "--secondaries",
       "1000", "--alpha", "0.02", "--seed", "3"});
  EXPECT_FALSE(command.arguments.keys.contains("paired"));
  EXPECT_EQ(
      parsed<CheckCommand>({"check", "mean(a) == mean(b)", "--paired"}).arguments.keys.at("paired"),
      "true");
  EXPECT_EQ(command.arguments.claim, "mean(a) == analytic");
  EXPECT_THAT(command.arguments.estimators, ElementsAre("a=luminaire/area,scene={x: [1, 2]}"));
  EXPECT_EQ(command.arguments.primaries, 100U);
  const TestKeys keys{
      {"detect", "0.5%"}, {"allow", "1e-6"}, {"test", "t"}, {"secondaries", "1000"}};
  EXPECT_EQ(command.arguments.keys, keys);
  EXPECT_EQ(command.options.alpha, 0.02);
  EXPECT_EQ(command.options.command,
            "assay check 'mean(a) == analytic' --estimator 'a=luminaire/area,scene={x: [1, 2]}' "
            "--detect 0.5% --allow 1e-6 --test t --primaries 1e2 --secondaries 1000 --alpha 0.02");
}

TEST(CommandLine, SamplesListsDescribesReplaysAndReports) {
  const auto sample = parsed<SampleArguments>(
      {"sample", "luminaire/area.irradiance", "--secondaries", "5", "--seed", "9"});
  EXPECT_EQ(sample.source, "luminaire/area.irradiance");
  EXPECT_EQ(sample.secondaries, 5U);
  EXPECT_EQ(sample.primaries, 1U);
  EXPECT_EQ(sample.seed, 9U);
  EXPECT_EQ(parsed<ListCommand>({"list", "plugins"}).what, "plugins");
  EXPECT_EQ(parsed<ListCommand>({"list", "methods"}).what, "methods");
  EXPECT_THAT(parsed<ListCommand>({"list", "tests", "a.yaml"}).suites, ElementsAre("a.yaml"));
  EXPECT_EQ(parsed<DescribeCommand>({"describe", "luminaire/area"}).name, "luminaire/area");
  const auto replay = parsed<ReplayArguments>({"replay", "run.json", "s/t", "0"});
  EXPECT_EQ(replay.record, "run.json");
  EXPECT_EQ(replay.test, "s/t");
  EXPECT_EQ(replay.observation, 0U);
  EXPECT_EQ(parsed<ReplayArguments>({"replay", "run.json", "s/t"}).observation, std::nullopt);
  const auto of_last = parsed<ReplayArguments>({"replay", "s/t", "3"});
  EXPECT_EQ(of_last.record, "");
  EXPECT_EQ(of_last.observation, 3U);
  EXPECT_EQ(parsed<ReportCommand>({"report", "run.json", "--report", "html=a"}).file, "run.json");
}

TEST(CommandLine, ARandomSeedIsFresh) {
  const auto first = parsed<RunCommand>({"run", "a.yaml", "--seed", "random"});
  const auto second = parsed<RunCommand>({"run", "a.yaml", "--seed", "random"});
  // Equal with probability 2^-64.
  EXPECT_NE(first.options.seed, second.options.seed);
}

TEST(CommandLine, HelpLeadsWithExamples) {
  for (const char* name : {"run", "plan", "check", "calibrate", "sample", "list", "describe",
                           "replay", "report", "init", "completion", "man"}) {
    const std::string help = parsed<TextCommand>({name, "--help"}).text;
    const std::size_t examples = help.find("Examples:\n  assay " + std::string(name));
    ASSERT_NE(examples, std::string::npos) << help;
    EXPECT_LT(examples, help.find("Usage:")) << help;
    EXPECT_THAT(help, HasSubstr(std::string("assay ") + name + " ["));
    EXPECT_THAT(parsed<TextCommand>({"help", "all"}).text,
                HasSubstr(std::string("  ") + name + " "));
  }
  EXPECT_THAT(parsed<TextCommand>({"help", "all"}).text, HasSubstr("Exit codes:"));
}

TEST(CommandLine, TheFirstPageFitsOneScreen) {
  const auto page = lines(parsed<TextCommand>({"--help"}).text);
  for (const std::string& line : page) EXPECT_LE(line.size(), 80U) << line;
  EXPECT_LE(page.size(), 24U);
}

/// The words that completion offers after `assay`, without descriptions.
std::vector<std::string> offered(std::vector<std::string> words) {
  words.insert(words.begin(), "__complete");
  auto all = lines(parsed<TextCommand>(words).text);
  for (std::string& line : all) line.resize(std::min(line.size(), line.find('\t')));
  return all;
}

TEST(CommandLine, CompletionOffersWhatMayFollow) {
  std::ifstream file(ASSAY_SOURCE_DIR "/tests/tables/completions.txt");
  int count = 0;
  for (std::string line; std::getline(file, line); ++count) {
    if (line.starts_with('#')) continue;
    const std::size_t arrow = line.find(" =>");
    EXPECT_EQ(offered(words_of(line.substr(0, arrow))), words_of(line.substr(arrow + 3))) << line;
  }
  EXPECT_GT(count, 15);
  EXPECT_THAT(offered({}), Contains("run"));
}

TEST(CommandLine, TheManualPageHasEveryCommandAndOption) {
  const std::string page = parsed<TextCommand>({"man"}).text;
  for (const std::string& name : offered({""})) {
    if (name == "help" || name.starts_with("-")) continue;
    EXPECT_THAT(page, HasSubstr(".SS assay " + name + " ["));
    for (std::string option : offered({name, "--"})) {
      if (option == "--help") continue;
      for (std::size_t at = 0; (at = option.find('-', at)) != std::string::npos; at += 2) {
        option.insert(at, "\\");
      }
      EXPECT_THAT(page, HasSubstr(".TP\n\\fB" + option + "\\fR"));
    }
  }
}

TEST(CommandLine, HelpIsACommandToo) {
  EXPECT_EQ(parsed<TextCommand>({"help"}).text, parsed<TextCommand>({"--help"}).text);
  EXPECT_EQ(parsed<TextCommand>({"help", "--help"}).text, parsed<TextCommand>({"--help"}).text);
  EXPECT_EQ(parsed<TextCommand>({"help", "run"}).text, parsed<TextCommand>({"run", "--help"}).text);
  // Not the first word: an argument as any other.
  EXPECT_EQ(parsed<ListCommand>({"list", "tests", "help"}).suites.at(0), "help");
}

TEST(CommandLine, TellsItsVersionAndCommit) {
  EXPECT_EQ(parsed<TextCommand>({"--version"}).text,
            "assay " + version() + " (" + commit() + ")\n");
  EXPECT_FALSE(commit().empty());
}

TEST(CommandLine, MergesRecordsInAnyNumber) {
  const auto command =
      parsed<MergeCommand>({"merge", "2.json", "1.json", "--report", "metrics=m.txt", "--github",
                            "never", "--inconclusive", "pass"});
  EXPECT_THAT(command.records, ElementsAre("2.json", "1.json"));
  EXPECT_EQ(command.output.reports.at(0).kind, "metrics");
  EXPECT_FALSE(command.output.github);
  EXPECT_EQ(command.output.inconclusive, InconclusivePolicy::pass);
  EXPECT_TRUE(parsed<MergeCommand>({"merge", "1.json"}).output.github);
}

TEST(CommandLine, IsRefusedInAnotherWayForEachMistake) {
  std::ifstream file(ASSAY_SOURCE_DIR "/tests/tables/refused_commands.txt");
  const std::string part = "  …";
  int count = 0;
  for (std::string line, message; std::getline(file, line);) {
    if (!line.starts_with("assay")) continue;
    ASSERT_TRUE(std::getline(file, message) && message.starts_with("  ")) << line;
    std::vector<std::string> words = words_of(line);
    words.erase(words.begin());
    if (message.starts_with(part)) {
      EXPECT_THAT(refused(words), HasSubstr(message.substr(part.size()))) << line;
    } else {
      EXPECT_EQ(refused(words), message.substr(2)) << line;
    }
    ++count;
  }
  EXPECT_GT(count, 80);
}

TEST(CommandLine, HelpTellsEveryDefaultInAHundredColumns) {
  for (const char* name :
       {"run", "plan", "check", "calibrate", "sample", "list", "describe", "replay", "report"}) {
    const std::string help = parsed<TextCommand>({name, "--help"}).text;
    std::string option;
    const auto finish = [&] {
      if (option.empty() || option.starts_with("  -h")) return;
      EXPECT_THAT(option, HasSubstr("default"));
    };
    const std::size_t options = std::min(help.find("\nOptions:\n") + 10, help.size());
    for (const std::string& line : lines(help.substr(options))) {
      EXPECT_LE(line.size(), 100U) << line;
      if (line.starts_with("  -")) {
        finish();
        option.clear();
      }
      option += line + "\n";
    }
    finish();
  }
}

// Any words are a command or an InputError: what CLI11 throws never gets out.
TEST(CommandLineFuzz, AnyWordsAreReadOrRefused) {
  const std::vector<std::string> words{
      "run", "check",  "list",     "tests",  "--set",    "--set=a.b=1", "-x",
      "--",  "-",      "--report", "json=x", "--seed",   "3",           "[1,2]",
      "",    "a=b",    "--help",   "-h",     "sample",   "report",      "--alpha",
      "0.1", "replay", "%%",       "--no",   "--version"};
  for (std::uint64_t i = 0; i < 3000; ++i) {
    Stream random({4}, i);
    std::vector<std::string> arguments(random() % 6);
    for (std::string& word : arguments) word = words[random() % words.size()];
    try {
      parse_command_line(arguments);
    } catch (const InputError& e) {
      EXPECT_FALSE(e.message().empty());
      EXPECT_THAT(e.message(), testing::Not(HasSubstr("\n")));
    }
  }
}

}  // namespace
}  // namespace assay::harness
