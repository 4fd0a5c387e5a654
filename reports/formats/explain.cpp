#include <fmt/format.h>

#include <algorithm>
#include <ranges>

#include "reports/report_formats.h"
#include "reports/words/describe.h"
#include "reports/words/display.h"
#include "reports/words/ledger.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

/// A text as a sentence of its own. A word of a claim, as `mean(a)`, keeps its letters.
std::string sentence(std::string text) {
  const std::size_t word = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz");
  if (word != std::string::npos && word > 1 && text[word] == ' ')
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text.empty() || text.ends_with('.') ? text : text + ".";
}

/// How sure the finding is.
std::string how_sure(const Test& test, const TestDisplay& words, const std::string& found) {
  std::string text;
  const Effect effect = effect_in_sentence(test);
  const bool shown = found.find(words.sentence) != std::string::npos;
  if (shown && effect.estimate && !range_text(effect).empty() && effect.confidence > 0)
    text = fmt::format("The range holds the true value with a confidence of {}. ",
                       confidence_text(effect.confidence));
  if (test.verdict == Verdict::fail && !words.chance.empty())
    text += fmt::format("The chance of such data, if nothing is wrong, is {}. ", words.chance);
  if (test.verdict == Verdict::pass && test.detectable && !test.detect && !is_proof(test))
    text += fmt::format("An error of {}{} would have been noticed. ",
                        margin_text(*test.detectable, deciding_channel(test).effect),
                        test.image ? " all over the image" : "");
  return text;
}

/// The fact of this label as a sentence that begins with these words; "" without one.
std::string fact_of(const TestDisplay& words, const std::string& label, const std::string& lead) {
  const auto found = std::ranges::find(words.facts, label, &Fact::label);
  return found == words.facts.end() ? "" : sentence(lead + found->text);
}

}  // namespace

std::string explain(const Suite& suite, const Test& test, int width, const Ledger& ledger) {
  const TestDisplay words = display(test);
  std::string out;
  const auto say = [&](const std::string& text) {
    for (const std::string& part : wrap(clean(text), width))
      if (!part.empty()) out += part + "\n";
  };
  say(fmt::format("{} {}{}", mark(standing(test)), one_line(test.id),
                  words.place.empty() ? "" : " (" + words.place + ")"));
  out += "\n";
  std::string text = fmt::format("The claim is `{}`. ", one_line(test.claim));
  const bool passed = test.verdict == Verdict::pass && test.expected == Verdict::pass;
  const std::string found = passed ? words.sentence : trouble(test);
  auto alarms = ledger.series | std::views::filter([&](const LedgerSeries& each) {
                  return each.alarm && each.test == test.id;
                });
  const std::string meaning =
      passed && !alarms.empty() ? "This run alone shows nothing against the claim." : words.meaning;
  for (const std::string& part : {meaning, sentence(found)})
    if (!part.empty()) text += part + " ";
  text += how_sure(test, words, found);
  std::vector<Step> next = steps(test);
  if (!next.empty() && next[0].label == "note") {
    text += sentence("Note: " + next[0].words) + " ";
    next.erase(next.begin());
  }
  const std::string broken = fact_of(words, "assumptions", "Assumptions ");
  if (test.verdict == Verdict::invalid && !broken.empty()) text += broken + " ";
  text += fact_of(words, "observations", "These observations were drawn: ");
  say(text);
  if (is_evidence(test) && test.verdict != Verdict::skipped && suite.alpha > 0)
    say(false_alarms(suite.alpha) + " In such a run a true claim of the suite fails.");
  for (const LedgerSeries& series : alarms) {
    out += "\n";
    say(fmt::format("The ledger {} raises an alarm for {}. {} The series has {}.", ledger.file,
                    one_line(series_name(ledger, series)), alarm_sentence(series),
                    series_sentence(series)));
    if (const std::string log = changes(series); !log.empty())
      next.push_back({.label = "what changed before that night", .paste = log});
  }
  if (!alarms.empty()) {
    constexpr Form escapes[] = {{'"', "\\\""}, {'\\', "\\\\"}};
    const std::string line = in_single_quotes("begin \"" + escape(test.id, escapes) + "\"");
    next.push_back({.label = "if the change is meant, begin anew with the next night",
                    .paste = "echo " + line + " >> " + in_single_quotes(ledger.file)});
  }
  if (next.empty()) return out;
  const bool nothing = !is_trouble(standing(test)) && standing(test) != Standing::not_run &&
                       next.size() == 1 && next[0].label == "again";
  out += "\nWhat to do next\n";
  for (const Step& step : next) {
    out += "  " + (nothing ? "Nothing. To run it again" : step.label) + ":\n";
    const std::vector<std::string> lines = step.paste.empty()
                                               ? wrap(one_line(step.words), width - 4)
                                               : wrap_command(one_line(step.paste), width - 6);
    for (std::string indent = "    "; const std::string& part : lines) {
      out += indent + part + "\n";
      if (!step.paste.empty()) indent = "      ";
    }
  }
  return out;
}

}  // namespace assay::reports
