#include "reports/console.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <sstream>

#include "reports/columns.h"
#include "reports/text.h"
#include "tests/reports/example_record.h"
#include "tests/reports/random_record.h"

namespace assay::reports {
namespace {

std::vector<std::string> lines(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> result;
  for (std::string line; std::getline(in, line);) result.push_back(line);
  return result;
}

TEST(Console, TheLastLineCounts) {
  const auto all = lines(console(example_record()));
  EXPECT_EQ(all.back(), "4 passed, 5 failed, 3 skipped");
  EXPECT_EQ(all[all.size() - 2], "2 inconclusive (counted as skipped below)");
  EXPECT_EQ(lines(console(Record{})).back(), "0 passed, 0 failed, 0 skipped");
}

TEST(Console, WhatIsNotOkIsExplainedAndWhatIsOkIsNot) {
  const std::string text = console(example_record());
  EXPECT_NE(text.find("replay           assay replay run.json 'triangle/mean(winners)"),
            std::string::npos);
  EXPECT_EQ(text.find("replay           assay replay run.json 'triangle/mean(area)"),
            std::string::npos);
  EXPECT_NE(console(example_record(), {.verbose = true})
                .find("replay           assay replay run.json 'triangle/mean(area)"),
            std::string::npos);
}

TEST(Console, ColourIsWrittenOnlyWhenAskedFor) {
  EXPECT_EQ(console(example_record()).find('\x1b'), std::string::npos);
  EXPECT_NE(console(example_record(), {.colour = true}).find("\x1b[1;31m"), std::string::npos);
}

TEST(Console, ColourChangesNoText) {
  const std::string coloured = console(example_record(), {.colour = true});
  std::string bare;
  for (std::size_t i = 0; i < coloured.size(); ++i) {
    if (coloured[i] == '\x1b')
      i = coloured.find('m', i);
    else
      bare += coloured[i];
  }
  EXPECT_EQ(bare, console(example_record()));
}

RC_GTEST_PROP(Console, NoLineIsWiderThanAskedFor, ()) {
  const Record record = random_record();
  const int width = *rc::gen::element(60, 80, 100, 200);
  const bool verbose = *rc::gen::arbitrary<bool>();
  const std::string text = console(record, {.width = width, .verbose = verbose});
  for (const std::string& line : lines(text)) RC_ASSERT(columns(line) <= width);
  RC_ASSERT(clean(text) == text);
}

}  // namespace
}  // namespace assay::reports
