#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>

#include "render/alias_table.h"
#include "render/patch_integrals.h"
#include "tests/estimators/draws.h"
#include "tests/estimators/exr.h"
#include "tests/estimators/sky.h"

namespace assay {
namespace {

using render::EnvironmentMap;
using render::Patch;
using render::Rgb;
using render::Vector3;
using ::testing::HasSubstr;
using namespace assay::draws;
using std::numbers::pi;

const std::string data = ASSAY_SOURCE_DIR "/suites/data";

Prepared sky_plugin(const std::string& plugin, const std::string& more = "") {
  return prepare("environment/" + plugin, "{map: sky.exr" + more + "}", data);
}

// --- Patches ---------------------------------------------------------------------------------

// Midpoint sums of max(0, n.w)^k over a patch.
std::array<double, 2> brute_force(const Patch& patch, const Vector3& n) {
  constexpr int steps = 1200;
  std::array<double, 2> sum{};
  const double dt = (patch.theta[1] - patch.theta[0]) / steps;
  const double dp = (patch.phi[1] - patch.phi[0]) / steps;
  for (int i = 0; i < steps; ++i) {
    const double theta = patch.theta[0] + (i + 0.5) * dt;
    for (int j = 0; j < steps; ++j) {
      const double phi = patch.phi[0] + (j + 0.5) * dp;
      const double cosine =
          std::max(0.0, n.x * std::sin(theta) * std::cos(phi) +
                            n.y * std::sin(theta) * std::sin(phi) + n.z * std::cos(theta));
      sum[0] += cosine * std::sin(theta) * dt * dp;
      sum[1] += cosine * cosine * std::sin(theta) * dt * dp;
    }
  }
  return sum;
}

TEST(PatchIntegrals, AgreeWithBruteForceSums) {
  const std::vector<Patch> patches{{{0, 0.4}, {0, 0.5}},
                                   {{0.3, 0.5}, {1, 1.2}},
                                   {{1.2, 1.9}, {5.5, 6.2}},
                                   {{2.8, pi}, {0, 2 * pi}},
                                   {{0, pi}, {0, 2 * pi}}};
  for (const Vector3& n :
       {Vector3{0, 0, 1}, Vector3{0, 0, -1}, Vector3{1, 0, 0}, normalised(Vector3{0.3, -0.5, 0.8}),
        normalised(Vector3{-1, 1, -0.01}), normalised(Vector3{0.2, 0.9, -0.7})}) {
    for (const Patch& patch : patches) {
      const auto exact = cosine_moments(patch, n);
      const auto brute = brute_force(patch, n);
      // The midpoint rule leaves some h^2 of the integral: 1e-5 for the whole sphere.
      EXPECT_NEAR(exact.first, brute[0], 1e-5);
      EXPECT_NEAR(exact.second, brute[1], 1e-5);
      EXPECT_LT(exact.error, 1e-11);
    }
  }
}

// Over any division of the sphere the first moments sum to pi, the second to 2 pi / 3.
TEST(PatchIntegrals, AddUpToTheHemisphere) {
  const EnvironmentMap map({.width = 48, .height = 25}, std::vector<Rgb>(48 * 25));
  for (const Vector3& n : {Vector3{0, 0, 1}, Vector3{0, -1, 0}, normalised(Vector3{0.3, -0.5, 0.8}),
                           normalised(Vector3{1, 2, -1e-3})}) {
    double first = 0, second = 0, error = 0, angle = 0;
    for (std::size_t texel = 0; texel < map.size(); ++texel) {
      const auto moments = cosine_moments(map.patch(texel), n);
      first += moments.first;
      second += moments.second;
      error += moments.error;
      angle += solid_angle(map.patch(texel));
    }
    EXPECT_NEAR(angle, 4 * pi, 1e-12);
    EXPECT_NEAR(first, pi, 1e-11);
    EXPECT_NEAR(second, 2 * pi / 3, 1e-11);
    EXPECT_LT(error, 1e-11);
  }
}

TEST(EnvironmentMap, FindsTheTexelOfADirectionDrawnInIt) {
  const EnvironmentMap map({.width = 6, .height = 5}, std::vector<Rgb>(30));
  for (std::size_t texel = 0; texel < map.size(); ++texel) {
    for (const double u : {0.001, 0.5, 0.999}) {
      for (const double v : {0.001, 0.5, 0.999}) {
        EXPECT_EQ(map.texel(direction_in(map.patch(texel), {u, v})), texel);
      }
    }
  }
  EXPECT_EQ(map.texel({0, 0, 1}), 0u);
  EXPECT_EQ(map.texel({0, 0, -1}) / 6, 4u);
  EXPECT_EQ(map.texel({1, -1e-300, 0}) % 6, 5u) << "just below a full turn is the last column";
}

TEST(EnvironmentMap, RefusesWhatIsNoRadiance) {
  EXPECT_THROW(EnvironmentMap({.width = 0, .height = 0}, {}), std::invalid_argument);
  EXPECT_THROW(EnvironmentMap({.width = 2, .height = 1}, {{1, 1, 1}}), std::invalid_argument);
  EXPECT_THROW(EnvironmentMap({.width = 1, .height = 1}, {{1, -1, 1}}), std::invalid_argument);
}

// --- Alias table -----------------------------------------------------------------------------

// The probabilities by exhausting a grid of (u, v).
TEST(AliasTable, PicksInProportion) {
  const std::vector<double> weights{3, 0, 1, 4, 0, 2, 6};
  const render::AliasTable table(weights);
  EXPECT_EQ(table.total(), 16);
  std::vector<double> share(weights.size());
  constexpr int columns = 7, steps = 1600;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < steps; ++j) {
      share[table.pick((i + 0.5) / columns, (j + 0.5) / steps)] += 1.0 / (columns * steps);
    }
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    EXPECT_NEAR(share[i], weights[i] / 16, 1.0 / steps);
    if (weights[i] == 0) {
      EXPECT_EQ(share[i], 0);
    }
  }
}

