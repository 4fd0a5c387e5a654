#pragma once

#include "stats/basics/moments.h"
#include "stats/images/image.h"
#include "stats/means/student_t.h"
#include "tests/philox.h"
#include "tests/prelude.h"

namespace assay::tests {

// Replicates of an image that own their values.
struct OwnedStack {
  stats::ImageExtent extent;
  std::vector<std::vector<float>> images;

  stats::ImageStack view() const { return {extent, {images.begin(), images.end()}}; }
};

// More than one block of elements and no multiple of anything.
inline constexpr stats::ImageExtent uneven{37, 31, 3};

// Moments of one element, value by value.
inline stats::Moments one_element(const OwnedStack& stack, std::size_t element) {
  stats::Moments moments;
  for (const auto& image : stack.images) moments.add(static_cast<double>(image[element]));
  return moments;
}

// Welch's statistic of every element by itself.
inline std::vector<stats::TestResult> welch_of_elements(const OwnedStack& a, const OwnedStack& b) {
  std::vector<stats::TestResult> tests;
  for (std::size_t e = 0; e < a.extent.elements(); ++e) {
    tests.push_back(stats::welch_t(one_element(a, e), one_element(b, e), {}));
  }
  return tests;
}

// draw(element) for every element of every replicate.
template <class Draw>
OwnedStack draw_stack(const stats::ImageExtent& extent, std::size_t replicates, Draw&& draw) {
  OwnedStack stack{extent, {}};
  for (std::size_t r = 0; r < replicates; ++r) {
    std::vector<float>& image = stack.images.emplace_back(extent.elements());
    for (std::size_t e = 0; e < image.size(); ++e) image[e] = static_cast<float>(draw(e));
  }
  return stack;
}

// A stats::ForEach in another order than one_by_one.
inline void last_first(std::size_t count, const std::function<void(std::size_t)>& work) {
  for (std::size_t i = count; i > 0; --i) work(i - 1);
}

inline std::vector<double> normals(Philox& random, std::size_t size) {
  std::vector<double> values(size);
  for (double& value : values) value = random.normal();
  return values;
}

// Gamma with this shape and unit scale (Marsaglia & Tsang 2000; below one, boosted by a power).
inline double gamma(Philox& random, double shape) {
  if (shape < 1) {
    const double power = std::pow(random.uniform(), 1 / shape);
    return gamma(random, shape + 1) * power;
  }
  const double d = shape - 1.0 / 3;
  const double c = 1 / std::sqrt(9 * d);
  for (;;) {
    const double x = random.normal();
    const double root = 1 + c * x;
    if (root <= 0) continue;
    const double v = root * root * root;
    if (std::log(random.uniform()) < 0.5 * x * x + d - d * v + d * std::log(v)) return d * v;
  }
}

// A defect of an image in units of an element's standard error. It is a block of this side, or all
// elements with this share, or a checkerboard.
struct Defect {
  const char* name;
  std::size_t block = 0;
  double size = 0;
  bool anywhere = false;
  double share = 0;
  bool checkerboard = false;
};

inline std::vector<Defect> defects() {
  return {{.name = "none"},
          {.name = "one element 6", .block = 1, .size = 6, .anywhere = true},
          {.name = "8x8 aligned .8", .block = 8, .size = .8},
          {.name = "32x32 aligned .2", .block = 32, .size = .2},
          {.name = "global .05", .block = 128, .size = .05},
          {.name = "1 % of elements 2.5", .size = 2.5, .share = .01},
          {.name = "checkerboard .3", .size = .3, .checkerboard = true},
          {.name = "checkerboard .05", .size = .05, .checkerboard = true},
          {.name = "8x8 anywhere .8", .block = 8, .size = .8, .anywhere = true},
          {.name = "32x32 anywhere .2", .block = 32, .size = .2, .anywhere = true}};
}

inline std::size_t below(Philox& random, std::size_t count) {
  return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
}

inline void add_block(std::span<double> z, const stats::ImageExtent& extent, const Defect& defect,
                      Philox& random) {
  const std::size_t step = defect.anywhere ? 1 : defect.block;
  const std::size_t x = step * below(random, (extent.width - defect.block) / step + 1);
  const std::size_t y = step * below(random, (extent.height - defect.block) / step + 1);
  for (std::size_t v = y; v < y + defect.block; ++v) {
    for (std::size_t u = x; u < x + defect.block; ++u) z[v * extent.width + u] += defect.size;
  }
}

// Adds the defect to a one-channel image.
inline void add_defect(std::span<double> z, const stats::ImageExtent& extent, const Defect& defect,
                       Philox& random) {
  if (defect.block > 0) return add_block(z, extent, defect, random);
  for (std::size_t e = 0; e < z.size(); ++e) {
    if (defect.checkerboard) {
      z[e] += (e % extent.width + e / extent.width) % 2 == 0 ? defect.size : -defect.size;
    } else if (random.uniform() < defect.share) {
      z[e] += defect.size;
    }
  }
}

// For a squared margin's test. If the noise of the means is as large as the bias, the jackknife's
// variance is up to twice too large (Efron & Stein). Then p-values crowd around one half, and only
// levels below it are judged.
inline double below_half(double log_p) { return log_p < std::log(0.5) ? log_p : 0; }

inline stats::TestResult below_half(stats::TestResult result) {
  result.log_p_lower = below_half(result.log_p_lower);
  result.log_p_upper = below_half(result.log_p_upper);
  return result;
}

}  // namespace assay::tests
