#include "harness/base/record_file.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <span>
#include <vector>

#include "estimators/core/quoting.h"
#include "harness/base/refuse.h"
#include "harness/base/text_file.h"
#include "reports/report_formats.h"

namespace assay::harness {

reports::Record read_record(const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    refuse({.file = file}, "there is no such file; `--report json=FILE` saves a run");
  }
  for (const char* extension : {".yaml", ".yml"}) {
    if (!file.ends_with(extension)) continue;
    refuse({.file = file},
           "this looks like a suite, not a saved run: `assay run {} --report json=run.json` saves "
           "a run",
           shell_quoted(file));
  }
  const std::optional<std::string> text = bytes_of(file);
  if (!text) refuse({.file = file}, "cannot be read; give a report of kind json");
  return reports::read_json(*text, file);
}

namespace {

std::string without_blanks(std::string text) {
  std::erase(text, ' ');
  return text;
}

std::string some_ids(const std::vector<Recorded>& tests) {
  constexpr std::size_t most = 5;
  const auto id = [](const Recorded& each) { return each.test.id; };
  return quoted(mapped(std::span(tests).first(std::min(most, tests.size())), id)) +
         (tests.size() > most ? ", …" : "");
}

}  // namespace

Recorded find_test(const reports::Record& record, const std::string& file,
                   const std::string& name) {
  std::vector<Recorded> all;
  std::vector<Recorded> named;
  std::vector<Recorded> parts;
  std::vector<Recorded> broken;  // of the parts
  std::vector<std::string> spellings;
  const std::string asked = without_blanks(name);
  const auto is_broken = [&](const reports::Test& test) {
    return !test.ok || std::ranges::any_of(record.ledger.series, [&](const auto& series) {
      return series.alarm && series.test == test.id;
    });
  };
  for (const reports::Suite& suite : record.suites) {
    for (const reports::Test& test : suite.tests) {
      const Recorded& each = all.emplace_back(Recorded{suite, test});
      if (test.id == name) return each;
      spellings.insert(spellings.end(), {test.id, test.name});
      if (without_blanks(test.name) == asked) named.push_back(each);
      if (without_blanks(test.id).find(asked) == std::string::npos) continue;
      parts.push_back(each);
      if (is_broken(test)) broken.push_back(each);
    }
  }
  // Without a name it is the one that is not as it should be.
  if (name.empty() && !broken.empty()) parts.swap(broken);
  const std::vector<Recorded>& matching = named.empty() ? parts : named;
  const Location where{.file = file};
  if (matching.size() == 1) return matching.front();
  if (!matching.empty()) {
    refuse(where, "{} tests match{}: {}", matching.size(),
           name.empty() ? "; give the id of one, or a part of it"
                        : " `" + name + "`; give the id of one, or more of it",
           some_ids(matching));
  }
  if (all.empty()) refuse(where, "this run has no test");
  refuse(where, "no test `{}` in this run{}{}", name,
         did_you_mean(name, spellings, "there is: " + some_ids(all)),
         file != the_last_run ? ""
                              : " (another run is kept by `--report json=FILE`: give FILE before "
                                "the test)");
}

}  // namespace assay::harness
