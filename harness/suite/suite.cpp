#include "harness/suite/suite.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <cmath>
#include <filesystem>
#include <ranges>

#include "estimators/catalogue.h"
#include "estimators/core/value.h"
#include "harness/base/text_file.h"

namespace assay::harness {
namespace {

namespace fs = std::filesystem;

/// Columns of errors count in the file if the claim stands there unbroken, else in the claim.
Claim read_claim(const Document& document, const Value& value) {
  std::string text = value.string("`claim`");
  std::ranges::replace(text, '\n', ' ');
  text.erase(text.find_last_not_of(' ') + 1);
  try {
    return parse_claim(text, value.where());
  } catch (const InputError& e) {
    const std::string_view line = document.line(value.where().line);
    const auto at = static_cast<std::size_t>(std::max(value.where().column, 1)) - 1;
    if (at < line.size() && line.substr(at).starts_with(text)) throw;
    const int column = e.where().column - value.where().column + 1;
    refuse(value.where(), "{} (character {} of `{}`)", e.message(), column, text);
  }
}

Margin read_margin(const Value& value, std::string_view what) {
  return parse_margin(value.string(what), value.where(), what);
}

/// The items of a list that has any. InputError with what it must be.
const std::vector<Value>& items_of(const Value& list, const std::string& otherwise) {
  if (list.kind() == Value::Kind::list && !list.items().empty()) return list.items();
  refuse(list.where(), otherwise);
}

std::vector<std::string> read_lines(const Value& list, const char* what) {
  return mapped(list.items(), [&](const Value& item) { return one_line(item, what); });
}

Budget read_short_budget(const Value& value) {
  const std::string& text = value.text();
  try {
    if (!text.ends_with('s')) return {count_from(value, "`budget`", 1), {}};
    const std::string number = boost::trim_right_copy(text.substr(0, text.size() - 1));
    const Value seconds = Value::scalar(number, value.where());
    return {{}, positive_number(seconds, "the seconds of `budget`")};
  } catch (const InputError&) {
    refuse(value.where(),
           "`budget` must be a number of primaries (1e7), of seconds (ten minutes are 600s), or a "
           "map of both, but it is `{}`",
           text);
  }
}

Sweep read_sweep(const Value& value) {
  if (value.members().size() != 1)
    refuse(value.where(),
           "`over` is one parameter and two values or more: `over: {primaries: [8, 16, 32]}`");
  const auto& [parameter, values] = value.members()[0];
  if (values.items().size() < 2)
    refuse(values.where(), "a slope needs two values of `{}` or more: `[8, 16, 32]`", parameter);
  Sweep sweep{.parameter = parameter, .values = values.items()};
  double last = 0;
  for (const Value& each : sweep.values) {
    const double number = positive_number(each, "a value of `over`");
    if (number <= last) refuse(each.where(), "the values of `over` must ascend");
    if (parameter == "primaries") count_from(each, "a number of primaries", 1);
    last = number;
  }
  return sweep;
}

void read_reference(const Value& value, TestEntry& test) {
  const auto reference = parse_reference(one_line(value, "`reference`"), value.where());
  if (const auto* source = std::get_if<Source>(&reference)) test.reference = *source;
  if (const auto* number = std::get_if<Constant>(&reference)) test.reference_number = *number;
}

void check_margins(const TestEntry& test) {
  if (test.detect && test.detect->value == 0) {
    refuse(test.place_of("detect"),
           "`detect` must be above 0: it is the effect that must not pass, as `1%`");
  }
  if (test.detect && test.claim.relation == Relation::within) {
    refuse(test.place_of("detect"),
           "`within` already says which error must not pass: leave `detect` out");
  }
  if (test.allow && is_proof(test.claim.relation)) {
    refuse(test.place_of("allow"), "`allow` has no meaning with `{}`, which must be proved in full",
           to_string(test.claim.relation));
  }
  if (!test.detect || !test.allow || test.allow->value == 0) return;
  const bool comparable = test.detect->relative == test.allow->relative;
  if (comparable && test.detect->value > test.allow->value) return;
  refuse(test.place_of("allow"),
         "`detect` ({}) must be above `allow` ({}), both in per cent or both absolute",
         to_string(*test.detect), to_string(*test.allow));
}

/// Checks a test beyond the types of its keys: `allow` is below `detect`, and the claim uses every
/// key. InputError at the offending key.
void check_test(const TestEntry& test) {
  check_margins(test);
  const Claim& claim = test.claim;
  if (claim.left.slope != test.over.has_value()) {
    refuse(test.place_of(test.over ? "over" : "claim"),
           "a slope needs `over`, and nothing else takes it: `over: {primaries: [8, 16, 32]}`");
  }
  const auto refuse_but_for = [&](const char* key, bool QuantityRow::*trait) {
    if (claim.left.row->*trait) return;
    auto rows = quantities() | std::views::filter(trait);
    refuse(test.place_of(key), "`{}` is only for `{}`", key,
           fmt::join(mapped(rows, &QuantityRow::word), "` and `"));
  };
  if (test.reference || test.reference_number) {
    refuse_but_for("reference", &QuantityRow::takes_reference);
  }
  if (test.cost != CostKind::rays) refuse_but_for("cost", &QuantityRow::counts_cost);
}

using Tests = std::vector<TestEntry>;

/// An exact name goes before a glob: a claim's factor contains an asterisk.
std::vector<const TestEntry*> tests_named(const std::string& name, const Tests& tests) {
  std::vector<const TestEntry*> found;
  for (const TestEntry& test : tests) {
    if (test.name == name) return {&test};
    if (matches(name, test.name)) found.push_back(&test);
  }
  return found;
}

/// A glob is replaced by the tests that it matches.
std::vector<std::string> read_names(const Keys& keys, const char* key, const Tests& tests) {
  const Value* list = keys.find(key);
  if (list == nullptr) return {};
  std::vector<std::string> names;
  for (const Value& item : items_of(
           *list,
           fmt::format("`{}` must be a list of at least one test, by its name or a glob", key))) {
    one_line(item, "the name of a test");
    const std::vector<const TestEntry*> found = tests_named(item.text(), tests);
    if (found.empty()) {
      refuse(item.where(), "the suite has no test `{}`{}", item.text(),
             did_you_mean(item.text(), mapped(tests, &TestEntry::name),
                          "tests are named by `name`, or else by their claim"));
    }
    for (const TestEntry* test : found) {
      if (test->expect != reports::Verdict::pass && test->expect != reports::Verdict::fail) {
        refuse(item.where(), "`{}` expects no decision, so it answers nothing", test->name);
      }
      if (std::ranges::count(names, test->name) == 0) names.push_back(test->name);
    }
  }
  return names;
}

void check(const reports::Statement& statement, const Location& where) {
  const bool both = !statement.holds.empty() && !statement.fails.empty();
  if (statement.holds.empty() && statement.fails.empty()) {
    refuse(where, "a statement needs tests that answer it: `holds`, `fails`, or both");
  }
  for (const std::string& name : statement.fails) {
    if (std::ranges::count(statement.holds, name) == 0) continue;
    refuse(where, "`{}` cannot be under both `holds` and `fails`", name);
  }
  if (both == statement.condition.empty()) {
    refuse(where,
           "a `condition` separates `holds` from `fails`: give all three, or one without it");
  }
}

reports::Statement read_statement(const Document& document, const Value& value,
                                  const Tests& tests) {
  const Keys keys(document, value, "a statement",
                  "{text: they agree, source: a talk, holds: [a test]}",
                  {"text", "source", "holds", "fails", "condition"});
  reports::Statement statement{
      .text = one_line(keys.require("text", "text: the variance is reduced"), "`text`"),
      .source = one_line(keys.require("source", "source: a talk"), "`source`"),
      .line = value.where().line};
  if (const Value* v = keys.find("condition")) statement.condition = one_line(*v, "`condition`");
  statement.holds = read_names(keys, "holds", tests);
  statement.fails = read_names(keys, "fails", tests);
  check(statement, value.where());
  return statement;
}

/// `budget: 1e7`, `budget: 30s` or a map of both.
Budget read_budget(const Document& document, const Value& value) {
  if (value.kind() == Value::Kind::scalar) return read_short_budget(value);
  const Keys keys(document, value, "a budget", "{primaries: 1e7, seconds: 60}",
                  {"primaries", "seconds"});
  Budget budget;
  if (const Value* v = keys.find("primaries")) {
    budget.primaries = count_from(*v, "the primaries of `budget`", 1);
  }
  if (const Value* v = keys.find("seconds")) {
    budget.seconds = positive_number(*v, "the seconds of `budget`");
  }
  if (!budget.primaries && !budget.seconds) {
    refuse(value.where(), "a budget needs `primaries` or `seconds`");
  }
  return budget;
}

void require_parameter(const EstimatorEntry& estimator, const std::string& key,
                       const Location& where) {
  const Information& plugin = find_plugin(estimator.plugin, where).information;
  std::vector<std::string> names = mapped(plugin.parameters, &ParameterInformation::name);
  names.emplace_back("primaries");
  if (std::ranges::find(names, key) != names.end()) return;
  refuse(where, "`{}` ({}) has no parameter `{}`{}", estimator.name, estimator.plugin, key,
         suggestion(key, names));
}

/// Reads an entry of `tests:`, without its id and without looking up estimators.
TestEntry read_test(const Document& document, const Value& value) {
  for (const auto& [key, advice] : std::initializer_list<std::pair<const char*, const char*>>{
           {"alpha", "`alpha` belongs to the suite, not to a test; put it at the top of the file"},
           {"beta", "`beta` belongs to the suite, not to a test; put it at the top of the file"},
           {"seed", "`seed` belongs to the suite, not to a test; put it at the top of the file"},
           {"primaries", "`primaries` belongs to an estimator, or to the `budget` of a test"},
           {"tolerance", "unknown key `tolerance` of a test; did you mean `allow`?"}}) {
    if (const Value* found = value.find(key)) refuse(document.key(*found), std::string(advice));
  }
  const Keys keys(document, value, "a test", "- claim: mean(area) == analytic",
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

void read_head(const Document& document, const Keys& keys, Suite& suite) {
  suite.name = one_line(keys.require("suite", "suite: my first suite"), "`suite`");
  if (const Value* v = keys.find("about")) suite.about = v->string("`about`");
  if (const Value* v = keys.find("alpha")) suite.alpha = error_rate(*v, "`alpha`");
  if (const Value* v = keys.find("beta")) {
    suite.beta = error_rate(*v, "`beta`");
    if (suite.beta == 0.5) {
      refuse(v->where(),
             "`beta` must be below 0.5: a pass uses the interval of confidence 1 - 2 beta");
    }
  }
  if (const Value* v = keys.find("seed")) {
    if (v->kind() == Value::Kind::scalar && v->text() == "random") {
      refuse(v->where(),
             "a suite's seed is a number, so that its runs repeat; `assay run --seed random` takes "
             "a fresh one");
    }
    suite.seed = v->count("`seed`");
  }
  if (const Value* v = keys.find("needs")) {
    items_of(*v, "`needs` must be a list of programs: `needs: [blender]`");
    suite.needs = read_lines(*v, "a program");
  }
  if (const Value* v = keys.find("budget")) suite.budget = read_budget(document, *v);
}

Value read_scenes(const Keys& keys) {
  const Value* scenes = keys.find("scenes");
  if (!scenes) return {};
  if (scenes->kind() != Value::Kind::map) {
    refuse(scenes->where(), "`scenes` must be a map of names to scenes");
  }
  for (const auto& [name, scene] : scenes->members()) {
    if (scene.kind() != Value::Kind::map) {
      refuse(scene.where(), "the scene `{}` must be a map", name);
    }
  }
  return *scenes;
}

void read_estimators(const Document& document, const Value& map, Suite& suite, Mistakes& mistakes) {
  if (map.members().empty()) {
    refuse(map.where(),
           "`estimators` must be a map of at least one name to its plugin, without `- `, as in "
           "`area: {plugin: luminaire/area}`");
  }
  for (const auto& [name, value] : map.members()) {
    mistakes.attempt(
        [&] { suite.estimators.push_back(read_estimator(document, name, value, suite.scenes)); });
  }
}

/// Leaves out tests with a mistake, and tests of estimators with a mistake.
void read_tests(const Document& document, const Value& list, const Value& estimators, Suite& suite,
                Mistakes& mistakes) {
  std::map<std::string, Location> names;
  const auto read = [&](const Value& item) {
    TestEntry test = read_test(document, item);
    test.id = suite.stem + "/" + test.name;
    bool sound = true;
    for (const Source& source : sources_of(test)) {
      const std::string& name = source.estimator;
      if (estimators.find(name) == nullptr) {
        refuse(source.where, "the suite has no estimator `{}`{}", name,
               suggestion(name, mapped(estimators.members(), &Value::Member::first)));
      }
      sound &= std::ranges::count(suite.estimators, name, &EstimatorEntry::name) > 0;
    }
    const auto [first, is_new] = names.emplace(test.name, test.where);
    if (!is_new) {
      refuse(
          test.where,
          "a second test named `{}`; the first is at {}:{}; give one of them a `name` of its own",
          test.name, first->second.line, first->second.column);
    }
    if (!sound) return;
    if (test.over && test.over->parameter != "primaries") {
      require_parameter(*std::ranges::find(suite.estimators, test.claim.left.source.estimator,
                                           &EstimatorEntry::name),
                        test.over->parameter, test.over->values[0].where());
    }
    suite.tests.push_back(std::move(test));
  };
  for (const Value& item :
       items_of(list,
                "`tests` must be a list of at least one test, as in `- claim: mean(area) == "
                "analytic`")) {
    mistakes.attempt([&] { read(item); });
  }
}

/// Compares files that exist, or one that the command is about to make.
bool is_same_file(const std::string& one, const std::string& other) {
  std::error_code failure;
  if (fs::equivalent(one, other, failure)) return true;
  const auto whole = [&](const std::string& path) {
    const fs::path absolute = fs::absolute(path, failure);
    const fs::path found = fs::weakly_canonical(absolute, failure);
    return failure ? absolute.lexically_normal() : found;  // of a folder that may not be read
  };
  return whole(one) == whole(other);
}

void add_named_files(const Value& value, const fs::path& folder, std::vector<std::string>& files) {
  std::error_code failure;
  const fs::path path = folder / value.text();
  if (value.kind() == Value::Kind::scalar && fs::is_regular_file(path, failure)) {
    files.push_back(path.string());
  }
  for (const Value& item : value.items()) add_named_files(item, folder, files);
  for (const auto& [key, member] : value.members()) add_named_files(member, folder, files);
}

}  // namespace

void require_estimator_name(const std::string& name, const Location& where) {
  if (is_estimator_name(name)) return;
  refuse(where, "`{}` cannot name an estimator: a letter, then letters, digits, `_`, `-` and `/`",
         name);
}

EstimatorEntry read_estimator(const Document& document, const std::string& name, const Value& value,
                              const Value& scenes) {
  if (name.find('{') != std::string::npos) {
    refuse(document.key(value), "a `: ` is missing before the `{{` of `{}`", name);
  }
  require_estimator_name(name, document.key(value));
  const Value* plugin = value.find("plugin");
  if (!plugin) {
    refuse(value.where(), "`{0}` needs the key `plugin`, as in `{0}: {{plugin: luminaire/area}}`",
           name);
  }
  find_plugin(plugin->string("`plugin`"), plugin->where());
  EstimatorEntry estimator{.name = name,
                           .plugin = plugin->text(),
                           .parameters = Value::map({}, value.where()),
                           .where = document.key(value)};
  for (const auto& [key, given] : value.members()) {
    if (key == "plugin") continue;
    require_parameter(estimator, key, document.key(given));
    set_parameter(estimator, key, given, scenes);
  }
  return estimator;
}

Value with_member(const Value& map, const std::string& key, const Value& value) {
  std::vector<Value::Member> members = map.members();
  const auto found = std::ranges::find(members, key, &Value::Member::first);
  if (found == members.end()) {
    members.emplace_back(key, value);
  } else {
    found->second = value;
  }
  return Value::map(std::move(members), map.where());
}

void set_parameter(EstimatorEntry& estimator, const std::string& key, const Value& value,
                   const Value& scenes) {
  require_parameter(estimator, key, value.where());
  const bool is_text = value.kind() == Value::Kind::scalar;
  if (key == "primaries") {
    estimator.primaries.reset();
    if (!is_text || value.text() != "auto") {
      estimator.primaries = count_from(value, "`primaries`", 1);
    }
    return;
  }
  const Value* scene = key == "scene" && is_text ? scenes.find(value.text()) : nullptr;
  estimator.parameters = with_member(estimator.parameters, key, scene ? *scene : value);
}

void read_test_keys(const Document& document, const Value& map, TestEntry& test) {
  for (const auto& [key, given] : map.members()) test.keys[key] = document.key(given);
  if (const Value* v = map.find("detect")) test.detect = read_margin(*v, "`detect`");
  if (const Value* v = map.find("allow")) test.allow = read_margin(*v, "`allow`");
  if (const Value* v = map.find("weight")) test.weight = positive_number(*v, "`weight`");
  if (const Value* v = map.find("expect")) {
    using enum reports::Verdict;
    constexpr reports::Verdict verdicts[] = {pass, fail, invalid, error};
    test.expect = verdicts[choice(*v, "`expect`", {"pass", "fail", "invalid", "error"})];
  }
  if (const Value* v = map.find("tags")) {
    v->require(v->kind() == Value::Kind::list, "`tags` must be a list: `tags: [slow, images]`");
    test.tags = read_lines(*v, "a tag");
  }
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
    test.cost = static_cast<CostKind>(choice(*v, "`cost`", {cost_words.begin(), cost_words.end()}));
  }
  if (const Value* v = map.find("paired")) test.paired = v->boolean("`paired`");
  check_test(test);
}

std::vector<Source> sources_of(const Claim& claim) {
  std::vector<Source> sources{claim.left.source};
  if (const auto* right = std::get_if<ScaledQuantity>(&claim.right)) {
    sources.push_back(right->quantity.source);
  }
  return sources;
}

std::vector<Source> sources_of(const TestEntry& test) {
  std::vector<Source> sources = sources_of(test.claim);
  if (test.reference) sources.push_back(*test.reference);
  return sources;
}

Suite load_suite(const std::string& file) {
  Mistakes mistakes;
  Suite suite = read_suite(file, mistakes);
  mistakes.refuse_any();
  return suite;
}

Suite read_suite(const std::string& file, Mistakes& mistakes) {
  const std::string text = read_text_file(file);
  const Document document(file, text);
  const Keys keys(document, document.root(), "a suite", "suite: my first suite",
                  {"suite", "about", "alpha", "beta", "seed", "needs", "budget", "scenes",
                   "estimators", "tests", "statements"});
  Suite suite;
  suite.file = file;
  suite.text = text;
  const fs::path path(file);
  suite.stem = path.stem().string();
  suite.folder = path.has_parent_path() ? path.parent_path().string() : ".";
  mistakes.attempt([&] { read_head(document, keys, suite); });
  mistakes.attempt([&] {
    suite.scenes = read_scenes(keys);
    const Value& estimators =
        keys.require("estimators", "estimators: {area: {plugin: luminaire/area}}");
    read_estimators(document, estimators, suite, mistakes);
    read_tests(document, keys.require("tests", "tests: [claim: mean(area) == analytic]"),
               estimators, suite, mistakes);
    const Value* const statements = mistakes.any() ? nullptr : keys.find("statements");
    if (!statements) return;
    suite.statements = mapped(
        items_of(*statements,
                 "`statements` must be a list of at least one, as in `- {text: they agree, source: "
                 "a talk, holds: [a test]}`"),
        [&](const Value& item) { return read_statement(document, item, suite.tests); });
  });
  return suite;
}

std::string excerpt(const Location& where) {
  // Reading a pipe would block.
  std::error_code ignored;
  if (where.line < 1 || !fs::is_regular_file(where.file, ignored)) return "";
  try {
    const std::string text = read_text_file(where.file);
    if (text.find_first_not_of(" \t\r\n") == std::string::npos) return "";  // nothing to point at
    const std::vector<std::string_view> lines = lines_of(text);
    const auto index = static_cast<std::size_t>(where.line) - 1;
    // An error at the end of the file is shown at the line after its last.
    const bool exists = index < lines.size();
    if (!exists && index > lines.size()) return "";
    std::string_view line = exists ? lines[index] : std::string_view{};
    if (index == 0 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    return caret_below(line, where.column);
  } catch (const InputError&) {
    return "";
  }
}

std::vector<std::string> files_read(const std::vector<Suite>& suites) {
  std::vector<std::string> files;
  for (const Suite& suite : suites) {
    if (!suite.file.empty()) files.push_back(suite.file);
    for (const EstimatorEntry& estimator : suite.estimators) {
      add_named_files(estimator.parameters, suite.folder, files);
    }
  }
  return files;
}

void refuse_overwriting(const std::string& report, const std::vector<std::string>& kept) {
  const bool overwrites = std::ranges::any_of(
      kept, [&](const std::string& file) { return is_same_file(report, file); });
  if (!overwrites) return;
  refuse(
      {.file = report},
      "is a file of this command, which a report would replace; name another file for the report");
}

}  // namespace assay::harness
