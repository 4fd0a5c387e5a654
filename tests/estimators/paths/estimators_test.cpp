// Path estimators against their closed forms and one another.

#include "tests/estimators/draws.h"
#include "tests/prelude.h"

namespace assay {
namespace {

constexpr std::uint64_t observations = 1u << 17;

double stated_variance(const char* plugin, const std::string& parameters) {
  return draws::prepare(plugin, parameters).setup->channels()[0].variance.value();
}

// a = 1/2, Le = 1: Le^2 a / (1 - a)^2 = 2.
TEST(Roulette, FurnaceStatesTheTextbookVariance) {
  EXPECT_DOUBLE_EQ(stated_variance("paths/roulette", "{}"), 2);
  EXPECT_DOUBLE_EQ(stated_variance("paths/improved_roulette", "{scale: .5}"), 0.5);
  EXPECT_DOUBLE_EQ(stated_variance("paths/improved_roulette", "{scale: 2}"), 2);
  EXPECT_DOUBLE_EQ(stated_variance("paths/improved_roulette", "{scale: 0}"), 2);
}

TEST(Roulette, ExactTerminalValueLeavesNoVariance) {
  for (const char* parameters : {"{}", "{scene: sphere, direct: exact}"}) {
    const draws::Prepared plugin = draws::prepare("paths/improved_roulette", parameters);
    const Channel channel = plugin.setup->channels()[0];
    EXPECT_EQ(channel.variance, std::nullopt);
    const std::vector<draws::Sample> samples = draws::observe(plugin, 10'000);
    for (const double x : samples[0].values) {
      ASSERT_NEAR(x, *channel.mean, channel.rounding) << parameters;
    }
  }
}

// With one child expected at most and one colour, winners and roulette are the same estimator.
TEST(Winners, OneChildIsTheClassicalRoulette) {
  EXPECT_DOUBLE_EQ(stated_variance("paths/winners", "{scene: furnace, splitting: 1}"), 2);
}

// A tetrahedron of diffuse albedo .3 and mirror .4.
std::string mirror_room() {
  const auto file = std::filesystem::temp_directory_path() / "assay_paths_mirrors.obj";
  std::ofstream(file) << "v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\n"
                         "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";
  return "scene: {furnace: {obj: " + file.string() +
         ", emission: 1, albedo: .3, mirror: .4}, camera: {position: [0, 0, 0], direction: [.3, "
         ".2, 1]}}";
}

// L = 1 / (1 - .7), whether emission is hit or known: of what a mirror shows the path must see the
// emission itself. False-alarm rate 1e-6 each.
TEST(Mirrors, KeepTheRadianceOfAFurnace) {
  for (const auto& [plugin, more] : {std::pair{"paths/plain", ""},
                                     {"paths/roulette", ""},
                                     {"paths/roulette", ", direct: exact"},
                                     {"paths/improved_roulette", ", scale: .5"},
                                     {"paths/improved_roulette", ", scale: .5, direct: exact"},
                                     {"paths/winners", ", direct: exact"}}) {
    SCOPED_TRACE(std::string(plugin) + more);
    const draws::Prepared prepared = draws::prepare(plugin, "{" + mirror_room() + more + "}");
    EXPECT_DOUBLE_EQ(prepared.setup->channels()[0].mean.value(), 1 / 0.3);
    draws::expect_declared(prepared, observations);
  }
}

// In a furnace with mirrors: diffuse .3, mirror .4, N = 4. Vertices of weight 1 have .3 N diffuse
// children of weight 1/N and .4 mirrored ones of weight 1. Vertices of weight 1/N have .3 and .4 /
// N.
TEST(Winners, MirrorsAreNotSplit) {
  const draws::Prepared plugin = draws::prepare("paths/winners", "{" + mirror_room() + "}");
  const auto samples = draws::observe(plugin, observations);
  double one = 1;
  double light = 0;
  for (std::size_t k = 1; k < 5; ++k) {
    const double next_one = 0.4 * (one + light / 4);
    light = 0.3 * (4 * one + light);
    one = next_one;
    const draws::Sample& bounce = samples[1 + k];
    EXPECT_LT(std::abs(bounce.mean() - one - light), draws::five * bounce.mean_error()) << k;
  }
  // False-alarm rate 1e-6: the radiance is 1 / (1 - .7).
  EXPECT_LT(std::abs(samples[0].mean() - 1 / 0.3), draws::five * samples[0].mean_error());
}

// The box has no closed form: the others agree with the trusted one. Two-sided 1e-6 a channel.
TEST(Box, EveryEstimatorAgreesWithThePlainOne) {
  const auto plain = draws::observe(draws::prepare("paths/plain", "{scene: box}"), observations);
  for (const auto& [plugin, parameters] :
       {std::pair{"paths/roulette", "{scene: box, rule: throughput}"},
        {"paths/roulette", "{scene: box, rule: radiance, direct: sampled}"},
        {"paths/improved_roulette", "{scene: box, terminal: global}"},
        {"paths/improved_roulette", "{scene: box, terminal: local, direct: sampled}"},
        {"paths/winners", "{scene: box, direct: sampled}"}}) {
    const auto other = draws::observe(draws::prepare(plugin, parameters), observations);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_LT(std::abs(plain[c].mean() - other[c].mean()),
                draws::five * std::hypot(plain[c].mean_error(), other[c].mean_error()))
          << plugin << parameters << c;
    }
  }
}

Cost cost_of(const char* plugin, const std::string& parameters, double& vertices) {
  const draws::Prepared prepared = draws::prepare(plugin, parameters);
  const auto channels = prepared.setup->channels();
  std::vector<double> out(channels.size());
  Stream random(prepared.key, 0);
  Cost cost;
  prepared.setup->make()->secondary(random, 1000, out, cost);
  vertices = 0;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].name == "vertices") vertices = 1000 * out[c];
  }
  return cost;
}

// In closed scenes every ray makes a vertex.
TEST(Cost, IsOneRayAVertex) {
  for (const char* plugin :
       {"paths/plain", "paths/roulette", "paths/improved_roulette", "paths/winners"}) {
    double vertices = 0;
    const Cost cost = cost_of(plugin, "{scene: sphere}", vertices);
    EXPECT_EQ(cost.samples, 1000u) << plugin;
    EXPECT_EQ(cost.camera_rays, 1000u) << plugin;
    EXPECT_NEAR(double(cost.camera_rays + cost.closest_hit_rays), vertices, 1e-6) << plugin;
    EXPECT_EQ(cost.shadow_rays, 0u) << plugin;
  }
}

TEST(Cost, ShadowRaysGoToWhereThereIsLightAndNowhereElse) {
  double vertices = 0;
  const Cost cost = cost_of("paths/roulette", "{scene: sphere, direct: sampled}", vertices);
  // A tenth of the sphere shines: binomial, 1e-6.
  EXPECT_NEAR(double(cost.shadow_rays), 0.1 * vertices, 4.9 * std::sqrt(0.09 * vertices));
  double unused = 0;
  const Cost free = cost_of("paths/ray_free", "{}", unused);
  EXPECT_EQ(free.rays(), 0u);
}

TEST(Cost, LocalEstimatesAreCostOfTheSetUp) {
  const draws::Prepared local = draws::prepare("paths/improved_roulette", "{terminal: local}");
  EXPECT_EQ(local.setup->cost().closest_hit_rays, 24u * 256u);
  EXPECT_EQ(draws::prepare("paths/improved_roulette").setup->cost().rays(), 0u);
}

}  // namespace
}  // namespace assay
