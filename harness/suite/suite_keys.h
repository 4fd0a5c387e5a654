#pragma once

#include <string>
#include <vector>

#include "harness/suite/yaml.h"

namespace assay::harness {

/// A map of a suite file. The constructor refuses unknown keys.
class Keys {
 public:
  /// `what` names the map in messages: "a suite", "a test". Messages offer the known keys.
  Keys(const Document& document, const Value& map, std::string what,
       const std::vector<std::string>& known);

  const Value* find(std::string_view key) const { return map_.find(key); }
  /// The value of the key. InputError at the map if it is missing, with a line to write.
  const Value& require(std::string_view key, std::string_view example) const;
  Location where(const Value& member) const { return document_.key(member); }

 private:
  const Document& document_;
  const Value& map_;
  std::string what_;
};

/// "; did you mean `x`?", or "; " and all candidates if none is near.
std::string suggestion(std::string_view name, const std::vector<std::string>& candidates);

/// True in [1e-9, 0.5]: a smaller rate, divided among tests and looks, is lost beside 1.
bool is_error_rate(double rate);

/// A finite number above 0; InputError at the value.
double positive_number(const Value& value, std::string_view what);
double error_rate(const Value& value, std::string_view what);  ///< is_error_rate
std::uint64_t count_from(const Value& value, std::string_view what, std::uint64_t least);

/// Non-empty text of one line; InputError otherwise.
std::string one_line(const Value& value, std::string_view what);

/// The index of the text among those allowed; InputError otherwise.
std::size_t choice(const Value& value, std::string_view what,
                   const std::vector<std::string>& allowed);

}  // namespace assay::harness
