#include "estimators/map_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <stdexcept>

namespace assay {
namespace {

std::vector<float> read_back(const std::string& file, const std::string& channel) {
  Imf::InputFile input(file.c_str());
  const Imath::Box2i window = input.header().dataWindow();
  const auto width = static_cast<std::size_t>(window.max.x + 1);
  std::vector<float> values(width * static_cast<std::size_t>(window.max.y + 1));
  Imf::FrameBuffer buffer;
  buffer.insert(channel, Imf::Slice::Make(Imf::FLOAT, values.data(), window, sizeof(float),
                                          sizeof(float) * width));
  input.setFrameBuffer(buffer);
  input.readPixels(window.min.y, window.max.y);
  return values;
}

TEST(MapFile, ReadsBackLayerByLayerBitForBit) {
  const std::string file = testing::TempDir() + "map_file_test.exr";
  const std::vector<float> z = {1.5f, -2.25f, std::numeric_limits<float>::infinity(), 1e-40f, 5, 6};
  const std::vector<float> colours = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  write_map_file(file, {3, 2}, {{"z", {"value"}, z}, {"mean", {"red", "green"}, colours}});
  EXPECT_EQ(read_back(file, "z.value"), z);
  EXPECT_EQ(read_back(file, "mean.red"), (std::vector<float>{1, 3, 5, 7, 9, 11}));
  EXPECT_EQ(read_back(file, "mean.green"), (std::vector<float>{2, 4, 6, 8, 10, 12}));
  std::filesystem::remove(file);
}

TEST(MapFile, NamesTheFileThatCannotBeWritten) {
  const std::vector<float> z(6);
  try {
    write_map_file("/nowhere/map.exr", {3, 2}, {{"z", {"value"}, z}});
    FAIL() << "was written";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).find("cannot write /nowhere/map.exr: "), 0u)
        << error.what();
  }
}

}  // namespace
}  // namespace assay
