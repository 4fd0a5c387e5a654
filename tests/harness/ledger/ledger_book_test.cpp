#include <rapidcheck.h>

#include "estimators/core/value.h"
#include "harness/ledger/ledger.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

const LedgerSeries score{.hash = "00ff",
                         .reference_error = 1e-9,
                         .weight = 0.25,
                         .test = "suite/mean(a) == \"x\" \\ |",
                         .channel = "red\tand\nblue"};
const LedgerSeries distance{
    .hash = "0a0b", .weight = 0.75, .test = "suite/law", .channel = "value"};

LedgerBook example() {
  LedgerBook book;
  const std::size_t a = book.open(score);
  book.add({"2026-11-01T02:00:00Z", 7, "abc", a,
            stats::NightEstimate{0.1 + 0.2, 1.0 / 3, 4096, 1365.5}});
  const std::size_t b = book.open(distance);
  book.add({"2026-11-01T02:00:00Z", 7, "abc", b, NightLogP{-0.69}});
  book.add({"2026-11-02T02:00:00Z", std::numeric_limits<std::uint64_t>::max(), "abd", a,
            stats::NightEstimate{-1e-300, 0, 1e300}});
  return book;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

std::string refused(const std::string& text) {
  return thrown<InputError>([&] { LedgerBook::parse(text, "n.ledger"); });
}

TEST(LedgerBook, ReadsBackWhatItWrote) {
  const LedgerBook book = example();
  const LedgerBook again = LedgerBook::parse(book.text(), "n.ledger");
  EXPECT_EQ(again.text(), book.text());
  EXPECT_EQ(again.nights(), book.nights());
  ASSERT_EQ(again.series().size(), 2U);
  EXPECT_EQ(again.series()[0].test, score.test);
  EXPECT_EQ(again.series()[0].channel, score.channel);
  EXPECT_EQ(again.series()[0].reference_error, score.reference_error);
  EXPECT_EQ(again.series()[0].weight, score.weight);
  EXPECT_FALSE(again.series()[1].has_estimates());
  EXPECT_EQ(again.budget(), default_ledger_budget);
}

TEST(LedgerBook, GrowsAsIfItHadNeverBeenWritten) {
  LedgerBook whole = example();
  LedgerBook again = LedgerBook::parse(example().text(), "n.ledger");
  const LedgerNight night{"2026-11-03T02:00:00Z", 9, "abe", 0, stats::NightEstimate{1, 2, 3}};
  whole.add(night);
  again.add(night);
  EXPECT_EQ(again.text(), whole.text());
}

TEST(LedgerBook, KnowsSeedsOfATestWhateverItsSeries) {
  LedgerBook book = example();
  LedgerSeries other = score;
  other.hash = "1111";
  EXPECT_TRUE(book.has_seed(other, 7));
  EXPECT_FALSE(book.has_seed(other, 8));
  other.channel = "green";
  EXPECT_FALSE(book.has_seed(other, 7));
}

TEST(LedgerBook, ABeginLineWrittenByHandStartsANewSeries) {
  std::vector<std::string> lines = tests::lines(example().text());
  lines.push_back("begin " + in_quotes(score.test) + " ");
  LedgerBook book = LedgerBook::parse(joined(lines), "n.ledger");
  EXPECT_EQ(book.open_series(score), std::nullopt);
  EXPECT_NE(book.open_series(distance), std::nullopt);
  EXPECT_TRUE(book.has_seed(score, 7));
  const std::size_t fresh = book.open(score);
  EXPECT_EQ(fresh, 2U);
  EXPECT_EQ(book.generation(fresh), 2);
  book.add({"2026-11-03T02:00:00Z", 9, "abe", fresh, stats::NightEstimate{1, 2, 3}});
  const LedgerBook again = LedgerBook::parse(book.text(), "n.ledger");
  EXPECT_EQ(again.nights_of(2).size(), 1U);
  EXPECT_EQ(again.nights_of(0).size(), 2U);
}

TEST(LedgerBook, AcceptsCommentsAndABudgetWrittenByHandBeforeTheFirstNight) {
  const LedgerBook book =
      LedgerBook::parse("assay-ledger 2 budget 0.01\n# of the renderer\n\nend 0\n", "n.ledger");
  EXPECT_EQ(book.budget(), 0.01);
  EXPECT_THAT(book.text(), HasSubstr("# of the renderer"));
}

TEST(LedgerBook, NamesTheLineThatWasChangedAndTheMend) {
  const std::vector<std::string> lines = tests::lines(example().text());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].starts_with("#")) continue;
    std::vector<std::string> edited = lines;
    // One digit of the line, whichever comes first.
    char& digit = edited[i][edited[i].find_first_of("0123456789")];
    digit = digit == '1' ? '2' : '1';
    const std::string why = refused(joined(edited));
    // A changed header shows at the first line that was written under it.
    const std::size_t at = i == 0 && why.find("n.ledger:1:") == std::string::npos ? 7 : i;
    EXPECT_THAT(why, HasSubstr("n.ledger:" + std::to_string(at + 1) + ":")) << lines[i];
  }
}

