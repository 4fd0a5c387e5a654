#include "stats/images/image_law.h"

#include "stats/tails/tails.h"
#include "tests/prelude.h"
#include "tests/stats/expect_calibrated.h"
#include "tests/stats/image_samples.h"

namespace assay::stats {
namespace {

std::vector<std::uint32_t> shuffled(Philox& random, std::size_t count) {
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0);
  for (std::size_t i = 0; i + 1 < count; ++i) {
    std::swap(all[i], all[i + tests::below(random, count - i)]);
  }
  return all;
}

DrawSubset any_subset(std::uint32_t key) {
  return [key](std::uint64_t index, std::size_t count, std::size_t size) {
    Philox random(key + static_cast<std::uint32_t>(index));
    std::vector<std::uint32_t> all = shuffled(random, count);
    all.resize(size);
    return all;
  };
}

ImageLawTest law_of(const OwnedStack& a, const OwnedStack& b, const ImageLawOptions& options) {
  return image_law_test(a.view(), b.view(), options);
}

// ---- The same by the definition: cell by cell, image by image.

std::vector<double> standardised(std::vector<double> values) {
  if (std::ranges::min(values) == std::ranges::max(values)) return std::vector(values.size(), 0.0);
  double mean = 0, squares = 0;
  for (const double x : values) mean += x / static_cast<double>(values.size());
  for (double& x : values) x -= mean;
  for (const double x : values) squares += x * x / static_cast<double>(values.size());
  for (double& x : values) x /= std::sqrt(squares);
  return values;
}

std::vector<double> scored(const std::vector<double>& values, ImageScore score) {
  if (score == ImageScore::value) return standardised(values);
  std::vector<double> ranks;
  for (const double x : values) {
    const auto below = std::ranges::count_if(values, [&](double y) { return y < x; });
    const auto equal = std::ranges::count(values, x);
    ranks.push_back(static_cast<double>(below) + static_cast<double>(equal - 1) / 2);
  }
  std::vector<double> scores = standardised(ranks);
  if (score == ImageScore::rank) return scores;
  for (double& x : scores) x *= x;
  return standardised(scores);
}

double z_of(const std::vector<double>& sums, const std::vector<std::uint32_t>& first) {
  double chosen = 0, squares = 0;
  for (const std::uint32_t r : first) chosen += sums[r];
  for (const double sum : sums) squares += sum * sum;
  const auto all = static_cast<double>(sums.size());
  const auto size = static_cast<double>(first.size());
  const double variance = squares * size * (all - size) / (all * (all - 1));
  return variance > 1e-6 ? chosen / std::sqrt(variance) : 0;
}

double adjusted_of(double z, std::size_t cells) {
  const double p = std::exp(normal_tails(std::abs(z)).upper) * 2;
  return std::log(-std::expm1(static_cast<double>(cells) * std::log1p(-p)));
}

struct Statistic {
  double log_p = 0;
  double z = 0;
};

// The statistic of the labelling that calls these images the first side.
Statistic statistic_of(const OwnedStack& a, const OwnedStack& b,
                       const std::vector<std::uint32_t>& first) {
  std::vector<std::vector<float>> images = a.images;
  images.insert(images.end(), b.images.begin(), b.images.end());
  const ImageExtent& extent = a.extent;
  Statistic least;
  for (const ImageScore score : {ImageScore::value, ImageScore::rank, ImageScore::spread}) {
    std::vector<std::vector<double>> scores;
    for (std::size_t e = 0; e < extent.elements(); ++e) {
      std::vector<double> values;
      for (const auto& image : images) values.push_back(static_cast<double>(image[e]));
      scores.push_back(scored(values, score));
    }
    for (std::size_t side = 1;; side *= 2) {
      double largest = 0;
      std::size_t cells = 0;
      for (std::size_t y = 0; y < extent.height; y += side) {
        for (std::size_t x = 0; x < extent.width; x += side) {
          for (std::size_t c = 0; c < extent.channels; ++c, ++cells) {
            std::vector<double> sums(images.size());
            for (std::size_t v = y; v < std::min(y + side, extent.height); ++v) {
              for (std::size_t u = x; u < std::min(x + side, extent.width); ++u) {
                for (std::size_t r = 0; r < sums.size(); ++r) {
                  sums[r] += scores[(v * extent.width + u) * extent.channels + c][r];
                }
              }
            }
            const double z = z_of(sums, first);
            if (std::abs(z) > std::abs(largest)) largest = z;
          }
        }
      }
      const double adjusted = adjusted_of(largest, cells);
      if (adjusted < least.log_p) least = {adjusted, largest};
      if (side >= extent.width && side >= extent.height) break;
    }
  }
  double largest = 0;
  for (std::size_t c = 0; c < extent.channels; ++c) {
    std::vector<double> brightest(images.size(), -1e300);
    for (std::size_t e = c; e < extent.elements(); e += extent.channels) {
      for (std::size_t r = 0; r < images.size(); ++r) {
        brightest[r] = std::max(brightest[r], static_cast<double>(images[r][e]));
      }
    }
    const double z = z_of(scored(brightest, ImageScore::rank), first);
    if (std::abs(z) > std::abs(largest)) largest = z;
  }
  const double adjusted = adjusted_of(largest, extent.channels);
  if (adjusted < least.log_p) least = {adjusted, largest};
  return least;
}

TEST(ImageLaw, IsTheDefinitionWordByWord) {
  Philox random(7101);
  const ImageExtent extent{37, 5, 2};
  const auto draw = [&](std::size_t) { return std::floor(4 / random.uniform()) / 4; };
  OwnedStack a = draw_stack(extent, 16, draw);
  OwnedStack b = draw_stack(extent, 19, draw);
  for (auto* stack : {&a, &b}) {
    for (auto& image : stack->images) image[3] = .1F;  // an element that never varies
  }
  const ImageLawTest test = law_of(a, b, {.permutations = 30, .draw = any_subset(88)});
  std::vector<std::uint32_t> first(16);
  std::iota(first.begin(), first.end(), 0);
  const Statistic data = statistic_of(a, b, first);
  EXPECT_NEAR(test.most.z, data.z, 1e-4 * std::abs(data.z));
  double as_small = 0, drawn = 0;
  for (; drawn < 30 && as_small < 10; ++drawn) {
    const auto labels = any_subset(88)(static_cast<std::uint64_t>(drawn), 35, 16);
    as_small += statistic_of(a, b, labels).log_p <= data.log_p ? 1 : 0;
  }
  EXPECT_EQ(static_cast<double>(test.permutations), drawn);
  EXPECT_NEAR(std::exp(test.log_p), as_small < 10 ? (as_small + 1) / (drawn + 1) : as_small / drawn,
              1e-12);
}

// ---- The level

double one_law(Philox& random, const DrawSubset& draw) {
  // Pareto 1/2: no mean, and elements that share a factor.
  std::vector<double> common(40);
  for (double& each : common) each = 1 / std::pow(random.uniform(), 2);
  std::size_t drawn = 0;
  const auto value = [&](std::size_t) {
    return common[drawn++ / 6 % common.size()] / std::pow(random.uniform(), 2);
  };
  const ImageExtent extent{3, 2, 1};
  const OwnedStack a = draw_stack(extent, 20, value);
  const OwnedStack b = draw_stack(extent, 20, value);
  return law_of(a, b, {.permutations = 199, .draw = draw}).log_p;
}

TEST(ImageLaw, IsExactOnElementsWithoutAMeanThatDependOnEachOther) {
  std::uint32_t key = 0;
  tests::expect_calibrated({7102, 4000, Shape::at_most_uniform}, [&](Philox& random) {
    return one_law(random, any_subset(1000 * ++key));
  });
}

TEST(ImageLaw, LabelsOfTooFewImagesAreCaught) {
  const DrawSubset few = [](std::uint64_t index, std::size_t count, std::size_t size) {
    return any_subset(31)(index, count, size / 4);
  };
  tests::expect_caught({7103, 1000, Shape::at_most_uniform},
                       [&](Philox& random) { return one_law(random, few); });
}

// ---- What it finds

// Fireflies of one in a hundred hide a shift of the mean from sums of values, but not from ranks.
double with_fireflies(Philox& random) {
  return random.normal() + (random.uniform() < .01 ? 1e3 : 0);
}

// Few values are bright: their mean differs more than their ranks.
double with_bright_values(Philox& random, double probability) {
  return .01 * random.normal() + (random.uniform() < probability ? 3 : 0);
}

struct Difference {
  const char* name;
  ImageScore score;
  double sign;
  std::function<double(Philox&, bool inside)> draw;
};

TEST(ImageLaw, FindsTheScoreAndThePlace) {
  const Difference differences[] = {
      {"a mean", ImageScore::value, 1,
       [](Philox& random, bool inside) { return with_bright_values(random, inside ? .25 : .1); }},
      {"a spread", ImageScore::spread, -1,
       [](Philox& random, bool inside) { return random.normal() * (inside ? .6 : 1); }},
      {"a typical value", ImageScore::rank, -1,
       [](Philox& random, bool inside) { return with_fireflies(random) - (inside ? .5 : 0); }}};
  const ImageExtent extent{40, 40, 1};
  Philox random(7104);
  for (const Difference& difference : differences) {
    SCOPED_TRACE(difference.name);
    const OwnedStack a = draw_stack(extent, 32, [&](std::size_t e) {
      const bool inside = e % 40 / 8 == 2 && e / 40 / 8 == 1;
      return difference.draw(random, inside);
    });
    const OwnedStack b =
        draw_stack(extent, 32, [&](std::size_t) { return difference.draw(random, false); });
    const ImageLawTest test = law_of(a, b, {.permutations = 199, .draw = any_subset(5)});
    EXPECT_NEAR(std::exp(test.log_p), 1.0 / 200, 1e-12);
    EXPECT_EQ(test.most.score, difference.score);
    EXPECT_GT(test.most.z * difference.sign, 5);
    EXPECT_EQ(test.most.window, (Rectangle{16, 8, 8, 8}));
  }
}

// One firefly in most pictures, anywhere: no cell and no mean tells of it.
TEST(ImageLaw, FindsAClamp) {
  Philox random(7105);
  const auto drawn = [&](double most) {
    return draw_stack({40, 40, 1}, 24, [&random, most](std::size_t) {
      return std::min(most, random.uniform() < 4e-3 ? 1 / random.uniform() : random.uniform());
    });
  };
  const OwnedStack sound = drawn(1e30);
  const ImageLawTest test = law_of(drawn(2), sound, {.permutations = 199, .draw = any_subset(6)});
  EXPECT_NEAR(std::exp(test.log_p), 1.0 / 200, 1e-12);
  EXPECT_EQ(test.most.score, ImageScore::largest);
  EXPECT_LT(test.most.z, -4);
}

TEST(ImageLaw, SaysNothingOfImagesThatNeverVary) {
  const OwnedStack a = draw_stack({4, 4, 1}, 16, [](std::size_t e) { return e; });
  const ImageLawTest test = law_of(a, a, {.permutations = 99, .draw = any_subset(9)});
  EXPECT_EQ(test.log_p, 0);
}

}  // namespace
}  // namespace assay::stats
