#include "reports/viewer/html.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <regex>

#include "reports/viewer/charts.h"
#include "reports/viewer/svg.h"
#include "reports/words/evidence.h"
#include "reports/words/text.h"
#include "tests/reports/example_record.h"
#include "tests/reports/random_record.h"

namespace assay::reports {
namespace {

// Tags outside script and style, whose content is ours.
std::vector<std::string> tags(const std::string& page) {
  static const std::regex tag("<(/?)([a-z0-9]+)((?:[^<>\"]|\"[^\"]*\")*)>");
  std::vector<std::string> result;
  for (std::sregex_iterator i(page.begin(), page.end(), tag), end; i != end; ++i)
    result.push_back(i->str());
  return result;
}

std::string without_scripts(std::string page) {
  for (const char* name : {"script", "style"}) {
    const std::string open = std::string("<") + name + ">", close = std::string("</") + name + ">";
    const std::size_t start = page.find(open), end = page.find(close);
    if (start != std::string::npos) page.erase(start, end + close.size() - start);
  }
  return page;
}

// Every tag is closed in order; "" where that holds.
std::string nesting_error(const std::string& page) {
  std::vector<std::string> open;
  for (const std::string& tag : tags(page)) {
    if (tag.ends_with("/>")) continue;
    const std::string name =
        tag.substr(tag[1] == '/' ? 2 : 1, tag.find_first_of(" >", 1) - (tag[1] == '/' ? 2 : 1));
    if (tag[1] != '/') {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return tag;
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : open.back();
}

TEST(Html, RefersToNothingOutsideItself) {
  const std::string page = html(example_record());
  for (const char* reference :
       {"http:", "https:", "src=", "url(", "@import", "<link", "<iframe", "<img"})
    EXPECT_EQ(page.find(reference), std::string::npos) << reference;
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
}

TEST(Html, HasAPictureOfEachKind) {
  const std::string page = html(example_record());
  for (const char* part :
       {"mean of 7\u00A0estimators", "variance of one primary (p) or secondary (s) of 7",
        "Pairs of estimators of triangle luminaire", "Histogram of observations",
        "Normal quantile plot of winners", "relative difference of means: mean(area)",
        "assay replay run.json"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
}

TEST(Html, EveryLinkInsideThePageHasATarget) {
  const std::string page = html(example_record());
  static const std::regex link("href=\"#([^\"]+)\"");
  int links = 0;
  for (std::sregex_iterator i(page.begin(), page.end(), link), end; i != end; ++i, ++links)
    EXPECT_NE(page.find("id=\"" + (*i)[1].str() + "\""), std::string::npos) << (*i)[1];
  EXPECT_EQ(links, 33);
}

TEST(Html, ForeignTextCannotBecomeMarkup) {
  const std::string page = html(example_record());
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;alert(1)&lt;/script&gt;"), std::string::npos);
}

RC_GTEST_PROP(Html, IsCleanNestedAndHasNoCoordinateThatIsNotANumber, ()) {
  const std::string page = html(random_record());
  RC_ASSERT(clean(page) == page);
  const std::string body = without_scripts(page);
  RC_ASSERT(nesting_error(body.substr(body.find("<html"))) == "");
  static const std::regex geometry(" (?:x|y|x1|x2|y1|y2|cx|cy|width|height|d)=\"([^\"]*)\"");
  for (std::sregex_iterator i(body.begin(), body.end(), geometry), end; i != end; ++i) {
    const std::string value = (*i)[1];
    RC_ASSERT(value.find("nan") == std::string::npos);
    RC_ASSERT(value.find("inf") == std::string::npos);
  }
}

// Each chart's coordinates lie inside its view box.
std::string outside_the_view(const std::string& svg) {
  static const std::regex box("viewBox=\"0 0 ([0-9.]+) ([0-9.]+)\"");
  static const std::regex coordinate(" (x|y|x1|x2|y1|y2|cx|cy)=\"([-0-9.]+)\"");
  std::smatch size;
  if (!std::regex_search(svg, size, box)) return "no view box";
  for (std::sregex_iterator i(svg.begin(), svg.end(), coordinate), end; i != end; ++i) {
    const bool horizontal = (*i)[1].str().find('x') != std::string::npos;
    const double value = std::stod((*i)[2]), limit = std::stod(size[horizontal ? 1 : 2]);
    if (value < 0 || value > limit) return i->str();
  }
  return "";
}

TEST(Charts, StayInsideTheirFrame) {
  for (const Record& record : {example_record(), forty_estimators()}) {
    for (const Suite& suite : record.suites) {
      for (const char* channel : {"value", "R", "G", "B"}) {
        for (const std::string& svg : {mean_bars(suite, channel), variance_bars(suite, channel),
                                       pair_matrix(suite, channel)}) {
          if (!svg.empty()) {
            EXPECT_EQ(outside_the_view(svg), "");
          }
        }
      }
      for (const reports::Test& test : suite.tests) {
        const std::string svg = interval_chart(test);
        if (!svg.empty()) {
          EXPECT_EQ(outside_the_view(svg), "") << test.name;
        }
      }
    }
  }
}

TEST(Charts, WideVariancesAreDrawnOnALogarithmicAxisThatSaysSo) {
  Suite suite = example_record().suites[0];
  EXPECT_NE(variance_bars(suite, "value").find("log scale"), std::string::npos);
  for (EstimatorSummary& estimator : suite.estimators)
    estimator.channels[0].variance = {1, 0.9, 1.1};
  suite.estimators[2].channels[0].reference_variance.reset();
  EXPECT_EQ(variance_bars(suite, "value").find("log scale"), std::string::npos);
}

// area's variance is a quarter of hemisphere's (0.0615 to 0.246): its row stands below the
// diagonal.
TEST(Charts, PairsBelowTheDiagonalReadRowAgainstColumn) {
  const std::string svg = pair_matrix(example_record().suites[0], "value");
  EXPECT_NE(svg.find("variance of area against hemisphere: &lt; smaller, 0.25×"),
            std::string::npos);
  EXPECT_NE(svg.find("variance of heavy against area: &gt; larger, 167×"), std::string::npos);
  EXPECT_NE(svg.find("mean of hemisphere against area: = agree"), std::string::npos);
  EXPECT_EQ(svg.find("variance of hemisphere against area"), std::string::npos);
}

TEST(Charts, EstimatorsWithoutFiniteDataSayNone) {
  const std::string svg = mean_bars(example_record().suites[0], "value");
  EXPECT_NE(svg.find(">none</text>"), std::string::npos);
}

TEST(Charts, ALogarithmOfARatioIsDrawnAsTheRatio) {
  const std::string svg = interval_chart(example_record().suites[0].tests[1]);
  EXPECT_NE(svg.find(">variance ratio, log scale</text>"), std::string::npos);
  EXPECT_EQ(svg.find("ln "), std::string::npos);
}

TEST(Charts, RatiosBeyondADoubleStayInsideTheFrame) {
  reports::Test test = example_record().suites[0].tests[1];
  for (const double theta : {-1e300, -800.0, 800.0, 1e300}) {
    test.channels[0].effect.estimate = theta;
    test.channels[0].effect.low = -theta;
    test.channels[0].effect.high = 2.0;
    EXPECT_EQ(outside_the_view(interval_chart(test)), "") << theta;
  }
}

/// The table of all tests, which follows that of the statements.
std::string overview_of(const std::string& page) {
  const std::size_t start = page.find("<table", page.find("<h2>Tests"));
  return page.substr(start, page.find("</table>", start) - start);
}

TEST(Html, WhatIsNotOkStandsFirst) {
  const std::string page = overview_of(html(example_record()));
  const std::size_t table = page.find("data-label=");
  EXPECT_LT(page.find(">Not ok</th>"), table);
  EXPECT_LT(page.find("✗ fail", table), page.find("✓ fail (as expected)", table));
  // A failure that was expected needs no look: it stands where the suite has it.
  EXPECT_LT(page.find("✓ pass", table), page.find("✓ fail (as expected)", table));
}

TEST(Html, ShowsNoUnderflowNoCanonicalQuotesAndNoZeroRays) {
  const std::string page = html(example_record());
  for (const char* bad : {"e-324", ":published", ">0 rays"})
    EXPECT_EQ(page.find(bad), std::string::npos) << bad;
  EXPECT_NE(page.find("2.3e-1205"), std::string::npos);
  EXPECT_NE(page.find("p(contrary)"), std::string::npos);
}

TEST(Html, EveryIntervalOfTheOverviewIsNamed) {
  const std::string table = overview_of(html(example_record()));
  static const std::regex interval("<span class=\"whole\">[^<]*\\[");
  static const std::regex named(
      "<span class=\"whole\">[^<]*\\[[^<]*</span><br/><span class=\"muted\">[^<]* interval</span>");
  const auto count = [&](const std::regex& pattern) {
    return std::distance(std::sregex_iterator(table.begin(), table.end(), pattern), {});
  };
  EXPECT_EQ(count(interval), 10);
  EXPECT_EQ(count(named), count(interval));
}

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

Record record_of(reports::Test test) {
  Record record;
  record.suites.resize(1);
  record.suites[0].name = "suite";
  record.suites[0].tests = {std::move(test)};
  return record;
}

TEST(Html, ObservationsOfTwoCoordinatesAreCountedOnce) {
  Record record = example_record();
  reports::Test& test = record.suites[0].tests[0];
  test.samples[0].channel = "theta";
  test.samples[0].secondaries = 321;
  test.samples.push_back(test.samples[0]);
  test.samples.back().channel = "phi";
  test.channels[0].name = "cell";
  EXPECT_NE(overview_of(html(record)).find("observations\" title=\"321\""), std::string::npos);
}

// Numbers that rest on an assumption that does not hold are no effect.
TEST(Html, AnInvalidTestShowsItsReasonAsRedAndNoNumbers) {
  reports::Test test = example_record().suites[0].tests[0];
  test.verdict = Verdict::invalid;
  test.ok = false;
  test.message = "rows of this shape need about 6100 rows";
  const std::string page = html(record_of(test));
  EXPECT_EQ(page.find("+0.031\u00A0%"), std::string::npos);
  EXPECT_EQ(page.find("no effect, dashed"), std::string::npos);
  EXPECT_NE(page.find("class=\"red\""), std::string::npos);
  test.gates.push_back(
      {"number of observations (limit: the fewest that keep the level)", 1000, 6100, "red"});
  EXPECT_EQ(html(record_of(test)).find("what the message says"), std::string::npos);
}

TEST(Html, TheMessageOfATestStandsOnThePageOnce) {
  for (const Verdict verdict : {Verdict::pass, Verdict::fail, Verdict::inconclusive}) {
    reports::Test test = example_record().suites[0].tests[0];
    test.verdict = verdict;
    test.ok = verdict == Verdict::pass;
    test.message = "one sentence on what came of it";
    EXPECT_EQ(occurrences(html(record_of(test)), test.message), 1u) << to_string(verdict);
  }
}

TEST(Html, TheInstructionSetIsOfRunsThatTraceRays) {
  Record record = record_of(example_record().suites[0].tests[0]);
  record.environment.isa = "avx2";
  EXPECT_NE(html(record).find("rays traced with"), std::string::npos);
  for (Sample& sample : record.suites[0].tests[0].samples) sample.cost = {.samples = 7};
  EXPECT_EQ(html(record).find("rays traced with"), std::string::npos);
}

TEST(Html, ASuiteWithoutAFileLeavesNoGap) {
  const Record record = record_of(example_record().suites[0].tests[0]);
  EXPECT_EQ(html(record).find("<span></span>"), std::string::npos);
}

// The overview shows the channel that the verdict rests on; the message is about it.
TEST(Html, TheOverviewShowsTheChannelThatDecides) {
  reports::Test test = example_record().suites[0].tests[0];
  test.channels.push_back(test.channels[0]);
  test.channels[1].name = "G";
  test.channels[1].p_pass = 0.009;
  test.channels[1].log10_p_pass = std::log10(0.009);
  test.channels[1].effect.estimate = 0.0042;
  EXPECT_EQ(deciding_channel(test).name, "G");
  const std::string page = html(record_of(test));
  EXPECT_NE(page.substr(0, page.find("<h2")).find("+0.42\u00A0%"), std::string::npos);
  test.verdict = Verdict::fail;
  EXPECT_EQ(deciding_channel(test).name, "value");
}

Map cells_map(const char* name, std::vector<float> values) {
  return {.name = name,
          .source = "theta 0 to 1.571 from top to bottom, phi 0 to 6.283 from left to right",
          .file = "",
          .width = 3,
          .height = 2,
          .components = {"draws"},
          .texels = {std::move(values)}};
}

TEST(Html, TheCellsOfASamplersDomainAreDrawn) {
  reports::Test test = example_record().suites[0].tests[0];
  test.maps = {cells_map("cells_observed", {1, 2, 3, 4, 5, 60}),
               cells_map("cells_expected", {1, 2, 3, 4, 5, 6}),
               cells_map("cells_z", {0, 0, 0, 0, 0, 22})};
  const std::string page = html(record_of(test));
  EXPECT_NE(page.find("Draws in each cell: theta 0 to 1.571 from top"), std::string::npos);
  EXPECT_NE(page.find("Draws expected: theta"), std::string::npos);
  // Observed and expected on one scale, up to 60, and z beyond its own.
  EXPECT_EQ(occurrences(page, ">60</text>"), 2u);
  EXPECT_NE(page.find("&gt;= +15"), std::string::npos);
  EXPECT_EQ(page.find("cell by cell"), std::string::npos);
  test.maps.push_back(cells_map("cells_z_close", {0, 0, 0, 0, 0, -22}));
  EXPECT_NE(html(record_of(test))
                .find("Where most is drawn, cell by cell, in standard deviations: theta"),
            std::string::npos);
  test.maps.resize(2);
  EXPECT_EQ(html(record_of(test)).find("Draws in each cell"), std::string::npos);
}

TEST(Charts, NothingIsDrawnFromNothing) {
  EXPECT_EQ(mean_bars(Suite{}, "value"), "");
  EXPECT_EQ(variance_bars(Suite{}, "value"), "");
  EXPECT_EQ(pair_matrix(Suite{}, "value"), "");
  EXPECT_EQ(interval_chart(reports::Test{}), "");
  EXPECT_EQ(histogram_chart({}), "");
  EXPECT_EQ(quantile_chart(Sample{}), "");
  EXPECT_EQ(law_chart(Channel{}), "");
  EXPECT_EQ(law_chart({.laws = {{.source = "one point", .points = {{}}}}}), "");
}

// Without a spread there is no evidence; a primary's variance and a secondary's are no pair.
TEST(Charts, APairWithoutVariancesSaysWhy) {
  Suite suite{.name = "pairs", .estimators = {{.name = "a"}, {.name = "b"}}};
  suite.comparisons = {{.first = "a", .second = "b", .channel = "value"}};
  const std::string constant = pair_matrix(suite, "value");
  EXPECT_NE(constant.find("no evidence"), std::string::npos);
  EXPECT_EQ(constant.find("units differ"), std::string::npos);
  suite.comparisons[0].mean_p = 0.5;
  EXPECT_NE(pair_matrix(suite, "value").find("not compared, units differ"), std::string::npos);
}

}  // namespace
}  // namespace assay::reports