TEST(AliasTable, RefusesWeightsWithoutAPositiveSum) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& weights : std::vector<std::vector<double>>{{}, {0, 0}, {1, -1}, {nan, 1}}) {
    EXPECT_THROW(render::AliasTable{weights}, std::invalid_argument);
  }
}

// --- Reading pictures ------------------------------------------------------------------------

class Exr : public ::testing::Test {
 protected:
  Exr() {
    const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        std::filesystem::path(::testing::TempDir()) / (std::string("assay_exr_") + test->name());
    std::filesystem::create_directories(folder_);
    file_ = (folder_ / "map.exr").string();
  }
  ~Exr() override { std::filesystem::remove_all(folder_); }

  void write(const std::vector<std::string>& channels, std::vector<float> values,
             int height = 1) const {
    const int width = static_cast<int>(values.size() / channels.size()) / height;
    write_exr(file_, {width, height, channels, std::move(values)});
  }
  std::string bytes() const {
    std::ifstream stream(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void write_bytes(const std::string& text) const {
    std::ofstream(file_, std::ios::binary) << text;
  }
  void expect_refused(const std::string& why) const {
    try {
      render::read_environment(file_);
      ADD_FAILURE() << "accepted, but " << why;
    } catch (const InputError& error) {
      EXPECT_EQ(error.where().file, file_);
      EXPECT_THAT(error.message(), HasSubstr(why));
    }
  }

  std::filesystem::path folder_;
  std::string file_;
};

TEST_F(Exr, ReadsColoursAndGrey) {
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

TEST_F(Exr, RefusesMissingChannels) {
  write({"R", "G"}, {1, 2});
  expect_refused("needs the channels R, G and B, or Y; it has G, R");
}

TEST_F(Exr, RefusesRadianceThatIsNegativeOrNotFinite) {
  write({"Y"}, {1, 1, 1, -0.5f}, 2);
  expect_refused("row 1, column 1 is -0.5");
  write({"Y"}, {1, std::numeric_limits<float>::quiet_NaN()});
  expect_refused("row 0, column 1 is nan");
  write({"Y"}, {std::numeric_limits<float>::infinity(), 1});
  expect_refused("row 0, column 0 is inf");
}

TEST_F(Exr, RefusesTruncatedFiles) {
  std::vector<float> noise;
  for (std::uint64_t i = 0; i < 64 * 64; ++i) {
    noise.push_back(static_cast<float>(Stream(StreamKey{1}, i).uniform()));
  }
  write({"Y"}, noise, 64);
  const std::string whole = bytes();
  for (const std::size_t length :
       {whole.size() - 1, whole.size() / 2, whole.size() / 50, std::size_t{10}, std::size_t{0}}) {
    write_bytes(whole.substr(0, length));
    expect_refused("cannot be read as OpenEXR");
  }
}

TEST_F(Exr, RefusesOtherFiles) {
  expect_refused("cannot be read as OpenEXR");  // not there
  write_bytes("P6 1 1 255 ...");
  expect_refused("cannot be read as OpenEXR");
}

// The header's boxes are four 32-bit numbers after the attribute's name and type.
void patch_box(std::string& file, const std::string& name, const std::array<std::int32_t, 4>& box) {
  const std::string attribute = name + std::string("\0box2i\0\x10\0\0\0", 11);
  const std::size_t at = file.find(attribute);
  ASSERT_NE(at, file.npos);
  std::string raw(reinterpret_cast<const char*>(box.data()), 16);
  file.replace(at + attribute.size(), 16, raw);
}

TEST_F(Exr, RefusesPicturesWithoutTexels) {
  write({"Y"}, {1, 1});
  std::string file = bytes();
  patch_box(file, std::string("dataWindow"), {0, 0, -1, 0});
  patch_box(file, std::string("displayWindow"), {0, 0, -1, 0});
  write_bytes(file);
  // OpenEXR itself refuses such a header.
  expect_refused("cannot be read as OpenEXR");
}

TEST_F(Exr, RefusesCroppedPictures) {
  write({"Y"}, {1, 1});
  std::string file = bytes();
  patch_box(file, std::string("displayWindow"), {0, 0, 2, 0});
  write_bytes(file);
  expect_refused("cropped");
}

TEST_F(Exr, ThePluginNamesItsParameterAndTheFile) {
  write({"R"}, {1});
  try {
    prepare("environment/cosine", "{map: map.exr}", folder_.string());
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.message(), HasSubstr("environment/cosine: parameter `map`"));
    EXPECT_THAT(error.message(), HasSubstr("map.exr"));
  }
}

TEST_F(Exr, EmittanceRefusesABlackSky) {
  write({"Y"}, {0, 0});
  EXPECT_THROW(prepare("environment/emittance", "{map: map.exr}", folder_.string()), InputError);
  const auto cosine = prepare("environment/cosine", "{map: map.exr}", folder_.string());
  EXPECT_EQ(*cosine.setup->channels()[0].mean, 0);
  EXPECT_EQ(*cosine.setup->channels()[0].variance, 0);
}

// --- Estimators ------------------------------------------------------------------------------

TEST_F(Exr, UniformSkyGivesPi) {
  write({"Y"}, {2, 2, 2, 2, 2, 2}, 2);
  for (const char* plugin : {"environment/cosine", "environment/emittance"}) {
    const auto prepared = prepare(plugin, "{map: map.exr, normal: [1, 2, -2]}", folder_.string());
    const Channel channel = prepared.setup->channels()[1];
    EXPECT_NEAR(*channel.mean, 2 * pi, 1e-12) << plugin;
    EXPECT_LE(std::abs(*channel.mean - 2 * pi), channel.mean_error + 1e-14) << plugin;
  }
}

TEST(Environment, TheSharedPictureIsWhatItsProgramMakes) {
  const EnvironmentMap map = render::read_environment(data + "/sky.exr");
  ASSERT_EQ(map.resolution().width, sky_width);
  ASSERT_EQ(map.resolution().height, sky_height);
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto texel = sky_texel(i / sky_width, i % sky_width);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(map.radiance(i)[c] / double{texel[c]}, 1, 1e-6);
    }
  }
}

