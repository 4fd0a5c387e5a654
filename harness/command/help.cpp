#include "harness/command/help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <cmath>
#include <set>
#include <sstream>
#include <utility>

#include "estimators/catalogue.h"
#include "harness/base/terminal.h"
#include "harness/base/text_file.h"
#include "harness/base/version.h"
#include "harness/command/commands.h"
#include "harness/language/laws.h"
#include "harness/theta/gate.h"
#include "harness/theta/methods.h"
#include "reports/report_formats.h"
#include "reports/words/text.h"

namespace assay::harness {
namespace {

constexpr std::size_t list_column = 14;  // of the summaries of commands

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
    if (!value.empty()) value = fmt::format(" \\fI{}\\fR", roff(value));
    text += fmt::format(".TP\n\\fB{}\\fR{}\n{}", roff(option.name), value, paragraph(option.about));
  }
  return text;
}

using Offers = std::vector<std::pair<std::string, std::string>>;

Offers offers_of(const std::vector<CommandText>& commands, const std::vector<std::string>& words) {
  Offers offers;
  const bool is_help = words.size() == 2 && words.front() == "help";
  if (words.size() == 1 || is_help) {
    if (is_help)
      offers = {{"all", "every command"}, {"claims", "the language of claims"}};
    else
      offers = {{"help", "explain a command"}, {"--help", ""}, {"--version", ""}};
    for (const CommandText& command : commands) offers.emplace_back(command.name, command.summary);
    return offers;
  }
  const auto found = std::ranges::find(commands, words.front(), &CommandText::name);
  if (found == commands.end()) return {};
  const CommandText& command = *found;
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

/// A row of a section; its further lines are indented.
std::string row_text(const std::string& text) { return "  " + wrapped(text, 6).substr(6); }

const char* bias_text(const Information& information) {
  // A mutant's bias is its defect's; the class is its original's.
  if (!information.original.empty()) return "that of its defect";
  if (information.name == "recorded") return "unknown: the observations were made elsewhere";
  if (information.says_nature) return "as the program declares it; unknown if it declares none";
  constexpr const char* classes[] = {"unbiased", "falls like 1 / primaries",
                                     "falls like 1 / bootstrap",
                                     "start-up: the chain has not forgotten where it began",
                                     "reconstruction: that of a filter or an interpolation"};
  return classes[static_cast<int>(information.bias)];
}

const char* primaries_text(const Information& information) {
  if (information.says_nature) return "averaged if the program declares it; else 1 unless given";
  return information.averages ? "averaged: a secondary estimate is the mean of its primaries"
                              : "not averaged; 1 unless given";
}

/// "(0, 1]", "[1, inf)", "a, b or c"; "" if anything is allowed.
std::string range_text(const ParameterInformation& p) {
  if (!p.choices.empty()) return fmt::format("{}", fmt::join(p.choices, " | "));
  const NumberRange& range = p.range;
  if (std::isinf(range.low) && std::isinf(range.high)) return "";
  const double low = p.type == ParameterType::count ? std::max(range.low, 0.0) : range.low;
  return fmt::format("{}{}, {}{}", range.low_excluded || std::isinf(low) ? "(" : "[", low,
                     range.high, range.high_excluded || std::isinf(range.high) ? ")" : "]");
}

std::string field(const char* name, const std::string& text) {
  return text.empty() ? "" : beside(name, text, 12);
}

std::string parameters_text(const Information& information) {
  if (information.parameters.empty()) return "\nparameters: none\n";
  constexpr const char* types[] = {"number", "count",         "true or false",
                                   "text",   "list of texts", "structure"};
  std::string out = "\nparameters\n";
  for (const ParameterInformation& p : information.parameters) {
    std::string head = fmt::format("{}: {}", p.name, types[static_cast<int>(p.type)]);
    for (const std::string& fact : {range_text(p), p.unit}) {
      if (!fact.empty()) head += ", " + fact;
    }
    head += p.fallback.empty() ? ", required" : ", default " + p.fallback;
    out += row_text(head) + wrapped(p.summary, 6);
  }
  return out;
}

std::string exact_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.12g}", *value) : "not known";
}

std::string channel_text(const Channel& channel) {
  std::string text = fmt::format("{}: mean {}", channel.name, exact_text(channel.mean));
  if (channel.mean_error > 0) text += fmt::format(" +- {:.2g}", channel.mean_error);
  text += ", variance of a primary " + exact_text(channel.variance);
  if (std::isfinite(channel.low) || std::isfinite(channel.high)) {
    text += fmt::format(", values in [{:.6g}, {:.6g}]", channel.low, channel.high);
  }
  if (channel.diagnostic) text += ", diagnostic (tested only where a claim names it)";
  return row_text(text);
}

