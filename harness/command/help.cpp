#include "harness/command/help.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/algorithm/string/replace.hpp>
#include <utility>

#include "harness/base/text_file.h"
#include "harness/base/version.h"
#include "harness/command/describe.h"

namespace assay::harness {
namespace {

constexpr const char* purpose =
    "Assay tests whether Monte Carlo estimators do what their authors claim.";

constexpr std::array<const char*, 5> of_the_first_hour{"init", "check", "run", "images",
                                                       "describe"};

constexpr std::size_t list_column = 14;  // of the summaries of commands

constexpr std::array<std::pair<const char*, const char*>, 7> exit_codes{{
    {"0", "every test came out as expected"},
    {"1",
     "at least one did not: it failed, was invalid or could not be tested; or the ledger alarms"},
    {"2", "the input is wrong, or Assay could not finish"},
    {"3", "no test went wrong, but at least one is inconclusive"},
    {"4",
     "no test ran: --filter, --tag or --shard selected none (0 if the environment asked for the "
     "shard)"},
    {"77", "all tests were skipped"},
    {"130", "interrupted"},
}};

std::string entry(const CommandText& command) {
  return beside("  " + command.name, command.summary, list_column);
}

std::string usage(const CommandText& command) {
  std::string text = fmt::format("assay {} [OPTIONS]", command.name);
  for (const OptionText& option : command.options) {
    if (!option.is_argument()) continue;
    std::string word = option.value;
    if (word.empty()) word = option.name + (option.repeats ? "..." : "");
    text += option.needed.empty() ? " [" + word + "]" : " " + word;
  }
  return text;
}

// The manual page.

std::string roff(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = i == 0 || text[i - 1] == '\n';
    if (begins && (text[i] == '.' || text[i] == '\'')) out += "\\&";
    if (begins && text[i] == '\n') out += ".PP";
    if (text[i] == '-') out += '\\';
    out += text[i] == '\\' ? "\\e" : std::string(1, text[i]);
  }
  return out;
}

/// Short lines, as mandoc asks for.
std::string paragraph(const std::string& text) { return roff(wrapped(text, 0, 70)); }

std::string roff_entry(const std::string& bold, const std::string& italic,
                       const std::string& text) {
  const std::string value = italic.empty() ? "" : fmt::format(" \\fI{}\\fR", roff(italic));
  return fmt::format(".TP\n\\fB{}\\fR{}\n{}", roff(bold), value, paragraph(text));
}

std::string roff_section(const CommandText& command) {
  const std::size_t examples = std::min(command.about.find("\nExamples:\n"), command.about.size());
  std::string text =
      fmt::format(".SS {}\n{}", roff(usage(command)), paragraph(command.about.substr(0, examples)));
  if (examples < command.about.size()) {
    text +=
        fmt::format(".PP\n.in -6n\n.nf\n{}.fi\n.in\n", roff(command.about.substr(examples + 1)));
  }
  for (const OptionText& option : command.options) {
    std::string value = option.is_argument() ? "" : option.value;
    if (option.repeats) value += value.empty() ? "..." : " ...";
    text += roff_entry(option.name, value, option.about);
  }
  return text;
}

// Completion.

using Offers = std::vector<std::pair<std::string, std::string>>;

Offers offers_of(const CommandText& command, const std::vector<std::string>& words) {
  Offers offers;
  const auto offer_words = [&](const OptionText& option) {
    for (const std::string& word : option.words) offers.emplace_back(word, "");
  };
  std::size_t place = 0;  // of the last word among the arguments
  std::string before;     // these, a blank behind each
  const OptionText* open = nullptr;
  for (std::size_t i = 1; i + 1 < words.size(); ++i) {
    if (std::exchange(open, nullptr) != nullptr) continue;
    for (const OptionText& option : command.options) {
      if (option.takes_value() && option.name == words[i]) open = &option;
    }
    if (!words[i].starts_with('-')) ++place, before += words[i] + " ";
  }
  if (open != nullptr) {
    offer_words(*open);
  } else if (words.back().starts_with('-')) {
    for (const OptionText& option : command.options) {
      if (!option.is_argument())
        offers.emplace_back(option.name, option.about.substr(0, option.about.find(';')));
    }
    offers.emplace_back("--help", "explain this command");
  } else {
    for (const OptionText& option : command.options) {
      if (!option.is_argument()) continue;
      if (place == 0 || option.repeats) offer_words(option);
      if (place-- == 0 || option.repeats) break;
    }
    // A name of several words is offered word by word.
    const auto is_other = [&](auto& offer) { return !offer.first.starts_with(before); };
    if (std::ranges::all_of(offers, is_other)) before.clear();
    std::erase_if(offers, is_other);
    for (auto& [name, about] : offers)
      name = name.substr(before.size(), name.find(' ', before.size()) - before.size());
    offers.erase(std::ranges::unique(offers).begin(), offers.end());
  }
  return offers;
}

Offers offers_of(const std::vector<CommandText>& commands, std::vector<std::string>& words) {
  Offers offers;
  const bool is_help = words.size() == 2 && words.front() == "help";
  if (words.size() == 1 || is_help) {
    for (const CommandText& command : commands) offers.emplace_back(command.name, command.summary);
    if (is_help) {
      offers.insert(offers.end(), {{"all", "every command"}, {"claims", "the language of claims"}});
      return offers;
    }
    offers.insert(offers.end(), {{"help", "explain a command"}, {"--help", ""}, {"--version", ""}});
    return offers;
  }
  const auto command = std::ranges::find(commands, words.front(), &CommandText::name);
  return command == commands.end() ? Offers{} : offers_of(*command, words);
}

}  // namespace

