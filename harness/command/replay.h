#pragma once

// `assay replay`: draws a recorded test, or one of its observations, again.

#include <cstdint>
#include <optional>
#include <string>

#include "reports/record/record.h"

namespace assay::harness {

struct ReplayArguments {
  std::string record;                             ///< RUN.json
  std::string test;                               ///< id or name
  std::optional<std::uint64_t> observation = {};  ///< none: the whole test
};
/// A recorded test found in its record.
struct Recorded {
  const reports::Suite& suite;
  const reports::Test& test;
};

/// The test with this id or name; `by_part` also accepts a part of an id that no other test has.
/// InputError if there is none or several, with suggestions.
Recorded find_test(const reports::Record& record, const ReplayArguments& arguments,
                   bool by_part = false);

/// Prints what was drawn. Returns 1 if something could not be.
int replay(const ReplayArguments&);

}  // namespace assay::harness
