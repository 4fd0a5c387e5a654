#pragma once

#include <cstdint>

#include "harness/commands.h"
#include "reports/record.h"

namespace assay::harness {

/// A recorded test found in its record.
struct Recorded {
  const reports::Suite& suite;
  const reports::Test& test;
  std::uint64_t seed;
};

/// The test whose id or name the arguments give. InputError, with what was meant or which there
/// are, where there is none or where several have that name.
Recorded find_test(const reports::Record& record, const ReplayArguments& arguments);

}  // namespace assay::harness
