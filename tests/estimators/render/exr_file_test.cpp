#include "estimators/core/value.h"
#include "estimators/picture_file.h"
#include "tests/estimators/exr_kinds.h"

namespace assay {
namespace {

using namespace assay::draws;

class ExrFiles : public InFolder {
 protected:
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    const auto picture = open_picture(file_);
    const PictureFile& file = *picture;
    for (const FileChannel& channel : file.channels()) names.push_back(channel.name);
    return names;
  }
  std::vector<float> read(const std::vector<std::string>& channels) const {
    const auto picture = open_picture(file_);
    const PictureFile& file = *picture;
    const PictureWindow window = file.window(channels);
    std::vector<float> texels(window.width * window.height * channels.size());
    file.read(channels, texels);
    expect_same_in_portions(file, channels, texels);
    return texels;
  }
  // One row, and then the rest: neither begins or ends where a chunk does.
  static void expect_same_in_portions(const PictureFile& file,
                                      const std::vector<std::string>& channels,
                                      const std::vector<float>& expected) {
    const std::size_t row = file.window(channels).width * channels.size();
    std::vector<float> texels(expected.size());
    const std::span<float> all(texels);
    file.read(channels, all.first(row));
    file.read(channels, all.subspan(row), 1);
    EXPECT_TRUE(std::ranges::equal(texels, expected, [](float a, float b) {
      return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
    }));
  }
  // Channels in the order asked for, not that of the file.
  void expect_read(const Part& part) const {
    ASSERT_EQ(part.channels.size(), 3u);
    const std::vector<float> texels = read({part.channels[2], part.channels[0], part.channels[1]});
    for (int y = 0; y < part.height; ++y) {
      for (int x = 0; x < part.width; ++x) {
        const auto at = static_cast<std::size_t>(3 * (y * part.width + x));
        EXPECT_EQ(texels[at], expected_texel(x, y, 2));
        EXPECT_EQ(texels[at + 1], expected_texel(x, y, 0));
        EXPECT_EQ(texels[at + 2], expected_texel(x, y, 1));
      }
    }
  }
  void expect_refused(const std::string& why, const std::vector<std::string>& channels = {"R"}) {
    EXPECT_THAT(thrown<InputError>([&] { read(channels); }),
                AllOf(StartsWith(file_), HasSubstr(why)));
  }
  const std::string file_ = file("picture.exr");
};

// Every lossless compression and both types. More lines than most compressions take together, and
// channels between those asked for.
TEST_F(ExrFiles, ReadsSomeChannelsOfManyLines) {
  for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT}) {
    for (const Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
          Imf::PIZ_COMPRESSION}) {
      write_scan_lines(file_, {.width = 3,
                               .height = 37,
                               .channels = {"A", "B", "G", "R", "Z"},
                               .type = type,
                               .compression = compression,
                               .left = 2});
      const std::vector<float> texels = read({"R", "B"});
      for (int y = 0; y < 37; ++y) {
        for (int x = 0; x < 3; ++x) {
          const auto at = static_cast<std::size_t>(2 * (3 * y + x));
          // A half holds the larger ones rounded.
          const auto stored = [&](float texel) {
            return type == Imf::HALF ? static_cast<float>(Imath::half(texel)) : texel;
          };
          EXPECT_EQ(texels[at], stored(expected_texel(x, y, 3)));
          EXPECT_EQ(texels[at + 1], stored(expected_texel(x, y, 1)));
        }
      }
    }
  }
}

// A chunk that compression would make larger is stored as it is: the second here, not the first.
TEST_F(ExrFiles, ReadsChunksThatDoNotCompress) {
  const Imath::Box2i box({0, 0}, {4, 31});
  std::vector<float> texels(5 * 32, 1.0F);
  std::uint32_t bits = 1;
  for (std::size_t i = 5 * 16; i < texels.size(); ++i) {
    bits = bits * 1664525 + 1013904223;
    texels[i] = std::bit_cast<float>(bits & 0xbfffffff);  // finite
  }
  Imf::Header header(box, box);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.channels().insert("R", Imf::Channel(Imf::FLOAT));
  Imf::FrameBuffer buffer;
  buffer.insert("R", Imf::Slice::Make(Imf::FLOAT, texels.data(), box, 4, 20));
  {
    Imf::OutputFile output(file_.c_str(), header);
    output.setFrameBuffer(buffer);
    output.writePixels(32);
  }
  EXPECT_EQ(read({"R"}), texels);
}

TEST_F(ExrFiles, ReadsTilesThatDoNotDivideThePicture) {
  for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT}) {
    const Part part{.width = 5, .height = 3, .channels = {"R", "G", "B"}, .type = type};
    write_tiles(file_, part);
    expect_read(part);
  }
}

