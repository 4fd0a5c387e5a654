#include "render/environment_map.h"
#include "tests/estimators/exr.h"
#include "tests/estimators/prelude.h"

namespace assay {
namespace {

using render::EnvironmentMap;
using render::Rgb;
using render::Vector3;

class ReadEnvironment : public InFolder {
 protected:
  void write(const std::vector<std::string>& channels, std::vector<float> values,
             int height = 1) const {
    const int width = static_cast<int>(values.size() / channels.size()) / height;
    write_exr(file_, {width, height, channels, std::move(values)});
  }
  std::string bytes() const { return bytes_in(file_); }
  void write_bytes(const std::string& text) const { place_.write("map.exr", text); }
  void expect_refused(const std::string& why) const {
    EXPECT_THAT(thrown<InputError>([&] { render::read_environment(file_); }),
                AllOf(StartsWith(file_), HasSubstr(why)));
  }
  const std::string file_ = file("map.exr");
};

TEST_F(ReadEnvironment, ReadsColoursAndGrey) {
  write({"R", "G", "B", "A"}, {1, 2, 3, 0, 4, 5, 6, 0});
  const EnvironmentMap colour = render::read_environment(file_);
  EXPECT_EQ(colour.resolution().width, 2u);
  EXPECT_EQ(colour.resolution().height, 1u);
  EXPECT_EQ(colour.radiance(std::size_t{0}), (Rgb{1, 2, 3}));
  EXPECT_EQ(colour.radiance(std::size_t{1}), (Rgb{4, 5, 6}));
  write({"Y"}, {7, 8}, 2);
  const EnvironmentMap grey = render::read_environment(file_);
  EXPECT_EQ(grey.resolution().height, 2u);
  EXPECT_EQ(grey.radiance(Vector3{0, 0, 1}), (Rgb{7, 7, 7})) << "+z is the first row's pole";
  EXPECT_EQ(grey.radiance(Vector3{0, 0, -1}), (Rgb{8, 8, 8}));
}

TEST_F(ReadEnvironment, RefusesWhatIsNoRadiance) {
  write({"R", "G"}, {1, 2});
  expect_refused("needs the channels R, G and B, or Y; it has G, R");
  EXPECT_THAT(refusal("environment/cosine", "{map: map.exr}", folder_.string()),
              AllOf(HasSubstr("environment/cosine: parameter `map`"), HasSubstr("map.exr")));
  write({"Y"}, {1, 1, 1, -0.5f}, 2);
  expect_refused("row 1, column 1 is -0.5");
  write({"Y"}, {1, std::numeric_limits<float>::quiet_NaN()});
  expect_refused("row 0, column 1 is nan");
  write({"Y"}, {std::numeric_limits<float>::infinity(), 1});
  expect_refused("row 0, column 0 is inf");
}

// The header's boxes are four 32-bit numbers after the attribute's name and type.
void patch_box(std::string& file, const std::string& name, const std::array<std::int32_t, 4>& box) {
  const std::string attribute = name + std::string("\0box2i\0\x10\0\0\0", 11);
  const std::size_t at = file.find(attribute);
  ASSERT_NE(at, file.npos);
  std::string raw(reinterpret_cast<const char*>(box.data()), 16);
  file.replace(at + attribute.size(), 16, raw);
}

TEST_F(ReadEnvironment, RefusesCroppedPictures) {
  write({"Y"}, {1, 1});
  std::string file = bytes();
  patch_box(file, std::string("displayWindow"), {0, 0, 2, 0});
  write_bytes(file);
  expect_refused("cropped");
}

TEST_F(ReadEnvironment, EmittanceRefusesABlackSky) {
  write({"Y"}, {0, 0});
  EXPECT_THROW(prepare("environment/emittance", "{map: map.exr}", folder_.string()), InputError);
  const auto cosine = prepare("environment/cosine", "{map: map.exr}", folder_.string());
  EXPECT_EQ(cosine.channel().mean, 0);
  EXPECT_EQ(cosine.channel().variance, 0);
}

TEST_F(ReadEnvironment, UniformSkyGivesPi) {
  write({"Y"}, {2, 2, 2, 2, 2, 2}, 2);
  for (const char* plugin : {"environment/cosine", "environment/emittance"}) {
    const auto prepared = prepare(plugin, "{map: map.exr, normal: [1, 2, -2]}", folder_.string());
    const Channel channel = prepared.channel(1);
    EXPECT_NEAR(*channel.mean, 2 * pi, 1e-12) << plugin;
    EXPECT_LE(std::abs(*channel.mean - 2 * pi), channel.mean_error + 1e-14) << plugin;
  }
}

}  // namespace
}  // namespace assay
