#include "tests/reports/example_tests.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace assay::reports {

namespace {

constexpr std::array<double, 21> normal_quantiles = {-2.6, -2.0, -1.67, -1.4, -1.2, -1.0, -0.8,
                                                     -0.6, -0.4, -0.2,  0.0,  0.2,  0.4,  0.6,
                                                     0.8,  1.0,  1.2,   1.4,  1.67, 2.0,  2.6};

Histogram bell(const Law& law) {
  Histogram h;
  h.low = law.mean - 3 * law.deviation;
  h.high = law.mean + 3 * law.deviation;
  for (int i = 0; i < 30; ++i) {
    const double x = (i - 14.5) / 15 - 0.35 * law.bend;
    const double cap = x > -1 && x < 1 ? 1 - x * x : 0;
    h.counts.push_back(static_cast<std::uint64_t>(120 * cap * cap * cap * cap));
  }
  h.below = 2;
  h.above = law.bend > 0 ? 9 : 3;
  return h;
}

std::vector<QuantilePoint> quantiles(const Law& law) {
  std::vector<QuantilePoint> points;
  for (const double z : normal_quantiles)
    points.push_back({z, law.mean + law.deviation * (z + law.bend * (z * z - 1))});
  return points;
}

}  // namespace

Sample sample(const std::string& estimator, const Law& law) {
  Sample s;
  s.estimator = estimator;
  s.plugin = "luminaire/" + estimator;
  s.parameters = R"(sampler=":published",scene="triangle")";
  s.channel = "value";
  s.stream = "5d3c1f0a9b7e2468";
  s.primaries = 64;
  s.secondaries = 16384;
  s.mean = law.mean;
  s.variance = law.deviation * law.deviation;
  s.skewness = 6 * law.bend;
  s.kurtosis = 3 + 10 * law.bend;
  s.minimum = law.mean - 3.1 * law.deviation;
  s.maximum = law.mean + 3.4 * law.deviation;
  s.nonzero = 16380;
  s.histogram = bell(law);
  s.quantiles = quantiles(law);
  s.cost = {.camera_rays = 0,
            .closest_hit_rays = 1048576,
            .shadow_rays = 524288,
            .samples = 1048576,
            .seconds = 0.375};
  s.with_cost = {{.kind = "rays", .mean = 128, .m2 = 0.5, .m11 = -0.25, .m21 = 3e-5}};
  return s;
}

Channel channel(const std::string& name, const Effect& effect) {
  Channel c;
  c.name = name;
  c.statistic = 0.84;
  c.distribution = {"students_t", {16383}};
  c.p_value = 0.4;
  c.log10_p = -0.3979400086720376;
  c.p_adjusted = 1;
  c.p_pass = 1.5e-7;
  c.log10_p_adjusted = 0;
  c.log10_p_pass = -6.823908740944319;
  c.effect = effect;
  c.reference = 0.481046907316;
  return c;
}

namespace {

// Nine values of a uniform law on [0, 1]; the claimed law is null if there is none.
EmpiricalLaw empirical_law(const std::string& source, double shift, bool claimed) {
  EmpiricalLaw law{.source = source, .confidence = 0.99};
  for (int i = 1; i < 10; ++i) {
    const double part = 0.1 * i;
    law.points.push_back({.value = part + shift,
                          .observed = part,
                          .low = std::max(0.0, part - 0.25),
                          .high = std::min(1.0, part + 0.25)});
    if (claimed) law.points.back().law = part;
  }
  return law;
}

}  // namespace

Effect mean_effect(double estimate, double half_width) {
  return {"relative difference of means", estimate, estimate - half_width,
          estimate + half_width,          0.99,     true};
}

namespace {

Effect ratio_effect(double estimate, double half_width) {
  return {"ln variance ratio", estimate, estimate - half_width, estimate + half_width, 0.99, false};
}

}  // namespace

Test base(const std::string& name, int line) {
  Test t;
  t.name = t.claim = name;
  t.id = "triangle/" + name;
  t.file = "suites/triangle.yaml";
  t.line = line;
  t.tags = {"main"};
  t.over = "{primaries: [8, 16]}";
  t.reference = "trusted";
  t.cost = "samples";
  t.method = "t";
  t.tail = "two-sided";
  t.null_hypothesis = "the mean equals 0.481046907316";
  t.alpha = 0.00125;
  t.beta = 0.01;
  t.detect = 0.005;
  t.allow = 0.0;
  t.detectable = 0.0031;
  t.power = 0.99;
  t.gates = {{"skewness", 1.04, 1.25, "green"}, {"dominance", 0.03, 0.1, "green"}};
  t.replay = "assay replay run.json '" + t.id + "'";
  return t;
}