// False alarm: 2 plugins x 3 normals x 3 channels x 2 comparisons at 1e-6 each.
TEST(Environment, SampledMeansAndVariancesAreExact) {
  for (const char* name : {"cosine", "emittance"}) {
    for (const char* normal : {"[0, 0, 1]", "[.3, -.5, .8]", "[-1, 0.2, -2]"}) {
      const auto plugin = sky_plugin(name, std::string(", normal: ") + normal);
      const auto channels = plugin.setup->channels();
      const auto samples = observe(plugin, 200000);
      ASSERT_EQ(channels.size(), 3u);
      for (std::size_t c = 0; c < 3; ++c) {
        const Sample& sample = samples[c];
        EXPECT_NEAR(sample.mean(), *channels[c].mean, five * sample.mean_error()) << name;
        EXPECT_NEAR(sample.variance(), *channels[c].variance, five * sample.variance_error())
            << name << normal;
        EXPECT_LT(channels[c].mean_error, 1e-9 * *channels[c].mean);
        EXPECT_LE(*std::ranges::max_element(sample.values), channels[c].high);
        EXPECT_GE(*std::ranges::min_element(sample.values), channels[c].low);
      }
    }
  }
}

TEST(Environment, BothEstimatorsHaveOneMean) {
  const auto a = sky_plugin("cosine").setup->channels();
  const auto b = sky_plugin("emittance").setup->channels();
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(a[c].mean, b[c].mean);
    EXPECT_LT(*b[c].variance, *a[c].variance) << "the sun is where emittance sampling looks";
  }
  EXPECT_EQ(a[0].name, "r");
  EXPECT_EQ(a[2].name, "b");
}