std::string setup_text(const Setup& setup) {
  std::string out;
  const std::optional<ImageShape> image = setup.image();
  if (image) {
    out += "\nimage (with default parameters)\n";
    out += row_text(fmt::format(
        "{} x {} pixels of {}, {}", image->width, image->height, fmt::join(image->components, ", "),
        image->independent ? "independent of each other" : "which depend on each other"));
  }
  out += "\nchannels (with default parameters)\n";
  const std::size_t count = setup.channel_count();
  const std::size_t shown = image ? 4 : 20;
  for (std::size_t i = 0; i < std::min(shown, count); ++i) out += channel_text(setup.channel(i));
  if (count > shown) out += fmt::format("  … {} more\n", count - shown);
  const std::vector<NamedSampler> samplers = setup.samplers();
  if (samplers.empty()) return out;
  out += "\nsamplers\n";
  constexpr const char* names[] = {"interval", "unit square", "triangle (barycentric)",
                                   "hemisphere (solid angle)", "sphere (solid angle)"};
  for (const NamedSampler& named : samplers) {
    const Domain domain = named.sampler->domain();
    const char* const name = names[static_cast<int>(domain)];
    std::string text = fmt::format("{}: {}; marginals", named.name, name);
    for (const Marginal& marginal : marginals(domain)) text += " " + marginal.name;
    out += row_text(text);
  }
  return out;
}

/// Facts that need a prepared set-up, if default parameters suffice for one.
std::string prepared_text(const Entry& plugin) {
  const Information& information = plugin.information;
  try {
    Parameters parameters(information.name, information.parameters, Value{}, ".");
    return setup_text(*plugin.prepare(parameters));
  } catch (const InputError& e) {
    return wrapped("\nchannels: known once its parameters are given (" + e.message() + ")");
  }
}

std::string mutants_text(const Information& information, const std::vector<Entry>& entries) {
  std::string out;
  for (const Entry& entry : entries) {
    if (entry.information.original != information.name) continue;
    out += row_text(entry.information.name + ": " + entry.information.defect);
  }
  return out.empty() ? "" : "\nmutants\n" + out;
}

/// Its page has a sentence for each property that a user may have to know.
TableRow row_of(const Method& row) {
  std::string page;
  const auto say = [&](bool holds, const std::string& sentence) {
    if (holds) page += wrapped(sentence, 2);
  };
  say(true, fmt::format("Force it by `test: {0}` in a suite, or by `--test {0}`.", row.name));
  say(row.is.exact, "Its level holds at every sample size.");
  say(!row.is.exact, "Its level is asymptotic. Gates refuse data on which it would err.");
  say(row.is.in_range || row.is.of_both_ends, "The channel must declare the range of its values.");
  say(row.is.of_observations, "It needs observations: moments of an earlier run do not suffice.");
  say(row.is.of_batches, "It assumes that means of consecutive observations are independent.");
  say(row.is.corrects_skewness, "It estimates the skewness from the data.");
  say(row.is.of_normal_values, "It assumes that the values are nearly normal.");
  say(row.is.of_distinct_values, "It refuses coarsely rounded values.");
  say(row.is.over_looks == stats::LookLaw::anytime_valid, "Its p-value is valid at every look.");
  return {row.name, row.summary, page};
}

TableRow row_of(const QuantityRow& quantity) {
  std::string page = wrapped(fmt::format("Claim: {}", quantity.example), 2);
  if (quantity.of_a_sampler) page += "  It is about a sampler of an estimator.\n";
  if (quantity.over_all_channels) page += "  It covers all channels of an estimator.\n";
  page += "  `assay help claims` explains margins and other keys.\n";
  return {quantity.word, quantity.summary, page};
}

TableRow row_of(const LawInformation& law) {
  std::string page = fmt::format("  Claim: distribution(a) == {}\n", signature(law));
  for (const LawParameter& parameter : law.parameters) {
    if (parameter.positive) page += fmt::format("  `{}` is above 0.\n", parameter.name);
  }
  return {law.name, signature(law), page};
}

TableRow row_of(const GateKind& gate) {
  std::string page = gate.needs_more() ? "  If it is red, the test needs more observations.\n"
                                       : "  If it is red, the test is invalid.\n";
  page += "  A forced method only shows it; dependence makes any method invalid.\n";
  if (gate.heavy_tail) page += "  More observations may only show more of the tail.\n";
  return {gate.name, fmt::format(fmt::runtime(gate.sentence), "VALUE", "LIMIT"), page};
}

TableRow row_of(const reports::ReportFormat& format) {
  return {format.kind, format.summary,
          fmt::format("  Write it by `--report {}=FILE.{}`.\n", format.kind, format.ending)};
}

/// Equal rows stand once, and those of one name together.
template <class Rows>
Table table_of(const char* plural, const char* singular, const Rows& rows) {
  Table table{plural, singular, {}};
  for (const auto& each : rows) {
    TableRow row = row_of(each);
    if (std::ranges::count(table.rows, row) > 0) continue;
    const auto last = std::find_if(table.rows.rbegin(), table.rows.rend(),
                                   [&](const TableRow& other) { return other.name == row.name; });
    table.rows.insert(last == table.rows.rend() ? table.rows.end() : last.base(), std::move(row));
  }
  return table;
}

}  // namespace

