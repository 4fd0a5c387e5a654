#pragma once

// Readers of options' values. Each takes the text and the option's name, and throws an InputError
// that names the option.

#include <cstdint>
#include <string>
#include <utility>

#include "harness/record/output.h"
#include "harness/suite/yaml.h"

namespace assay::harness {

/// A whole number, `least` or more.
inline auto at_least(std::uint64_t least) {
  return [least](const std::string& text, const std::string& option) {
    return count_from(Value::scalar(text), option, least);
  };
}

unsigned read_threads(const std::string& text, const std::string& option);
/// A number, as a reader of suites takes it.
template <double (*read)(const Value&, std::string_view)>
double read_number(const std::string& text, const std::string& option) {
  return read(Value::scalar(text), option);
}
inline constexpr auto read_error_rate = read_number<error_rate>;
inline constexpr auto read_positive = read_number<positive_number>;

/// A count, or `random`: 64 bits from the operating system.
std::uint64_t read_seed(const std::string& text, const std::string& option);

/// "I/N" with 1 <= I <= N.
std::pair<unsigned, unsigned> read_shard(const std::string& text, const std::string& option);

/// "KIND=PATH" with a known kind.
ReportRequest read_report(const std::string& text, const std::string& option);

/// One of the words, as the value beside it.
template <class T>
struct OneOf {
  std::vector<std::pair<std::string, T>> meanings;

  std::vector<std::string> words() const {
    std::vector<std::string> all;
    for (const auto& [word, meaning] : meanings) all.push_back(word);
    return all;
  }
  T operator()(const std::string& text, const std::string& option) const {
    return meanings[choice(Value::scalar(text), option, words())].second;
  }
};

}  // namespace assay::harness
