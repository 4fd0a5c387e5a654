#pragma once

// A suite file, read and checked. Nothing is sampled or prepared here.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "estimators/core/value.h"
#include "harness/language/claim.h"

namespace assay::harness {

enum class Expectation { pass, fail, invalid, error };

/// An entry of `estimators:`.
struct EstimatorEntry {
  std::string name = {};
  std::string plugin = {};
  Value parameters = {};                        ///< a map; plugin and primaries are taken out
  std::optional<std::uint64_t> primaries = {};  ///< nullopt: auto, chosen from the pilot
  Location where = {};
};

/// The most a test may cost: primaries, or CPU seconds.
struct Budget {
  std::optional<std::uint64_t> primaries = {};
  std::optional<double> seconds = {};
};

/// A parameter and the values it takes: `over: {primaries: [8, 16, 32]}`.
struct Sweep {
  std::string parameter = {};
  std::vector<Value> values = {};
};

enum class CostKind { rays, samples, seconds };

/// An entry of `tests:`.
struct TestEntry {
  std::string name = {};  ///< default: the claim
  std::string id = {};    ///< suite file's stem, slash, name
  Claim claim = {};
  std::optional<Margin> detect = {};
  bool detect_by_default = false;  ///< not written in the suite (ask_as_written)
  std::optional<Margin> allow = {};
  double weight = 1;
  std::optional<std::string> method = {};         ///< `test:`: forced
  std::optional<std::uint64_t> secondaries = {};  ///< fixed instead of planned
  std::optional<Budget> budget = {};
  std::optional<Sweep> over = {};
  std::optional<Source> reference = {};           ///< `reference:`, an estimator
  std::optional<Constant> reference_number = {};  ///< `reference:`, a number
  CostKind cost = CostKind::rays;
  bool paired = false;  ///< Observations of equal index share their random numbers.
  Expectation expect = Expectation::pass;
  std::vector<std::string> tags = {};
  Location where = {};
  std::map<std::string, Location, std::less<>> keys = {};  ///< the places of the keys that are
                                                           ///< given

  /// The place of the key, or of the test if the key is not given.
  const Location& place_of(std::string_view key) const {
    const auto found = keys.find(key);
    return found == keys.end() ? where : found->second;
  }
};

/// An entry of `statements:`: what somebody claims, and the tests that answer it.
struct StatementEntry {
  std::string text = {};
  std::string source = {};
  std::string condition = {};           ///< Completes "only if"; with both lists.
  std::vector<std::string> holds = {};  ///< Tests whose expected verdicts show it true.
  std::vector<std::string> fails = {};  ///< Tests that show it false, or its limits.
  Location where = {};
};

struct Suite {
  std::string name = {};
  std::string about = {};
  std::string file = {};  ///< as given by the user
  std::string stem = {};  ///< Of suites/luminaire.yaml: "luminaire".
  std::string text = {};
  std::string folder = {};  ///< Relative file names start here.
  double alpha = 0.01;
  double beta = 0.01;
  std::optional<std::uint64_t> seed = {};
  /// Programs; if one is missing, the suite's tests are skipped.
  std::vector<std::string> needs = {};
  /// The budget of all tests together; see README.md of the suites.
  std::optional<Budget> budget = {};
  Value scenes =
      {};  ///< map of `scenes:`, for --set; their names are already replaced in `estimators`
  std::vector<EstimatorEntry> estimators = {};
  std::vector<TestEntry> tests = {};
  std::vector<StatementEntry> statements = {};
};

/// Reads a suite. InputError (file:line:column, the mend) for anything that is not exactly a suite.
/// It refuses a syntax error, a merge key, a wrong type, and a key that is unknown or repeated. It
/// also refuses unknown estimators and plugins, a duplicate test name, `detect` not above `allow`,
/// … Named scenes replace their names. Parameters of plugins are checked when they are prepared.
Suite load_suite(const std::string& file);

/// The suite of a single claim from the command line. An estimator is "NAME=PLUGIN[,key=value]…"
/// with YAML flow values; a plugin that the claim names needs none.
struct CheckArguments {
  std::string claim;
  std::vector<std::string> estimators = {};
  std::optional<std::string> detect = {};
  std::optional<std::string> allow = {};
  std::optional<std::string> method = {};
  std::optional<std::uint64_t> primaries = {};
  std::optional<std::uint64_t> secondaries = {};
  std::optional<std::string> over = {};       ///< YAML flow, as in a suite
  std::optional<std::string> reference = {};  ///< an estimator or a number
  std::optional<std::string> cost = {};
  std::optional<std::string> budget = {};
  bool paired = false;
};
Suite suite_of_claim(const CheckArguments&);

/// Its only test, without looking up its estimators.
TestEntry test_of_claim(const CheckArguments&);

/// `--set estimator.key=value`: replaces or adds a parameter in every suite that has the estimator.
/// InputError if none has.
void set_parameter(std::vector<Suite>& suites, const std::string& assignment);

/// The entry that "NAME=PLUGIN[,key=value]…" describes.
EstimatorEntry parse_estimator_option(const std::string& text);

/// One entry for each estimator that a claim names, in order. The entry comes from `options`
/// ("NAME=PLUGIN…"), else it is the plugin of that name. `primaries` goes to all.
std::vector<EstimatorEntry> estimators_of(const std::vector<Source>& sources,
                                          const std::vector<std::string>& options,
                                          std::optional<std::uint64_t> primaries);

/// The sources that the claim names, left to right.
std::vector<Source> sources_of(const Claim& claim);

/// The line of the file with a caret under the column; "" if the file cannot be read.
std::string excerpt(const Location&);

}  // namespace assay::harness
