#include "tests/reports/large_records.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include "tests/reports/example_record.h"

namespace assay::reports {
namespace {

Record with_suites(std::vector<Suite> suites) {
  Record record;
  record.tool = {"assay", "0.1.0", "0123abc"};
  record.environment = {"g++ 12.2.0", "Example CPU @ 3 GHz", "avx2", 2};
  record.seed = 1;
  record.started = "2026-01-31T12:34:56Z";
  record.seconds = 60;
  record.suites = std::move(suites);
  return record;
}

Suite empty_suite(const std::string& name) {
  Suite suite;
  suite.name = name;
  suite.file = "suites/" + name + ".yaml";
  suite.seed = 1;
  suite.alpha = suite.beta = 0.01;
  return suite;
}

/// Numbers as a run has them: none is another's.
void make_distinct(Test& test, std::mt19937_64& bits) {
  std::normal_distribution<double> normal;
  std::poisson_distribution<std::uint64_t> count(100);
  for (Sample& sample : test.samples) {
    sample.quantiles.clear();
    double value = normal(bits);
    for (int i = -49; i < 50; ++i)
      sample.quantiles.push_back({0.05 * i, value += 0.05 * std::abs(normal(bits))});
    sample.histogram.counts.assign(60, 0);
    for (std::uint64_t& bin : sample.histogram.counts) bin = count(bits);
    for (Number* number : {&sample.mean, &sample.variance, &sample.skewness, &sample.kurtosis,
                           &sample.min, &sample.max})
      *number = normal(bits);
  }
  test.looks.clear();
  for (std::uint64_t k = 0; k < 12; ++k) {
    Look look{.secondaries = std::uint64_t{100} << k, .alpha = 1e-4 * std::abs(normal(bits))};
    look.log10_p = -std::abs(normal(bits));
    look.p_pass = std::abs(normal(bits)) / 10;
    look.log10_p_pass = std::log10(*look.p_pass);
    look.effect = mean_effect(0.01 * normal(bits), 0.02);
    test.looks.push_back(look);
  }
}

constexpr std::size_t width = 960, height = 540, components = 3;

struct Area {
  double x, y, half_width, half_height;
  bool contains(std::size_t px, std::size_t py) const {
    const double dx = (static_cast<double>(px) - x) / half_width;
    const double dy = (static_cast<double>(py) - y) / half_height;
    return dx * dx + dy * dy <= 1;
  }
};

Map empty_map(const char* name, const char* source) {
  return {.name = name,
          .source = source,
          .file = "",
          .width = width,
          .height = height,
          .components = {"B", "G", "R"},
          .texels = {}};
}

/// Pictures with noise of 2 %, and z of their difference; inside the area both are raised.
Record pair(const Area& area, double raised_z, double raised_value) {
  std::mt19937_64 bits(1);
  std::normal_distribution<double> normal;
  Map z = empty_map("z", ""), mean = empty_map("mean", "candidate"),
      other = empty_map("other_mean", "reference");
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const bool inside = area.contains(x, y);
      for (std::size_t c = 0; c < components; ++c) {
        const double shade = 0.2 + 0.6 * static_cast<double>(x + c * y) / (width + 2 * height);
        z.texels.values.push_back(static_cast<float>(normal(bits) + (inside ? raised_z : 0)));
        mean.texels.values.push_back(static_cast<float>(shade * (1 + 0.02 * normal(bits)) *
                                                        (inside ? 1 + raised_value : 1)));
        other.texels.values.push_back(static_cast<float>(shade * (1 + 0.02 * normal(bits))));
      }
    }
  }
  Test test = failing();
  test.name = test.claim = "mean(candidate) == mean(reference)";
  test.id = "images/" + test.name;
  test.replay = "assay images --candidate 'new/*.exr' --reference 'old/*.exr' --seed 1";
  test.samples = {sample("candidate"), sample("reference")};
  const auto first = [](double centre, double half) {
    return static_cast<std::uint64_t>(centre - half);
  };
  test.image =
      Image{.width = width,
            .height = height,
            .components = {"B", "G", "R"},
            .replicates = 64,
            .tested = width * height * components,
            .winner = {.statistic = "window",
                       .place = "x 600-680, y 276-324 of G",
                       .x = first(area.x, area.half_width),
                       .y = first(area.y, area.half_height),
                       .width = static_cast<std::uint64_t>(2 * area.half_width) + 1,
                       .height = static_cast<std::uint64_t>(2 * area.half_height) + 1,
                       .component = "G",
                       .z = 60,
                       .log10_p = -100,
                       .log10_p_adjusted = -95,
                       .effect = Effect{"relative difference of the sums", raised_value,
                                        0.6 * raised_value, 1.4 * raised_value, 0.99, true}},
            .groups = {}};
  test.maps = {std::move(z), std::move(mean), std::move(other)};
  Suite suite = empty_suite("images");
  suite.tests.push_back(std::move(test));
  return with_suites({std::move(suite)});
}

}  // namespace

Record many_claims(std::size_t count) {
  constexpr std::size_t suites = 10, broken = 8;
  std::vector<Suite> all;
  std::mt19937_64 bits(1);
  for (std::size_t s = 0; s < suites; ++s) all.push_back(empty_suite(fmt::format("suite_{}", s)));
  for (std::size_t i = 0; i < count; ++i) {
    Suite& suite = all[i % suites];
    const bool fails = i % suites == 1 && i / suites < broken;
    Test test = fails ? failing() : passing();
    const std::string estimator = fails ? "triangle_area" : fmt::format("estimator_{}", i);
    test.name = test.claim = fails ? fmt::format("mean(estimator_{}) == mean(triangle_area)", i)
                                   : fmt::format("mean({}) == analytic", estimator);
    test.id = fmt::format("{}/{}", suite.name, test.name);
    test.samples.front().estimator = estimator;
    test.replay = fmt::format("assay run {} --seed 1 --filter '{}'", suite.file, test.id);
    if (!fails) test.samples.resize(1 + i % 2);
    make_distinct(test, bits);
    test.image.reset();
    test.maps.clear();
    test.channels.front().effect.estimate = (fails ? 0.012 : 0.0) + 1e-6 * static_cast<double>(i);
    test.channels.front().effect.low = *test.channels.front().effect.estimate - 0.001;
    test.channels.front().effect.high = *test.channels.front().effect.estimate + 0.001;
    suite.tests.push_back(std::move(test));
  }
  return with_suites(std::move(all));
}

Record planted_ellipse() { return pair({640, 300, 40, 24}, 4, 0.05); }

Record hot_pixel() { return pair({201, 77, 0.4, 0.4}, 40, 9); }

Calibration small_calibration() {
  Calibration measured;
  measured.runs = 1000;
  measured.detect = "0.15 of <means>";
  for (const double alpha : {0.05, 0.01}) {
    for (const char* method : {"t", "F"}) {
      const bool errs = alpha == 0.01 && *method == 'F';
      CalibrationCell cell{.method = method,
                           .question = "mean == <number>",
                           .law = "exponential(1)",
                           .alpha = alpha};
      cell.holds.pass.runs = 1000;
      cell.holds.fail = {.count = errs ? 60U : 8U,
                         .runs = 1000,
                         .low = errs ? 0.04 : 0.002,
                         .high = errs ? 0.09 : 0.03};
      measured.cells.push_back(cell);
    }
  }
  return measured;
}

}  // namespace assay::reports
