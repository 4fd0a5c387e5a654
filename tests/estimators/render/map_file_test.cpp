#include "estimators/map_file.h"

#include "tests/estimators/exr.h"
#include "tests/prelude.h"

namespace assay {
namespace {

TEST(MapFile, ReadsBackLayerByLayerBitForBit) {
  const Folder place;
  const std::string file = place.file("map.exr");
  const std::vector<float> z = {1.5f, -2.25f, std::numeric_limits<float>::infinity(), 1e-40f, 5, 6};
  const std::vector<float> colours = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  write_map_file(file, {3, 2}, {{"z", {"value"}, z}, {"mean", {"red", "green"}, colours}});
  EXPECT_EQ(draws::read_exr_channel(file, "z.value"), z);
  EXPECT_EQ(draws::read_exr_channel(file, "mean.red"), (std::vector<float>{1, 3, 5, 7, 9, 11}));
  EXPECT_EQ(draws::read_exr_channel(file, "mean.green"), (std::vector<float>{2, 4, 6, 8, 10, 12}));
}

TEST(MapFile, NamesTheFileThatCannotBeWritten) {
  const std::vector<float> z(6);
  EXPECT_THAT(thrown([&] {
                write_map_file("/nowhere/map.exr", {3, 2}, {{"z", {"value"}, z}});
              }),
              StartsWith("cannot write /nowhere/map.exr: "));
}

TEST(MapFile, RefusesALayerOfAnotherSize) {
  const std::vector<float> z(8);
  const Folder place;
  const std::string file = place.file("map.exr");
  EXPECT_THROW(write_map_file(file, {3, 2}, {{"z", {"value"}, z}}), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace assay
