#pragma once

#include "harness/command/commands.h"
#include "harness/sampling/prepare.h"
#include "reports/report_formats.h"
#include "tests/prelude.h"
#include "tests/reports/without_times.h"

namespace assay::harness {

using reports::Verdict;
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
  return run(suites, options, silence);
}

/// Options of a run whose tests can be replayed.
inline const RunOptions repeatable{.command = "assay run"};

inline std::map<std::string, PreparedEstimator> prepare_all(const Suite& suite) {
  std::map<std::string, PreparedEstimator> prepared;
  for (const EstimatorEntry& entry : suite.estimators) {
    prepared.emplace(entry.name, prepare(entry, suite.folder));
  }
  share_random_numbers(suite, prepared);
  return prepared;
}

/// tests/suites/good.yaml with more tests.
inline std::string good_suite(const std::string& more = "") {
  std::string text = tests::bytes_in(ASSAY_SOURCE_DIR "/tests/suites/good.yaml");
  return text.insert(text.find("statements:"), more);
}

/// The output of a command, and its exit code.
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

/// The suite of this text, beside the files of the place, run.
inline reports::Suite run_in(const Workplace& place, const std::string& text,
                             const RunOptions& options = {}) {
  return run_files({place.write("suite.yaml", text)}, options).suites[0];
}

/// All that a run says but when and how long: equal runs have equal texts.
inline std::string numbers_of(const reports::Record& record) {
  return reports::json(reports::without_times(record));
}

/// The first test of a suite given as text.
inline reports::Test run_test(const std::string& text, const RunOptions& options = {.threads = 1}) {
  return run_text(text, options).suites[0].tests[0];
}

/// A test alone, without what belongs to the run (Holm, times, the file it stood in).
inline reports::Test raw(reports::Test test) {
  test.file.clear();
  test.replay.clear();
  test.line = 0;
  for (reports::Sample& sample : test.samples) sample.cost.seconds = 0;
  for (reports::Channel& channel : test.channels) {
    channel.p_adjusted.reset();
    channel.log10_p_adjusted.reset();
  }
  return test;
}

/// The verdict, and words of the message.
inline void expect_said(const reports::Test& test, reports::Verdict verdict,
                        const std::vector<std::string>& all = {}) {
  EXPECT_EQ(test.verdict, verdict) << test.message;
  for (const std::string& words : all) EXPECT_THAT(test.message, HasSubstr(words));
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
