// Each line of tests/tables/words.txt.

#include "reports/formats/base64.h"
#include "reports/words/describe.h"
#include "reports/words/ledger.h"
#include "reports/words/number.h"
#include "reports/words/text.h"
#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

using Arguments = std::vector<std::string>;

Number number(const std::string& text) {
  return text == "-" ? Number() : std::strtod(text.c_str(), nullptr);
}

Effect effect_of(const Arguments& a, std::size_t first = 0) {
  Effect effect{
      a.at(first), number(a.at(first + 1)),  number(a.at(first + 2)), number(a.at(first + 3)),
      0.9998,      a.at(first) == "relative"};
  if (effect.quantity != "ratio") return effect;
  effect.quantity = "ln(ratio)";
  for (Number* ends : {&effect.estimate, &effect.low, &effect.high}) *ends = std::log(**ends);
  return effect;
}

Verdict verdict_of(const std::string& name) {
  return static_cast<Verdict>(std::ranges::find(verdict_names, name) - verdict_names);
}

bool is_claim_a_proof(const std::string& claim) {
  reports::Test test;
  test.claim = claim;
  return is_proof(test);
}

std::string in_brackets(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += "[" + line + "]";
  return text;
}

std::string encoded(std::string_view bytes) {
  return base64({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

std::string yes_if(bool holds) { return holds ? "yes" : "no"; }

const std::map<std::string, std::string (*)(const Arguments&)> functions{
    {"human",
     [](auto& a) {
       return a.size() == 1 ? human(number(a[0])) : human(*number(a[0]), std::stoi(a[1]));
     }},
    {"signed", [](auto& a) { return with_sign(*number(a[0]), false); }},
    {"signed per cent", [](auto& a) { return with_sign(*number(a[0]), true); }},
    {"p", [](auto& a) { return p_text(number(a[0]), number(a.at(1))); }},
    {"power of ten", [](auto& a) { return scientific(*number(a[0])); }},
    {"e-value", [](auto& a) { return e_text(number(a[0])); }},
    {"count", [](auto& a) { return count_text(std::stoull(a[0])); }},
    {"in commas", [](auto& a) { return in_commas(*number(a[0])); }},
    {"primaries", [](auto& a) { return counted(std::stoull(a[0]), "primary", "primaries"); }},
    {"duration", [](auto& a) { return duration(*number(a[0])); }},
    {"confidence", [](auto& a) { return confidence_text(*number(a[0])); }},
    {"effect", [](auto& a) { return effect_text(effect_of(a)); }},
    {"named effect", [](auto& a) { return named_effect_text(effect_of(a)); }},
    {"effect name", [](auto& a) { return effect_name({.quantity = a[0]}); }},
    {"interval", [](auto& a) { return range_text(effect_of(a)); }},
    {"lies above 0", [](auto& a) { return yes_if(lies_above(effect_of(a), 0)); }},
    {"lies below 0", [](auto& a) { return yes_if(lies_below(effect_of(a), 0)); }},
    {"size of low end", [](auto& a) { return size_text(*effect_of(a).low, effect_of(a)); }},
    {"size of high end", [](auto& a) { return size_text(*effect_of(a).high, effect_of(a)); }},
    {"margin", [](auto& a) { return margin_text(*number(a[0]), effect_of(a, 1)); }},
    {"relation", [](auto& a) { return sides_of(a[0]).relation; }},
    {"is proof", [](auto& a) { return yes_if(is_claim_a_proof(a[0])); }},
    {"contrary", [](auto& a) { return contrary(a[0]); }},
    {"verdict",
     [](auto& a) { return verdict_text(judged(verdict_of(a[0]), verdict_of(a.at(1)))); }},
    {"tally",
     [](auto& a) {
       return tally_sentence({{Standing::holds, std::stoi(a[0])},
                              {Standing::broken, std::stoi(a[1])},
                              {Standing::no_verdict, std::stoi(a[2])},
                              {Standing::undecided, std::stoi(a[3])},
                              {Standing::not_run, std::stoi(a[4])}});
     }},
    {"false alarms", [](auto& a) { return false_alarms(*number(a[0])); }},
    {"clean", [](auto& a) { return clean(a[0]); }},
    {"xml", [](auto& a) { return escape_xml(a[0]); }},
    {"attribute", [](auto& a) { return escape_attribute(a[0]); }},
    {"markdown", [](auto& a) { return escape_markdown(a[0]); }},
    {"columns", [](auto& a) { return std::to_string(columns(a[0])); }},
    {"shorten", [](auto& a) { return shorten(a.at(1), std::stoi(a[0])); }},
    {"wrap", [](auto& a) { return in_brackets(wrap(a.at(1), std::stoi(a[0]))); }},
    {"wrap command", [](auto& a) { return in_brackets(wrap_command(a.at(1), std::stoi(a[0]))); }},
    {"base64", [](auto& a) { return encoded(a[0]); }},
    {"is base64", [](auto& a) { return yes_if(from_base64(a[0]).has_value()); }}};

/// The text that a cell of the table stands for.
std::string text_of(const std::string& cell) {
  if (cell == "\"\"") return "";
  std::string text;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    if (cell[i] == '~') {
      text += "\u00A0";
    } else if (cell[i] != '\\') {
      text += cell[i];
    } else if (cell.at(++i) == 'x') {
      text += static_cast<char>(std::stoi(cell.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      text += cell[i] == 'n' ? '\n' : cell[i] == 't' ? '\t' : cell[i] == 'r' ? '\r' : cell[i];
    }
  }
  return text;
}

TEST(Words, AreThoseOfTheTable) {
  std::ifstream file(ASSAY_SOURCE_DIR "/tests/tables/words.txt");
  std::set<std::string> met;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    SCOPED_TRACE(line);
    const std::size_t colon = line.find(": ");
    const std::size_t arrow = line.find(" => ");
    ASSERT_LT(colon, arrow);
    Arguments arguments;
    for (std::string rest = line.substr(colon + 2, arrow - colon - 2) + " | "; !rest.empty();) {
      arguments.push_back(text_of(rest.substr(0, rest.find(" | "))));
      rest.erase(0, rest.find(" | ") + 3);
    }
    const std::string name = line.substr(0, colon);
    EXPECT_EQ(functions.at(name)(arguments), text_of(line.substr(arrow + 4)));
    met.insert(name);
  }
  EXPECT_EQ(met.size(), functions.size());
}

}  // namespace
}  // namespace assay::reports
