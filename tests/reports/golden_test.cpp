// Every writer against an approved file.

#include "reports/report_formats.h"
#include "tests/reports/approved.h"
#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

TEST(Approved, JsonIsAsApproved) { expect_approved("record.json", json(example_record())); }

TEST(Approved, JunitIsAsApproved) { expect_approved("junit.xml", junit(example_record())); }

TEST(Approved, MarkdownIsAsApproved) { expect_approved("report.md", markdown(example_record())); }

TEST(Approved, ConsoleIsAsApproved) {
  expect_approved("console.txt", console(example_record()));
  expect_approved("console-60.txt", console(example_record(), {.width = 60, .slowest = 2}));
  expect_approved("console-v.txt", console(example_record(), {.detail = 1}));
  expect_approved("console-vv.txt", console(example_record(), {.width = 100, .detail = 2}));
}

TEST(Approved, MetricsAreAsApproved) { expect_approved("metrics.txt", metrics(example_record())); }

TEST(Approved, AnnotationsAreAsApproved) {
  expect_approved("annotations.txt", annotations(example_record()));
}

TEST(Approved, ExplanationsAreAsApproved) {
  std::string text;
  for (const Suite& suite : example_record().suites) {
    for (const reports::Test& test : suite.tests) text += explain(suite, test, 80) + "\n";
  }
  // What would have been noticed is said where the suite asks to catch nothing.
  reports::Test alarm = passing();
  alarm.detect.reset();
  expect_approved("explain.txt", text + explain(example_record().suites[0], alarm, 80));
}

}  // namespace
}  // namespace assay::reports