Test passing() {
  Test t = base("mean(area) == analytic", 14);
  t.verdict = t.expected = Verdict::pass;
  t.ok = true;
  t.samples = {sample("area", {0.4812, 0.031, 0.01})};
  t.channels = {channel("value", mean_effect(0.00031, 0.00125))};
  t.channels[0].laws = {empirical_law("area", 0.02, true)};
  t.message = "no evidence of bias; a bias of 0.31 % or more is excluded";
  return t;
}

Test proof() {
  Test t = base("variance(area) < variance(hemisphere)", 16);
  t.verdict = Verdict::pass;
  t.ok = true;
  t.method = "influence-t";
  t.tail = "upper";
  t.null_hypothesis = "variance(area) <= variance(hemisphere)";
  t.detect = 0.5;
  t.detectable = 0.12;
  t.samples = {sample("area", {0.4812, 0.031, 0.01}), sample("hemisphere", {0.4809, 0.062, 0.08})};
  t.channels = {channel("value", ratio_effect(-1.38, 0.06))};
  // The claim stands with p = 1; its contrary is rejected with a p-value that underflowed.
  t.channels[0].p_value = 1;
  t.channels[0].log10_p = -6e-304;
  t.channels[0].p_pass = 5e-324;
  t.channels[0].log10_p_pass = -1204.64;
  t.channels[0].effect.low.reset();
  t.channels[0].reference.reset();
  t.channels[0].laws = {empirical_law("area", 0, false), empirical_law("hemisphere", 0.1, false)};
  t.message = "proved: the variance is 0.252 times as large";
  return t;
}

namespace {

// An image of 4 x 3 pixels with two components, whose right side differs.
Map map_of(const std::string& name, const std::string& source, float base, float right) {
  Map map{.name = name,
          .source = source,
          .file = "run.maps/winners.exr",
          .width = 4,
          .height = 3,
          .components = {"red", "green"},
          .texels = {}};
  for (int i = 0; i < 24; ++i) {
    map.texels.values.push_back(base + 0.125f * static_cast<float>(i % 3) +
                                (i / 2 % 4 >= 2 ? right : 0.0f));
  }
  return map;
}

ImageFinding finding(const std::string& statistic, const std::string& place, double z) {
  return {.statistic = statistic,
          .place = place,
          .x = 2,
          .y = 1,
          .width = 2,
          .height = 2,
          .component = "green",
          .z = z,
          .log10_p = -46.25,
          .log10_p_adjusted = -44.63827216398241,
          .effect = Effect{"relative difference", -0.0162, -0.0227, -0.0097, 0.99, true}};
}

void add_image(Test& t) {
  t.image = Image{.width = 4,
                  .height = 3,
                  .components = {"red", "green"},
                  .replicates = 64,
                  .tested = 21,
                  .constant = 2,
                  .unseen = 1,
                  .winner = finding("window", "columns 2-3, rows 1-2 of green, z = -14.2", -14.2),
                  .groups = {}};
  t.image->groups = {
      t.image->winner,
      finding("alternating", "the whole image of red with alternating signs (rows in turn), z = +3",
              3)};
  t.maps = {map_of("z", "", 0.5f, -14.5f), map_of("p_adjusted", "", 0.5f, -0.499f),
            map_of("mean", "winners", 0.25f, 0.5f), map_of("variance", "winners", 0.0625f, 0.0f)};
}

}  // namespace

Test failing() {
  Test t = base("mean(winners) == mean(hemisphere)", 18);
  t.verdict = Verdict::fail;
  t.method = "welch";
  t.null_hypothesis = "mean(winners) == mean(hemisphere)";
  t.allow = 0.001;
  t.samples = {sample("winners", {0.4711, 0.021, 0.0}),
               sample("hemisphere", {0.4809, 0.062, 0.08})};
  t.channels = {channel("value", mean_effect(-0.0204, 0.0021))};
  t.channels[0].p_value = 2.3e-45;
  t.channels[0].log10_p = -44.63827216398241;
  t.channels[0].p_adjusted = 2.07e-44;
  t.channels[0].log10_p_adjusted = -43.68402965454308;
  t.channels[0].p_pass = 1;
  t.channels[0].log10_p_pass = 0;
  t.message = "the means differ by -2.04 %; interval [-2.25 %, -1.83 %]";
  add_image(t);
  return t;
}

