#include "reports/words/statements.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "reports/words/describe.h"
#include "reports/words/number.h"

namespace assay::reports {
namespace {

/// The test of this name; null if it is not in the record.
const Test* test_of(const Suite& suite, const std::string& name) {
  const auto found = std::ranges::find(suite.tests, name, &Test::name);
  return found == suite.tests.end() ? nullptr : &*found;
}

/// A test's effect on the answer. A test that decided nothing is silent, whatever was expected. So
/// is a test that is not ok although its verdict is the expected one.
enum class Voice { contradicts, silent, speaks };

Voice voice_of(const Test* test) {
  if (test == nullptr) return Voice::silent;
  if (test->verdict != Verdict::pass && test->verdict != Verdict::fail) return Voice::silent;
  if (test->verdict != test->expected) return Voice::contradicts;
  return test->ok ? Voice::speaks : Voice::silent;
}

constexpr std::size_t findings_shown = 2;

std::string evidence_of(const Test& test) {
  if (!is_evidence(test)) return {};
  const Effect effect = deciding_channel(test).effect;
  const std::string interval = named_effect_text(effect);
  const std::string text =
      interval.empty() ? headline_p(test).text() : effect_name(effect) + " " + interval;
  // A pass that rests on a margin must not read as one without.
  const double allowed = test.allow.value_or(0);
  return allowed == 0 ? text : text + ", " + margin_text(allowed, effect) + " allowed";
}

std::string finding(const Test* test) {
  if (test == nullptr) return "not run";
  const std::string evidence = evidence_of(*test);
  if (test->ok && !evidence.empty()) return evidence;
  const std::string verdict = mark(standing(*test)) + " " + verdict_text(*test);
  return evidence.empty() ? verdict : verdict + "; " + evidence;
}

}  // namespace

const char* to_string(Answer answer) {
  constexpr const char* names[] = {"yes", "only if", "no", "open", "contradicted"};
  return names[static_cast<int>(answer)];
}

Answer answer(const Suite& suite, const Statement& statement) {
  bool silent = statement.holds.empty() && statement.fails.empty();
  for (const std::vector<std::string>* names : {&statement.holds, &statement.fails}) {
    for (const std::string& name : *names) {
      const Voice voice = voice_of(test_of(suite, name));
      if (voice == Voice::contradicts) return Answer::contradicted;
      silent = silent || voice == Voice::silent;
    }
  }
  if (silent) return Answer::open;
  if (statement.fails.empty()) return Answer::yes;
  return statement.holds.empty() ? Answer::no : Answer::only_if;
}

std::vector<std::string> answers(const Suite& suite) {
  std::vector<std::string> all;
  for (const Statement& statement : suite.statements)
    all.emplace_back(to_string(answer(suite, statement)));
  return all;
}

std::size_t statement_count(const Record& record) {
  std::size_t sum = 0;
  for (const Suite& suite : record.suites) sum += suite.statements.size();
  return sum;
}

std::string answer_text(Answer answer) {
  if (answer == Answer::open) return mark(Standing::undecided) + " open";
  if (answer == Answer::contradicted) return mark(Standing::broken) + " contradicted";
  return to_string(answer);
}

std::string whole_answer(const Suite& suite, const Statement& statement) {
  const Answer given = answer(suite, statement);
  return answer_text(given) + (given == Answer::only_if ? " " + statement.condition : "");
}

std::string statement_totals(const Record& record) {
  std::map<Answer, std::size_t> counts;
  for (const Suite& suite : record.suites) {
    for (const Statement& statement : suite.statements) ++counts[answer(suite, statement)];
  }
  std::vector<std::string> parts;
  for (const auto& [given, count] : counts)
    parts.push_back(fmt::format("{}\u00A0{}", count, to_string(given)));
  return fmt::format("{}: {}.", counted(statement_count(record), "statement", "statements"),
                     fmt::join(parts, ", "));
}

std::string findings(const Suite& suite, const std::vector<std::string>& names) {
  std::vector<std::pair<const Test*, std::string>> all;
  for (const std::string& name : names) all.emplace_back(test_of(suite, name), name);
  std::ranges::stable_sort(all, {}, [](const auto& each) { return voice_of(each.first); });
  std::vector<std::string> parts;
  for (const auto& [test, name] : all) parts.push_back(fmt::format("{}: {}", name, finding(test)));
  if (parts.size() > findings_shown) {
    parts[findings_shown] = fmt::format("and {} more", parts.size() - findings_shown);
    parts.resize(findings_shown + 1);
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace assay::reports
