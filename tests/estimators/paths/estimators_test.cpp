#include "tests/estimators/prelude.h"
// Path estimators against their closed forms and one another.

namespace assay {
namespace {

constexpr std::uint64_t observations = 1u << 17;

double stated_variance(const char* plugin, const std::string& parameters) {
  return channel(plugin, parameters).variance.value();
}

// a = 1/2, Le = 1: Le^2 a / (1 - a)^2 = 2.
TEST(Roulette, FurnaceStatesTheTextbookVariance) {
  EXPECT_DOUBLE_EQ(stated_variance("paths/roulette", "{}"), 2);
  EXPECT_DOUBLE_EQ(stated_variance("paths/improved_roulette", "{scale: .5}"), 0.5);
  EXPECT_DOUBLE_EQ(stated_variance("paths/improved_roulette", "{scale: 2}"), 2);
  EXPECT_DOUBLE_EQ(stated_variance("paths/improved_roulette", "{scale: 0}"), 2);
  // With one child expected at most and one colour, winners and roulette are the same estimator.
  EXPECT_DOUBLE_EQ(stated_variance("paths/winners", "{scene: furnace, splitting: 1}"), 2);
}

TEST(Roulette, ExactTerminalValueLeavesNoVariance) {
  for (const char* parameters : {"{}", "{scene: sphere, direct: exact}"}) {
    const Prepared plugin = prepare("paths/improved_roulette", parameters);
    const Channel stated = plugin.channel();
    EXPECT_EQ(stated.variance, std::nullopt);
    EXPECT_THAT(observe(plugin, 10'000)[0].values, Each(DoubleNear(*stated.mean, stated.rounding)))
        << parameters;
  }
}

// A furnace of diffuse albedo .3 and mirror .4: L = 1 / (1 - .7), whether emission is hit or known.
// Of what a mirror shows the path must see the emission itself (families_test.cpp).
const std::string mirrors =
    "{scene: {furnace: {obj: room.obj, emission: 1, albedo: .3, mirror: .4}, camera: {position: "
    "[1.6, .5, .5], direction: [.3, .2, 1]}}}";

TEST(Mirrors, KeepTheRadianceOfAFurnace) {
  for (const char* plugin : {"plain", "roulette", "improved_roulette", "winners"}) {
    EXPECT_DOUBLE_EQ(*channel(std::string("paths/") + plugin, mirrors).mean, 1 / 0.3);
  }
}

// With N = 4. Vertices of weight 1 have .3 N diffuse
// children of weight 1/N and .4 mirrored ones of weight 1. Vertices of weight 1/N have .3 and .4 /
// N.
TEST(Winners, MirrorsAreNotSplit) {
  const auto samples = observe(prepare("paths/winners", mirrors), observations);
  double one = 1;
  double light = 0;
  for (std::size_t k = 1; k < 5; ++k) {
    const double next_one = 0.4 * (one + light / 4);
    light = 0.3 * (4 * one + light);
    one = next_one;
    EXPECT_THAT(samples[1 + k], HasMean(one + light)) << k;
  }
  EXPECT_THAT(samples[0], HasMean(1 / 0.3));
}

// The box has no closed form: the others agree with the trusted one. Two-sided 1e-6 a channel.
TEST(Box, EveryEstimatorAgreesWithThePlainOne) {
  const auto plain = observe(prepare("paths/plain", "{scene: box}"), observations);
  for (const auto& [plugin, parameters] :
       {std::pair{"paths/roulette", "{scene: box, rule: throughput}"},
        {"paths/roulette", "{scene: box, rule: radiance, direct: sampled}"},
        {"paths/improved_roulette", "{scene: box, terminal: global}"},
        {"paths/improved_roulette", "{scene: box, terminal: local, direct: sampled}"},
        {"paths/winners", "{scene: box, direct: sampled}"}}) {
    const auto other = observe(prepare(plugin, parameters), observations);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_LT(std::abs(plain[c].mean() - other[c].mean()),
                five * std::hypot(plain[c].mean_error(), other[c].mean_error()))
          << plugin << parameters << c;
    }
  }
}

/// The cost of 1000 paths, and their vertices.
std::pair<Cost, double> cost_of(const char* plugin, const std::string& parameters) {
  const Prepared prepared = prepare(plugin, parameters);
  const auto [out, cost] = observe_one(prepared, 1000);
  std::size_t c = 0;
  while (prepared.channel(c).name != "vertices") ++c;
  return {cost, 1000 * out[c]};
}

// In closed scenes every ray makes a vertex.
TEST(Cost, IsOneRayAVertex) {
  for (const char* plugin :
       {"paths/plain", "paths/roulette", "paths/improved_roulette", "paths/winners"}) {
    const auto [cost, vertices] = cost_of(plugin, "{scene: sphere}");
    EXPECT_EQ(cost.samples, 1000u) << plugin;
    EXPECT_EQ(cost.camera_rays, 1000u) << plugin;
    EXPECT_NEAR(double(cost.camera_rays + cost.closest_hit_rays), vertices, 1e-6) << plugin;
    EXPECT_EQ(cost.shadow_rays, 0u) << plugin;
  }
}

TEST(Cost, ShadowRaysGoToWhereThereIsLightAndNowhereElse) {
  const auto [cost, vertices] = cost_of("paths/roulette", "{scene: sphere, direct: sampled}");
  // A tenth of the sphere shines: binomial, 1e-6.
  EXPECT_NEAR(double(cost.shadow_rays), 0.1 * vertices, 4.9 * std::sqrt(0.09 * vertices));
  EXPECT_EQ(observe_one(prepare("paths/ray_free"), 1000).cost.rays(), 0u);
}

TEST(Cost, LocalEstimatesAreCostOfTheSetUp) {
  const Prepared local = prepare("paths/improved_roulette", "{terminal: local}");
  EXPECT_EQ(local.setup->cost().closest_hit_rays, 24u * 256u);
  EXPECT_EQ(prepare("paths/improved_roulette").setup->cost().rays(), 0u);
}

}  // namespace
}  // namespace assay
