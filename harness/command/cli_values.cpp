#include "harness/command/cli_values.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <limits>
#include <system_error>

#include "harness/suite/suite_keys.h"
#include "reports/report_formats.h"

namespace assay::harness {

namespace {

/// Functions for suites read options too: they say "it is `x`" at a place, and an option has none.
Value given(const std::string& text) { return Value::scalar(text); }

std::uint64_t random_seed() {
  std::uint64_t seed = 0;
  if (getrandom(&seed, sizeof seed, 0) != static_cast<ssize_t>(sizeof seed)) {
    throw std::system_error(errno, std::generic_category(), "no random seed from the system");
  }
  return seed;
}

/// A report's kind alone, or a path by its ending, completed.
std::string meant_report(std::string text) {
  while (text.ends_with('=')) text.pop_back();
  const std::string ending = text.substr(std::min(text.rfind('.') + 1, text.size()));
  for (const reports::ReportFormat& format : reports::report_formats()) {
    if (text == format.kind) return fmt::format("{}=run.{}", format.kind, format.ending);
    if (ending == format.ending) return fmt::format("{}={}", format.kind, text);
  }
  return "html=run.html";
}

unsigned shard_number(const std::string& text) {
  const std::uint64_t number = parse_count(text, "each number of --shard I/N", 1);
  if (number > std::numeric_limits<unsigned>::max()) throw InputError({}, "--shard is too large");
  return static_cast<unsigned>(number);
}

}  // namespace

std::uint64_t parse_count(const std::string& text, const char* option, std::uint64_t least) {
  return count_from(given(text), option, least);
}

double parse_rate(const std::string& text, const char* option) {
  return error_rate(given(text), option);
}

double parse_positive(const std::string& text, const char* option) {
  return positive_number(given(text), option);
}

std::uint64_t parse_seed(const std::string& text) {
  if (text == "random") return random_seed();
  try {
    return parse_count(text, "--seed", 0);
  } catch (const InputError&) {
    throw InputError(
        {}, fmt::format("--seed must be a whole number from 0 to {}, or `random`, but it is `{}`",
                        std::numeric_limits<std::uint64_t>::max(), text));
  }
}

std::pair<unsigned, unsigned> parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) {
    throw InputError({}, fmt::format("--shard must be I/N, as in 2/5, but it is `{}`", text));
  }
  const unsigned index = shard_number(text.substr(0, slash));
  const unsigned shards = shard_number(text.substr(slash + 1));
  if (index > shards) {
    throw InputError({},
                     fmt::format("--shard {}: there is no shard {} of {}", text, index, shards));
  }
  return {index, shards};
}

ReportRequest parse_report(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (text == "console") return {text, "-"};  // the kind for reading at once
  if (equals == std::string::npos || equals + 1 == text.size()) {
    throw InputError({}, fmt::format("--report must be KIND=PATH, but it is `{}`; write "
                                     "`--report {}`, where the path - is standard output",
                                     text, meant_report(text)));
  }
  const std::string kind = text.substr(0, equals);
  std::vector<std::string> kinds;
  for (const reports::ReportFormat& format : reports::report_formats()) {
    kinds.push_back(format.kind);
  }
  choice(given(kind), "the kind of --report", kinds);
  return {kind, text.substr(equals + 1)};
}

bool parse_github(const std::string& text) {
  return choice(given(text), "--github", {"auto", "never"}) == 0;
}

Colour parse_colour(const std::string& text) {
  return static_cast<Colour>(choice(given(text), "--color", {"auto", "always", "never"}));
}

InconclusivePolicy parse_inconclusive(const std::string& text) {
  const std::size_t index = choice(given(text), "--inconclusive", {"fail", "pass"});
  return index == 0 ? InconclusivePolicy::fail : InconclusivePolicy::pass;
}

}  // namespace assay::harness