// A wall at x = -0.001 hides w_x < 0 but for a millionth: what is left is the sum over the texels
// with w_x > 0, whose columns end at the wall. Single precision rays. False alarm: 6 at 1e-6.
TEST(Environment, AWallHidesHalfTheSky) {
  const EnvironmentMap map = render::read_environment(data + "/sky.exr");
  Rgb expected{};
  for (std::size_t i = 0; i < map.size(); ++i) {
    const std::size_t column = i % sky_width;
    if (column >= sky_width / 4 && column < 3 * sky_width / 4) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      expected[c] += map.radiance(i)[c] * cosine_moments(map.patch(i), {0, 0, 1}).first;
    }
  }
  const std::string wall =
      ", position: [5, 6, 7], occluders: [{polygon: [[4.999, -994, -993], [4.999, 1006, -993], "
      "[4.999, 1006, 1007], [4.999, -994, 1007]]}]";
  for (const char* name : {"cosine", "emittance"}) {
    const auto plugin = sky_plugin(name, wall);
    const auto samples = observe(plugin, 200000);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_FALSE(plugin.setup->channels()[c].mean.has_value());
      EXPECT_NEAR(samples[c].mean(), expected[c],
                  five * samples[c].mean_error() + 1e-5 * expected[c])
          << name;
    }
  }
}

// S6: L = 1 + bx wx + bz wz with the half w_x > 0 gives pi/2 + (2/3) bx + (pi/3) bz. Texels at
// their middle's radiance differ by some h^2.
TEST(Environment, GradientSkyApproachesItsClosedForm) {
  const double bx = 0.3, bz = 0.2;
  const EnvironmentMap map({.width = 512, .height = 256}, std::vector<Rgb>(512 * 256));
  double half = 0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Patch p = map.patch(i);
    const double theta = (p.theta[0] + p.theta[1]) / 2, phi = (p.phi[0] + p.phi[1]) / 2;
    const double x = std::sin(theta) * std::cos(phi);
    if (x > 0) half += (1 + bx * x + bz * std::cos(theta)) * cosine_moments(p, {0, 0, 1}).first;
  }
  EXPECT_NEAR(half, pi / 2 + 2 * bx / 3 + pi * bz / 3, 2e-5);
}

