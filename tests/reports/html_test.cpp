#include "reports/html.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <regex>

#include "reports/charts.h"
#include "reports/svg.h"
#include "reports/text.h"
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
       {"mean of 7\u00A0estimators", "variance of one primary (p) or secondary (s) estimate of 7",
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
  EXPECT_EQ(links, 14);
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

TEST(Html, WhatIsNotOkStandsFirst) {
  const std::string page = html(example_record());
  const std::size_t table = page.find("data-label=");
  EXPECT_LT(page.find(">Not ok</th>"), table);
  EXPECT_LT(page.find("✗ fail", table), page.find("✓ fail (as expected)", table));
  EXPECT_LT(page.find("✓ fail (as expected)", table), page.find("✓ pass", table));
}

TEST(Html, ShowsNoUnderflowNoCanonicalQuotesAndNoZeroRays) {
  const std::string page = html(example_record());
  for (const char* bad : {"e-324", ":published", ">0 rays"})
    EXPECT_EQ(page.find(bad), std::string::npos) << bad;
  EXPECT_NE(page.find("2.3e-1205"), std::string::npos);
  EXPECT_NE(page.find("p(contrary)"), std::string::npos);
}

TEST(Html, EveryIntervalOfTheOverviewIsNamed) {
  const std::string page = html(example_record());
  const std::string table =
      page.substr(page.find("<table"), page.find("</table>") - page.find("<table"));
  static const std::regex interval("<span class=\"whole\">[^<]*\\[");
  static const std::regex named(
      "<span class=\"whole\">[^<]*\\[[^<]*</span><br/><span class=\"muted\">[^<]* interval</span>");
  const auto count = [&](const std::regex& pattern) {
    return std::distance(std::sregex_iterator(table.begin(), table.end(), pattern), {});
  };
  EXPECT_EQ(count(interval), 10);
  EXPECT_EQ(count(named), count(interval));
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

}  // namespace
}  // namespace assay::reports
