#include "harness/suite/suite_statements.h"

#include <fmt/format.h>

#include <algorithm>

#include "estimators/core/text_pattern.h"
#include "harness/suite/suite_keys.h"

namespace assay::harness {

namespace {

using Tests = std::vector<TestEntry>;

bool is_in(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

/// An exact name goes before a glob: a claim's factor contains an asterisk.
std::vector<const TestEntry*> tests_named(const std::string& name, const Tests& tests) {
  std::vector<const TestEntry*> found;
  for (const TestEntry& test : tests) {
    if (test.name == name) return {&test};
    if (matches(name, test.name)) found.push_back(&test);
  }
  return found;
}

void require_tests(const std::vector<const TestEntry*>& found, const Value& name,
                   const Tests& tests) {
  if (!found.empty()) return;
  std::vector<std::string> names;
  for (const TestEntry& test : tests) names.push_back(test.name);
  throw InputError(name.where(),
                   fmt::format("the suite has no test `{}`{}", name.text(),
                               did_you_mean(name.text(), names,
                                            "tests are named by `name`, or else by their claim")));
}

void require_an_answer(const TestEntry& test, const Location& where) {
  if (test.expect == Expectation::pass || test.expect == Expectation::fail) return;
  throw InputError(
      where, fmt::format("`{}` expects that it cannot be decided: it answers nothing", test.name));
}

std::vector<std::string> read_names(const Keys& keys, const char* key, const Tests& tests) {
  const Value* list = keys.find(key);
  if (list == nullptr) return {};
  if (list->kind() != Value::Kind::list || list->items().empty()) {
    throw InputError(list->where(), fmt::format("`{}` must be a list of at least one test, by its "
                                                "name or a glob",
                                                key));
  }
  std::vector<std::string> names;
  for (const Value& item : list->items()) {
    one_line(item, "the name of a test");
    const std::vector<const TestEntry*> found = tests_named(item.text(), tests);
    require_tests(found, item, tests);
    for (const TestEntry* test : found) {
      require_an_answer(*test, item.where());
      if (!is_in(names, test->name)) names.push_back(test->name);
    }
  }
  return names;
}

void check(const StatementEntry& statement) {
  const bool both = !statement.holds.empty() && !statement.fails.empty();
  if (statement.holds.empty() && statement.fails.empty()) {
    throw InputError(statement.where,
                     "a statement needs tests that answer it: `holds`, `fails`, or both");
  }
  for (const std::string& name : statement.fails) {
    if (!is_in(statement.holds, name)) continue;
    throw InputError(statement.where,
                     fmt::format("`{}` cannot stand under `holds` and under `fails`", name));
  }
  if (both && statement.condition.empty()) {
    throw InputError(statement.where,
                     "a statement with `holds` and `fails` needs a `condition` that tells the one "
                     "from the other");
  }
  if (!both && !statement.condition.empty()) {
    throw InputError(statement.where,
                     "a `condition` needs tests on both of its sides: `holds` and `fails`");
  }
}

StatementEntry read_statement(const Document& document, const Value& value, const Tests& tests) {
  if (value.kind() != Value::Kind::map) {
    throw InputError(value.where(),
                     "a statement is a map of keys and values, as in `{text: they agree, source: a "
                     "talk, holds: [a test]}`");
  }
  const Keys keys(document, value, "a statement",
                  {"text", "source", "holds", "fails", "condition"});
  StatementEntry statement{
      .text = one_line(keys.require("text", "text: the variance is reduced"), "`text`"),
      .source = one_line(keys.require("source", "source: a talk"), "`source`"),
      .where = value.where()};
  if (const Value* v = keys.find("condition")) statement.condition = one_line(*v, "`condition`");
  statement.holds = read_names(keys, "holds", tests);
  statement.fails = read_names(keys, "fails", tests);
  check(statement);
  return statement;
}

}  // namespace

std::vector<StatementEntry> read_statements(const Document& document, const Value& list,
                                            const Tests& tests) {
  if (list.kind() != Value::Kind::list || list.items().empty()) {
    throw InputError(list.where(),
                     "`statements` must be a list of at least one, as in `- {text: they agree, "
                     "source: a talk, holds: [a test]}`");
  }
  std::vector<StatementEntry> statements;
  for (const Value& item : list.items()) {
    statements.push_back(read_statement(document, item, tests));
  }
  return statements;
}

}  // namespace assay::harness
