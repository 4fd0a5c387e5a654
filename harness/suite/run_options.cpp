#include "harness/suite/run_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <ranges>
#include <set>

#include "estimators/core/quoting.h"
#include "estimators/core/value.h"
#include "harness/suite/yaml.h"

namespace assay::harness {
namespace {

bool excludes(const std::string& filter) { return filter.starts_with("-"); }

std::vector<const TestEntry*> selected(const std::vector<Suite>& suites,
                                       const Selection& selection) {
  std::vector<const TestEntry*> found;
  for (const Suite& suite : suites) {
    for (const TestEntry& test : suite.tests) {
      if (selects(selection, test)) found.push_back(&test);
    }
  }
  return found;
}

std::string few_of(const std::vector<std::string>& ids) {
  constexpr std::size_t most = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, ids.size()); ++i) text += "    " + ids[i] + "\n";
  if (ids.size() > most) {
    text += fmt::format("    … {} more; `assay list tests SUITE` has all\n", ids.size() - most);
  }
  return text;
}

std::string unknown_tag(const std::vector<Suite>& suites, const std::string& tag) {
  std::set<std::string> known;
  for (const TestEntry* test : selected(suites, {})) {
    known.insert(test->tags.begin(), test->tags.end());
  }
  if (known.contains(tag)) return "";
  const std::vector<std::string> tags(known.begin(), known.end());
  return fmt::format("--tag {}: no test has this tag{}\n", shell_quoted(tag),
                     tags.empty() ? "; a test gets one by `tags: [slow]`" : suggestion(tag, tags));
}

std::string unmatched_filter(const std::vector<Suite>& suites, const std::string& filter) {
  const std::vector<std::string> ids = mapped(selected(suites, {}), &TestEntry::id);
  const auto matched = [&](const std::string& glob) {
    const auto is_matched = [&](const std::string& id) { return matches(glob, id); };
    return mapped(ids | std::views::filter(is_matched), std::identity());
  };
  if (!matched(filter).empty()) return "";
  std::string text = fmt::format("--filter {} matches no test\n", shell_quoted(filter));
  std::vector<std::string> near = matched("*" + filter + "*");
  if (near.empty() && !nearest(filter, ids).empty()) near = {nearest(filter, ids)};
  text += "  it must match a whole id, suite/name, where * and ? are wildcards; ";
  return text + (near.empty() ? "ids here:\n" + few_of(ids) : "near it:\n" + few_of(near));
}

}  // namespace

bool selects(const Selection& selection, const TestEntry& test) {
  const auto includes_it = [&](const std::string& filter) {
    return !excludes(filter) && matches(filter, test.id);
  };
  const auto excludes_it = [&](const std::string& filter) {
    return excludes(filter) && matches(std::string_view(filter).substr(1), test.id);
  };
  const std::vector<std::string>& filters = selection.filters;
  const bool tagged = selection.tags.empty() ||
                      std::ranges::find_first_of(test.tags, selection.tags) != test.tags.end();
  return tagged && std::ranges::none_of(filters, excludes_it) &&
         (std::ranges::all_of(filters, excludes) || std::ranges::any_of(filters, includes_it));
}

std::string option_words(const std::string& option, const std::vector<std::string>& values) {
  std::string text;
  for (const std::string& value : values) {
    text += (option.empty() ? " " : " " + option + " ") + shell_quoted(value);
  }
  return text;
}

std::string options_text(const Selection& selection) {
  return option_words("--filter", selection.filters) + option_words("--tag", selection.tags);
}

std::string unmatched(const std::vector<Suite>& suites, const Selection& selection) {
  for (const std::string& tag : selection.tags) {
    if (std::string text = unknown_tag(suites, tag); !text.empty()) return text;
  }
  for (const std::string& filter : selection.filters) {
    if (excludes(filter)) continue;
    if (std::string text = unmatched_filter(suites, filter); !text.empty()) return text;
  }
  if (!selected(suites, selection).empty()) return "";
  return fmt::format("no test is left by{}\n", options_text(selection));
}

}  // namespace assay::harness
