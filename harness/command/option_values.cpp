#include "harness/command/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <random>

#include "reports/report_formats.h"

namespace assay::harness {

namespace {

std::uint64_t random_seed() {
  std::random_device words;
  return std::uint64_t{words()} << 32U | words();
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

}  // namespace

unsigned read_threads(const std::string& text, const std::string& option) {
  constexpr std::uint64_t most = 4096;
  return static_cast<unsigned>(std::min(at_least(1)(text, option), most));
}

std::uint64_t read_seed(const std::string& text, const std::string& option) {
  if (text == "random") return random_seed();
  try {
    return at_least(0)(text, option);
  } catch (const InputError&) {
    refuse({}, "{} must be a whole number from 0 to {}, or `random`, but it is `{}`", option,
           std::numeric_limits<std::uint64_t>::max(), text);
  }
}

std::pair<unsigned, unsigned> read_shard(const std::string& text, const std::string& option) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) {
    refuse({}, "{} must be I/N, as in 2/5, but it is `{}`", option, text);
  }
  const auto number = [&](const std::string& digits) {
    const std::uint64_t read = at_least(1)(digits, fmt::format("each number of {} I/N", option));
    if (read <= std::numeric_limits<unsigned>::max()) return static_cast<unsigned>(read);
    refuse({}, option + " is too large");
  };
  const unsigned index = number(text.substr(0, slash));
  const unsigned shards = number(text.substr(slash + 1));
  if (index <= shards) return {index, shards};
  refuse({}, "{} {}: there is no shard {} of {}", option, text, index, shards);
}

ReportRequest read_report(const std::string& text, const std::string& option) {
  const std::size_t equals = text.find('=');
  if (text == "console") return {text, "-"};  // the kind for reading at once
  if (equals == std::string::npos || equals + 1 == text.size()) {
    refuse({},
           "{0} must be KIND=PATH, but it is `{1}`; write `{0} {2}`, where the path - is standard "
           "output",
           option, text, meant_report(text));
  }
  const std::string kind = text.substr(0, equals);
  const auto kinds = names_of(reports::report_formats(), &reports::ReportFormat::kind);
  choice(Value::scalar(kind), "the kind of " + option, kinds);
  for (const std::string& other : kinds) {
    const std::size_t comma = text.find("," + other + "=");
    if (comma == std::string::npos) continue;
    refuse({}, "a blank stands between two reports: write `{} {} {}`", option,
           text.substr(0, comma), text.substr(comma + 1));
  }
  return {kind, text.substr(equals + 1)};
}

}  // namespace assay::harness
