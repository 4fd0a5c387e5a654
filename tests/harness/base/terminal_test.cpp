#include "harness/base/terminal.h"

#include "reports/words/text.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

using namespace std::chrono_literals;

/// A clock that the test turns.
struct Hands {
  std::chrono::steady_clock::time_point time{1h};
  Clock clock() {
    return [this] { return time; };
  }
};

TEST(ProgressText, CountsUnitsOrSaysWhichPartIsDone) {
  EXPECT_EQ(progress_text({.total = 149, .unit = "claims"}, 31), "31 of 149 claims");
  EXPECT_EQ(progress_text({"calibration", 3000, "runs"}, 1290), "calibration  1290 of 3000 runs");
  // Rounded down, so that 100 % means all.
  EXPECT_EQ(progress_text({.name = "pilot", .total = 1000}, 999), "pilot  99 %");
  EXPECT_EQ(progress_text({.name = "pilot", .total = 1000}, 1000), "pilot  100 %");
  EXPECT_EQ(progress_text({.name = "pilot"}, 7), "pilot  0 %");
}

/// A bar of the width, and the text that it has written.
struct Bar {
  std::ostringstream out = {};
  Hands hands = {};
  int width = 80;
  ProgressLine bar{out, true, hands.clock(), [this] { return width; }};

  std::string last() const { return out.str().substr(out.str().rfind("\033[K") + 3); }
};

TEST(ProgressBar, RedrawsAtMostTenTimesASecond) {
  Bar shown;
  shown.bar.begin({.total = 1000, .unit = "claims"});
  for (std::uint64_t i = 1; i <= 1000; ++i) {
    shown.hands.time += 1ms;
    shown.bar.advance(i);
  }
  const std::string text = shown.out.str();
  EXPECT_EQ(std::ranges::count(text, '\r'), 11);
  EXPECT_THAT(text, HasSubstr("[#############.............] 500 of 1000 claims  0 s"));
  EXPECT_EQ(text.find('\n'), std::string::npos);
}

TEST(ProgressBar, TellsTheTimeOfAllPhasesAndWipesItself) {
  Bar shown;
  shown.bar.begin({.name = "pilot", .total = 100});
  shown.hands.time += 10s;
  shown.bar.end();
  shown.bar.begin({.total = 4, .unit = "claims"});
  shown.hands.time += 2s;
  shown.bar.advance(1);
  EXPECT_EQ(shown.last(), "[######....................] 1 of 4 claims  12 s");
  shown.bar.end();
  EXPECT_TRUE(shown.out.str().ends_with("\r\033[K"));
}

TEST(ProgressBar, IsWipedWhereAMistakeEndsTheRun) {
  std::ostringstream out;
  { ProgressLine(out, true).begin({.total = 4, .unit = "claims"}); }
  EXPECT_TRUE(out.str().ends_with("\r\033[K"));
  const std::string all = out.str();
  std::ostringstream other;
  say_beside_progress("it is slow", other);
  EXPECT_EQ(out.str(), all);
}

TEST(ProgressLines, AreOneAMinute) {
  std::ostringstream out;
  Hands hands;
  ProgressLine lines(out, false, hands.clock());
  lines.begin({.total = 150, .unit = "claims"});
  for (std::uint64_t i = 0; i < 150; ++i, hands.time += 1s) lines.advance(i);
  EXPECT_EQ(out.str(), "assay: 60 of 150 claims  60 s\nassay: 120 of 150 claims  120 s\n");
}

// The last column stays free: a line that fills it scrolls on some terminals.
TEST(ProgressBar, IsCutToTheWidthOfTheTerminalAsItIs) {
  Bar shown;
  shown.bar.begin({.total = 1000, .unit = "claims"});
  for (const int width : {120, 60, 30, 20, 10}) {
    shown.width = width;
    shown.hands.time += 1s;
    shown.bar.advance(500);
    EXPECT_LT(reports::columns(shown.last()), width) << shown.last();
  }
}

TEST(ProgressBar, GivesWayToASentence) {
  Bar shown;
  shown.bar.begin({.name = "pilot", .total = 100});
  const std::string before = shown.out.str();
  std::ostringstream other;
  say_beside_progress("it is slow", other);
  EXPECT_EQ(shown.out.str(), before + "\r\033[K");
  EXPECT_EQ(other.str(), "assay: it is slow\n");
  shown.hands.time += 1s;
  shown.bar.advance(50);
  EXPECT_THAT(shown.last(), HasSubstr("pilot  50 % (1 s left)  1 s"));
  shown.bar.end();
  const std::string ended = shown.out.str();
  say_beside_progress("it is slow", other);
  EXPECT_EQ(shown.out.str(), ended);
}

TEST(ProgressBar, StandsMoreDoneThanAnnounced) {
  Bar shown;
  shown.bar.begin({.name = "pilot", .total = 10});
  shown.hands.time += 1s;
  shown.bar.advance(20);
  EXPECT_THAT(shown.last(), HasSubstr("100 %"));
}

TEST(Terminal, WithoutATerminalTheWidthIsThatOfTheEnvironmentOrUsual) {
  std::FILE* file = std::tmpfile();
  ASSERT_NE(file, nullptr);
  unsetenv("COLUMNS");
  EXPECT_EQ(terminal_width(file), 80);
  setenv("COLUMNS", "132", 1);
  EXPECT_EQ(terminal_width(file), 132);
  setenv("COLUMNS", "wide", 1);
  EXPECT_EQ(terminal_width(file), 80);
  unsetenv("COLUMNS");
  std::fclose(file);
}

}  // namespace
}  // namespace assay::harness