Test caught_mutant() {
  Test t = base("mean(no_cosine) == analytic", 21);
  t.name = "forgetting the receiver's cosine is caught";
  t.verdict = t.expected = Verdict::fail;
  t.ok = true;
  t.detect = 0.05;
  t.samples = {sample("no_cosine", {0.68, 0.05, 0.02})};
  t.channels = {channel("value", mean_effect(0.4136, 0.004))};
  t.channels[0].p_value = 5e-324;
  t.channels[0].log10_p = -812.3;
  t.channels[0].p_adjusted.reset();
  t.channels[0].log10_p_adjusted.reset();
  t.message = "bias of +41.4 %; the defect is found";
  return t;
}

// The same mutant under another method, which is blind to it.
Test unseen_mutant() {
  Test t = base("variance(no_cosine) == variance(area)", 23);
  t.name = "its variance does not show it";
  t.method = "influence-t";
  t.null_hypothesis = "variance(no_cosine) == variance(area)";
  t.verdict = Verdict::pass;
  t.ok = true;
  t.detect = 0.0953101798043249;
  t.detectable = 0.09;
  t.samples = {sample("no_cosine", {0.68, 0.05, 0.02}), sample("area", {0.4812, 0.031, 0.01})};
  t.channels = {channel("value", ratio_effect(0.01, 0.05))};
  t.message = "no evidence against the claim; a factor of 1.1 or more is excluded";
  return t;
}

Test surviving_mutant() {
  Test t = base("mean(shared_seed) == analytic", 25);
  t.name = "sharing a seed is caught";
  t.verdict = Verdict::pass;
  t.expected = Verdict::fail;
  t.samples = {sample("shared_seed", {0.4813, 0.03, 0.0})};
  t.channels = {channel("value", mean_effect(0.0006, 0.0012))};
  t.message = "no evidence of bias; a bias of 0.31 % or more is excluded";
  return t;
}

Test undecided() {
  Test t = base("mean(heavy) == analytic", 29);
  t.verdict = Verdict::inconclusive;
  t.samples = {sample("heavy", {0.46, 0.4, 0.3})};
  t.channels = {channel("value", mean_effect(-0.04, 0.055))};
  t.channels[0].p_value = 0.064;
  t.channels[0].log10_p = -1.1938200260161129;
  t.gates[0] = {"skewness", 1.7, 1.25, "amber"};
  t.planned_looks = {1024, 4096, 16384};
  t.looks = {{1024, 1e-5, 8e-5, -0.31, 0.7, -0.155, mean_effect(-0.09, 0.2)},
             {4096, 0.0002, 0.002, -0.85, 0.45, -0.347, mean_effect(-0.05, 0.11)},
             {16384, 0.0012, 0.009, -1.19, std::nullopt, std::nullopt}};
  t.message = "the budget ended; about 2.3 M more observations would decide";
  return t;
}

Test invalid() {
  Test t = base("variance(heavy) <= 0.07", 33);
  t.verdict = Verdict::invalid;
  t.method = "chi-square";
  t.forced = true;
  t.tail = "upper";
  t.null_hypothesis = "the variance is at most 0.07";
  t.samples = {sample("heavy", {0.46, 0.4, 0.3})};
  t.channels = {channel("value", ratio_effect(0.21, 0.9))};
  t.gates = {{"tail index", 0.41, 0.25, "red"}, {"dominance", 0.34, 0.1, "red"}};
  t.message = "the fourth moment may not exist: a test of variance says nothing here";
  return t;
}

Test broken() {
  Test t = base("mean(rare_nan) == analytic", 37);
  t.verdict = Verdict::error;
  t.samples = {sample("rare_nan", {0.48, 0.03, 0.0})};
  Sample& s = t.samples[0];
  s.mean = s.variance = s.skewness = s.kurtosis = s.minimum = s.maximum = std::nullopt;
  s.nonfinite = s.secondaries;
  s.primaries = 1;
  s.histogram = {};
  s.quantiles.clear();
  t.detectable = t.power = std::nullopt;
  t.message = "16384 of 16384 observations are not finite, the first is observation 0";
  return t;
}

Test not_run() {
  Test t = base("mean(solid_angle) == analytic", 41);
  t.verdict = Verdict::skipped;
  t.alpha = t.beta = t.detectable = t.power = std::nullopt;
  t.gates.clear();
  t.message = "belongs to another shard";
  return t;
}

}  // namespace assay::reports