std::string overview(const std::vector<CommandText>& commands) {
  std::string first;
  for (const char* name : {"init", "check", "run", "images", "describe"}) {
    first += entry(*std::ranges::find(commands, name, &CommandText::name));
  }
  return boost::replace_first_copy(std::string(carried_text("help/overview.txt")), "@FIRST@",
                                   first);
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
  std::string all;
  for (const CommandText& command : commands) all += entry(command);
  return boost::replace_first_copy(std::string(carried_text("help/all.txt")), "@COMMANDS@", all);
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
  const std::string_view overview = carried_text("help/overview.txt");
  const std::string purpose(overview.substr(0, overview.find('\n')));
  std::string text = fmt::format(
      ".TH ASSAY 1 \"\" \"assay {0}\" \"\"\n.SH NAME\nassay \\- test claims about Monte Carlo "
      "estimators\n.SH SYNOPSIS\n.B assay\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR] "
      "[\\fIARGUMENTS\\fR]\n.SH DESCRIPTION\n{1}.SH COMMANDS\n",
      version(), paragraph(purpose));
  for (const CommandText& command : commands) text += roff_section(command);
  text += ".SH EXIT STATUS\n";
  const std::string all(carried_text("help/all.txt"));
  text += fmt::format(".in -6n\n.nf\n{}.fi\n.in\n", roff(all.substr(all.find("  0 "))));
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

std::size_t page_width() {
  return static_cast<std::size_t>(std::clamp(terminal_width(stdout), 40, 80));
}

std::string wrapped(const std::string& text, std::size_t indent, std::size_t width) {
  std::string out;
  const std::string all = text.substr(0, text.find_last_not_of('\n') + 1);
  for (const std::string& line : reports::wrap(all, static_cast<int>(width - indent))) {
    out += (line.empty() ? "" : std::string(indent, ' ')) + line + "\n";
  }
  return out;
}

std::string beside(const std::string& left, const std::string& right, std::size_t column) {
  const std::string lines = wrapped(right, column);
  if (left.size() >= column) return left + "\n" + lines;
  return left + lines.substr(left.size());
}

std::string manual(const Entry& plugin, const std::vector<Entry>& entries) {
  const Information& information = plugin.information;
  std::string out = information.name + "\n" + wrapped(information.summary, 2);
  if (!information.description.empty()) out += "\n" + wrapped(information.description);
  out += "\n" + field("bias", bias_text(information));
  out += field("primaries", primaries_text(information));
  out += field("mutant of", information.original) + field("defect", information.defect);
  return out + parameters_text(information) + prepared_text(plugin) +
         mutants_text(information, entries);
}

const std::vector<Table>& tables() {
  static const std::vector<Table> all{table_of("methods", "a method", method_table()),
                                      table_of("quantities", "a quantity", quantities()),
                                      table_of("laws", "a law", laws()),
                                      table_of("gates", "a gate", gate_kinds()),
                                      table_of("reports", "a report", reports::report_formats())};
  return all;
}

std::string text_of(const Table& table) {
  std::size_t longest = 0;
  for (const TableRow& row : table.rows) longest = std::max(longest, row.name.size());
  std::string text;
  std::string last;
  for (const TableRow& row : table.rows) {
    text += beside(row.name == last ? "" : row.name, row.summary, longest + 2);
    last = row.name;
  }
  return text;
}

int describe(const std::string& name) {
  Table family;
  std::string pages;
  std::vector<std::string> names;
  for (const Entry& plugin : catalogue()) {
    const Information& its = plugin.information;
    names.insert(names.end(), {its.name.substr(0, its.name.find('/')), its.name});
    if (its.name == name) pages = manual(plugin, catalogue());
    if (its.name.starts_with(name + "/")) family.rows.push_back({its.name, its.summary, ""});
  }
  pages += text_of(family);
  for (const Table& table : tables()) {
    names.push_back(table.plural);
    if (name == table.plural) pages += text_of(table);
    std::set<std::string> said;  // Rows of one name have most sentences in common.
    for (const TableRow& row : table.rows) {
      names.push_back(row.name);
      if (row.name != name) continue;
      if (said.empty()) {
        pages += fmt::format("{}{}, {}\n", pages.empty() ? "" : "\n", row.name, table.singular);
      }
      std::istringstream lines(wrapped(row.summary, 2) + row.page);
      for (std::string line; std::getline(lines, line);) {
        if (said.insert(line).second) pages += line + "\n";
      }
    }
  }
  if (pages.empty()) {
    refuse({}, "there is no plugin, family, method, quantity, law, gate or report `{}`{}", name,
           did_you_mean(name, names, "`assay list --help` shows how to list them"));
  }
  fmt::print("{}", pages);
  return 0;
}

}  // namespace assay::harness
