#include <zlib.h>

#include <nlohmann/json.hpp>

#include "reports/formats/base64.h"
#include "reports/report_formats.h"
#include "reports/viewer/page.h"
#include "tests/reports/large_records.h"
#include "tests/reports/prelude.h"

// The tests in tests/viewer open the page in a browser.

namespace assay::reports {
namespace {

std::string between(const std::string& text, std::string_view open, std::string_view close) {
  const std::size_t start = text.find(open) + open.size();
  return text.substr(start, text.find(close, start) - start);
}

/// The bytes of the page's record.
std::string unpacked(const std::string& page) {
  std::vector<std::uint8_t> packed_bytes =
      from_base64(between(page, "id=\"record\">", "</script>")).value();
  std::string bytes(std::size_t{1} << 26, '\0');
  uLongf length = bytes.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length, packed_bytes.data(),
                       packed_bytes.size()),
            Z_OK);
  bytes.resize(length);
  return bytes;
}

struct Unpacked {
  nlohmann::ordered_json text;
  std::string planes;
};

Unpacked parts_of(const std::string& bytes) {
  std::size_t length = 0;
  for (std::size_t i = 0; i < 4; ++i)
    length |= static_cast<std::size_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  return {nlohmann::ordered_json::parse(bytes.substr(4, length)), bytes.substr(4 + length)};
}

TEST(Html, HoldsTheRecordAndThePlanesOfItsPictures) {
  const Record record = example_record();
  const std::string bytes = unpacked(html(record));
  EXPECT_TRUE(bytes == packed(record));
  const Unpacked parts = parts_of(bytes);
  Record read = read_json(parts.text["record"].dump(), "page");
  EXPECT_EQ(read.suites[0].tests.size(), record.suites[0].tests.size());
  for (std::size_t i = 0; i < record.suites[0].tests.size(); ++i) {
    const reports::Test& shown = read.suites[0].tests[i];
    const reports::Test& test = record.suites[0].tests[i];
    EXPECT_EQ(shown.id, test.id);
    EXPECT_EQ(shown.gates, test.gates);
    ASSERT_EQ(shown.samples.size(), test.samples.size());
    for (std::size_t k = 0; k < test.samples.size(); ++k) {
      EXPECT_EQ(shown.samples[k].histogram.counts, test.samples[k].histogram.counts);
      const auto near = [](const auto& one, const auto& other) {
        return std::abs(one.observed - other.observed) <= 5e-6 * std::abs(other.observed);
      };
      EXPECT_TRUE(std::ranges::equal(shown.samples[k].quantiles, test.samples[k].quantiles, near));
    }
  }
  EXPECT_EQ(parts.text["pictures"].size(), 2u);
  EXPECT_EQ(parts.text["pictures"][0]["name"], "z");
}

TEST(Html, RefersToNothingOutsideItself) {
  const std::string page = html(example_record());
  for (const char* reference : {"src=\"", "<link", "<iframe", "<img", "@import", "url(http"})
    EXPECT_THAT(page, Not(HasSubstr(reference)));
  EXPECT_THAT(page, HasSubstr("default-src 'none'; script-src 'sha256-"));
  EXPECT_THAT(page, Not(HasSubstr("unsafe")));
}

TEST(Html, TitleAndTablesAreEscaped) {
  Record record = example_record();
  const std::string page = html(record);
  EXPECT_THAT(page, HasSubstr("<title>Assay: Shard 2 of 4: 1\u00A0ledger alarm over all nights"));
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(between(page, "<noscript><pre>", "</pre>"), HasSubstr("| verdict | test |"));
  EXPECT_THAT(between(page, "<noscript><pre>", "</pre>"), Not(HasSubstr("<")));
  EXPECT_THAT(page, Not(HasSubstr("{{")));
}

TEST(Html, OfACalibrationHoldsItsVerdictAndTables) {
  const std::string page = html(small_calibration());
  const Unpacked parts = parts_of(unpacked(page));
  EXPECT_EQ(parts.text["calibration"]["cells"].size(), 4u);
  EXPECT_EQ(parts.text["title"], verdict_sentence(small_calibration()));
  EXPECT_EQ(parts.text["sound"], false);
  EXPECT_THAT(parts.text["text"].get<std::string>(), HasSubstr("0.15 of <means>"));
  EXPECT_THAT(page, Not(HasSubstr("<number>")));
}

