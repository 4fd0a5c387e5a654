#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "estimators/ready_made.h"
#include "recorded/table.h"
#include "tests/estimators/draws.h"

namespace assay {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A file of its own for every test, gone afterwards.
class Recorded : public ::testing::Test {
 protected:
  Recorded() {
    const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(::testing::TempDir()) /
              (std::string("assay_recorded_") + test->name());
    std::filesystem::create_directories(folder_);
  }
  ~Recorded() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& text) const {
    std::ofstream(folder_ / "data.txt", std::ios::binary) << text;
    return (folder_ / "data.txt").string();
  }
  recorded::Table read(const std::string& text) const { return recorded::read_table(write(text)); }

  struct Refusal {
    int line;
    int column;
    std::string message;
  };
  Refusal refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const InputError& error) {
      EXPECT_EQ(error.where().file, (folder_ / "data.txt").string());
      return {error.where().line, error.where().column, error.message()};
    }
    return {-1, -1, "nothing was refused"};
  }
  void expect_refused(const std::string& text, std::pair<int, int> place,
                      const std::string& message) const {
    const Refusal r = refusal(text);
    EXPECT_EQ(std::pair(r.line, r.column), place) << r.message;
    EXPECT_THAT(r.message, HasSubstr(message));
  }

  draws::Prepared prepare(const std::string& text, const std::string& more = "") const {
    write(text);
    return draws::prepare("recorded", "{file: data.txt" + more + "}", folder_.string());
  }

  std::filesystem::path folder_;
};

TEST_F(Recorded, ReadsColumnsByWhiteSpaceOrCommas) {
  const auto table = read("# columns: a b\n1 2.5\n-3e-2,\t4 # note\n\n  +5   6\r\n");
  EXPECT_THAT(table.columns, ElementsAre("a", "b"));
  EXPECT_THAT(table.values, ElementsAre(1, 2.5, -0.03, 4, 5, 6));
  EXPECT_EQ(table.rows(), 3u);
}

TEST_F(Recorded, KnowsWhereEachRowStands) {
  const draws::Prepared rows = prepare("# columns: a\n1\n\n2 # note\n# more\nnan\n");
  const std::string file = std::filesystem::weakly_canonical(folder_ / "data.txt").string();
  EXPECT_EQ(recorded::observation_place(*rows.setup, {.index = 0}), file + ":2");
  EXPECT_EQ(recorded::observation_place(*rows.setup, {.index = 1}), file + ":4");
  EXPECT_EQ(recorded::observation_place(*rows.setup, {.index = 2}), file + ":6");
  EXPECT_EQ(recorded::observation_place(*rows.setup, {.index = 3}), "");
}

TEST_F(Recorded, NamesColumnsThatHaveNone) {
  EXPECT_THAT(read("1\n2").columns, ElementsAre("value"));
  EXPECT_THAT(read("# made by hand\n1 2 3\n").columns, ElementsAre("value1", "value2", "value3"));
  EXPECT_THAT(read("\xef\xbb\xbf# columns: x, y\n1,2\n").columns, ElementsAre("x", "y"));
}

TEST_F(Recorded, KeepsValuesThatAreNotFinite) {
  const auto table = read("1 inf\n-inf nan\n");
  EXPECT_EQ(table.values[1], std::numeric_limits<double>::infinity());
  EXPECT_EQ(table.values[2], -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(table.values[3]));
}

TEST_F(Recorded, KeepsEveryBitOfANumber) {
  EXPECT_EQ(read("0.1\n").values[0], 0.1);
  EXPECT_EQ(read("1.7976931348623157e308\n").values[0], std::numeric_limits<double>::max());
  EXPECT_EQ(read("4.9406564584124654e-324\n").values[0], std::numeric_limits<double>::denorm_min());
}

TEST_F(Recorded, RefusesJunk) {
  expect_refused("1\n2\nthree\n", {3, 1}, "`three` is not a number");
  expect_refused("1 2x\n", {1, 3}, "`2x` is not a number");
  expect_refused("a,b\n1,2\n", {1, 1}, "# columns: a b");
  expect_refused("1,2 3\n", {1, 3}, "`2 3` is not a number");
  expect_refused("+-1\n", {1, 1}, "`+-1` is not a number");
  expect_refused("0x10\n", {1, 1}, "is not a number");
}

