#pragma once

#include <functional>

#include "harness/suite/suite.h"
#include "harness/suite/yaml.h"

namespace assay::harness {

/// Reads an entry of `estimators:`. `scenes` is the suite's map `scenes:`.
EstimatorEntry read_estimator(const Document& document, const std::string& name, const Value& value,
                              const Value& scenes);

/// Reads a claim. Columns of errors count in the file if the claim stands there unbroken, else in
/// the claim.
Claim read_claim(const Document& document, const Value& value);

/// Reads an entry of `tests:`, without its id and without looking up estimators.
TestEntry read_test(const Document& document, const Value& value);

/// `over:`, `reference:` and `cost:` of a test.
Sweep read_sweep(const Value& value);
void read_reference(const Value& value, TestEntry& test);
CostKind read_cost(const Value& value);

/// `primaries:` of an estimator: a count from 1, or auto (nullopt).
std::optional<std::uint64_t> read_primaries(const Value& value, std::string_view what);

/// `1e7` primaries or `30s`.
Budget read_short_budget(const Value& value);
/// `budget: 1e7`, `budget: 30s` or a map of both.
Budget read_budget(const Document& document, const Value& value);

/// Checks a test beyond the types of its keys: `allow` is below `detect`, and the claim uses every
/// key. InputError at the offending key.
void check_test(const TestEntry& test);

const Value& scene_or(const Value& value, const Value& scenes);

}  // namespace assay::harness
