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
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <future>
#include <map>
#include <string>
#include <vector>

#include "estimators/path_tracing/image.h"
#include "stats/basics/moments.h"
#include "stats/means/welch_t.h"
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

using Stack = std::vector<std::vector<double>>;

Stack pictures(const Picture& picture, const std::string& stream, std::uint64_t seed,
               std::size_t first, std::size_t count) {
  const StreamKey key = stream_key(seed, "picture_study", stream, 0);
  Stack stack(count, std::vector<double>(elements));
  for (std::size_t i = 0; i < count; ++i) {
    Stream random(key, first + i);
    Cost cost;
    path_tracing::render(picture, random, paths, stack[i], cost);
    // As a file would have them.
    for (double& value : stack[i]) value = static_cast<double>(static_cast<float>(value));
  }
  return stack;
}

struct Found {
  bool assay = false;
  bool welch = false;
  bool part = false;
  bool whole = false;
  std::uint32_t size = 0;
};

Found look(const Stack& a, const Stack& b) {
  const stats::ImageExtent extent{width, height, channels};
  const auto view = [&](const Stack& stack) {
    stats::ImageStack<double> views{extent, {}};
    for (const auto& image : stack) views.images.emplace_back(image);
    return views;
  };
  Found found;
  const stats::ImageFamily family = stats::image_pyramid(view(a), view(b));
  found.assay = family.log_p <= std::log(alpha);
  found.size = family.groups.empty() ? 0 : family.winner.size;
  const double share = -std::expm1(std::log1p(-alpha) / static_cast<double>(elements));
  std::size_t beyond = 0;
  for (std::size_t e = 0; e < elements; ++e) {
    stats::Moments x;
    stats::Moments y;
    for (const auto& image : a) x.add(image[e]);
    for (const auto& image : b) y.add(image[e]);
    if (x.m2 + y.m2 == 0) {
      if (x.mean != y.mean) found.welch = true;
      continue;
    }
    const stats::TestResult test = stats::welch_t(x, y, {});
    found.welch |= stats::log_p_two_sided(test) <= std::log(share);
    beyond += 2 * std::exp(stats::normal_tails(std::abs(test.statistic)).upper) <= share;
  }
  found.part = static_cast<double>(beyond) > 0.0025 * static_cast<double>(elements);
  stats::Moments x;
  stats::Moments y;
  const auto mean = [](const std::vector<double>& image) {
    double sum = 0;
    for (const double value : image) sum += value;
    return sum / static_cast<double>(image.size());
  };
  for (const auto& image : a) x.add(mean(image));
  for (const auto& image : b) y.add(mean(image));
  found.whole = stats::log_p_two_sided(stats::welch_t(x, y, {})) <= std::log(alpha);
  return found;
}

Picture picture_of(const std::string& scene, const std::string& integrator) {
  return {.scene = path_tracing::scene_of(scene),
          .integrator = path_tracing::integrator_of(integrator),
          .width = width,
          .height = height};
}

void level(const std::string& scene, const std::string& a, const std::string& b,
           std::size_t count, std::size_t runs, std::uint64_t seed) {
  std::map<std::uint32_t, std::size_t> sizes;
  std::size_t found[4] = {};
  for (std::size_t run = 0; run < runs; ++run) {
    const Found one = look(pictures(picture_of(scene, a), a + "/a", seed, run * count, count),
                           pictures(picture_of(scene, b), b + "/b", seed, run * count, count));
    found[0] += one.assay;
    found[1] += one.welch;
    found[2] += one.part;
    found[3] += one.whole;
    if (one.assay) ++sizes[one.size];
  }
  std::printf("level %s %s %s %zu of %zu: assay %zu welch %zu part %zu whole %zu; sizes", scene.c_str(),
              a.c_str(), b.c_str(), count, runs, found[0], found[1], found[2], found[3]);
  for (const auto& [size, times] : sizes) std::printf(" %u:%zu", size, times);
  std::printf("\n");
  std::fflush(stdout);
}

using Put = std::function<void(Picture&, double)>;
struct Defect {
  Put put;
  double most;
  bool falls = false;  // A smaller amount is the larger defect.
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
  std::vector<std::vector<int>> least(4, std::vector<int>(runs, -1));
  for (std::size_t run = 0; run < runs; ++run) {
    const Stack sound =
        pictures(picture_of(scene, "multiple"), "multiple/b", seed, run * count, count);
    std::map<int, Found> tried;
    const auto at = [&](int step) {
      const auto known = tried.find(step);
      if (known != tried.end()) return known->second;
      Picture picture = picture_of(scene, "multiple");
      defect.put(picture, defect.most * std::pow(1.15, -step));
      return tried[step] =
                 look(pictures(picture, "multiple/a", seed, run * count, count), sound);
    };
    for (int rule = 0; rule < 4; ++rule) {
      const auto finds = [&](int step) {
        const Found found = at(step);
        const bool by_rule[] = {found.assay, found.welch, found.part, found.whole};
        return by_rule[rule];
      };
      int low = -1;
      int high = steps;
      if (!finds(0)) continue;
      low = 0;
      while (high - low > 1) {
        const int middle = (low + high) / 2;
        (finds(middle) ? low : high) = middle;
      }
      least[static_cast<std::size_t>(rule)][run] = low;
    }
  }
  std::printf("power %s %s %zu of %zu:", scene.c_str(), name.c_str(), count, runs);
  constexpr const char* rules[] = {"assay", "welch", "part", "whole"};
  for (int rule = 0; rule < 4; ++rule) {
    std::vector<int>& found = least[static_cast<std::size_t>(rule)];
    std::ranges::sort(found);
    const int step = found[runs - static_cast<std::size_t>(std::ceil(0.9 * static_cast<double>(runs)))];
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
  std::fprintf(stderr, "picture_study level SCENE A B PICTURES RUNS [SEED]\n"
                       "picture_study power SCENE DEFECT PICTURES RUNS [SEED]\n");
  return 2;
}