TEST_F(Recorded, RefusesWhatNoDoubleCanHold) {
  expect_refused("1\n 1e999\n", {2, 2}, "beyond what a double can hold");
}

TEST_F(Recorded, RefusesAnEmptyField) {
  expect_refused("1,,3\n", {1, 3}, "a number is missing");
  expect_refused("1,\n", {1, 3}, "a number is missing");
}

TEST_F(Recorded, RefusesRaggedRows) {
  expect_refused("1 2\n3\n", {2, 1}, "numbers in this row: 1, but columns: 2");
  expect_refused("1 2\n3 4 5\n", {2, 5}, "numbers in this row: 3, but columns: 2");
  expect_refused("# columns: a\n1 2\n", {2, 3}, "numbers in this row: 2, but columns: 1");
}

TEST_F(Recorded, RefusesBadHeaders) {
  expect_refused("# columns: a a\n1 2\n", {1, 14}, "two columns `a`");
  expect_refused("# columns: a,,b\n1 2\n", {1, 14}, "the name of a column is empty");
  expect_refused("# columns:\n1\n", {1, 3}, "names no column");
  expect_refused("1\n# columns: a\n", {2, 3}, "before the first row");
  expect_refused("# columns: a\n# columns: b\n1\n", {2, 3}, "must stand once");
}

TEST_F(Recorded, RefusesAFileWithoutRows) {
  expect_refused("", {0, 0}, "no rows");
  expect_refused("# columns: a\n\n", {0, 0}, "no rows");
}

TEST_F(Recorded, RefusesAFileThatIsNotThere) {
  EXPECT_THROW(recorded::read_table((folder_ / "none.txt").string()), InputError);
  try {
    draws::prepare("recorded", "{file: none.txt}", folder_.string());
    FAIL() << "a missing file was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.message(), HasSubstr("none.txt"));
    EXPECT_THAT(error.message(), HasSubstr("cannot be read: No such file or directory"));
  }
}

TEST_F(Recorded, RefusesAFolder) {
  try {
    draws::prepare("recorded", "{file: .}", folder_.string());
    FAIL() << "a folder was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.message(), HasSubstr("cannot be read: it is a folder"));
  }
}

TEST_F(Recorded, ObservationIsTheRow) {
  const auto plugin = prepare("# columns: a b\n1 2\n3 4\n5 6\n");
  EXPECT_EQ(plugin.setup->observations(), 3u);
  EXPECT_FALSE(plugin.information.averages);
  const auto channels = plugin.setup->channels();
  ASSERT_EQ(channels.size(), 2u);
  EXPECT_EQ(channels[0].name, "a");
  EXPECT_FALSE(channels[0].mean.has_value());
  const auto samples = draws::observe(plugin, 3);
  EXPECT_THAT(samples[0].values, ElementsAre(1, 3, 5));
  EXPECT_THAT(samples[1].values, ElementsAre(2, 4, 6));
}

TEST_F(Recorded, AnyObservationCanBeReadAlone) {
  const auto plugin = prepare("1\n2\n3\n");
  double out = 0;
  Cost cost;
  Stream random(plugin.key, 2);
  plugin.setup->make()->secondary(random, 1, {&out, 1}, cost);
  EXPECT_EQ(out, 3);
}

TEST_F(Recorded, PicksOneColumn) {
  const auto plugin = prepare("# columns: a b\n1 2\n3 4\n", ", column: b");
  ASSERT_EQ(plugin.setup->channels().size(), 1u);
  EXPECT_EQ(plugin.setup->channels()[0].name, "b");
  EXPECT_THAT(draws::observe(plugin, 2)[0].values, ElementsAre(2, 4));
}

TEST_F(Recorded, RefusesAColumnThatIsNotThere) {
  try {
    prepare("# columns: a b\n1 2\n", ", column: c");
    FAIL() << "an unknown column was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(
        error.message(),
        HasSubstr("parameter `column` must be a column of the file, but it is `c`; there is: "
                  "`a`, `b`"));
    EXPECT_THAT(error.message(), HasSubstr("`a`, `b`"));
  }
}

TEST_F(Recorded, RefusesMoreThanItHas) {
  const auto plugin = prepare("1\n2\n");
  EXPECT_THROW(draws::observe(plugin, 3), std::out_of_range);
  EXPECT_THROW(draws::observe(plugin, 1, 2), std::invalid_argument);
}

}  // namespace
}  // namespace assay
