#include "harness/ledger/ledger_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace assay::harness {
namespace {

constexpr std::string_view escaped = "\"\\\n\t\r";
constexpr std::string_view letters = "\"\\ntr";

template <class Value>
std::optional<Value> whole(std::string_view word) {
  Value value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const std::size_t at = escaped.find(c);
    if (at == std::string_view::npos) {
      out += c;
    } else {
      out += std::string("\\") + letters[at];
    }
  }
  return out + "\"";
}

std::string with_check(const std::string& line, std::uint64_t hash) {
  return fmt::format("{} | {:08x}", line, hash & 0xffffffffU);
}

std::pair<std::string_view, std::string_view> split_check(std::string_view line) {
  const std::size_t bar = line.rfind(" | ");
  if (bar == std::string_view::npos) return {line, {}};
  return {line.substr(0, bar), line.substr(bar + 3)};
}

void LineFields::skip_blanks() {
  rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
}

std::string_view LineFields::next() {
  skip_blanks();
  return rest_.substr(0, rest_.find(' '));
}

bool LineFields::word(std::string_view wanted) {
  if (next() != wanted) return false;
  rest_.remove_prefix(wanted.size());
  return true;
}

std::optional<std::string> LineFields::any_word() {
  const std::string_view found = next();
  if (found.empty() || found.front() == '"') return std::nullopt;
  rest_.remove_prefix(found.size());
  return std::string(found);
}

std::optional<std::uint64_t> LineFields::count() {
  const std::string_view found = next();
  rest_.remove_prefix(found.size());
  return whole<std::uint64_t>(found);
}

std::optional<double> LineFields::number() {
  const std::string_view found = next();
  rest_.remove_prefix(found.size());
  const std::optional<double> value = whole<double>(found);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<std::string> LineFields::text() {
  skip_blanks();
  if (!rest_.starts_with('"')) return std::nullopt;
  std::string out;
  for (std::size_t i = 1; i < rest_.size(); ++i) {
    if (rest_[i] == '"') {
      rest_.remove_prefix(i + 1);
      return out;
    }
    if (rest_[i] != '\\') {
      out += rest_[i];
      continue;
    }
    const std::size_t at = ++i < rest_.size() ? letters.find(rest_[i]) : std::string_view::npos;
    if (at == std::string_view::npos) return std::nullopt;
    out += escaped[at];
  }
  return std::nullopt;
}

bool LineFields::at_end() {
  skip_blanks();
  return rest_.empty();
}

}  // namespace assay::harness
