#pragma once

#include <string>
#include <vector>

#include "harness/suite/suite.h"

namespace assay::harness {

struct Selection {
  /// Globs on whole ids, suite/name. A glob that begins with `-` excludes tests.
  std::vector<std::string> filters = {};
  std::vector<std::string> tags = {};

  bool empty() const { return filters.empty() && tags.empty(); }
};

/// True if the test has one of the tags, matches an including filter, and matches no excluding one.
/// An empty list selects everything.
bool selects(const Selection& selection, const TestEntry& test);

/// An option's words for a shell, each after a blank: " --tag 'a b' --tag c". Without a name they
/// are arguments.
std::string option_words(const std::string& option, const std::vector<std::string>& values);

/// The options that make the selection, each after a blank: " --filter '*/mean*' --tag slow".
std::string options_text(const Selection& selection);

/// An error message if a tag or an including filter matches nothing, or no test is left; else "".
/// It lists the tags, or the nearest ids.
std::string unmatched(const std::vector<Suite>& suites, const Selection& selection);

}  // namespace assay::harness