TEST(LedgerBook, FindsEveryLineTakenOutDoubledOrMoved) {
  const std::vector<std::string> lines = tests::lines(example().text());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].starts_with("#")) continue;
    std::vector<std::string> cut = lines;
    cut.erase(cut.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_THAT(refused(joined(cut)), HasSubstr("n.ledger:")) << lines[i];
    std::vector<std::string> doubled = lines;
    doubled.insert(doubled.begin() + static_cast<std::ptrdiff_t>(i), lines[i]);
    EXPECT_THAT(refused(joined(doubled)), HasSubstr("n.ledger:")) << lines[i];
    std::vector<std::string> swapped = lines;
    if (i + 1 == lines.size() || lines[i + 1].starts_with("#")) continue;
    std::swap(swapped[i], swapped[i + 1]);
    EXPECT_THAT(refused(joined(swapped)), HasSubstr("version control")) << lines[i];
  }
}

TEST(LedgerBook, FindsEveryFileCutShort) {
  const std::string text = example().text();
  for (std::size_t size = 1; size + 1 < text.size(); ++size) {
    EXPECT_THAT(refused(text.substr(0, size)), HasSubstr("n.ledger:")) << size;
  }
}

TEST(LedgerBook, RefusesWhatIsNoLedger) {
  EXPECT_THAT(refused("suite: a\n"), HasSubstr("n.ledger:1:1"));
  EXPECT_THAT(refused("assay-ledger 2 budget 0\nend 0\n"), HasSubstr("from 1e-9 to 0.5"));
  EXPECT_THAT(refused("assay-ledger 2 budget nan\nend 0\n"), HasSubstr("from 1e-9 to 0.5"));
  std::vector<std::string> lines = tests::lines(example().text());
  lines.push_back("begin \"suite/other\"");
  EXPECT_THAT(refused(joined(lines)), HasSubstr("has no test \"suite/other\""));
  lines.back() = "begin " + in_quotes(score.test);
  lines.back().pop_back();
  EXPECT_THAT(refused(joined(lines)), HasSubstr("the test's id in double quotes"));
  lines.back() = "<<<<<<< HEAD";
  EXPECT_THAT(refused(joined(lines)), HasSubstr("n.ledger:" + std::to_string(lines.size()) + ":"));
}

TEST(LedgerBook, AnyTextAsNameReadsBack) {
  rc::check([](const std::string& test, const std::string& channel) {
    LedgerBook book;
    LedgerSeries series = score;
    series.test = test;
    series.channel = channel;
    book.add({"d", 1, "c", book.open(series), stats::NightEstimate{1, 1, 1}});
    const LedgerBook again = LedgerBook::parse(book.text(), "n.ledger");
    RC_ASSERT(again.series()[0].test == test);
    RC_ASSERT(again.series()[0].channel == channel);
  });
}

}  // namespace
}  // namespace assay::harness
