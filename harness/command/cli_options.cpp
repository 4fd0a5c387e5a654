#include "harness/command/cli_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "estimators/core/quoting.h"
#include "harness/command/cli_help.h"
#include "harness/language/method_names.h"
#include "harness/suite/suite_entries.h"
#include "harness/suite/suite_keys.h"

namespace assay::harness {

namespace {

CLI::App* subcommand(CLI::App& app, const std::string& name) {
  CLI::App* sub = app.add_subcommand(name, help_of(name));
  sub->allow_extras();
  return sub;
}

void many(CLI::App* sub, const char* name, Texts& values, const char* kind, const char* about) {
  sub->add_option(name, values, about)->type_name(kind)->allow_extra_args(false)->take_all();
}

void one(CLI::App* sub, const char* name, std::string& value, const char* kind,
         const std::string& about) {
  sub->add_option(name, value, about)->type_name(kind);
}

void add_output(CLI::App* sub, Given& given) {
  many(sub, "--report", given.reports, "KIND=PATH",
       "console, json, junit, markdown, html or metrics (OpenMetrics) to a file, - is standard "
       "output; one or more; default console=-, which goes to standard error where another report "
       "has standard output; console=/dev/null silences it");
  one(sub, "--color", given.colour, "WHEN",
      "auto, always or never; default auto: on a terminal, as NO_COLOR and FORCE_COLOR say");
}

/// Texts that differ between the commands that sample and judge.
struct Running {
  const char* seed;
  const char* alpha;
};

void add_sampling(CLI::App* sub, Given& given, const Running& about) {
  one(sub, "--seed", given.seed, "N|random", about.seed);
  one(sub, "--threads", given.threads, "N", "worker threads; default one for each core");
  one(sub, "--alpha", given.alpha, "A", about.alpha);
  sub->add_flag("--quiet", given.quiet, "no progress on standard error; default shown");
}

void add_inconclusive(CLI::App* sub, Given& given) {
  one(sub, "--inconclusive", given.inconclusive, "fail|pass",
      "count undecided tests as failed or as passed; default neither: exit code 3");
  one(sub, "--github", given.github, "auto|never",
      "annotations and the step's summary for a job of GitHub Actions; default auto: where "
      "GITHUB_ACTIONS is true");
}

void add_running(CLI::App* sub, Given& given, const Running& about) {
  add_sampling(sub, given, about);
  add_inconclusive(sub, given);
  add_output(sub, given);
}

/// Texts that differ between the commands that take estimators.
struct Sizes {
  const char* primaries;
  const char* secondaries;
};

void add_estimators(CLI::App* sub, Given& given, const Sizes& about) {
  many(sub, "--estimator", given.estimators, "NAME=PLUGIN[,key=value]...",
       "an estimator with parameters; repeatable; default the plugin of that name");
  one(sub, "--primaries", given.primaries, "N", about.primaries);
  one(sub, "--secondaries", given.secondaries, "M", about.secondaries);
}

void add_selection(CLI::App* sub, Given& given) {
  many(sub, "--filter", given.filters, "GLOB",
       "only tests whose id, suite/name, matches, or with '-GLOB' all but these; * and ? are wild; "
       "repeatable; default all");
  many(sub, "--tag", given.tags, "TAG",
       "only tests that have this tag; repeatable, any of them; default all");
}

void add_suites(CLI::App* sub, Given& given) {
  sub->add_option("SUITE", given.suites, "suite files")->type_name("");
  add_selection(sub, given);
  one(sub, "--coarsen", given.coarsen, "F", "multiply every `detect` by F, above 0; default 1");
  many(sub, "--set", given.sets, "estimator.key=value",
       "set a parameter; repeatable; default as in the suite");
}

constexpr Running of_suites{
    .seed = "seed of all streams, or a fresh one; default the suite's, else 1",
    .alpha =
        "probability that a suite whose claims hold fails, in [1e-9, 0.5]; default the suite's, "
        "else 0.01"};

void define_plan(CLI::App& app, Given& given) {
  CLI::App* sub = subcommand(app, "plan");
  add_suites(sub, given);
  add_sampling(sub, given, of_suites);
}

void define_run(CLI::App& app, Given& given) {
  CLI::App* sub = subcommand(app, "run");
  add_suites(sub, given);
  one(sub, "--shard", given.shard, "I/N",
      "only the I-th of N parts of the tests, each on its fixed share of alpha, for `assay merge`; "
      "default all, or what GTEST_TOTAL_SHARDS or TEST_TOTAL_SHARDS says");
  one(sub, "--ledger", given.ledger, "FILE",
      "add the run's evidence to a file of nights with fresh seeds and alarm at what they say "
      "together; default none");
  add_running(sub, given, of_suites);
}

void define_check(CLI::App& app, Given& given) {
  CLI::App* sub = subcommand(app, "check");
  sub->add_option("CLAIM", given.claim, "the claim, in quotes")->type_name("");
  one(sub, "--detect", given.detect, "X",
      "the effect that must not pass, as 0.5% or 0.002; default none: 1000 observations; of laws "
      "0.05");
  one(sub, "--allow", given.allow, "X",
      "the effect that may be there, as 0.5% or 0.002; default 0");
  one(sub, "--test", given.method, "METHOD",
      "force a method, one of " + listed(method_names()) + "; default chosen from the pilot");
  one(sub, "--over", given.over, "SWEEP",
      "of a slope: a parameter and its values, as '{primaries: [8, 16, 32]}'; default none");
  one(sub, "--reference", given.reference, "R",
      "of a bias or an efficiency: the truth, as 6.36, '6.36 +- 0.01' or an estimator; default "
      "what the plugin knows");
  one(sub, "--cost", given.cost, "KIND", "rays, samples or seconds; default rays");
  one(sub, "--budget", given.budget, "B",
      "the most it may cost, as 1e7 primaries or 30s of CPU time; default none");
  add_estimators(sub, given,
                 {.primaries = "primary estimates of an observation; default chosen from the pilot",
                  .secondaries = "number of observations, 2 or more; default what --detect needs"});
  add_running(sub, given,
              {.seed = "seed of all streams, or a fresh one; default 1",
               .alpha = "probability that a claim that holds fails, in [1e-9, 0.5]; default 0.01"});
}

void define_images(CLI::App& app, Given& given) {
  CLI::App* sub = subcommand(app, "images");
  one(sub, "--candidate", given.candidate, "GLOB",
      "the pictures in question, OpenEXR, 16 or more, each rendered with a seed of its own");
  one(sub, "--reference", given.pictures, "GLOB",
      "what they are held against: as many again, or one picture, with its variance (channels "
      "`Variance.*` or `m2_*`) or exact");
  one(sub, "--channels", given.channels, "GLOB",
      "the channels to test, as 'ViewLayer.DiffInd.*'; commas between several; default R, G and B, "
      "or what stands for them");
  one(sub, "--pixels", given.pixels, "KIND",
      "independent, as under a box filter one pixel wide, or dependent; default dependent");
  one(sub, "--samples", given.picture_samples, "N",
      "of how many samples the means of one picture with its variance are, or the channel that "
      "counts them; default its own word");
  one(sub, "--detect", given.detect, "X",
      "the difference over the whole picture that must not pass, as 0.5% or 0.002; default none");
  one(sub, "--allow", given.allow, "X",
      "the difference that may be there, as 0.5% or 0.002; default 0");
  one(sub, "--within", given.within, "X",
      "prove that the pictures differ by less, as 1% or 0.002; default test that they are equal");
  add_running(sub, given,
              {.seed = "seed of the signs that are flipped where pixels depend on each other; "
                       "default 1",
               .alpha = "probability that equal pictures fail, in [1e-9, 0.5]; default 0.01"});
}

void define_others(CLI::App& app, Given& given) {
  CLI::App* sample = subcommand(app, "sample");
  sample->add_option("SOURCE", given.source, "an estimator, or a part of it")->type_name("");
  add_estimators(sample, given,
                 {.primaries = "primary estimates of an observation; default 1",
                  .secondaries = "number of observations; default 10"});
  one(sample, "--seed", given.seed, "N|random", "seed of the stream, or a fresh one; default 1");

  CLI::App* calibrate = subcommand(app, "calibrate");
  calibrate->add_option("METHOD", given.methods, "methods; default all")->type_name("");
  many(calibrate, "--law", given.laws, "LAW",
       "what is drawn, as exponential or 'student_t(3)'; repeatable; default eight laws");
  many(calibrate, "--alpha", given.alphas, "A",
       "nominal level, in [1e-9, 0.5]; repeatable; default 0.05, 0.01 and 0.001");
  one(calibrate, "--runs", given.runs, "N", "runs a cell; default 1000");
  one(calibrate, "--samples", given.samples, "N",
      "observations of every test, in one look, 2 or more; default planned, in looks, and 1000 or "
      "64 images of a method alone");
  one(calibrate, "--seed", given.seed, "N|random",
      "seed of the first run, the next ones follow; default 1");
  one(calibrate, "--threads", given.threads, "N", "worker threads; default one for each core");
  calibrate->add_flag("--quiet", given.quiet, "no progress on standard error; default shown");
  many(calibrate, "--report", given.reports, "KIND=PATH",
       "console, json, markdown or html to a file, - is standard output; one or more; default "
       "console=-, which goes to standard error where another report has standard output; "
       "console=/dev/null silences it");

  CLI::App* list = subcommand(app, "list");
  list->add_option("WHAT", given.what,
                   "plugins, tests, methods, quantities, laws, gates or reports")
      ->type_name("");
  list->add_option("SUITE", given.suites, "suite files, of which the tests are listed")
      ->type_name("");
  add_selection(list, given);

  CLI::App* describe = subcommand(app, "describe");
  describe
      ->add_option("NAME", given.plugin,
                   "a plugin, a method, a quantity, a law or a report, as `assay list` prints them")
      ->type_name("");

  CLI::App* replay = subcommand(app, "replay");
  replay->add_option("RUN.json", given.record, "a saved run")->type_name("");
  replay->add_option("TEST", given.test, "a test's id or name")->type_name("");
  replay
      ->add_option("OBSERVATION", given.observation,
                   "one observation alone, from 0; default the whole test")
      ->type_name("");

  CLI::App* merge = subcommand(app, "merge");
  merge->add_option("SHARD.json", given.records, "the records of all shards, in any order")
      ->type_name("");
  add_inconclusive(merge, given);
  add_output(merge, given);

  CLI::App* report = subcommand(app, "report");
  report->add_option("RUN.json", given.record, "a saved run")->type_name("");
  add_output(report, given);
}

void define_options(CLI::App& app, Given& given) {
  define_run(app, given);
  define_plan(app, given);
  define_check(app, given);
  define_images(app, given);
  define_others(app, given);
}

Texts option_names(const CLI::App& app) {
  Texts names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

Texts subcommand_names(const CLI::App& app) {
  Texts names;
  for (const CLI::App* sub : app.get_subcommands({})) names.push_back(sub->get_name());
  return names;
}

/// The suite's key that does the same as an option of `check`.
std::string key_of_a_suite(const CLI::App& sub, const std::string& option) {
  if (sub.get_name() != "run" && sub.get_name() != "plan") return "";
  for (const char* key : {"detect", "allow", "test", "over", "reference", "cost", "budget",
                          "primaries", "secondaries"}) {
    if (option == std::string("--") + key) return key;
  }
  return "";
}

void refuse_extras(const CLI::App& sub) {
  for (const std::string& extra : sub.remaining()) {
    const std::string help = fmt::format("see `assay {} --help`", sub.get_name());
    if (!extra.starts_with("-")) {
      std::string mend = help;
      if (extra.ends_with(".exr")) mend = "quote a pattern, so that the shell leaves it alone";
      if (sub.get_name() == "check") mend = "quote the claim: `assay check 'mean(a) == 3'`";
      usage_error(fmt::format("`{}` is one argument too many; {}", extra, mend));
    }
    const std::string name = extra.substr(0, extra.find('='));
    const std::string near = nearest(name, option_names(sub));
    std::string mend = near.empty() ? help : fmt::format("did you mean `{}`?", near);
    if (const std::string key = key_of_a_suite(sub, name); !key.empty()) {
      mend = fmt::format("write it into the suite, as the key `{}`", key);
    }
    usage_error(fmt::format("`assay {}` has no option `{}`; {}", sub.get_name(), name, mend));
  }
}

/// The command that fits a suite, a saved run or a claim.
std::string command_meant(const std::string& word, const CLI::App& app) {
  const auto meant = [&](const char* command) {
    return fmt::format("; did you mean `assay {} {}`?", command, shell_quoted(word));
  };
  if (word.ends_with(".yaml") || word.ends_with(".yml")) return meant("run");
  if (word.ends_with(".json")) return meant("report");
  if (word.find('(') != std::string::npos) return meant("check");
  return suggestion(word, subcommand_names(app));
}

const CLI::App& chosen(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  for (const std::string& extra : app.remaining()) {
    if (extra.starts_with("-")) {
      usage_error(
          fmt::format("unknown option `{}`; options stand after the command, see `assay "
                      "--help`",
                      extra));
    }
    usage_error(fmt::format("unknown command `{}`{}", extra, command_meant(extra, app)));
  }
  if (parsed.empty()) usage_error("no command; see `assay --help`");
  return *parsed.front();
}

/// Our own code demands arguments; CLI11 marks them as required only to show them in the usage
/// line.
std::string help_text(CLI::App& app) {
  const auto parsed = app.get_subcommands();
  if (parsed.empty()) return general_help();
  CLI::App& sub = *parsed.front();
  sub.set_help_flag("-h,--help", "this text");
  for (CLI::Option* option : sub.get_options()) {
    const std::string name = option->get_name(true);
    const bool optional =
        name == "OBSERVATION" || name == "METHOD" || (name == "SUITE" && sub.get_name() == "list");
    if (option->get_positional() && !optional) option->required();
  }
  return wrapped_options(sub.help("assay"));
}

/// `assay help` is `assay --help`, `assay help run` is `assay run --help`.
Texts without_help_command(const Texts& arguments, const CLI::App& app) {
  if (arguments.empty() || arguments.front() != "help") return arguments;
  if (arguments.size() == 1) return {"--help"};
  Texts asked(arguments.begin() + 1, arguments.end());
  const Texts names = subcommand_names(app);
  // An unknown command is passed on, so that it is refused.
  if (std::find(names.begin(), names.end(), asked.front()) != names.end()) {
    asked.emplace_back("--help");
  }
  return asked;
}

/// True for KIND=PATH, which nothing else that follows a report resembles.
bool is_report(const std::string& word) {
  const std::size_t kind = word.find_first_not_of("abcdefghijklmnopqrstuvwxyz");
  return kind != std::string::npos && kind > 0 && word[kind] == '=';
}

/// `--report json=a html=b` is `--report json=a --report html=b`.
Texts with_an_option_each(const Texts& words) {
  Texts all;
  bool after_report = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (after_report && is_report(words[i])) {
      all.insert(all.end(), {"--report", words[i]});
      continue;
    }
    all.push_back(words[i]);
    after_report = words[i].starts_with("--report=");
    if (words[i] != "--report" || i + 1 == words.size()) continue;
    all.push_back(words[++i]);
    after_report = true;
  }
  return all;
}

/// CLI11's refusal, reworded: it names the methods if one was expected. CLI11 says "--detect: 1
/// required X missing" if a value is missing.
std::string in_words(const CLI::ParseError& error) {
  std::string text = error.what();
  const std::size_t colon = text.find(": 1 required ");
  if (colon != std::string::npos && text.ends_with(" missing")) {
    const std::size_t kind = colon + std::string_view(": 1 required ").size();
    const std::string option = text.substr(0, colon);
    text = fmt::format("{0} needs a value: `{0} {1}`", option,
                       text.substr(kind, text.rfind(' ') - kind));
    if (option == "--test") text += "; METHOD is one of " + listed(method_names());
  }
  return text;
}

}  // namespace

void usage_error(const std::string& why) { throw InputError({}, why); }

SortedWords sorted_words(const Texts& arguments) {
  SortedWords sorted;
  CLI::App app("", "assay");
  app.require_subcommand(0, 1);
  app.allow_extras();
  app.add_flag("--version", sorted.version);
  define_options(app, sorted.given);
  try {
    const Texts words = with_an_option_each(without_help_command(arguments, app));
    // CLI11 takes the words from the back.
    app.parse(Texts(words.rbegin(), words.rend()));
  } catch (const CLI::CallForHelp&) {
    sorted.help = help_text(app);
    return sorted;
  } catch (const CLI::ParseError& e) {
    usage_error(in_words(e));
  }
  if (sorted.version) return sorted;
  const CLI::App& sub = chosen(app);
  refuse_extras(sub);
  sorted.command = sub.get_name();
  return sorted;
}

}  // namespace assay::harness
