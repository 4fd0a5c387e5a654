#include "harness/record/recorded_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace assay::harness {
namespace {

/// The nearest id to an unknown one; "" if none is near.
std::string meant(const std::string& asked, const std::vector<Recorded>& all) {
  std::vector<std::string> spellings;
  for (const Recorded& each : all) {
    spellings.push_back(each.test.id);
    spellings.push_back(each.test.name);
  }
  const std::string near = nearest(asked, spellings);
  for (const Recorded& each : all) {
    const bool is_near = !near.empty() && (each.test.id == near || each.test.name == near);
    if (is_near || (near.empty() && each.test.id.find(asked) != std::string::npos)) {
      return each.test.id;
    }
  }
  return "";
}

std::string some_ids(const std::vector<Recorded>& tests) {
  constexpr std::size_t most = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, tests.size()); ++i) {
    text += (i == 0 ? "`" : ", `") + tests[i].test.id + "`";
  }
  return text + (tests.size() > most ? ", …" : "");
}

}  // namespace

Recorded find_test(const reports::Record& record, const ReplayArguments& arguments) {
  std::vector<Recorded> all;
  std::vector<Recorded> named;
  for (const reports::Suite& suite : record.suites) {
    for (const reports::Test& test : suite.tests) {
      all.push_back({suite, test, suite.seed});
      if (test.id == arguments.test) return all.back();
      if (test.name == arguments.test) named.push_back(all.back());
    }
  }
  if (named.size() == 1) return named.front();
  const Location where{.file = arguments.record};
  if (!named.empty()) {
    throw InputError(where, fmt::format("{} tests have the name `{}`; give the id of one: {}",
                                        named.size(), arguments.test, some_ids(named)));
  }
  const std::string near = meant(arguments.test, all);
  throw InputError(where, fmt::format("no test `{}` in this run; {}", arguments.test,
                                      near.empty() ? "there is: " + some_ids(all)
                                                   : "did you mean `" + near + "`?"));
}

Recorded find_test_by_part(const reports::Record& record, const ReplayArguments& arguments) {
  std::vector<Recorded> parts;
  for (const reports::Suite& suite : record.suites) {
    for (const reports::Test& test : suite.tests) {
      if (test.id == arguments.test) return {suite, test, suite.seed};
      if (test.id.find(arguments.test) == std::string::npos) continue;
      parts.push_back({suite, test, suite.seed});
    }
  }
  if (parts.empty()) return find_test(record, arguments);
  if (parts.size() == 1) return parts.front();
  throw InputError({}, fmt::format("{} tests have `{}` in their id; give more of one: {}",
                                   parts.size(), arguments.test, some_ids(parts)));
}

}  // namespace assay::harness
