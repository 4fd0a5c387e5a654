#pragma once

// Which tests of a suite run: those that `--filter` and `--tag` name.

#include <string>
#include <vector>

#include "harness/suite/suite.h"

namespace assay::harness {

struct Selection {
  /// Globs on whole ids, suite/name. One that begins with `-` excludes what the rest matches.
  std::vector<std::string> filters = {};
  std::vector<std::string> tags = {};

  bool empty() const { return filters.empty() && tags.empty(); }
};

/// True if the test has one of the tags, matches one of the filters that include, and matches none
/// that excludes. A list without members asks for nothing.
bool selects(const Selection& selection, const TestEntry& test);

/// The options that make the selection, each after a blank: " --filter '*/mean*' --tag slow".
std::string options_text(const Selection& selection);

/// Says that no test has a tag, that no id matches a filter, or that no test is left. Names the
/// tags there are, or the nearest ids. "" else. A filter that excludes may match no id.
std::string unmatched(const std::vector<Suite>& suites, const Selection& selection);

}  // namespace assay::harness
