#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "harness/command/run.h"
#include "reports/formats/json.h"
#include "tests/prelude.h"
#include "tests/reports/without_times.h"

namespace assay::harness {

using Workplace = tests::Folder;

/// A test with one.
class Placed : public Test {
 protected:
  const Workplace place;
};

inline reports::Record run_files(const std::vector<std::string>& files,
                                 const RunOptions& options = {}) {
  std::vector<Suite> suites;
  for (const std::string& file : files) suites.push_back(load_suite(file));
  Silence silence;
  return run(suites, options, silence);
}

/// What a command prints, and its exit code.
struct Said {
  int code = 0;
  std::string text;
  std::string errors;
};

inline Said said_by(const std::function<int()>& command) {
  internal::CaptureStdout();
  internal::CaptureStderr();
  Said said{.code = command()};
  std::fflush(stdout);
  std::fflush(stderr);
  said.text = internal::GetCapturedStdout();
  said.errors = internal::GetCapturedStderr();
  return said;
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