std::string overview(const std::vector<CommandText>& commands) {
  std::string text = fmt::format("{}\n\n", purpose);
  text += R"(Examples:
  assay init suite       a file of claims that runs at once
  assay check 'mean(luminaire/area) == analytic' --detect 0.5%
  assay images --candidate 'new/*.exr' --reference 'old/*.exr'

First commands:
)";
  for (const char* name : of_the_first_hour) {
    text += entry(*std::ranges::find(commands, name, &CommandText::name));
  }
  text += R"(
`assay COMMAND --help` explains a command, `assay help claims` the language of
claims and suites. `assay help all` lists all commands and exit codes.
`assay man` prints a manual page of all commands.
`assay completion bash|zsh|fish` prints a script that completes commands.

Options:
  -h, --help   this text
  --version    version and commit
)";
  return text;
}

std::string help_of_claims(std::string_view markdown) {
  constexpr std::size_t column = 24;  // of what stands beside the first cell of a row
  std::string text;
  std::string paragraph;
  const auto end_paragraph = [&] {
    const bool is_item = paragraph.starts_with("- ");
    if (!paragraph.empty())
      text += is_item ? beside("-", paragraph.substr(2), 2) : wrapped(paragraph);
    paragraph.clear();
  };
  bool in_code = false;
  for (const std::string_view line : lines_of(markdown)) {
    const bool is_fence = line.starts_with("```");
    const bool is_row = line.starts_with("| ") && !in_code;
    const bool stands_alone = in_code || is_fence || line.empty() || line.starts_with('#');
    if (stands_alone || line.starts_with('|') || line.starts_with("- ")) end_paragraph();
    if (is_fence) in_code = !in_code;
    const std::size_t sign = line.find(" = ");
    if (in_code && line.size() > page_width() && sign != line.npos) {
      text += beside(std::string(line.substr(0, sign + 2)), std::string(line.substr(sign + 3)),
                     sign + 3);
    } else if (stands_alone) {
      text += std::string(line) + "\n";
    } else if (is_row) {
      const std::size_t cell = std::min(line.find(" | "), line.size());
      std::string rest(line.substr(std::min(cell + 3, line.size())));
      rest.erase(std::min(rest.rfind(" |"), rest.size()));
      boost::replace_all(rest, " | ", "; ");
      text += beside(std::string(line.substr(0, cell)).replace(0, 1, " "), rest, column);
    } else if (!line.starts_with('|')) {
      const std::size_t begin = line.find_first_not_of(' ');
      paragraph += (paragraph.empty() ? "" : " ") + std::string(line.substr(begin));
    }
  }
  end_paragraph();
  return text;
}

std::string help_of_all(const std::vector<CommandText>& commands) {
  std::string text = "Commands (each has its own --help, with examples and defaults):\n";
  for (const CommandText& command : commands) text += entry(command);
  text +=
      beside("  help", "print the first page, or help on a command: `assay help run`", list_column);
  text += "\nExit codes:\n";
  for (const auto& [code, meaning] : exit_codes) {
    text += beside(fmt::format("  {}", code), meaning, 7);
  }
  return text;
}

std::string help_of(const CommandText& command) {
  constexpr std::size_t column = 26;
  std::string arguments;
  std::string options;
  for (const OptionText& option : command.options) {
    const std::string value = option.takes_value() ? " " + option.value : "";
    const std::string called = "  " + option.name + value + (option.repeats ? " ..." : "");
    (option.is_argument() ? arguments : options) += beside(called, option.about, column);
  }
  options += beside("  -h, --help", "this text", column);
  if (!arguments.empty()) arguments = "Arguments:\n" + arguments + "\n";
  return fmt::format("{}\nUsage: {}\n\n{}Options:\n{}", command.about, usage(command), arguments,
                     options);
}

std::string man_page(const std::vector<CommandText>& commands) {
  std::string text = fmt::format(
      ".TH ASSAY 1 \"\" \"assay {0}\" \"\"\n.SH NAME\nassay \\- test claims about Monte Carlo "
      "estimators\n.SH SYNOPSIS\n.B assay\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR] "
      "[\\fIARGUMENTS\\fR]\n.SH DESCRIPTION\n{1}.SH COMMANDS\n",
      version(), paragraph(purpose));
  for (const CommandText& command : commands) text += roff_section(command);
  text += ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : exit_codes) text += roff_entry(code, "", meaning);
  return text;
}

std::string completions(const std::vector<CommandText>& commands,
                        const std::vector<std::string>& typed) {
  std::vector<std::string> words = typed;
  if (words.empty()) words.emplace_back();
  // `--option=value` is two words, of which the first stays before each offer.
  std::string kept;
  const std::size_t equals = words.back().find('=');
  if (words.back().starts_with("--") && equals != std::string::npos) {
    kept = words.back().substr(0, equals + 1);
    words.push_back(words.back().substr(equals + 1));
    words[words.size() - 2] = kept.substr(0, equals);
  }
  // A file follows `json=`.
  if (words.size() > 1 && words.back().find('=') != std::string::npos) return "*\t\n";
  std::string text;
  for (const auto& [word, about] : offers_of(commands, words)) {
    if (word.find('*') != std::string::npos) {
      text += word + "\t\n";
    } else if (word.starts_with(words.back())) {
      text += fmt::format("{}{}\t{}\n", kept, word, about);
    }
  }
  return text;
}

}  // namespace assay::harness
