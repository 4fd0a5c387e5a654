#include "reports/record/statements.h"

#include <algorithm>

namespace assay::reports {
namespace {

std::optional<std::size_t> place_of(const Suite& suite, const std::string& name) {
  for (std::size_t t = 0; t < suite.tests.size(); ++t) {
    if (suite.tests[t].name == name) return t;
  }
  return std::nullopt;
}

/// A test's effect on the answer. A test that decided nothing is silent, whatever was expected. So
/// is a test that is not ok although its verdict is the expected one.
enum class Voice { contradicts, silent, speaks };

Voice voice_of(const Suite& suite, const std::optional<std::size_t>& place) {
  if (!place) return Voice::silent;
  const Test& test = suite.tests[*place];
  if (test.verdict != Verdict::pass && test.verdict != Verdict::fail) return Voice::silent;
  if (test.verdict != test.expected) return Voice::contradicts;
  return test.ok ? Voice::speaks : Voice::silent;
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
      const Voice voice = voice_of(suite, place_of(suite, name));
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

std::vector<Witness> witnesses(const Suite& suite, const std::vector<std::string>& names) {
  std::vector<Witness> all;
  for (const std::string& name : names) all.push_back({name, place_of(suite, name)});
  std::stable_sort(all.begin(), all.end(), [&](const Witness& a, const Witness& b) {
    return voice_of(suite, a.test) < voice_of(suite, b.test);
  });
  return all;
}

std::size_t statement_count(const Record& record) {
  std::size_t sum = 0;
  for (const Suite& suite : record.suites) sum += suite.statements.size();
  return sum;
}

}  // namespace assay::reports
