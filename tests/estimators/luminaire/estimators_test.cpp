#include "tests/estimators/prelude.h"
// The four estimators of one irradiance; families_test.cpp holds them against what is known
// exactly. False-alarm rate 1e-4 for each comparison.

namespace assay::luminaire {
namespace {

constexpr std::uint64_t observations = 1u << 20;
const std::string at_origin = "{receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: ";

class LuminaireEstimators : public testing::TestWithParam<const char*> {
 protected:
  Prepared in(const std::string& text) const {
    return prepare(std::string("luminaire/") + GetParam(), draws::scene(text));
  }
};

TEST_P(LuminaireEstimators, CountTheirRays) {
  const std::string name = GetParam();
  EXPECT_EQ(
      observe_one(in("triangle"), 1000).cost,
      (name == "hemisphere" || name == "cosine" ? Cost{.closest_hit_rays = 1000, .samples = 1000}
                                                : Cost{.shadow_rays = 1000, .samples = 1000}));
}

TEST_P(LuminaireEstimators, AreExactlyZeroWhereNoLightArrives) {
  const std::string triangle = "light: {polygon: [[0, 0, 1], [1, 0, 1], [0, 1, 1]], radiance: 1";
  for (const std::string& scene :
       {"{receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, " + triangle +
            ", normal: [0, 0, 1]}}",
        "{receiver: {position: [0, 0, 0], normal: [0, 0, -1]}, " + triangle + "}}",
        "{receiver: {position: [3, 3, 1], normal: [0, 0, 1]}, " + triangle + "}}"}) {
    SCOPED_TRACE(scene);
    const Prepared plugin = in(scene);
    EXPECT_THAT(observe(plugin, 1000)[0].values, Each(0));
    EXPECT_EQ(plugin.channel().mean, 0);
    EXPECT_EQ(plugin.channel().variance, 0);
  }
}

// A box whose near faces show the receiver exactly the built-in rectangle: far ones are hidden
// behind them and emit away from the receiver.
TEST_P(LuminaireEstimators, SeeAClosedLampAsItsNearFaces) {
  const Folder place;
  const std::string file =
      place.write("box.obj",
                  "v -.8 -.6 1\nv .9 -.6 1\nv .9 .8 1\nv -.8 .8 1\n"
                  "v -.8 -.6 1.5\nv .9 -.6 1.5\nv .9 .8 1.5\nv -.8 .8 1.5\n"
                  "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const Prepared plugin = in(at_origin + "{obj: " + file + ", radiance: 1}}");
  EXPECT_FALSE(plugin.channel().mean.has_value());
  const Sample sample = observe(plugin, observations)[0];
  EXPECT_NEAR(sample.mean(), 1.320523614, four * sample.mean_error());
}

// Nothing exact is stated with a disc. The reference is the cosine estimator with other
// observations.
TEST_P(LuminaireEstimators, SeeAFiniteDiscInTheWay) {
  const std::string scene = at_origin +
                            "{polygon: [[-.8, -.6, 1], [.9, -.6, 1], [.9, .8, 1], [-.8, .8, 1]], "
                            "radiance: 1}, occluders: "
                            "[{disc: {center: [.1, .1, .5], normal: [0, 0, 1], radius: .2}}]}";
  Prepared cosine = prepare("luminaire/cosine", draws::scene(scene));
  cosine.key = stream_key(1, "reference", "", 0);
  const Sample reference = observe(cosine, observations)[0];
  const Sample sample = observe(in(scene), observations)[0];
  EXPECT_NEAR(sample.mean(), reference.mean(),
              four * std::hypot(sample.mean_error(), reference.mean_error()));
  EXPECT_LT(sample.mean(), 1.3);
}

INSTANTIATE_TEST_SUITE_P(Luminaire, LuminaireEstimators,
                         testing::Values("hemisphere", "cosine", "area", "solid_angle"),
                         [](const auto& parameter) { return std::string(parameter.param); });

TEST(LuminaireEstimators, HaveThePublishedDeviationsOnTheTriangle) {
  const auto deviation = [](const char* plugin) {
    return std::sqrt(*channel(plugin, "{scene: triangle}").variance);
  };
  // The first was measured from 4e6 samples and is 1.563 exactly.
  EXPECT_NEAR(deviation("luminaire/hemisphere"), 1.564, 1.5e-3);
  EXPECT_NEAR(deviation("luminaire/cosine"), 1.131, 5e-4);
  EXPECT_NEAR(deviation("luminaire/area"), 0.262, 5e-4);
  EXPECT_NEAR(deviation("luminaire/solid_angle"), 0.041, 5e-4);
}

TEST(LuminaireMutants, TwoSidedLightShinesBackwards) {
  const auto mutant = prepare("mutants/two_sided_light",
                              draws::scene(at_origin + "{polygon: [[.2, -.4, 1], [1.6, .3, 1.4], "
                                                       "[-.3, 1.2, 1.1]], normal: [-.57, -.34, "
                                                       "2.59], radiance: 1}}"));
  EXPECT_EQ(mutant.channel().mean, 0);
  const Sample sample = observe(mutant, observations)[0];
  EXPECT_NEAR(sample.mean(), 0.481046907316, four * sample.mean_error());
}

TEST(LuminaireMutants, StateTheirOriginalAndDefect) {
  const auto of_luminaire = [](const Entry& entry) {
    return entry.information.original.starts_with("luminaire/");
  };
  EXPECT_EQ(std::ranges::count_if(catalogue(), of_luminaire), 19);
}

}  // namespace
}  // namespace assay::luminaire
