// Images in reports: base64, colours, pictures, previews.

#include <gtest/gtest.h>
#include <png.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "example_record.h"
#include "reports/formats/base64.h"
#include "reports/formats/console.h"
#include "reports/formats/junit.h"
#include "reports/formats/markdown.h"
#include "reports/viewer/colour_scale.h"
#include "reports/viewer/html.h"

namespace assay::reports {
namespace {

std::string text_of(std::string_view bytes) {
  return base64({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

// RFC 4648, section 10.
TEST(Base64, IsThatOfTheStandard) {
  EXPECT_EQ(text_of(""), "");
  EXPECT_EQ(text_of("f"), "Zg==");
  EXPECT_EQ(text_of("fo"), "Zm8=");
  EXPECT_EQ(text_of("foo"), "Zm9v");
  EXPECT_EQ(text_of("foob"), "Zm9vYg==");
  EXPECT_EQ(text_of("foobar"), "Zm9vYmFy");
}

RC_GTEST_PROP(Base64, ReadsBack, (const std::vector<std::uint8_t>& bytes)) {
  RC_ASSERT(from_base64(base64(bytes)) == bytes);
}

TEST(Base64, RefusesWhatIsNone) {
  for (const char* text : {"Zg=", "Z", "Zg==Zg==", "Zm9\n", "Z===", "====", "Zm9-"}) {
    EXPECT_FALSE(from_base64(text)) << text;
  }
}

TEST(Base64, FloatsAreLittleEndian) {
  EXPECT_EQ(bytes_of(std::vector<float>{1.0f}), (std::vector<std::uint8_t>{0, 0, 0x80, 0x3f}));
  const std::vector<float> values = {-0.0f, 1e-45f, std::numeric_limits<float>::infinity(), 3.25f};
  EXPECT_EQ(floats_of(bytes_of(values)), values);
}

TEST(ColourScale, OfZIsWhiteAtZeroAndSymmetric) {
  const ColourScale z{Palette::difference, -5, 5};
  EXPECT_EQ(z(0), (Rgb{255, 255, 255}));
  EXPECT_GT(z(2.5).red, z(2.5).blue);
  EXPECT_LT(z(-2.5).red, z(-2.5).blue);
  EXPECT_EQ(z(7), z(5));
  EXPECT_EQ(z(-std::numeric_limits<double>::infinity()), z(-5));
}

Map map_of(const std::string& name, std::vector<float> values) {
  const std::uint64_t width = values.size();
  return {.name = name,
          .source = "",
          .file = "",
          .width = width,
          .height = 1,
          .components = {"value"},
          .texels = {std::move(values)}};
}

TEST(ColourScale, ReachesFromFiveToFifteen) {
  EXPECT_EQ(scale_of(map_of("z", {1, -2})).high, 5);
  EXPECT_EQ(scale_of(map_of("z", {1, -7.5f})).low, -8);
  EXPECT_EQ(scale_of(map_of("z", {1e9f, std::numeric_limits<float>::infinity()})).high, 15);
  EXPECT_EQ(scale_of(map_of("mean", {0.5f, 2})).low, 0);
  EXPECT_EQ(scale_of(map_of("mean", {0.5f, 2})).high, 2);
}

TEST(ColourScale, OfProbabilitiesIsLogarithmic) {
  const ColourScale p = scale_of(map_of("p_adjusted", {1}));
  EXPECT_EQ(p(1), (Rgb{255, 255, 255}));
  EXPECT_EQ(p(1e-30), p(1e-6));
  EXPECT_EQ(p(1e-3), (Rgb{150, 110, 190}));
}

TEST(Png, ReadsBackPixelForPixel) {
  const Pixels pixels{3, 2, {{1, 2, 3}, {255, 0, 7}, {9, 9, 9}, {0, 0, 0}, {4, 5, 6}, {7, 8, 9}}};
  const std::vector<std::uint8_t> bytes = png(pixels);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  EXPECT_EQ(image.width, 3u);
  EXPECT_EQ(image.height, 2u);
  image.format = PNG_FORMAT_RGB;
  std::vector<Rgb> rows(6);
  ASSERT_NE(png_image_finish_read(&image, nullptr, rows.data(), 0, nullptr), 0);
  EXPECT_EQ(rows, pixels.rows);
}

TEST(Png, AnEmptyPictureIsRefused) { EXPECT_THROW(png({}), std::runtime_error); }

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

// Two components of z, one each of p, mean and variance; a scale below each.
TEST(ImagePreview, ShowsMapsWithTheirScalesAndOutlinesTheCell) {
  const std::string page = html(example_record());
  EXPECT_EQ(count_of(page, "href=\"data:image/png;base64,"), 10u);
  EXPECT_EQ(count_of(page, "<rect class=\"found\""), 1u);
  EXPECT_NE(page.find(">-14</text>"), std::string::npos);
  EXPECT_NE(page.find(">+14</text>"), std::string::npos);
  EXPECT_NE(page.find("img-src data:"), std::string::npos);
  EXPECT_NE(page.find("image-rendering: pixelated"), std::string::npos);
}

TEST(ImagePreview, EveryFormatNamesTheCell) {
  const Record record = example_record();
  for (const std::string& text :
       {html(record), junit(record), console(record, {.colour = false, .verbose = true})}) {
    EXPECT_NE(text.find("columns 2-3, rows"), std::string::npos) << text;
  }
  EXPECT_NE(markdown(record).find("columns 2-3, rows 1-2 of green"), std::string::npos);
}

}  // namespace
}  // namespace assay::reports
