#include "harness/base/progress_terminal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace assay::harness {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// A clock that the test turns.
struct Hands {
  std::chrono::steady_clock::time_point time{1h};
  Clock clock() {
    return [this] { return time; };
  }
};

TEST(ProgressText, RoundsDownSoThatAHundredMeansAll) {
  EXPECT_EQ(progress_text("sampling", 999, 1000), "sampling  99 %  999 of 1000 primaries");
  EXPECT_EQ(progress_text("sampling", 1000, 1000), "sampling  100 %  1000 of 1000 primaries");
  EXPECT_EQ(progress_text("pilot", 7, 0), "pilot  7 primaries");
  EXPECT_EQ(progress_text("sampling", 2'340'000, 62'000'000),
            "sampling  3 %  2.3 of 62.0 million primaries");
}

TEST(ProgressBar, RedrawsAtMostTenTimesASecond) {
  std::ostringstream out;
  Hands hands;
  ProgressBar bar(out, hands.clock());
  bar.begin("sampling", 1000);
  for (std::uint64_t i = 1; i <= 1000; ++i) {
    hands.time += 1ms;
    bar.advance(i);
  }
  const std::string text = out.str();
  EXPECT_EQ(std::ranges::count(text, '\r'), 11);
  EXPECT_THAT(text, HasSubstr("[###############...............] sampling  50 %  500 of 1000"));
  EXPECT_EQ(text.find('\n'), std::string::npos);
}

TEST(ProgressBar, TellsWhatRemainsAndWipesItself) {
  std::ostringstream out;
  Hands hands;
  ProgressBar bar(out, hands.clock());
  bar.begin("sampling", 100);
  hands.time += 10s;
  bar.advance(25);
  EXPECT_THAT(out.str(), HasSubstr("30 s left"));
  bar.end();
  EXPECT_TRUE(out.str().ends_with("\r\033[K"));
}

TEST(ProgressBar, GivesWayToASentence) {
  std::ostringstream out;
  Hands hands;
  ProgressBar bar(out, hands.clock());
  bar.begin("sampling", 100);
  const std::string before = out.str();
  say_beside_progress("it is slow", out);
  EXPECT_EQ(out.str(), before + "\r\033[Kassay: it is slow\n");
  hands.time += 1s;
  bar.advance(50);
  EXPECT_THAT(out.str(), HasSubstr("it is slow\n\r\033[K[###############"));
  bar.end();
  std::ostringstream without;
  say_beside_progress("it is slow", without);
  EXPECT_EQ(without.str(), "assay: it is slow\n");
}

TEST(ProgressBar, StandsMoreDoneThanAnnounced) {
  std::ostringstream out;
  Hands hands;
  ProgressBar bar(out, hands.clock());
  bar.begin("sampling", 10);
  hands.time += 1s;
  bar.advance(20);
  EXPECT_THAT(out.str(), HasSubstr("100 %  20 of 10"));
}

TEST(ProgressLines, SpeakAtMostEveryHalfMinute) {
  std::ostringstream out;
  Hands hands;
  ProgressLines lines(out, hands.clock());
  lines.begin("sampling", 100);
  for (std::uint64_t second = 1; second <= 70; ++second) {
    hands.time += 1s;
    lines.advance(second);
  }
  lines.end();
  EXPECT_EQ(out.str(),
            "assay: sampling  30 %  30 of 100 primaries\n"
            "assay: sampling  60 %  60 of 100 primaries\n");
}

TEST(ProgressLines, SayNothingOfAShortRun) {
  std::ostringstream out;
  Hands hands;
  ProgressLines lines(out, hands.clock());
  lines.begin("pilot", 100);
  hands.time += 29s;
  lines.advance(100);
  EXPECT_EQ(out.str(), "");
}

}  // namespace
}  // namespace assay::harness
