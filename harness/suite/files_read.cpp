#include "harness/suite/files_read.h"

#include <algorithm>
#include <filesystem>

namespace assay::harness {
namespace {

namespace fs = std::filesystem;

/// Compares files that exist, or one that the command is about to make.
bool is_same_file(const std::string& one, const std::string& other) {
  std::error_code failure;
  if (fs::equivalent(one, other, failure)) return true;
  const auto whole = [&](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(path, failure), failure);
  };
  return whole(one) == whole(other);
}

void add_named_files(const Value& value, const fs::path& folder, std::vector<std::string>& files) {
  std::error_code failure;
  const fs::path path = folder / value.text();
  if (value.kind() == Value::Kind::scalar && fs::is_regular_file(path, failure)) {
    files.push_back(path.string());
  }
  for (const Value& item : value.items()) add_named_files(item, folder, files);
  for (const auto& [key, member] : value.members()) add_named_files(member, folder, files);
}

}  // namespace

std::vector<std::string> files_read(const std::vector<Suite>& suites) {
  std::vector<std::string> files;
  for (const Suite& suite : suites) {
    if (!suite.file.empty()) files.push_back(suite.file);
    for (const EstimatorEntry& estimator : suite.estimators) {
      add_named_files(estimator.parameters, suite.folder, files);
    }
  }
  return files;
}

void refuse_overwriting(const std::string& report, const std::vector<std::string>& kept) {
  const bool overwrites = std::ranges::any_of(
      kept, [&](const std::string& file) { return is_same_file(report, file); });
  if (!overwrites) return;
  throw InputError({.file = report},
                   "is read or kept by this very command, and a report would replace it; name "
                   "another file for the report");
}

}  // namespace assay::harness
