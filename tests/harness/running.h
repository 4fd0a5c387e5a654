#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/command/run.h"
#include "reports/formats/json.h"

namespace assay::harness {

/// A folder of the current test alone, removed at its end.
class Workplace {
 public:
  Workplace() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    // Two builds may be tested at once.
    path_ = std::filesystem::temp_directory_path() /
            fmt::format("assay_{}_{}_{}", info->test_suite_name(), info->name(), getpid());
    std::filesystem::create_directories(path_);
  }
  ~Workplace() { std::filesystem::remove_all(path_); }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

inline reports::Record run_files(const std::vector<std::string>& files,
                                 const RunOptions& options = {}) {
  std::vector<Suite> suites;
  for (const std::string& file : files) suites.push_back(load_suite(file));
  Silence silence;
  return run(suites, options, silence);
}

/// Runs a suite given as text.
inline reports::Record run_text(const std::string& text, const RunOptions& options = {}) {
  const Workplace place;
  return run_files({place.write("suite.yaml", text)}, options);
}

/// All that a run says but when and how long: equal runs have equal texts.
inline std::string numbers_of(const reports::Record& record) {
  return reports::json(reports::without_times(record));
}

/// The only test of a suite given as text, run on one thread.
inline reports::Test run_test(const std::string& text) {
  return run_text(text, {.threads = 1}).suites[0].tests[0];
}

/// Its verdict; the message is kept for when the verdict is not the one expected.
inline reports::Verdict run_verdict(const std::string& text) {
  const reports::Test result = run_test(text);
  testing::Test::RecordProperty("message", result.message);
  return result.verdict;
}

inline const reports::Test& test_named(const reports::Record& record, const std::string& name) {
  for (const reports::Suite& suite : record.suites) {
    for (const reports::Test& test : suite.tests) {
      if (test.name == name) return test;
    }
  }
  throw std::out_of_range("no test named " + name);
}

}  // namespace assay::harness
