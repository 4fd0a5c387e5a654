#include "harness/suite/suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "estimators/catalogue.h"
#include "harness/base/text_file.h"
#include "harness/suite/suite_entries.h"
#include "harness/suite/suite_keys.h"
#include "harness/suite/yaml.h"

namespace assay::harness {

namespace {

constexpr const char* estimators_example = "estimators: {area: {plugin: luminaire/area}}";
constexpr const char* tests_example = "tests: [claim: mean(area) == analytic]";

/// A suite's seed is fixed; only the command line can ask for a fresh one.
std::uint64_t seed_of(const Value& value) {
  if (value.kind() == Value::Kind::scalar && value.text() == "random") {
    throw InputError(value.where(),
                     "a suite's seed is a number, so that its runs repeat; `assay run --seed "
                     "random` draws a fresh one");
  }
  return value.count("`seed`");
}

std::string folder_of(const std::string& file) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  return folder.empty() ? "." : folder.string();
}

std::vector<std::string> read_needs(const Value& value) {
  if (value.kind() != Value::Kind::list || value.items().empty()) {
    throw InputError(value.where(), "`needs` must be a list of programs: `needs: [blender]`");
  }
  std::vector<std::string> programs;
  for (const Value& program : value.items()) programs.push_back(one_line(program, "a program"));
  return programs;
}

void read_head(const Document& document, const Keys& keys, Suite& suite) {
  suite.name = one_line(keys.require("suite", "suite: my first suite"), "`suite`");
  if (const Value* v = keys.find("about")) suite.about = v->string("`about`");
  if (const Value* v = keys.find("alpha")) suite.alpha = error_rate(*v, "`alpha`");
  if (const Value* v = keys.find("beta")) {
    suite.beta = error_rate(*v, "`beta`");
    if (suite.beta == 0.5) {
      throw InputError(v->where(),
                       "`beta` must be below 0.5: what a pass excludes is the interval "
                       "of confidence 1 - 2 beta");
    }
  }
  if (const Value* v = keys.find("seed")) suite.seed = seed_of(*v);
  if (const Value* v = keys.find("needs")) suite.needs = read_needs(*v);
  if (const Value* v = keys.find("budget")) suite.budget = read_budget(document, *v);
}

Value read_scenes(const Keys& keys) {
  const Value* scenes = keys.find("scenes");
  if (!scenes) return {};
  if (scenes->kind() != Value::Kind::map) {
    throw InputError(scenes->where(), "`scenes` must be a map of names to scenes");
  }
  for (const auto& [name, scene] : scenes->members()) {
    if (scene.kind() != Value::Kind::map) {
      throw InputError(scene.where(), fmt::format("the scene `{}` must be a map", name));
    }
  }
  return *scenes;
}

void read_estimators(const Document& document, const Value& map, Suite& suite) {
  if (map.kind() == Value::Kind::list) {
    throw InputError(map.where(),
                     "`estimators` is a map of names, not a list: leave the `- ` out, as in `area: "
                     "{plugin: luminaire/area}`");
  }
  if (map.kind() != Value::Kind::map || map.members().empty()) {
    throw InputError(map.where(),
                     "`estimators` must be a map of at least one name to its plugin, as in `area: "
                     "{plugin: luminaire/area}`");
  }
  for (const auto& [name, value] : map.members()) {
    suite.estimators.push_back(read_estimator(document, name, value, suite.scenes));
  }
}

void require_estimator(const Suite& suite, const Source& source) {
  std::vector<std::string> names;
  for (const EstimatorEntry& estimator : suite.estimators) names.push_back(estimator.name);
  if (std::ranges::find(names, source.estimator) != names.end()) return;
  throw InputError(source.where, fmt::format("the suite has no estimator `{}`{}", source.estimator,
                                             suggestion(source.estimator, names)));
}

void check_sweep(const Suite& suite, const TestEntry& test) {
  if (!test.over || test.over->parameter == "primaries") return;
  const EstimatorEntry& estimator =
      *std::ranges::find(suite.estimators, test.claim.left.source.estimator, &EstimatorEntry::name);
  const auto names = settable_names(find_plugin(estimator.plugin, estimator.where));
  if (std::ranges::find(names, test.over->parameter) != names.end()) return;
  throw InputError(
      test.over->values[0].where(),
      fmt::format("`{}` ({}) has no parameter `{}`{}", estimator.name, estimator.plugin,
                  test.over->parameter, suggestion(test.over->parameter, names)));
}

void read_tests(const Document& document, const Value& list, Suite& suite) {
  if (list.kind() != Value::Kind::list || list.items().empty()) {
    throw InputError(list.where(),
                     "`tests` must be a list of at least one test, as in `- claim: mean(area) == "
                     "analytic`");
  }
  std::map<std::string, Location> names;
  for (const Value& item : list.items()) {
    TestEntry test = read_test(document, item);
    test.id = suite.stem + "/" + test.name;
    for (const Source& source : sources_of(test.claim)) require_estimator(suite, source);
    if (test.reference) require_estimator(suite, *test.reference);
    check_sweep(suite, test);
    const auto [first, is_new] = names.emplace(test.name, test.where);
    if (!is_new) {
      throw InputError(test.where,
                       fmt::format("a second test named `{}`; the first is at {}:{}; give one of "
                                   "them a `name`",
                                   test.name, first->second.line, first->second.column));
    }
    suite.tests.push_back(std::move(test));
  }
}

}  // namespace

std::vector<Source> sources_of(const Claim& claim) {
  std::vector<Source> sources{claim.left.source};
  if (const auto* right = std::get_if<ScaledQuantity>(&claim.right)) {
    sources.push_back(right->quantity.source);
  }
  return sources;
}

Suite load_suite(const std::string& file) {
  const std::string text = read_text_file(file);
  const Document document = read_yaml_text(text, file);
  const Keys keys(document, document.root(), "a suite",
                  {"suite", "about", "alpha", "beta", "seed", "needs", "budget", "scenes",
                   "estimators", "tests", "statements"});
  Suite suite;
  suite.file = file;
  suite.text = text;
  suite.stem = std::filesystem::path(file).stem().string();
  suite.folder = folder_of(file);
  read_head(document, keys, suite);
  suite.scenes = read_scenes(keys);
  read_estimators(document, keys.require("estimators", estimators_example), suite);
  read_tests(document, keys.require("tests", tests_example), suite);
  if (const Value* v = keys.find("statements")) {
    suite.statements = read_statements(document, *v, suite.tests);
  }
  return suite;
}

std::string excerpt(const Location& where) {
  // Reading a pipe would block.
  std::error_code ignored;
  if (where.line < 1 || !std::filesystem::is_regular_file(where.file, ignored)) return "";
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

}  // namespace assay::harness
