#include "harness/command/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <random>

#include "estimators/core/quoting.h"
#include "harness/base/version.h"
#include "harness/language/claim.h"
#include "reports/report_formats.h"

namespace assay::harness {

namespace {

Texts subcommand_names(const CLI::App& app) {
  return mapped(app.get_subcommands({}), [](const CLI::App* sub) { return sub->get_name(); });
}

/// Options of `check` that are keys in a suite.
constexpr const char* keys_of_a_suite[] = {"--detect",    "--allow",      "--test",   "--over",
                                           "--reference", "--cost",       "--budget", "--paired",
                                           "--primaries", "--secondaries"};

/// Says what to write in place of an argument too many.
std::string mend_of_extra(const std::string& command, const std::string& extra) {
  if (command == "images") {
    const std::filesystem::path file = extra;
    if (!file.has_extension() || extra.find('*') != std::string::npos) {
      return "give the pictures by `--candidate 'NEW/*.exr' --reference 'OLD/*.exr'`";
    }
    return fmt::format("quote the pattern, as in '{}'",
                       (file.parent_path() / ("*" + file.extension().string())).string());
  }
  if (command != "check") return fmt::format("see `assay {} --help`", command);
  const std::size_t equals = extra.find('=');
  const bool names_a_plugin =
      equals != 0 && equals < extra.find_first_of("(, ") && extra.compare(equals, 2, "==") != 0;
  if (names_a_plugin) {
    return fmt::format("give each estimator an option of its own: `--estimator {}`",
                       shell_quoted(extra));
  }
  return "quote the claim and other words with blanks: `assay check 'mean(a) == 3'`, `--estimator "
         "'a=process,command=[python3, a.py]'`";
}

void refuse_extras(const CLI::App& sub) {
  for (const std::string& extra : sub.remaining()) {
    if (!extra.starts_with("-")) {
      refuse({}, "`{}` is one argument too many; {}", extra, mend_of_extra(sub.get_name(), extra));
    }
    const std::string name = extra.substr(0, extra.find('='));
    Texts names;
    for (const CLI::Option* option : sub.get_options()) {
      for (const std::string& known : option->get_lnames()) names.push_back("--" + known);
    }
    const std::string near = nearest(name, names);
    std::string mend = near.empty() ? fmt::format("see `assay {} --help`", sub.get_name())
                                    : fmt::format("did you mean `{}`?", near);
    const bool of_suites = sub.get_name() == "run" || sub.get_name() == "plan";
    if (of_suites && std::ranges::count(keys_of_a_suite, name) > 0) {
      mend = fmt::format("write it into the suite, as the key `{}`", name.substr(2));
    }
    refuse({}, "`assay {}` has no option `{}`; {}", sub.get_name(), name, mend);
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
  for (const std::string& extra : app.remaining()) {
    if (extra.starts_with("-")) {
      refuse({}, "unknown option `{}`; options follow the command, see `assay --help`", extra);
    }
    refuse({}, "unknown command `{}`{}", extra, command_meant(extra, app));
  }
  if (app.get_subcommands().empty()) refuse({}, "no command; see `assay --help`");
  return *app.get_subcommands().front();
}

/// `assay help` is `assay --help`, `assay help run` is `assay run --help`.
Texts without_help_command(const Texts& arguments, const CLI::App& app) {
  if (arguments.empty() || arguments.front() != "help") return arguments;
  if (arguments.size() == 1) return {"--help"};
  Texts asked(arguments.begin() + 1, arguments.end());
  // An unknown command is passed on, so that it is refused.
  if (std::ranges::count(subcommand_names(app), asked.front()) > 0) asked.emplace_back("--help");
  return asked;
}

/// `--report json=a html=b` is `--report json=a --report html=b`. Nothing else that follows a
/// report resembles KIND=PATH.
Texts with_an_option_each(const Texts& words) {
  Texts all;
  bool is_value = false;
  bool after_report = false;
  for (const std::string& word : words) {
    const std::size_t kind = word.find_first_not_of("abcdefghijklmnopqrstuvwxyz");
    if (after_report && kind != std::string::npos && kind > 0 && word[kind] == '=') {
      all.emplace_back("--report");
      is_value = true;
    }
    all.push_back(word);
    after_report = is_value || word.starts_with("--report=");
    is_value = !is_value && word == "--report";
  }
  return all;
}

/// CLI11's refusal, reworded: it names the methods if one was expected. CLI11 says "--detect: 1
/// required X missing" if a value is missing, and "--detect: At Most 1 required" if there are two.
std::string in_words(const CLI::ParseError& error) {
  std::string text = error.what();
  if (const std::size_t most = text.find(": At Most 1 required"); most != std::string::npos) {
    return text.substr(0, most) + " is given more than once; leave the others out";
  }
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

/// A report's kind alone, or a path by its ending, completed.
std::string meant_report(std::string text) {
  while (text.ends_with('=')) text.pop_back();
  const std::string ending = text.substr(std::min(text.rfind('.') + 1, text.size()));
  for (const reports::ReportFormat& format : reports::report_formats()) {
    if (text == format.kind) return fmt::format("{}=run.{}", format.kind, format.ending);
    if (ending == format.ending) return fmt::format("{}={}", format.kind, text);
  }
  return "html=run.html";
}

}  // namespace

Texts Options::Row::given() const {
  Texts texts = option->results();
  if (!text.repeats) std::erase(texts, "");
  return texts;
}

void Options::add_row(OptionText text, const std::string& about, bool repeats,
                      std::function<void(const std::string&)> take) {
  CLI::Option* option = app_.add_option(text.name, CLI::callback_t{})->type_name(text.value);
  if (repeats) option->expected(CLI::detail::expected_max_vector_size);
  if (repeats && !option->get_positional()) option->allow_extra_args(false)->take_all();
  text.about = about;
  text.repeats = repeats;
  rows_.push_back({option, std::move(text), std::move(take)});
}

void Options::flag(const OptionText& name, const std::string& about, std::function<void()> act) {
  const auto take = [act = std::move(act), name = name.name](const std::string& value) {
    // CLI11 takes `--quiet=false` for the flag with a text.
    if (value != "true") refuse({}, "{0} takes no value; write `{0}`, or leave it out", name);
    act();
  };
  rows_.push_back({app_.add_flag(name.name), name, take});
  rows_.back().text.about = about;
}

void Options::choice(const std::string& name, const std::string& about, std::function<void()> act) {
  flag({name}, about, std::move(act));
  CLI::Option* const option = rows_.back().option;
  for (CLI::Option* const other : choices_) option->excludes(other);
  choices_.push_back(option);
}

void Options::read_values() const {
  const std::string command = app_.get_name();
  for (const Row& row : rows_) {
    const Texts texts = row.given();
    const std::string& needed = row.text.needed;
    if (!needed.empty() && (texts.empty() || texts.front().empty())) {
      refuse({}, "`assay {0}` needs {1}; see `assay {0} --help`", command, needed);
    }
    for (const std::string& text : texts) row.take(text);
  }
  afterwards_();
  if (replay_line_ == nullptr) return;
  *replay_line_ = "assay " + command;
  for (const Row& row : rows_) {
    if (row.text.replay == Replay::no) continue;
    const bool flag = row.option->get_expected_max() == 0;
    const std::string name = row.text.is_argument() ? "" : row.text.name;
    if (flag && row.option->count() > 0) *replay_line_ += " " + name;
    if (!flag) *replay_line_ += option_words(name, row.given());
  }
}

CommandText Options::text(const std::string& summary) const {
  const std::string about(carried_text("help/" + app_.get_name() + ".txt"));
  return {app_.get_name(), summary, about, mapped(rows_, &Row::text)};
}

std::vector<CommandText> texts_of(const std::vector<CommandRow>& commands) {
  CLI::App app("", "assay");
  return mapped(commands, [&](const CommandRow& row) {
    Options options(*app.add_subcommand(row.name));
    row.define(options);
    return options.text(row.summary);
  });
}

Command parsed(const Texts& arguments, const std::vector<CommandRow>& commands) {
  CLI::App app("", "assay");
  app.require_subcommand(0, 1);
  app.allow_extras();
  bool version_asked = false;
  app.add_flag("--version", version_asked);
  std::map<std::string, Options> options;
  std::map<std::string, std::function<Command()>> made;
  for (const CommandRow& row : commands) {
    CLI::App* sub = app.add_subcommand(row.name)->allow_extras();
    made[row.name] = row.define(options.try_emplace(row.name, *sub).first->second);
  }
  try {
    const Texts words = with_an_option_each(without_help_command(arguments, app));
    // CLI11 takes the words from the back.
    app.parse(Texts(words.rbegin(), words.rend()));
  } catch (const CLI::CallForHelp&) {
    const auto asked = app.get_subcommands();
    if (asked.empty()) return TextCommand{overview(texts_of(commands))};
    return TextCommand{help_of(options.at(asked.front()->get_name()).text(""))};
  } catch (const CLI::ParseError& e) {
    refuse({}, in_words(e));
  }
  if (version_asked) return TextCommand{fmt::format("assay {} ({})\n", version(), commit())};
  const CLI::App& sub = chosen(app);
  refuse_extras(sub);
  options.at(sub.get_name()).read_values();
  return made.at(sub.get_name())();
}

unsigned read_part(const std::string& text, const std::string& what, std::uint64_t least) {
  const std::uint64_t read = at_least(least)(text, what);
  if (read < std::numeric_limits<unsigned>::max()) return static_cast<unsigned>(read);
  refuse({}, what + " is too large");
}

unsigned read_threads(const std::string& text, const std::string& option) {
  constexpr std::uint64_t most = 4096;
  return static_cast<unsigned>(std::min(at_least(1)(text, option), most));
}

std::uint64_t read_seed(const std::string& text, const std::string& option) {
  if (text == "random") {
    std::random_device words;
    return std::uint64_t{words()} << 32U | words();
  }
  try {
    return at_least(0)(text, option);
  } catch (const InputError&) {
    refuse({}, "{} must be a whole number from 0 to {}, or `random`, but it is `{}`", option,
           std::numeric_limits<std::uint64_t>::max(), text);
  }
}

std::pair<unsigned, unsigned> read_shard(const std::string& text, const std::string& option) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) {
    refuse({}, "{} must be I/N, as in 2/5, but it is `{}`", option, text);
  }
  const std::string each = fmt::format("each number of {} I/N", option);
  const unsigned index = read_part(text.substr(0, slash), each, 1);
  const unsigned shards = read_part(text.substr(slash + 1), each, 1);
  if (index <= shards) return {index, shards};
  refuse({}, "{} {}: there is no shard {} of {}", option, text, index, shards);
}

ReportRequest read_report(const std::string& text, const std::string& option) {
  const std::size_t equals = text.find('=');
  if (text == "console") return {text, "-"};  // the kind for reading at once
  if (equals == std::string::npos || equals + 1 == text.size()) {
    refuse({},
           "{0} must be KIND=PATH, but it is `{1}`; write `{0} {2}`, where the path - is standard "
           "output",
           option, text, meant_report(text));
  }
  const std::string kind = text.substr(0, equals);
  const auto kinds = mapped(reports::report_formats(), &reports::ReportFormat::kind);
  choice(Value::scalar(kind), "the kind of " + option, kinds);
  for (const std::string& other : kinds) {
    const std::size_t comma = text.find("," + other + "=");
    if (comma == std::string::npos) continue;
    refuse({}, "put a blank between two reports: write `{} {} {}`", option, text.substr(0, comma),
           text.substr(comma + 1));
  }
  return {kind, text.substr(equals + 1)};
}

}  // namespace assay::harness
