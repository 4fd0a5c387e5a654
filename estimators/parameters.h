#pragma once

// The parameters of a plugin: what it declares, and what a user gave.

#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "estimators/core/value.h"

namespace assay {

/// `texts` is a list of texts that are taken as they are written: the words of a command.
enum class ParameterType { number, count, boolean, string, texts, structure };

/// The numbers that a parameter may have.
struct NumberRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_excluded = false;
  bool high_excluded = false;
};

/// One parameter as the plugin declares it. `fallback` is YAML-like text; empty means required.
struct ParameterInformation {
  std::string name;
  ParameterType type = ParameterType::number;
  std::string summary;
  std::string unit = "";
  std::string fallback = "";
  NumberRange range = {};
  std::vector<std::string> choices = {};  ///< The only texts allowed of a string.
  std::string reason = "";                ///< Reason for the range, if that is not plain.
  /// False if no draw depends on it (a time-out): it is no part of the stream's key.
  bool shapes_draws = true;
};

/// The usual declarations, in one line each. `low` of above() is excluded.
inline NumberRange above(double low) { return {.low = low, .low_excluded = true}; }
ParameterInformation number_parameter(std::string name, std::string summary, std::string fallback,
                                      const NumberRange& range = {}, std::string unit = "");
ParameterInformation count_parameter(std::string name, std::string summary, std::string fallback,
                                     const NumberRange& range = {}, std::string unit = "");
ParameterInformation boolean_parameter(std::string name, std::string summary, bool fallback);
ParameterInformation text_parameter(std::string name, std::string summary,
                                    std::string fallback = "",
                                    std::vector<std::string> choices = {});
ParameterInformation structure_parameter(std::string name, std::string summary,
                                         std::string fallback = "", std::string unit = "");
/// The same, for a parameter that no draw depends on.
ParameterInformation beside_draws(ParameterInformation parameter);
/// One list and then the other.
std::vector<ParameterInformation> joined(std::vector<ParameterInformation> all,
                                         const std::vector<ParameterInformation>& more);

/// The values that a user gave for one estimator, checked against the plugin's declarations.
///
/// Errors are InputErrors that name plugin, parameter and the place in the file. They are for an
/// unknown name (with the nearest known one), a missing required one, a wrong type, and a value out
/// of range. The last is for a parameter that the plugin declares but never reads
/// (`require_all_read`).
class Parameters {
 public:
  /// `given` is a map, or null for none. Its place is used for a missing parameter. Relative file
  /// names are relative to `folder`.
  Parameters(std::string plugin, std::vector<ParameterInformation> declared, const Value& given,
             std::string folder);

  double number(std::string_view name);
  std::uint64_t count(std::string_view name);
  bool boolean(std::string_view name);
  std::string string(std::string_view name);
  /// A string with choices, as an enumeration that lists them in the same order.
  template <class Enumeration>
  Enumeration choice(std::string_view name) {
    return static_cast<Enumeration>(place_among_choices(name));
  }
  std::vector<std::string> texts(std::string_view name);
  /// A string that names a file, resolved against the folder of the suite.
  std::string file(std::string_view name);
  /// A list or map with a meaning of the plugin's own (a scene).
  const Value& structure(std::string_view name);
  /// True if the user wrote it; false if the fallback stands in.
  bool given(std::string_view name) const;
  /// The place to blame for a parameter's value.
  Location where(std::string_view name) const;
  /// An InputError at the parameter's place, beginning with plugin and parameter.
  [[noreturn]] void refuse(std::string_view name, const std::string& why) const;
  /// The same unless something holds.
  void require(bool holds, std::string_view name, const std::string& why) const;

  const std::string& plugin() const { return plugin_; }
  const std::string& folder() const { return folder_; }

  /// Throws std::logic_error when the plugin declares a parameter and never asked for it: a user's
  /// setting would be without effect.
  void require_all_read() const;

  /// Every declared parameter with its value, fallbacks included, names sorted.
  std::string canonical() const;
  /// The same restricted to `names`: a mutant's key is that of its original's parameters.
  std::string canonical(const std::vector<std::string>& names) const;

 private:
  const ParameterInformation& declared(std::string_view name) const;
  const Value& value(std::string_view name);
  std::size_t place_among_choices(std::string_view name);
  void check(const ParameterInformation&, const Value&) const;
  void in_range(const ParameterInformation&, double) const;
  void one_of(const ParameterInformation&, const std::string&) const;

  std::string plugin_;
  std::vector<ParameterInformation> declared_;
  std::map<std::string, Value, std::less<>> values_;
  std::set<std::string, std::less<>> given_;
  std::set<std::string, std::less<>> read_;
  Location where_;
  std::string folder_;
};

}  // namespace assay
