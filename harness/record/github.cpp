#include "harness/record/github.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "reports/formats/annotations.h"
#include "reports/formats/markdown.h"

namespace assay::harness {
namespace {

// Less room would hold no readable summary.
constexpr std::size_t least_summary = 2048;

/// The error, or "" if the summary was written.
std::string append_summary(const reports::Record& record, const std::string& file) {
  std::error_code none;
  const std::uintmax_t there =
      std::filesystem::exists(file, none) ? std::filesystem::file_size(file, none) : 0;
  if (there + least_summary > reports::markdown_limit) {
    return "the step's summary is full: this run has none there";
  }
  const std::size_t room = reports::markdown_limit - static_cast<std::size_t>(there);
  std::ofstream stream(file, std::ios::app | std::ios::binary);
  stream << reports::markdown(record, room) << '\n' << std::flush;
  return stream ? "" : "the step's summary cannot be written";
}

}  // namespace

std::string tell_github(const reports::Record& record, const Environment& environment) {
  if (environment("GITHUB_ACTIONS") != "true") return "";
  std::string text = reports::annotations(record);
  const std::string file = environment("GITHUB_STEP_SUMMARY");
  if (file.empty()) return text;
  const std::string trouble = append_summary(record, file);
  if (!trouble.empty()) text += fmt::format("::warning title=assay::{}\n", trouble);
  return text;
}

}  // namespace assay::harness
