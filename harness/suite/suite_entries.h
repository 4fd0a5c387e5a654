#pragma once

// The entries of a suite file, one by one.

#include <functional>

#include "harness/suite/suite.h"
#include "harness/suite/yaml.h"

namespace assay::harness {

/// An entry of `estimators:`. `scenes` is the map under the suite's `scenes:`.
EstimatorEntry read_estimator(const Document& document, const std::string& name, const Value& value,
                              const Value& scenes);

/// A claim from a document: columns of errors are those of the file where the claim stands in one
/// piece, else they are given in the claim.
Claim read_claim(const Document& document, const Value& value);

/// An entry of `tests:`, without its id; estimators are not looked up yet.
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

/// What a test must satisfy beyond the type of each key: `allow` below `detect`, and only keys that
/// its claim gives a meaning to. InputError at the offending key.
void check_test(const TestEntry& test);

/// The value, or the scene that it names.
const Value& scene_or(const Value& value, const Value& scenes);

}  // namespace assay::harness
