// Suites from the command line: `assay check`, `--estimator`, `--set`.

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <filesystem>

#include "estimators/catalogue.h"
#include "estimators/core/quoting.h"
#include "harness/suite/suite.h"
#include "harness/suite/yaml.h"

namespace assay::harness {

namespace {

/// `text` before and after the first `separator`; nullopt without one.
std::optional<std::pair<std::string, std::string>> cut(const std::string& text, char separator) {
  const std::size_t at = text.find(separator);
  if (at == std::string::npos) return {};
  return std::pair{text.substr(0, at), text.substr(at + 1)};
}

/// Does one `estimator.key=value`.
void assign(std::vector<Suite>& suites, const std::string& assignment) {
  const Location where{"--set " + assignment, 0, 0};
  const auto sides = cut(assignment, '=');
  const auto path = sides ? cut(sides->first, '.') : std::nullopt;
  if (!path || path->first.empty() || path->second.empty()) {
    refuse(where, "expected estimator.key=value; put a value with commas in brackets or quotes");
  }
  const auto& [name, key] = *path;
  const Value value = read_flow(sides->second, where);
  std::vector<std::string> names;
  for (Suite& suite : suites) {
    for (EstimatorEntry& estimator : suite.estimators) {
      names.push_back(estimator.name);
      if (estimator.name == name) set_parameter(estimator, key, value, suite.scenes);
    }
  }
  if (std::ranges::count(names, name) > 0) return;
  refuse(where, "no suite has an estimator `{}`{}", name, suggestion(name, names));
}

/// Null if no entry has the name.
const EstimatorEntry* entry_named(const std::vector<EstimatorEntry>& entries,
                                  const std::string& name) {
  const auto found = std::ranges::find(entries, name, &EstimatorEntry::name);
  return found == entries.end() ? nullptr : &*found;
}

/// Says how an estimator is made of a file. `command` stands before its option.
[[noreturn]] void refuse_file(const Location& where, const std::string& name,
                              const std::string& file, const std::string& command = "") {
  refuse(where, "`{}` is a file: {}", file,
         file.ends_with(".so")
             ? fmt::format("`{}--estimator {}=library,file={}` loads it", command, name, file)
         : file.ends_with(".py")
             ? fmt::format("`{}--estimator '{}=process,command=[python3, {}]'` runs it", command,
                           name, file)
             : fmt::format("`{3}--estimator {0}=recorded,file={1}` reads numbers, and `--estimator "
                           "'{0}=process,command=[{2}{1}]'` runs a program",
                           name, file, file.find('/') == file.npos ? "./" : "", command));
}

EstimatorEntry entry_for(const Source& source, const std::vector<EstimatorEntry>& given,
                         const std::string& command) {
  if (const auto* entry = entry_named(given, source.estimator)) return *entry;
  const std::string file = source.estimator + "." + source.part;
  if (std::filesystem::is_regular_file(file)) {
    const std::string name = std::filesystem::path(source.estimator).filename().string();
    refuse_file(source.where, name, file, boost::replace_all_copy(command, file, name) + " ");
  }
  const std::string near = nearest(source.estimator, mapped(given, &EstimatorEntry::name));
  if (!near.empty()) {
    refuse(source.where, "no --estimator is named `{}`; did you mean `{}`?", source.estimator,
           near);
  }
  try {
    return {.name = source.estimator,
            .plugin = find_plugin(source.estimator, source.where).information.name,
            .parameters = Value::map({}, source.where),
            .where = source.where};
  } catch (const InputError& error) {
    if (given.empty() || source.estimator.find('/') != std::string::npos) throw;
    refuse(error.where(), "{}; --estimator names {}", error.message(),
           quoted(mapped(given, &EstimatorEntry::name)));
  }
}

}  // namespace

void set_parameter(std::vector<Suite>& suites, const std::string& assignment) {
  for (const std::string& piece : split_outside_brackets(assignment)) assign(suites, piece);
}

EstimatorEntry parse_estimator_option(const std::string& text) {
  const Location where{"--estimator " + text, 0, 0};
  const std::vector<std::string> pieces = split_outside_brackets(text);
  const auto head = cut(pieces[0], '=');
  if (!head) {
    refuse(where, "the plugin needs a name, which the claim uses: `--estimator {}`",
           shell_quoted("x=" + text));
  }
  require_estimator_name(head->first, where);
  if (std::filesystem::is_regular_file(head->second)) refuse_file(where, head->first, head->second);
  EstimatorEntry entry{.name = head->first,
                       .plugin = find_plugin(head->second, where).information.name,
                       .parameters = Value::map({}, where),
                       .where = where};
  std::vector<std::string> seen;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const auto sides = cut(pieces[i], '=');
    if (!sides) {
      refuse(where, "`{}` is not key=value; put a value with commas in brackets or quotes",
             pieces[i]);
    }
    if (std::ranges::find(seen, sides->first) != seen.end()) {
      refuse(where, "`{}` is given twice", sides->first);
    }
    seen.push_back(sides->first);
    set_parameter(entry, sides->first, read_flow(sides->second, where), {});
  }
  return entry;
}

std::vector<EstimatorEntry> estimators_of(const std::vector<Source>& sources,
                                          const std::vector<std::string>& options,
                                          std::optional<std::uint64_t> primaries,
                                          const std::string& command) {
  std::vector<EstimatorEntry> given;
  std::string repeated = command;
  for (const std::string& option : options) {
    EstimatorEntry entry = parse_estimator_option(option);
    if (entry_named(given, entry.name)) {
      refuse(entry.where, "a second estimator named `{}`", entry.name);
    }
    given.push_back(std::move(entry));
    repeated += " --estimator " + shell_quoted(option);
  }
  std::vector<EstimatorEntry> used;
  for (const Source& source : sources) {
    if (entry_named(used, source.estimator)) continue;
    used.push_back(entry_for(source, given, repeated));
    if (primaries) used.back().primaries = primaries;
  }
  for (const EstimatorEntry& entry : given) {
    if (entry_named(used, entry.name)) continue;
    refuse(entry.where,
           "`{0}` is used nowhere, only {1}: write `{0}` in its place, or leave the option out",
           entry.name, quoted(mapped(used, &EstimatorEntry::name)));
  }
  return used;
}

TestEntry test_of(const std::string& command, const std::string& claim, const TestKeys& keys) {
  const Location where{"claim", 1, 1};
  TestEntry test{.claim = parse_claim(claim, where), .where = where};
  test.name = test.claim.text;
  test.id = command + "/" + test.name;
  std::vector<Value::Member> given;
  for (const auto& [key, text] : keys) {
    const Location place{fmt::format("--{} {}", key, text), 0, 0};
    given.emplace_back(key, key == "over" ? read_flow(text, place) : Value::scalar(text, place));
  }
  read_test_keys({}, Value::map(std::move(given)), test);
  return test;
}

Suite suite_of_claim(const CheckArguments& arguments) {
  TestEntry test = test_of("check", arguments.claim, arguments.keys);
  Suite suite{.name = "check", .stem = "check", .folder = "."};
  suite.estimators = estimators_of(sources_of(test), arguments.estimators, arguments.primaries,
                                   "assay check " + shell_quoted(arguments.claim));
  suite.tests.push_back(std::move(test));
  return suite;
}

}  // namespace assay::harness
