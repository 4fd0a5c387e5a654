#pragma once

// Reading maps of a suite strictly.

#include <string>
#include <vector>

#include "harness/suite/yaml.h"

namespace assay::harness {

/// A map of a suite file of which all keys are known. Refuses unknown ones when it is made.
class Keys {
 public:
  /// `what` names the map in messages: "a suite", "a test". Messages offer the keys of `known`;
  /// those of `reserved` are read as well.
  Keys(const Document& document, const Value& map, std::string what,
       const std::vector<std::string>& known, const std::vector<std::string>& reserved = {});

  const Value* find(std::string_view key) const { return map_.find(key); }
  /// InputError at the map when the key is not there, with a line to write instead.
  const Value& require(std::string_view key, std::string_view example) const;
  Location where(const Value& member) const { return document_.key(member); }

 private:
  const Document& document_;
  const Value& map_;
  std::string what_;
};

/// "; did you mean `x`?", or "; " and the candidates where none is near.
std::string suggestion(std::string_view name, const std::vector<std::string>& candidates);

/// In [1e-9, 0.5]: shares of less, of many tests or looks, would be lost beside 1 in a confidence.
bool is_error_rate(double rate);

/// Finite numbers in a range that `what` must have; InputError at the value.
double positive_number(const Value& value, std::string_view what);
double error_rate(const Value& value, std::string_view what);  ///< is_error_rate
std::uint64_t count_from(const Value& value, std::string_view what, std::uint64_t least);

/// Text that is not empty and has one line.
std::string one_line(const Value& value, std::string_view what);

/// The index of a text among those allowed.
std::size_t choice(const Value& value, std::string_view what,
                   const std::vector<std::string>& allowed);

}  // namespace assay::harness