// False alarm 2e-6. Cells are 2 x 2 texels; the emittance sampler is uniform within a texel.
TEST(Environment, EmittanceDirectionsFollowTheirDensity) {
  const auto plugin = sky_plugin("emittance");
  const auto named = plugin.setup->samplers().at(0);
  EXPECT_EQ(named.sampler->domain(), Domain::sphere);
  const EnvironmentMap map = render::read_environment(data + "/sky.exr");
  // Quarters of texels.
  std::vector<double> counts(4 * map.size());
  constexpr int draws = 400000;
  for (std::uint64_t i = 0; i < draws; ++i) {
    Stream random(plugin.key, i);
    const SamplerDraw draw = named.sampler->sample(random);
    ASSERT_TRUE(draw.valid);
    const Vector3 w{draw.point[0], draw.point[1], draw.point[2]};
    const std::size_t texel = map.texel(w);
    const Patch p = map.patch(texel);
    const bool lower = w.z < (std::cos(p.theta[0]) + std::cos(p.theta[1])) / 2;
    const double phi = std::atan2(w.y, w.x);
    const bool later = (phi < 0 ? phi + 2 * pi : phi) > (p.phi[0] + p.phi[1]) / 2;
    counts[4 * texel + (lower ? 2 : 0) + (later ? 1 : 0)] += 1;
    EXPECT_NEAR(draw.weight * draw.density, named.sampler->evaluate(draw.point), 1e-9);
  }
  double total = 0;
  std::vector<double> power;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto l = sky_texel(i / sky_width, i % sky_width);
    const Patch p = map.patch(i);
    power.push_back(double{l[0] + l[1] + l[2]} * (p.phi[1] - p.phi[0]) *
                    (std::cos(p.theta[0]) - std::cos(p.theta[1])));
    total += power.back();
  }
  Pearson pearson;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    pearson.add(counts[i], draws * power[i / 4] / total / 4);
  }
  EXPECT_TRUE(pearson.passes()) << pearson.statistic;
}

// False alarm 1e-6. Cells of equal probability: z^2 is uniform.
TEST(Environment, CosineDirectionsFollowTheirDensity) {
  const auto plugin = sky_plugin("cosine", ", normal: [1, 1, 0]");
  const auto named = plugin.setup->samplers().at(0);
  EXPECT_EQ(named.sampler->domain(), Domain::hemisphere);
  std::vector<double> counts(256);
  constexpr int draws = 100000;
  for (std::uint64_t i = 0; i < draws; ++i) {
    Stream random(plugin.key, i);
    const SamplerDraw draw = named.sampler->sample(random);
    const double turn = std::atan2(draw.point[1], draw.point[0]) / (2 * pi);
    const double row = std::min(15.0, std::floor(16 * draw.point[2] * draw.point[2]));
    const double column = std::min(15.0, std::floor(16 * (turn < 0 ? turn + 1 : turn)));
    counts[static_cast<std::size_t>(16 * row + column)] += 1;
    EXPECT_NEAR(draw.density, draw.point[2] / pi, 1e-15);
    EXPECT_NEAR(draw.weight * draw.density, named.sampler->evaluate(draw.point), 1e-12);
  }
  Pearson pearson;
  for (const double count : counts) pearson.add(count, draws / 256.0);
  EXPECT_TRUE(pearson.passes()) << pearson.statistic;
}

TEST(Environment, RefusesBadReceiversAndOccluders) {
  EXPECT_THROW(sky_plugin("cosine", ", normal: [0, 0, 0]"), InputError);
  EXPECT_THROW(sky_plugin("cosine", ", normal: up"), InputError);
  EXPECT_THROW(sky_plugin("cosine", ", position: [0, 0]"), InputError);
  EXPECT_THROW(sky_plugin("cosine", ", occluders: [{ball: 1}]"), InputError);
}

}  // namespace
}  // namespace assay
