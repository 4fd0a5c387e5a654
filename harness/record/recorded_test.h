#pragma once

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
  std::uint64_t seed;
};

/// The test with this id or name. InputError if there is none or several, with suggestions.
Recorded find_test(const reports::Record& record, const ReplayArguments& arguments);

/// The same, where a part of an id will do that no other test has.
Recorded find_test_by_part(const reports::Record& record, const ReplayArguments& arguments);

}  // namespace assay::harness