RC_GTEST_PROP(Html, TheSameRecordGivesTheSamePage, ()) {
  const Record record = random_record();
  RC_ASSERT(html(record) == html(record));
}

/// A number from its 16 bits: the low bytes of all codes stand before their high bytes.
int code_at(const Unpacked& page, const nlohmann::ordered_json& picture, std::size_t i) {
  const std::size_t start = picture["start"], length = picture["length"];
  const int folded = static_cast<unsigned char>(page.planes[start + i]) +
                     256 * static_cast<unsigned char>(page.planes[start + length / 2 + i]);
  return folded % 2 == 1 ? -(folded + 1) / 2 : folded / 2;
}

TEST(Pictures, LargeMapsReadBackWithinTheirSteps) {
  const Record record = planted_ellipse();
  const Unpacked page = parts_of(packed(record));
  const std::vector<Map>& maps = record.suites[0].tests[0].maps;
  ASSERT_EQ(page.text["pictures"].size(), maps.size());
  for (std::size_t m = 0; m < maps.size(); ++m) {
    const nlohmann::ordered_json& picture = page.text["pictures"][m];
    const double step = picture["step"], zero = picture["zero"];
    const bool linear = picture["coding"] == "linear";
    EXPECT_EQ(linear, maps[m].name == "z");
    int before = 0;
    for (std::size_t i = 0; i < 5000; ++i) {
      const int code = code_at(page, picture, i);  // of the first component
      const double value = static_cast<double>(maps[m].texels.values[3 * i]);
      before = linear ? code : before + code;
      if (linear) {
        EXPECT_NEAR(before * step, value, step / 2 + 1e-6);
      } else {
        EXPECT_NEAR(std::exp2((before - zero) * step) / value, 1, 0.015);
      }
    }
  }
}

// 3 megapixels take squares of two by two: the sum of their z is halved.
TEST(Pictures, AboveTwoMegapixelsAreReduced) {
  Record record = planted_ellipse();
  std::vector<Map>& maps = record.suites[0].tests[0].maps;
  maps = {{.name = "z", .width = 2001, .height = 1500, .components = {"Y"}}};
  maps.push_back(maps[0]);
  maps[1].name = "mean";
  for (Map& map : maps) map.texels.values.assign(2001 * 1500, 1);
  const Unpacked page = parts_of(packed(record));
  for (const nlohmann::ordered_json& picture : page.text["pictures"]) {
    EXPECT_EQ(picture["reduced"], 2);
    EXPECT_EQ(picture["width"], 1001);
    EXPECT_EQ(picture["height"], 750);
  }
  const nlohmann::ordered_json& z = page.text["pictures"][0];
  EXPECT_EQ(code_at(page, z, 0) * z["step"].get<double>(), 2);
  EXPECT_NEAR(code_at(page, z, 1000) * z["step"].get<double>(), std::sqrt(2), 0.07);
  EXPECT_EQ(code_at(page, page.text["pictures"][1], 1), 0);
}

TEST(Pictures, ValuesWithoutACodeAreKeptInRange) {
  Record record = planted_ellipse();
  std::vector<Map>& maps = record.suites[0].tests[0].maps;
  maps[0].texels.values[0] = std::numeric_limits<float>::infinity();
  maps[0].texels.values[3] = std::numeric_limits<float>::quiet_NaN();
  maps[1].texels.values[0] = -1;
  maps[1].texels.values[3] = std::numeric_limits<float>::infinity();
  const Unpacked page = parts_of(packed(record));
  EXPECT_EQ(code_at(page, page.text["pictures"][0], 0), 32767);
  EXPECT_EQ(code_at(page, page.text["pictures"][0], 1), 0);
  EXPECT_EQ(code_at(page, page.text["pictures"][1], 0), 0);
  EXPECT_GT(code_at(page, page.text["pictures"][1], 1), 10000);
}

}  // namespace
}  // namespace assay::reports
