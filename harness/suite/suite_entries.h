#pragma once

#include <vector>

#include "estimators/estimator.h"
#include "harness/suite/suite.h"
#include "harness/suite/yaml.h"

namespace assay::harness {

/// Reads an entry of `estimators:`. `scenes` is the suite's map `scenes:`.
EstimatorEntry read_estimator(const Document& document, const std::string& name, const Value& value,
                              const Value& scenes);

/// Reads an entry of `tests:`, without its id and without looking up estimators.
TestEntry read_test(const Document& document, const Value& value);

/// Reads the keys of a test beside its claim and name, as from a suite or the options of a command.
/// It checks that `allow` is below `detect` and that the claim uses every key. InputError at the
/// offending key.
void read_test_keys(const Document& document, const Value& map, TestEntry& test);

/// `primaries` and the plugin's parameters, which a sweep or `--set` can change.
std::vector<std::string> settable_names(const Entry& plugin);

/// `primaries:` of an estimator: a count from 1, or auto (nullopt).
std::optional<std::uint64_t> read_primaries(const Value& value, std::string_view what);

/// `budget: 1e7`, `budget: 30s` or a map of both.
Budget read_budget(const Document& document, const Value& value);

const Value& scene_or(const Value& value, const Value& scenes);

/// Reads `statements:`. A member of `holds` or `fails` is a test's name, or a glob that its matches
/// replace; no test stands twice. InputError at its place for a name that no test has, and for a
/// test that expects invalid or error, which shows nothing. InputError also for a test in both
/// lists, a condition without both lists, and both lists without a condition.
std::vector<StatementEntry> read_statements(const Document& document, const Value& list,
                                            const std::vector<TestEntry>& tests);

}  // namespace assay::harness
