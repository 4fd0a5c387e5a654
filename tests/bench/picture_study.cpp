// False alarms and power of the family of an image pair (stats/pyramids/image_pyramid.h) beside
// three rules that others use, on pictures of estimators/path_tracing of 32 x 24 pixels and 8 paths
// a pixel. Prints one line a cell. Every picture is a function of seed, scene, integrator and
// index.
//
//   picture_study level SCENE A B PICTURES RUNS [SEED]     rejections at .01 of a true claim
//   picture_study power SCENE DEFECT PICTURES RUNS [SEED]  least defects found with probability .9
//
// Rules: `welch` rejects if any element's Welch p-value is below Sidak's share; `part` if more than
// .25 % of the elements' are, by the normal law; `whole` by Welch's test of the pictures' means.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "estimators/path_tracing/image.h"
#include "stats/basics/moments.h"
#include "stats/means/student_t.h"
#include "stats/pyramids/image_pyramid.h"
#include "stats/tails/tails.h"

namespace {

using namespace assay;
using path_tracing::Picture;

constexpr std::size_t width = 32;
constexpr std::size_t height = 24;
constexpr std::size_t channels = 3;
constexpr std::size_t elements = width * height * channels;
constexpr std::uint64_t paths = 8;
constexpr double alpha = 0.01;

using Stack = std::vector<std::vector<float>>;

Stack pictures(const Picture& picture, const std::string& stream, std::uint64_t seed,
               std::size_t first, std::size_t count) {
  const StreamKey key = stream_key(seed, "picture_study", stream, 0);
  Stack stack(count);
  std::vector<double> drawn(elements);
  for (std::size_t i = 0; i < count; ++i) {
    Stream random(key, first + i);
    Cost cost;
    path_tracing::render(picture, random, paths, drawn, cost);
    for (const double value : drawn) stack[i].push_back(static_cast<float>(value));
  }
  return stack;
}

// The rules, and what each of them says.
constexpr std::array rules{"assay", "welch", "part", "whole"};
struct Found {
  std::array<bool, 4> by = {};
  std::uint32_t size = 0;
};

double mean(const std::vector<float>& image) {
  return std::accumulate(image.begin(), image.end(), 0.0) / static_cast<double>(image.size());
}

Found look(const Stack& a, const Stack& b) {
  const auto view = [&](const Stack& stack) {
    stats::ImageStack views{{width, height, channels}, {}};
    for (const auto& image : stack) views.images.emplace_back(image);
    return views;
  };
  // Moments of a number of each picture.
  const auto moments = [](const Stack& stack, const auto& number) {
    stats::Moments all;
    for (const auto& image : stack) all.add(number(image));
    return all;
  };
  const stats::ImageFamily family = stats::image_pyramid({view(a), view(b)});
  Found found{.size = family.groups.empty() ? 0 : family.winner.size};
  auto& [assay, welch, part, whole] = found.by;
  assay = family.log_p <= std::log(alpha);
  const double share = -std::expm1(std::log1p(-alpha) / static_cast<double>(elements));
  std::size_t beyond = 0;
  for (std::size_t e = 0; e < elements; ++e) {
    const auto element = [e](const std::vector<float>& image) { return double{image[e]}; };
    const stats::Moments x = moments(a, element);
    const stats::Moments y = moments(b, element);
    if (x.m2 + y.m2 == 0) {
      welch |= x.mean != y.mean;
      continue;
    }
    const stats::TestResult test = stats::welch_t(x, y, {});
    welch |= stats::log_p_two_sided(test) <= std::log(share);
    beyond += 2 * std::exp(stats::normal_tails(std::abs(test.statistic)).upper) <= share;
  }
  part = static_cast<double>(beyond) > 0.0025 * static_cast<double>(elements);
  whole = stats::log_p_two_sided(stats::welch_t(moments(a, mean), moments(b, mean), {})) <=
          std::log(alpha);
  return found;
}

path_tracing::Integrator integrator_of(const std::string& name) {
  if (name == "light") return path_tracing::Integrator::light;
  return name == "bsdf" ? path_tracing::Integrator::bsdf : path_tracing::Integrator::multiple;
}

Picture picture_of(const std::string& scene, const std::string& integrator) {
  return {.scene = path_tracing::scene_of(scene),
          .integrator = integrator_of(integrator),
          .width = width,
          .height = height};
}

void level(const std::string& scene, const std::string& a, const std::string& b, std::size_t count,
           std::size_t runs, std::uint64_t seed) {
  std::map<std::uint32_t, std::size_t> sizes;
  std::array<std::size_t, 4> found = {};
  for (std::size_t run = 0; run < runs; ++run) {
    const Found one = look(pictures(picture_of(scene, a), a + "/a", seed, run * count, count),
                           pictures(picture_of(scene, b), b + "/b", seed, run * count, count));
    for (std::size_t rule = 0; rule < 4; ++rule) found[rule] += one.by[rule];
    if (one.by[0]) ++sizes[one.size];
  }
  std::printf("level %s %s %s %zu of %zu: assay %zu welch %zu part %zu whole %zu; sizes",
              scene.c_str(), a.c_str(), b.c_str(), count, runs, found[0], found[1], found[2],
              found[3]);
  for (const auto& [size, times] : sizes) std::printf(" %u:%zu", size, times);
  std::printf("\n");
  std::fflush(stdout);
}

using Put = std::function<void(Picture&, double)>;
struct Defect {
  Put put;
  double most;
};
const std::map<std::string, Defect>& defects() {
  static const std::map<std::string, Defect> all{
      {"light_density", {[](Picture& p, double x) { p.defects.light_density = x; }, 4}},
      {"weight", {[](Picture& p, double x) { p.defects.weight = x; }, 1}},
      {"roulette", {[](Picture& p, double x) { p.defects.roulette = x; }, 1}},
      {"clamp", {[](Picture& p, double x) { p.defects.clamp = 1 / x; }, 20}},
      {"tile", {[](Picture& p, double x) { p.shift = x; }, 4}},
      {"dead_pixel", {[](Picture& p, double x) { p.dead = x; }, 1}},
      {"shadow_offset", {[](Picture& p, double x) { p.defects.shadow_offset = x; }, 1}},
      {"schlick", {[](Picture& p, double x) { p.defects.schlick = x; }, 1}}};
  return all;
}

// Halving of the logarithm of the amount, for each rule and run; the .9 quantile over the runs.
void power(const std::string& scene, const std::string& name, std::size_t count, std::size_t runs,
           std::uint64_t seed) {
  const Defect& defect = defects().at(name);
  constexpr int steps = 40;  // From the largest amount down, by a factor of 1.15.
  std::vector<std::vector<int>> least(rules.size(), std::vector<int>(runs, -1));
  for (std::size_t run = 0; run < runs; ++run) {
    const Stack sound =
        pictures(picture_of(scene, "multiple"), "multiple/b", seed, run * count, count);
    std::map<int, Found> tried;
    const auto at = [&](int step) {
      const auto known = tried.find(step);
      if (known != tried.end()) return known->second;
      Picture picture = picture_of(scene, "multiple");
      defect.put(picture, defect.most * std::pow(1.15, -step));
      return tried[step] = look(pictures(picture, "multiple/a", seed, run * count, count), sound);
    };
    for (std::size_t rule = 0; rule < rules.size(); ++rule) {
      if (!at(0).by[rule]) continue;
      int low = 0;
      int high = steps;
      while (high - low > 1) {
        const int middle = (low + high) / 2;
        (at(middle).by[rule] ? low : high) = middle;
      }
      least[rule][run] = low;
    }
  }
  std::printf("power %s %s %zu of %zu:", scene.c_str(), name.c_str(), count, runs);
  for (std::size_t rule = 0; rule < rules.size(); ++rule) {
    std::ranges::sort(least[rule]);
    const int step =
        least[rule][runs - static_cast<std::size_t>(std::ceil(0.9 * static_cast<double>(runs)))];
    if (step < 0) {
      std::printf(" %s -", rules[rule]);
    } else {
      std::printf(" %s %.4g", rules[rule], defect.most * std::pow(1.15, -step));
    }
  }
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const auto number = [&](std::size_t i) { return std::stoull(words[i]); };
  if (words.size() >= 6 && words[0] == "level") {
    level(words[1], words[2], words[3], number(4), number(5), words.size() > 6 ? number(6) : 1);
    return 0;
  }
  if (words.size() >= 5 && words[0] == "power") {
    power(words[1], words[2], number(3), number(4), words.size() > 5 ? number(5) : 1);
    return 0;
  }
  std::fprintf(stderr,
               "picture_study level SCENE A B PICTURES RUNS [SEED]\n"
               "picture_study power SCENE DEFECT PICTURES RUNS [SEED]\n");
  return 2;
}
