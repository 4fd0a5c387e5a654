#include "harness/suite/suite_entries.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "estimators/catalogue.h"
#include "estimators/core/text_pattern.h"
#include "harness/language/quantities.h"
#include "harness/suite/suite_keys.h"

namespace assay::harness {
namespace {

/// True if the file has the text unbroken at the value's place.
bool stands_in_one_piece(const Document& document, const Value& value, const std::string& text) {
  const std::string_view line = document.line(value.where().line);
  const auto at = static_cast<std::size_t>(std::max(value.where().column, 1)) - 1;
  return at < line.size() && line.substr(at).starts_with(text);
}

std::string without_line_ends(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

/// Columns of errors count in the file if the claim stands there unbroken, else in the claim.
Claim read_claim(const Document& document, const Value& value) {
  const std::string text = without_line_ends(value.string("`claim`"));
  try {
    return parse_claim(text, value.where());
  } catch (const InputError& e) {
    if (stands_in_one_piece(document, value, text)) throw;
    const int column = e.where().column - value.where().column + 1;
    throw InputError(value.where(),
                     fmt::format("{} (character {} of `{}`)", e.message(), column, text));
  }
}

Margin read_margin(const Value& value, std::string_view what) {
  return parse_margin(value.string(what), value.where(), what);
}

double read_seconds(std::string_view text, const Value& value) {
  return positive_number(Value::scalar(std::string(text), value.where()),
                         "the seconds of `budget`");
}

void require_increasing(const Sweep& sweep) {
  double last = 0;
  for (const Value& value : sweep.values) {
    const double number = positive_number(value, "a value of `over`");
    if (number <= last) throw InputError(value.where(), "the values of `over` must ascend");
    last = number;
  }
}

std::vector<std::string> read_tags(const Value& value) {
  if (value.kind() != Value::Kind::list) {
    throw InputError(value.where(), "`tags` must be a list: `tags: [slow, images]`");
  }
  std::vector<std::string> tags;
  for (const Value& tag : value.items()) tags.push_back(one_line(tag, "a tag"));
  return tags;
}

Budget read_short_budget(const Value& value) {
  const std::string_view text = value.text();
  try {
    if (text.ends_with('s')) return {{}, read_seconds(text.substr(0, text.size() - 1), value)};
    return {count_from(value, "`budget`", 1), {}};
  } catch (const InputError&) {
    throw InputError(
        value.where(),
        fmt::format(
            "`budget` must be a number of primaries (1e7), of seconds (ten minutes are 600s), "
            "or a map of both, but it is `{}`",
            text));
  }
}

Sweep read_sweep(const Value& value) {
  const bool one = value.kind() == Value::Kind::map && value.members().size() == 1;
  if (!one || value.members()[0].second.kind() != Value::Kind::list) {
    throw InputError(value.where(),
                     "`over` is one parameter and its values: `over: {primaries: [8, 16, 32]}`");
  }
  const auto& [parameter, values] = value.members()[0];
  Sweep sweep{.parameter = parameter, .values = values.items()};
  if (sweep.values.size() < 2) {
    throw InputError(values.where(), "a slope needs at least two values in `over`");
  }
  require_increasing(sweep);
  if (parameter == "primaries") {
    for (const Value& count : sweep.values) count_from(count, "a number of primaries", 1);
  }
  return sweep;
}

/// `reference: trusted`, `reference: 6.36` or `reference: 6.36 +- 0.01`.
void read_reference(const Value& value, TestEntry& test) {
  const std::string text = one_line(value, "`reference`");
  if (text.find_first_of("0123456789") != text.find_first_not_of(" +-.")) {
    test.reference = parse_source(text, value.where());
    return;
  }
  const std::size_t error = text.find("+-");
  const auto number = [&](const std::string& part) {
    const std::size_t end = part.find_last_not_of(' ');
    const std::size_t begin = part.find_first_not_of(' ');
    const std::string bare = begin == std::string::npos ? "" : part.substr(begin, end - begin + 1);
    return Value::scalar(bare, value.where()).number("a number of `reference`");
  };
  Constant reference{.value = number(text.substr(0, error))};
  if (error != std::string::npos) reference.standard_error = number(text.substr(error + 2));
  if (!std::isfinite(reference.value) || !(reference.standard_error >= 0) ||
      std::isinf(reference.standard_error)) {
    throw InputError(value.where(), "`reference` must be finite, and its error not negative");
  }
  test.reference_number = reference;
}

/// The quantities that have a trait, as "`bias` and `efficiency`".
std::string quantities_with(bool QuantityRow::*trait) {
  std::vector<std::string> words;
  for (const QuantityRow& row : quantities()) {
    if (row.*trait) words.push_back("`" + row.word + "`");
  }
  return fmt::format("{}", fmt::join(words, " and "));
}

using Refuse = std::function<void(const char* key, const std::string& why)>;

void check_margins(const TestEntry& test, const Refuse& refuse) {
  if (test.detect && test.detect->value == 0) {
    refuse("detect", "`detect` must be above 0: it is the effect that must not pass, as `1%`");
  }
  if (test.detect && test.claim.relation == Relation::within) {
    refuse("detect",
           "`within` says how far off the claim must not be: `detect` has no meaning beside it; "
           "leave it out");
  }
  if (test.allow && is_proof(test.claim.relation)) {
    refuse("allow",
           fmt::format("`allow` has no meaning with `{}`: what is claimed must be shown in "
                       "full",
                       to_string(test.claim.relation)));
  }
  const bool comparable =
      test.detect && test.allow && test.detect->relative == test.allow->relative;
  if (test.detect && test.allow && test.allow->value > 0 && !comparable) {
    refuse("allow", fmt::format("`detect` ({}) and `allow` ({}) must both be in per cent or both "
                                "absolute",
                                to_string(*test.detect), to_string(*test.allow)));
  }
  if (comparable && test.allow->value >= test.detect->value) {
    refuse("allow", fmt::format("`detect` ({}) must be above `allow` ({})", to_string(*test.detect),
                                to_string(*test.allow)));
  }
}

/// Checks a test beyond the types of its keys: `allow` is below `detect`, and the claim uses every
/// key. InputError at the offending key.
void check_test(const TestEntry& test) {
  const auto refuse = [&](const char* key, const std::string& why) {
    throw InputError(test.place_of(key), why);
  };
  check_margins(test, refuse);
  const Claim& claim = test.claim;
  if (claim.left.slope && !test.over) {
    refuse("claim", "a slope needs `over`: `over: {primaries: [8, 16, 32]}`");
  }
  if (!claim.left.slope && test.over) refuse("over", "`over` has no meaning but for `slope(…)`");
  const auto refuse_but_for = [&](const char* key, bool QuantityRow::*trait) {
    if (claim.left.row->*trait) return;
    refuse(key, fmt::format("`{}` has no meaning but for {}", key, quantities_with(trait)));
  };
  if (test.reference || test.reference_number) {
    refuse_but_for("reference", &QuantityRow::takes_reference);
  }
  if (test.cost != CostKind::rays) refuse_but_for("cost", &QuantityRow::counts_cost);
  if (test.paired && !std::holds_alternative<ScaledQuantity>(claim.right)) {
    refuse("paired", "`paired` takes two estimators, as in `mean(new) == mean(old)`");
  }
}

/// Error rates and seeds belong to the run.
void refuse_levels(const Document& document, const Value& test) {
  for (const char* key : {"alpha", "beta", "seed"}) {
    const Value* found = test.find(key);
    if (!found) continue;
    throw InputError(document.key(*found),
                     fmt::format("`{}` is the suite's, so that no test can choose its own; put it "
                                 "at the top of the file",
                                 key));
  }
}

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

Budget read_budget(const Document& document, const Value& value) {
  if (value.kind() == Value::Kind::scalar) return read_short_budget(value);
  const Keys keys(document, value, "a budget", {"primaries", "seconds"});
  Budget budget;
  if (const Value* v = keys.find("primaries")) {
    budget.primaries = count_from(*v, "the primaries of `budget`", 1);
  }
  if (const Value* v = keys.find("seconds")) {
    budget.seconds = positive_number(*v, "the seconds of `budget`");
  }
  if (!budget.primaries && !budget.seconds) {
    throw InputError(value.where(), "a budget needs `primaries` or `seconds`");
  }
  return budget;
}

const Value& scene_or(const Value& value, const Value& scenes) {
  const Value* scene = value.kind() == Value::Kind::scalar ? scenes.find(value.text()) : nullptr;
  return scene ? *scene : value;
}

std::optional<std::uint64_t> read_primaries(const Value& value, std::string_view what) {
  if (value.kind() == Value::Kind::scalar && value.text() == "auto") return {};
  return count_from(value, what, 1);
}

std::vector<std::string> settable_names(const Entry& plugin) {
  std::vector<std::string> names{"primaries"};
  for (const ParameterInformation& p : plugin.information.parameters) names.push_back(p.name);
  return names;
}

EstimatorEntry read_estimator(const Document& document, const std::string& name, const Value& value,
                              const Value& scenes) {
  if (name.find('{') != std::string::npos) {
    throw InputError(document.key(value),
                     fmt::format("a `: ` is missing before the `{{` of `{}`", name));
  }
  if (!is_estimator_name(name)) {
    throw InputError(document.key(value),
                     fmt::format("`{}` cannot name an estimator: a letter, then letters, digits, "
                                 "`_`, `-` and `/`",
                                 name));
  }
  if (value.kind() != Value::Kind::map) {
    throw InputError(
        value.where(),
        fmt::format("the estimator `{}` must be a map, as in `{{plugin: family/name}}`", name));
  }
  const Value* plugin = value.find("plugin");
  if (!plugin) {
    throw InputError(value.where(), fmt::format("`{0}` needs the key `plugin`, as in `{0}: "
                                                "{{plugin: luminaire/area}}`",
                                                name));
  }
  const Entry& entry = find_plugin(plugin->string("`plugin`"), plugin->where());
  std::vector<std::string> known = settable_names(entry);
  known.insert(known.begin(), "plugin");
  const Keys keys(document, value, fmt::format("`{}` ({})", name, plugin->text()), known);
  EstimatorEntry estimator{.name = name, .plugin = plugin->text(), .where = document.key(value)};
  if (const Value* v = keys.find("primaries")) {
    estimator.primaries = read_primaries(*v, "`primaries`");
  }
  std::vector<Value::Member> parameters;
  for (const auto& [key, given] : value.members()) {
    if (key == "plugin" || key == "primaries") continue;
    parameters.emplace_back(key, key == "scene" ? scene_or(given, scenes) : given);
  }
  estimator.parameters = Value::map(std::move(parameters), value.where());
  return estimator;
}

TestEntry read_test(const Document& document, const Value& value) {
  if (value.kind() != Value::Kind::map) {
    throw InputError(value.where(),
                     "a test is a map of keys and values, as in `- claim: mean(area) == analytic`");
  }
  refuse_levels(document, value);
  const Keys keys(document, value, "a test",
                  {"claim", "name", "detect", "allow", "weight", "test", "secondaries", "budget",
                   "over", "reference", "cost", "paired", "expect", "tags"});
  TestEntry test{
      .claim = read_claim(document, keys.require("claim", "claim: mean(area) == analytic")),
      .where = value.where()};
  const Value* name = keys.find("name");
  test.name = name ? one_line(*name, "`name`") : test.claim.text;
  read_test_keys(document, value, test);
  return test;
}

void read_test_keys(const Document& document, const Value& map, TestEntry& test) {
  for (const auto& [key, given] : map.members()) test.keys[key] = document.key(given);
  if (const Value* v = map.find("detect")) test.detect = read_margin(*v, "`detect`");
  if (const Value* v = map.find("allow")) test.allow = read_margin(*v, "`allow`");
  if (const Value* v = map.find("weight")) test.weight = positive_number(*v, "`weight`");
  if (const Value* v = map.find("expect")) {
    test.expect =
        static_cast<Expectation>(choice(*v, "`expect`", {"pass", "fail", "invalid", "error"}));
  }
  if (const Value* v = map.find("tags")) test.tags = read_tags(*v);
  if (const Value* v = map.find("test")) {
    test.method = method_names()[choice(*v, "`test`", method_names())];
  }
  if (const Value* v = map.find("secondaries")) {
    test.secondaries = count_from(*v, "`secondaries`", 2);
  }
  if (const Value* v = map.find("budget")) test.budget = read_budget(document, *v);
  if (const Value* v = map.find("over")) test.over = read_sweep(*v);
  if (const Value* v = map.find("reference")) read_reference(*v, test);
  if (const Value* v = map.find("cost")) {
    test.cost = static_cast<CostKind>(choice(*v, "`cost`", {"rays", "samples", "seconds"}));
  }
  if (const Value* v = map.find("paired")) {
    test.paired = choice(*v, "`paired`", {"false", "true"}) == 1;
  }
  check_test(test);
}

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