TEST_F(ExrFiles, NamesChannelsByTheirPartsUnlessTheyDoSoThemselves) {
  write_parts(file_, {{.channels = {"R", "G", "B"}, .name = "beauty"},
                      {.width = 2, .channels = {"albedo.R"}, .type = Imf::HALF, .name = "albedo"}});
  EXPECT_THAT(names(), ElementsAre("beauty.B", "beauty.G", "beauty.R", "albedo.R"));
  EXPECT_EQ(read({"beauty.G"})[5], expected_texel(1, 1, 1));
  EXPECT_EQ(read({"albedo.R"})[3], expected_texel(1, 1, 0));
  expect_refused("of unequal sizes", {"beauty.R", "albedo.R"});
}

TEST_F(ExrFiles, ReadsTheDataWindowWhereverItLies) {
  const std::vector<std::string> channels{"ViewLayer.Debug Sample Count.X"};
  write_scan_lines(file_, {.channels = channels, .left = -7});
  EXPECT_EQ(read(channels)[6], expected_texel(2, 1, 0));
  EXPECT_EQ(open_picture(file_)->window(channels),
            (PictureWindow{.left = -7, .top = 0, .width = 4, .height = 3}));
}

TEST_F(ExrFiles, KnowsTheSamplesThatPbrtWrites) {
  write_scan_lines(file_, {.channels = {"R"}});
  EXPECT_EQ(open_picture(file_)->samples_per_pixel(), std::nullopt);
  write_scan_lines(file_, {.channels = {"R"}, .samples = 64});
  EXPECT_EQ(open_picture(file_)->samples_per_pixel(), 64u);
}

TEST_F(ExrFiles, RefusesWhatIsNoPicture) {
  expect_refused("it does not open: No such file");
  write_bytes(file_, "1 2 3\n");
  expect_refused("it is no OpenEXR, PFM or PNG picture");
  write_bytes(file_, "");
  expect_refused("it is empty");
  write_deep(file_);
  expect_refused("deep pixels");
  write_scan_lines(file_, {.channels = {"R", "G"}});
  expect_refused("there is no channel `Q`; it has `G`, `R`", {"Q"});
  std::filesystem::remove(file_);
  std::filesystem::create_directory(file_);
  expect_refused("it is a folder");
}

// A picture cut anywhere is refused, and nothing else happens.
TEST_F(ExrFiles, RefusesAPictureCutShortAnywhere) {
  for (const bool tiled : {false, true}) {
    const Part part{.width = 40, .height = 40, .channels = {"R", "G", "B"}};
    tiled ? write_tiles(file_, part) : write_scan_lines(file_, part);
    const std::string whole = bytes_in(file_);
    for (std::size_t size = 0; size < whole.size(); size += whole.size() / 37) {
      write_bytes(file_, whole.substr(0, size));
      EXPECT_THROW(read({"R", "G", "B"}), InputError) << size;
    }
  }
}

// The library's classes would make room for the text of an attribute before they read it.
TEST_F(ExrFiles, RefusesAnAttributeLongerThanTheFileBeforeMakingRoomForIt) {
  write_scan_lines(file_, {.channels = {"R"}, .name = "beauty"});
  std::string bytes = bytes_in(file_);
  const std::string key = std::string("name") + '\0' + "string" + '\0';
  const std::size_t size = bytes.find(key) + key.size();
  ASSERT_EQ(bytes[size], 6);
  bytes[size + 3] = 0x6f;
  write_bytes(file_, bytes);
  expect_refused("Invalid size");
}

// The data window's last corner is four integers into its attribute: any number may stand there.
TEST_F(ExrFiles, RefusesAHeaderThatPromisesMoreThanTheFileCanHold) {
  write_scan_lines(file_, {.channels = {"R"}});
  std::string bytes = bytes_in(file_);
  const std::string key = std::string("dataWindow") + '\0' + "box2i" + '\0';
  const std::size_t box = bytes.find(key) + key.size() + 4;
  const auto corner = [&](std::uint32_t x, std::uint32_t y) {
    for (int i = 0; i < 4; ++i) {
      bytes[box + 8 + static_cast<std::size_t>(i)] = static_cast<char>(x >> (8 * i));
      bytes[box + 12 + static_cast<std::size_t>(i)] = static_cast<char>(y >> (8 * i));
    }
    write_bytes(file_, bytes);
  };
  corner(200000000, 2);
  expect_refused("2^27");
  corner(20000000, 2);
  expect_refused("which a file of this size cannot hold");
  corner(2, 200000000);
  expect_refused("damaged or cut short");
  for (const std::uint32_t x : {0U, 1U, 5U, 0x7fffffffU, 0x80000000U, 0xffffffffU}) {
    for (const std::uint32_t y : {0U, 3U, 200U, 0x3fffffffU, 0x7fffffffU, 0xfffffff0U}) {
      corner(x, y);
      // A smaller picture than was written may be read; nothing else may happen.
      try {
        EXPECT_LE(read({"R"}).size(), 24U) << x << " " << y;
      } catch (const InputError&) {
      }
    }
  }
}

}  // namespace
}  // namespace assay
