#pragma once

// A suite file, read and checked. Nothing is sampled or prepared here.

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "estimators/core/value.h"
#include "estimators/estimator.h"
#include "harness/language/claim.h"
#include "harness/suite/yaml.h"
#include "reports/record/record.h"

namespace assay::harness {

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
  bool of_suite = false;  ///< The primaries are a share of the suite's.
};

/// A parameter and the values it takes: `over: {primaries: [8, 16, 32]}`.
struct Sweep {
  std::string parameter = {};
  std::vector<Value> values = {};
};

enum class CostKind { rays, samples, seconds };
/// The words of CostKind; the first two are those of CountedCost.
inline constexpr std::array cost_words{"rays", "samples", "seconds"};

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
  reports::Verdict expect = reports::Verdict::pass;
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
  std::vector<reports::Statement> statements = {};
};

/// The place of one of its tests.
inline std::uint64_t position_of(const TestEntry& test, const Suite& suite) {
  return static_cast<std::uint64_t>(&test - suite.tests.data());
}

/// Reads a suite. InputError (file:line:column, the mend) for anything that is not exactly a suite.
/// Named scenes replace their names. Parameters of plugins are checked when they are prepared.
Suite load_suite(const std::string& file);
/// The same, but keeps the mistakes. The suite is without the parts that have one, and without what
/// needs these. InputError for a text that is no map of a suite's keys.
Suite read_suite(const std::string& file, Mistakes& mistakes);

/// The keys of a test as text, each from the option of its name.
using TestKeys = std::map<std::string, std::string>;

/// The suite of a single claim from the command line. An estimator is "NAME=PLUGIN[,key=value]…"
/// with YAML flow values; a plugin that the claim names needs none.
struct CheckArguments {
  std::string claim;
  std::vector<std::string> estimators = {};
  std::optional<std::uint64_t> primaries = {};
  TestKeys keys = {};
};
Suite suite_of_claim(const CheckArguments&);

/// A test of `check` or `images`, without looking up its estimators.
TestEntry test_of(const std::string& command, const std::string& claim, const TestKeys& keys);

/// `--set estimator.key=value`: replaces or adds a parameter in every suite that has the estimator.
/// InputError if none has.
void set_parameter(std::vector<Suite>& suites, const std::string& assignment);

/// The entry that "NAME=PLUGIN[,key=value]…" describes.
EstimatorEntry parse_estimator_option(const std::string& text);

/// One entry for each estimator that a claim names, in order. The entry comes from `options`
/// ("NAME=PLUGIN…"), else it is the plugin of that name. `primaries` goes to all. Messages repeat
/// the command.
std::vector<EstimatorEntry> estimators_of(const std::vector<Source>& sources,
                                          const std::vector<std::string>& options,
                                          std::optional<std::uint64_t> primaries,
                                          const std::string& command);

/// The sources that the claim names, left to right.
std::vector<Source> sources_of(const Claim& claim);
/// The same, then the estimator of `reference:`.
std::vector<Source> sources_of(const TestEntry& test);

/// The line of the file with a caret under the column; "" if the file cannot be read.
std::string excerpt(const Location&);

// Protects files that a command reads from being overwritten by a report.

/// The suites' own files, and every file that an estimator's parameter names, relative to its
/// suite: recorded rows, programs, libraries.
std::vector<std::string> files_read(const std::vector<Suite>& suites);

/// InputError if the report would replace one of `kept`, by whichever path.
void refuse_overwriting(const std::string& report, const std::vector<std::string>& kept);

/// Reads the keys of a test beside its claim and name, as from a suite or the options of a command.
/// It checks that `allow` is below `detect` and that the claim uses every key. InputError at the
/// offending key.
void read_test_keys(const Document& document, const Value& map, TestEntry& test);

/// Reads an entry of `estimators:`. `scenes` is the suite's map `scenes:`.
EstimatorEntry read_estimator(const Document& document, const std::string& name, const Value& value,
                              const Value& scenes);

/// Sets `primaries` or a parameter of the plugin; the text of a `scene` may be one of `scenes`.
/// InputError if the plugin has no such parameter.
void set_parameter(EstimatorEntry& estimator, const std::string& key, const Value& value,
                   const Value& scenes);

/// InputError at the place of a name that no claim can use.
void require_estimator_name(const std::string& name, const Location& where);
/// The map with this value of the key.
Value with_member(const Value& map, const std::string& key, const Value& value);

// `assay images`: compares two sets of rendered pictures without a suite file.

struct ImagesArguments {
  std::string candidate;                    ///< A pattern of pictures, one observation each.
  std::string reference;                    ///< A pattern, or one file.
  std::string channels = "usual";           ///< Patterns separated by commas.
  bool independent_pixels = false;          ///< Pixels of one picture are independent.
  std::string quantity = "mean";            ///< Or "distribution".
  bool ignores_nonfinite = false;           ///< Leaves out pixels that are not finite somewhere.
  std::optional<std::string> mask = {};     ///< A picture; where it is 0 pixels are left out.
  std::optional<std::string> samples = {};  ///< For a reference that carries its variance.
  std::optional<std::string> within = {};
  TestKeys keys = {};  ///< Every layer's test has them.
};

/// The suite of the claim `mean(candidate) == mean(reference)`, or `within` a margin of it. Several
/// layers have a claim each, on `candidate_LAYER` and `reference_LAYER`. The usual channels include
/// alpha unless it is 1, or missing, throughout the first picture of each side. A single reference
/// file is a mean whose error its channels tell (pbrt's `Variance.*`, Mitsuba's `m2_*`), else
/// exact. InputError for pictures that cannot be compared, and options that contradict each other.
Suite suite_of_images(const ImagesArguments&);

}  // namespace assay::harness
