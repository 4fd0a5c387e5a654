#include "stats/pyramids/image_pyramid.h"

#include "stats/tails/tails.h"
#include "tests/prelude.h"
#include "tests/stats/expect_calibrated.h"
#include "tests/stats/image_samples.h"

namespace assay::stats {
namespace {

constexpr ImageExtent small{12, 10, 1};
const std::vector<double> zeros(small.elements());

double two_sided(LogTails tails) {
  return std::min(0.0, std::numbers::ln2 + std::min(tails.lower, tails.upper));
}

OwnedStack normal_stack(Philox& random, std::size_t replicates, double sd = 1) {
  return draw_stack(small, replicates, [&](std::size_t) { return sd * random.normal(); });
}

// Means of `shape` exponential values, three times as many at the last element.
OwnedStack skewed_stack(Philox& random, std::size_t replicates, double shape) {
  return draw_stack(small, replicates, [&](std::size_t e) {
    const double own = shape * (1 + 2 * static_cast<double>(e) / 119);
    return tests::gamma(random, own) / own;
  });
}

// ln p of the sum of the elements' z-values, taken for independent.
double log_p_of_sum(const std::vector<TestResult>& tests) {
  double sum = 0;
  for (const TestResult& test : tests) {
    const double size = normal_quantile({Tail::upper, log_p_two_sided(test) - std::numbers::ln2});
    sum += std::copysign(size, test.statistic);
  }
  return two_sided(normal_tails(sum / std::sqrt(static_cast<double>(tests.size()))));
}

// One value common to all elements of a replicate: as correlated as an image can be.
OwnedStack correlated_stack(Philox& random, std::size_t replicates) {
  OwnedStack stack = normal_stack(random, replicates);
  for (auto& image : stack.images) {
    const float common = static_cast<float>(random.normal());
    for (float& value : image) value += common;
  }
  return stack;
}

// Every calibration below raises a false alarm with probability 1e-5.

CALIBRATED(ImagePyramid, TwoStacksOfSixteenKeepTheirLevel, 821, 4000, Shape::at_most_uniform) {
  return image_pyramid({normal_stack(random, 16, 3).view(), normal_stack(random, 16).view()}).log_p;
}

CALIBRATED(ImagePyramid, SkewedStacksOfUnequalVarianceKeepTheirLevel, 822, 2000,
           Shape::at_most_uniform) {
  const OwnedStack a = skewed_stack(random, 32, 4);
  return image_pyramid({a.view(), skewed_stack(random, 16, 12).view()}).log_p;
}

CALIBRATED(ImagePyramid, ACorrelatedStackKeepsItsLevel, 823, 4000, Shape::at_most_uniform) {
  const OwnedStack a = correlated_stack(random, 16);
  return image_pyramid({a.view(), correlated_stack(random, 16).view()}).log_p;
}

CALIBRATED(ImagePyramid, AReferencesErrorIsInTheTest, 824, 4000, Shape::at_most_uniform) {
  const OwnedStack a = normal_stack(random, 16);
  const std::vector<double> error(small.elements(), 0.3);
  std::vector<double> value = normals(random, small.elements());
  for (double& v : value) v *= 0.3;
  return image_pyramid({a.view(), ImageReference{small, value, error}}).log_p;
}

// Normal elements, and among them a block of which a single replicate saw one element lit.
OwnedStack rarely_lit(Philox& random) {
  OwnedStack stack = normal_stack(random, 32);
  for (std::size_t r = 0; r < 32; ++r) {
    for (std::size_t e = 0; e < small.elements(); ++e) {
      const bool in_block = e % small.width / 4 == 1 && e / small.width / 5 == 1;
      if (in_block) stack.images[r][e] = r == 7 && e == 7 * small.width + 5 ? 1.0f : 0.0f;
    }
  }
  return stack;
}

// Half of the replicates never saw the block vary. It has no weight there, even if a quadrature
// left an error of 1e-17 in its reference. With one that block alone would be the whole sum.
TEST(ImagePyramid, AnErrorOfRoundingSizeGivesNoWeightToElementsThatDidNotVary) {
  Philox random(826);
  const OwnedStack stack = rarely_lit(random);
  std::vector<double> value(small.elements());
  value[7 * small.width + 5] = 1.0 / 32;
  const std::vector<double> error(small.elements(), 1e-17);
  const ImageFamily exact = image_pyramid({stack.view(), ImageReference{small, value}});
  const ImageFamily nearly = image_pyramid({stack.view(), ImageReference{small, value, error}});
  ASSERT_EQ(exact.groups.size(), nearly.groups.size());
  for (std::size_t g = 0; g < exact.groups.size(); ++g) {
    EXPECT_LT(std::abs(exact.groups[g].z), 5) << exact.groups[g].window.width;
    EXPECT_EQ(nearly.groups[g].window, exact.groups[g].window);
    EXPECT_NEAR(nearly.groups[g].z, exact.groups[g].z, 1e-6);
  }
}

// Sixteen pictures of 24 x 16. The first image's light is partly rare: `rate` of its values in a
// wide patch are bright, and carry `share` of the mean. The second image is smooth, or like it.
struct Fireflies {
  double rate = 0.2;
  double share = 0.9;
};
constexpr ImageExtent lit{24, 16, 1};

OwnedStack lit_stack(Philox& random, const Fireflies& rare, std::size_t replicates = 16) {
  return draw_stack(lit, replicates, [&](std::size_t e) {
    const double level = 1 + static_cast<double>(e % lit.width) / 24;
    const double base = level * (1 + 0.2 * random.normal());
    if (e % lit.width < 6) return base;
    const bool bright = random.uniform() < rare.rate;
    return base * (1 - rare.share) +
           (bright ? -level * rare.share / rare.rate * std::log1p(-random.uniform()) : 0);
  });
}

OwnedStack smooth_stack(Philox& random) { return lit_stack(random, {.rate = 0.5, .share = 0}); }

// Values of 100 with probability .01, else 0. Most elements never vary in a half.
constexpr ImageExtent mostly_zero{16, 16, 1};
OwnedStack mostly_zero_stack(Philox& random, std::size_t replicates) {
  return draw_stack(mostly_zero, replicates,
                    [&](std::size_t) { return random.uniform() < 0.01 ? 100.0 : 0.0; });
}

// Signs in turn do not cancel the skewness where few elements carry the weight.
CALIBRATED(ImagePyramid, RarelyLitElementsAgainstASmoothSideKeepTheLevel, 847, 400,
           Shape::at_most_uniform) {
  const OwnedStack a = mostly_zero_stack(random, 64);
  const OwnedStack b =
      draw_stack(mostly_zero, 64, [&](std::size_t) { return 1 + 0.05 * random.normal(); });
  return image_pyramid({a.view(), b.view()}).log_p;
}

CALIBRATED(ImagePyramid, RarelyLitElementsAgainstTheirMeansKeepTheLevel, 848, 800,
           Shape::at_most_uniform) {
  const std::vector<double> means(mostly_zero.elements(), 1.0);
  return image_pyramid({mostly_zero_stack(random, 32).view(), ImageReference{mostly_zero, means}},
                       {.constants_decide = false})
      .log_p;
}

CALIBRATED(ImagePyramid, RareLightOfOneSideKeepsTheLevel, 846, tests::repetitions(2000),
           Shape::at_most_uniform) {
  return image_pyramid({lit_stack(random, {}).view(), smooth_stack(random).view()}).log_p;
}

// The left half is dark but for rare light, which most of its elements never show in a half.
CALIBRATED(ImagePyramid, RareLightInTheDarkKeepsTheLevel, 853, 500, Shape::at_most_uniform) {
  const auto dark = [](std::size_t e) { return e % lit.width < 12; };
  const OwnedStack a = draw_stack(lit, 16, [&](std::size_t e) {
    return dark(e) ? 50.0 * (random.uniform() < 0.002) : 0.3 + 0.1 * random.normal();
  });
  std::vector<double> means;
  for (std::size_t e = 0; e < lit.elements(); ++e) means.push_back(dark(e) ? 0.1 : 0.3);
  return image_pyramid({a.view(), ImageReference{lit, means}}, {.constants_decide = false}).log_p;
}

// An object's edge before a constant background. Ever fewer of a pixel's eight samples hit it.
// Values there differ in their last bits now and then.
CALIBRATED(ImagePyramid, AnEdgeBeforeAConstantKeepsTheLevel, 854, 200, Shape::at_most_uniform) {
  const auto covered = [](std::size_t e) {
    return e % lit.width == 10 ? std::ldexp(0.5, -static_cast<int>(e / lit.width)) : 0.0;
  };
  const OwnedStack a = draw_stack(lit, 32, [&](std::size_t e) {
    if (e % lit.width < 10) return 0.1 + 0.02 * random.normal();
    const bool off = covered(e) > 0 && random.uniform() < 0.04;
    double value = off ? 0.2 + 1e-5 * (random.uniform() - 0.5) : 0.2;
    for (int i = 0; i < 8; ++i) value -= random.uniform() < covered(e) ? 0.15 / 8 : 0;
    return value;
  });
  std::vector<double> means;
  for (std::size_t e = 0; e < lit.elements(); ++e) {
    means.push_back(e % lit.width < 10 ? 0.1 : static_cast<float>(0.2 - 0.15 * covered(e)));
  }
  return image_pyramid({a.view(), ImageReference{lit, means}}, {.constants_decide = false}).log_p;
}

// A filter spreads each value over 3 x 3 pixels. One side has rarer light.
OwnedStack filtered(Philox& random, double rate) {
  OwnedStack stack = lit_stack(random, {.rate = rate, .share = 0.8}, 64);
  for (auto& image : stack.images) {
    const auto sharp = image;
    for (std::size_t e = 0; e < image.size(); ++e) {
      image[e] = 0;
      for (const std::size_t k : {0U, 1U, 2U, 24U, 25U, 26U, 48U, 49U, 50U})
        image[e] += sharp[(e + k) % image.size()] / 9;
    }
  }
  return stack;
}
CALIBRATED(ImagePyramid, FilteredLightKeepsTheLevel, 865, 600, Shape::at_most_uniform) {
  const OwnedStack a = filtered(random, 0.0003);
  return image_pyramid({a.view(), filtered(random, 0.02).view()}).log_p;
}

// An object covers .08 of each pixel in a row, and of the next row all but .08. Many pixels never
// show the rarer.
CALIBRATED(ImagePyramid, ASilhouetteKeepsTheLevel, 864, 400, Shape::at_most_uniform) {
  const auto covered = [](std::size_t e) {
    const std::size_t row = e / lit.width;
    if (row == 7) return 0.08;
    if (row == 8) return 0.92;
    return row < 7 ? 0.0 : 1.0;
  };
  const OwnedStack a = draw_stack(lit, 16, [&](std::size_t e) {
    return random.uniform() < covered(e) ? 0.28 + 0.01 * random.normal()
                                         : 0.78 + 0.003 * random.normal();
  });
  std::vector<double> means;
  for (std::size_t e = 0; e < lit.elements(); ++e) {
    means.push_back(static_cast<float>(0.78 - 0.5 * covered(e)));
  }
  return image_pyramid({a.view(), ImageReference{lit, means}}, {.constants_decide = false}).log_p;
}

CALIBRATED(ImagePyramid, UnequalNumbersOfOneLawKeepTheLevel, 852, tests::repetitions(500),
           Shape::at_most_uniform) {
  const Fireflies rare{.rate = 0.02, .share = 0.5};
  return image_pyramid({lit_stack(random, rare).view(), lit_stack(random, rare, 48).view()}).log_p;
}

// Half of the mean is in a fiftieth of the values: a cell often misses all of them.
CALIBRATED(ImagePyramid, RarerLightOfOneSideKeepsTheLevel, 846, tests::repetitions(2000),
           Shape::at_most_uniform) {
  const OwnedStack a = lit_stack(random, {.rate = 0.02, .share = 0.5});
  return image_pyramid({a.view(), smooth_stack(random).view()}).log_p;
}

// Four highlights of 4 x 4 in a dull picture. One side has their light in one of 75 values, of
// sizes up to 200 times the least. The other side is smooth there.
constexpr double largest_over_least = 200;
OwnedStack highlight_stack(Philox& random, bool rare) {
  constexpr double least = 0.5;
  const double mean_size = least * (largest_over_least - 1) / std::log(largest_over_least);
  return draw_stack(lit, 16, [&](std::size_t e) {
    const std::size_t x = e % lit.width % 12;
    const std::size_t y = e / lit.width % 8;
    const bool highlight = x >= 4 && x < 8 && y >= 2 && y < 6;
    if (!highlight) return 0.05 * std::abs(1 + 0.3 * random.normal());
    if (!rare) return 0.25 * (1 + 0.002 * random.normal());
    const double size = least * std::pow(largest_over_least, random.uniform());
    return random.uniform() < 0.25 / mean_size ? size : 0;
  });
}
CALIBRATED(ImagePyramid, RareHighlightsOfOneSideKeepTheLevel, 850, tests::repetitions(2000),
           Shape::at_most_uniform) {
  const OwnedStack a = highlight_stack(random, true);
  return image_pyramid({a.view(), highlight_stack(random, false).view()}).log_p;
}

// A glossy ball under the sun, on a floor. Light sampling shows the ball's other reflections in one
// of 60 values, of many sizes. BSDF sampling finds the sun from the floor in one of 25.
OwnedStack gloss_stack(Philox& random, bool light) {
  return draw_stack(lit, 16, [&](std::size_t e) {
    const double seen = random.uniform();
    const std::size_t x = e % lit.width - 10, y = e / lit.width - 6;
    if (x >= 5 || y >= 5) return light ? 0.1 * random.uniform() : seen < 0.04 ? 1 : 0.01 / 0.96;
    if (!light) return 0.45 - 0.05 / 60 + 0.06 * (random.uniform() - 0.5);
    return seen < 1 / 60.0 ? -24 * std::log(60 * seen) : 0.1 * random.uniform();
  });
}
CALIBRATED(ImagePyramid, AGlossyBallUnderTheSunKeepsTheLevel, 855, 200, Shape::at_most_uniform) {
  return image_pyramid({gloss_stack(random, true).view(), gloss_stack(random, false).view()}).log_p;
}

// The edge of a lamp of 50 varies much, and its values are common in their pixels. They tell
// nothing of the floor, whose light one side has in part in one of fifty values.
OwnedStack lamp_stack(Philox& random, bool rare) {
  return draw_stack(lit, 16, [&](std::size_t e) {
    if (e >= 6 * lit.width) {
      const double light = 0.2 * (1 + 0.02 * random.normal());
      if (!rare) return light + 0.05;
      return random.uniform() < 0.02 ? light - 2.5 * std::log(random.uniform()) : light;
    }
    const double radius = std::hypot(int(e % lit.width) - 17, int(e / lit.width) - 3);
    double lamp = 0;
    for (int path = 0; path < 4; ++path) lamp += random.uniform() < 3.5 - radius ? 12.5 : 0;
    return lamp;
  });
}
CALIBRATED(ImagePyramid, RareLightBesideALampKeepsTheLevel, 851, tests::repetitions(500),
           Shape::at_most_uniform) {
  return image_pyramid({lamp_stack(random, true).view(), lamp_stack(random, false).view()}).log_p;
}

// Welch's test of every element, which knows no neighbours.
CAUGHT(ImagePyramid, ElementsWithoutTheirNeighboursAreCaughtOnRareLight, 846, 200,
       Shape::at_most_uniform) {
  double least = 0;
  for (const TestResult& test :
       tests::welch_of_elements(lit_stack(random, {}), smooth_stack(random))) {
    least = std::min(least, log_p_two_sided(test));
  }
  return adjusted(least, {static_cast<double>(lit.elements()), 1});
}

using Factor = std::function<float(std::size_t x, std::size_t y)>;
void scale(OwnedStack& stack, const Factor& factor) {
  for (auto& image : stack.images) {
    for (std::size_t e = 0; e < image.size(); ++e) image[e] *= factor(e % lit.width, e / lit.width);
  }
}

// A block of 6 x 6 is 30 % too dark in one of two images with rare light, or with none. Neighbours
// take little away where both sides have the same law, and more replicates of one hide nothing.
TEST(ImagePyramid, NeighboursLeaveADefectToTwoImagesOfOneLaw) {
  for (const auto& [share, others] : {std::pair(0.0, 16U), {0.1, 16U}, {0.0, 48U}, {0.1, 48U}}) {
    Philox random(847);
    int found = 0;
    for (int run = 0; run < 20; ++run) {
      const Fireflies rare{.rate = 0.2, .share = share};
      OwnedStack a = lit_stack(random, rare);
      scale(a, [](std::size_t x, std::size_t y) {
        return x >= 10 && x < 16 && y >= 5 && y < 11 ? 0.7F : 1.0F;
      });
      const OwnedStack b = lit_stack(random, rare, others);
      found += image_pyramid({a.view(), b.view()}).log_p < std::log(1e-2);
    }
    EXPECT_GE(found, 18) << share << " " << others;
  }
}

CAUGHT(ImagePyramid, AddingTheElementsOwnZIsCaughtOnSkewedData, 825, 2000) {
  const OwnedStack a = skewed_stack(random, 32, 2);
  return log_p_of_sum(tests::welch_of_elements(a, skewed_stack(random, 32, 6)));
}

CAUGHT(ImagePyramid, AddingTheElementsOwnZIsCaughtOnCorrelatedData, 823, 2000) {
  const OwnedStack a = correlated_stack(random, 16);
  return log_p_of_sum(tests::welch_of_elements(a, correlated_stack(random, 16)));
}

CAUGHT(ImagePyramid, StudentsTTakenForNormalIsCaught, 827, 4000, Shape::at_most_uniform) {
  const OwnedStack a = normal_stack(random, 16);
  double largest = 0;
  for (std::size_t e = 0; e < small.elements(); ++e) {
    const Moments moments = tests::one_element(a, e);
    largest = std::max(largest, std::abs(moments.mean / moments.standard_error()));
  }
  return adjusted(two_sided(normal_tails(largest)), {120, 1});
}

CAUGHT(ImagePyramid, AReferencesErrorIgnoredIsCaught, 824, 2000, Shape::at_most_uniform) {
  const OwnedStack a = normal_stack(random, 16);
  std::vector<double> value = normals(random, small.elements());
  for (double& v : value) v *= 0.3;
  return image_pyramid({a.view(), ImageReference{small, value}}).log_p;
}

CAUGHT(ImagePyramid, TheBestWindowWithoutItsCountIsCaught, 828, 4000, Shape::at_most_uniform) {
  const OwnedStack a = normal_stack(random, 16);
  return image_pyramid({a.view(), ImageReference{small, zeros}}).winner.log_p;
}

CAUGHT(ImagePyramid, GroupsWithoutTheirSharesAreCaught, 829, 4000, Shape::at_most_uniform) {
  const auto groups = window_groups(small);
  const OwnedStack a = normal_stack(random, 16);
  const ImageFamily family = image_pyramid({a.view(), ImageReference{small, zeros}});
  double smallest = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    smallest = std::min(smallest, family.groups[g].adjusted_log_p + std::log(groups[g].share));
  }
  return smallest;
}

// At 128 x 128, 64 replicates, alpha 1e-3. Each demanded number of 40 lies far below its own. They
// miss it with probability below 1e-4, and so do a quarter less 2 of a quarter of the runs.
TEST(ImagePyramid, DefectsOfEveryScaleAreFound) {
  const ImageExtent extent{128, 128, 1};
  const std::vector<double> truth(extent.elements());
  const std::map<std::string, int> demanded{{"none", 0},
                                            {"one element 6", 4},
                                            {"8x8 aligned .8", 12},
                                            {"32x32 aligned .2", 26},
                                            {"global .05", 31},
                                            {"checkerboard .3", 39},
                                            {"checkerboard .05", 31},
                                            {"32x32 anywhere .2", 18}};
  const int runs = tests::is_long() ? 40 : 10;
  std::uint32_t test_case = 830;
  for (const Defect& defect : tests::defects()) {
    Philox random(test_case++);
    const auto at = demanded.find(defect.name);
    if (at == demanded.end()) continue;
    int found = 0;
    for (int i = 0; i < runs; ++i) {
      std::vector<double> shift(extent.elements());
      add_defect(shift, extent, defect, random);
      // A standard error is 1/8.
      const OwnedStack a =
          draw_stack(extent, 64, [&](std::size_t e) { return random.normal() + shift[e] / 8; });
      found += image_pyramid({a.view(), ImageReference{extent, truth}}).log_p <= std::log(1e-3);
    }
    EXPECT_GE(found, tests::is_long() ? at->second : at->second / 4 - 2) << defect.name;
    if (at->second == 0) {
      EXPECT_LE(found, 2);  // P(Binomial(40, 1e-3) > 2) = 1e-5
    }
  }
}

// The first of 16 to 128 pictures a side, of one law with rare light. All are 4 % too bright, or a
// block of 4 x 4 is half as bright. Two counts of 100 with one probability differ by more than 21
// with probability .003 at most. As neighbours counted in images of one law, 16 found 41 blocks.
TEST(ImagePyramid, MorePicturesNeverLosePower) {
  const Fireflies rare{.rate = 0.05, .share = 0.3};
  const auto all = [](std::size_t, std::size_t) { return 1.04F; };
  const auto block = [](std::size_t x, std::size_t y) {
    return x >= 12 && x < 16 && y >= 4 && y < 8 ? .5F : 1.F;
  };
  Philox random(848);
  for (const auto& [factor, least] : {std::pair<Factor, int>{all, 10}, {block, 70}}) {
    std::map<std::size_t, int> found;
    for (int run = 0; run < 100; ++run) {
      OwnedStack a = lit_stack(random, rare, 128);
      OwnedStack b = lit_stack(random, rare, 128);
      scale(a, factor);
      for (const std::size_t count : {128U, 64U, 32U, 16U}) {
        a.images.resize(count);
        b.images.resize(count);
        found[count] += image_pyramid({a.view(), b.view()}).log_p < std::log(1e-2);
      }
    }
    std::cout << "  found of 100 in 16, 32, 64, 128 pictures: " << found[16] << ", " << found[32]
              << ", " << found[64] << ", " << found[128] << "\n";
    EXPECT_GE(found[16], least);
    EXPECT_LE(found[16], found[32] + 21);
    EXPECT_LE(found[32], found[64] + 21);
    EXPECT_LE(found[64], found[128] + 21);
    EXPECT_GE(found[128], 95);
  }
}

TEST(ImagePyramid, TheWinnerSaysWhereTheDefectIs) {
  const ImageExtent extent{50, 40, 3};
  Philox random(840);
  OwnedStack stack = draw_stack(extent, 64, [&](std::size_t) { return random.normal(); });
  for (auto& image : stack.images) {
    for (std::size_t y = 16; y < 24; ++y) {
      for (std::size_t x = 26; x < 34; ++x) image[(y * 50 + x) * 3 + 2] -= 0.375F;
    }
  }
  const std::vector<double> truth(extent.elements());
  const ImageFamily family = image_pyramid({stack.view(), ImageReference{extent, truth}});
  EXPECT_LT(family.log_p, std::log(1e-20));
  EXPECT_EQ(family.winner.size, 8);
  EXPECT_EQ(family.winner.window, (Rectangle{26, 16, 8, 8}));
  EXPECT_EQ(family.winner.channel, 2);
  EXPECT_LT(family.winner.z, -10);
}

TEST(ImagePyramid, PixelsThatNeverVaryTellNoSize) {
  Philox random(868);
  const auto draw = [&](double mean) {
    const auto pixel = [&](std::size_t e) { return e % 2 == 0 ? 0 : mean + random.normal(); };
    return draw_stack({8, 8, 1}, 32, pixel);
  };
  const OwnedStack a = draw(2), b = draw(1);
  EXPECT_NEAR(image_pyramid({a.view(), b.view()}).winner.effect.estimate, 1, .2);
}

// A tile is brighter. The interval of the winner's window holds its true mean difference where this
// p-value is above 1 - confidence.
double log_p_of_the_true_effect(Philox& random, bool adjust) {
  constexpr double brighter = 1.2;
  const auto is_tile = [](std::size_t x, std::size_t y) { return x / 4 == 1 && y / 5 == 1; };
  const OwnedStack a = draw_stack(small, 16, [&](std::size_t e) {
    const bool brightened = is_tile(e % small.width, e / small.width);
    return random.normal() + (brightened ? brighter : 0);
  });
  const ImageFamily family = image_pyramid({a.view(), normal_stack(random, 16).view()});
  const ImageFinding& found = family.winner;
  if (found.alternation) return 0;
  double sum = 0, weight = 0;
  for (std::size_t y = found.window.y; y < found.window.y + found.window.height; ++y) {
    for (std::size_t x = found.window.x; x < found.window.x + found.window.width; ++x) {
      const double w = static_cast<double>(family.weights[y * small.width + x]);
      sum += is_tile(x, y) ? w * brighter : 0;
      weight += w;
    }
  }
  const double t = (found.effect.estimate - sum / weight) / found.effect.standard_error;
  const double log_p = two_sided(student_t_tails(t, found.effect.degrees));
  return adjust ? adjusted(log_p, found.group) : log_p;
}

CALIBRATED(ImagePyramid, TheWinnersIntervalHoldsItsTrueEffect, 830, 4000, Shape::at_most_uniform) {
  return log_p_of_the_true_effect(random, true);
}

TEST(ImagePyramid, TheWinnersIntervalExcludesZeroWhereItIsAFinding) {
  Philox random(831);
  int findings = 0;
  for (int run = 0; run < 400; ++run) {
    const OwnedStack a = draw_stack(small, 16, [&](std::size_t e) {
      return random.normal() + (e % small.width / 4 == 1 && e / small.width / 5 == 1 ? .8 : 0);
    });
    const ImageFinding found = image_pyramid({a.view(), normal_stack(random, 16).view()}).winner;
    if (found.alternation || found.adjusted_log_p > std::log(1 - confidence_at_place)) continue;
    const double t = found.effect.estimate / found.effect.standard_error;
    const double own = adjusted(two_sided(student_t_tails(t, found.effect.degrees)), found.group);
    EXPECT_LE(own, std::log(1 - confidence_at_place)) << run;
    ++findings;
  }
  EXPECT_GT(findings, 50);
}

CAUGHT(ImagePyramid, AnIntervalThatForgetsTheSearchIsCaught, 830, 4000, Shape::at_most_uniform) {
  return log_p_of_the_true_effect(random, false);
}

TEST(ImagePyramid, ALevelIsSharedOutAsItIsAdjusted) {
  for (const GroupSize& group : {GroupSize{1, 1}, GroupSize{3, .4}, GroupSize{6e6, .01}}) {
    const double one = unadjusted(std::log(.01), group);
    EXPECT_NEAR(adjusted(one, group), std::log(.01), 1e-9) << group.count;
  }
}

TEST(ImagePyramid, OneDifferentConstantIsCertainAndPlaced) {
  Philox random(841);
  OwnedStack a = normal_stack(random, 16);
  OwnedStack b = normal_stack(random, 16);
  for (auto& image : a.images) image[27] = 1;
  for (auto& image : b.images) image[27] = 1;
  const ImageFamily equal = image_pyramid({a.view(), b.view()});
  EXPECT_EQ(equal.equal_constants, 1);
  EXPECT_EQ(equal.tested, 119);
  EXPECT_GT(equal.log_p, std::log(1e-6));
  for (auto& image : b.images) image[27] = std::nextafter(1.0F, 2.0F);
  const ImageFamily different = image_pyramid({a.view(), b.view()});
  EXPECT_EQ(different.unseen.size(), 1);
  EXPECT_EQ(different.log_p, std::numeric_limits<double>::lowest());
  EXPECT_EQ(different.winner.window, (Rectangle{3, 2, 1, 1}));
  EXPECT_LT(different.winner.z, 0);
}

TEST(ImagePyramid, DifferentConstantsFarFromNoiseAreCertain) {
  Philox random(843);
  const auto draw = [&](float constant) {
    return draw_stack({64, 32, 1}, 16, [&, constant](std::size_t element) {
      return element < 8 ? random.normal() : constant;
    });
  };
  const OwnedStack a = draw(1);
  const OwnedStack b = draw(1.02F);
  const ImageFamily family = image_pyramid({a.view(), b.view()});
  EXPECT_EQ(family.log_p, std::numeric_limits<double>::lowest());
  EXPECT_EQ(family.winner.window, (Rectangle{0, 0, 64, 32}));
}

// 2 / p with probability p, else 0, beside 2. A pixel that shows no 0 differs without noise.
TEST(ImagePyramid, RouletteBesideAConstantIsNoDifference) {
  Philox random(844);
  int fails = 0;
  for (int run = 0; run < 60; ++run) {
    const OwnedStack b = draw_stack({32, 32, 1}, 16, [](std::size_t) { return 2.0F; });
    const OwnedStack a = draw_stack(
        {32, 32, 1}, 16, [&](std::size_t) { return random.uniform() < .95 ? 2 / .95F : 0; });
    fails += image_pyramid({a.view(), b.view()}).log_p < std::log(.01);
  }
  EXPECT_LE(fails, 4);
}

TEST(ImagePyramid, AllDifferentConstantsOfOneSignAreThePlaceAndCertain) {
  Philox random(842);
  OwnedStack a = normal_stack(random, 16);
  OwnedStack b = normal_stack(random, 16);
  const std::size_t constant[] = {27, 40, 95, 119};
  for (const std::size_t e : constant) {
    for (auto& image : a.images) image[e] = 1;
    for (auto& image : b.images) image[e] = e == 40 ? 1.0F : e == 119 ? 0.0F : 2.0F;
  }
  std::vector<double> z(small.elements());
  const ImageFamily family = image_pyramid({a.view(), b.view()}, {.z = z});
  EXPECT_EQ(family.winner.window, (Rectangle{3, 2, 9, 6}));
  // Sums of it are finite: maps average it.
  EXPECT_EQ(z[27], -certain_z);
  EXPECT_EQ(z[95], z[27]);
  EXPECT_EQ(z[40], 0);
  EXPECT_EQ(z[119], certain_z);
}

// Half of it black, one side has fewer degrees of freedom there: a cell half beside the defect has
// a smaller p-value, and not a larger effect.
TEST(ImagePyramid, AClearDefectIsWhereItIs) {
  const ImageExtent extent{64, 48, 1};
  for (const std::uint32_t seed : {861U, 862U, 863U, 864U, 865U}) {
    Philox random(seed);
    const OwnedStack b = draw_stack(extent, 24, [&](std::size_t) { return 3 + random.normal(); });
    OwnedStack a = draw_stack(extent, 24, [&](std::size_t) { return 3 + random.normal(); });
    for (auto& image : a.images) {
      for (std::size_t y = 8; y < 16; ++y) std::fill_n(&image[y * 64 + 40], 8, 0.0F);
    }
    const ImageFinding winner = image_pyramid({a.view(), b.view()}).winner;
    EXPECT_EQ(winner.window, (Rectangle{40, 8, 8, 8})) << seed;
    EXPECT_NEAR(winner.effect.estimate, -3, 0.15);
  }
}

// 2 % of the image's noise everywhere is no pixel's finding.
TEST(ImagePyramid, AUniformDifferenceIsOfTheWholeImage) {
  const ImageExtent extent{64, 48, 1};
  for (const std::uint32_t seed : {871U, 872U, 873U, 874U, 875U}) {
    Philox random(seed);
    const OwnedStack b = draw_stack(extent, 24, [&](std::size_t) { return random.normal(); });
    const OwnedStack a = draw_stack(extent, 24, [&](std::size_t) { return .04 + random.normal(); });
    EXPECT_EQ(image_pyramid({a.view(), b.view()}).winner.window, (Rectangle{0, 0, 64, 48})) << seed;
  }
}

// Elements around it that never vary have no part in a finding, whatever its shape. The sum over
// any place is as many standard errors off.
TEST(ImagePyramid, AFindingIsThePlaceThatVaries) {
  const ImageExtent extent{64, 48, 1};
  Philox random(855);
  for (const Rectangle& place :
       {Rectangle{16, 8, 8, 8}, Rectangle{7, 5, 1, 1}, Rectangle{3, 0, 1, 48},
        Rectangle{18, 9, 5, 7}, Rectangle{0, 47, 64, 1}}) {
    const double deviation = std::sqrt(place.width * place.height) / 8;
    const auto stack_of = [&](double mean) {
      return draw_stack(extent, 32, [&](std::size_t e) {
        const bool varies = e % 64 - place.x < place.width && e / 64 - place.y < place.height;
        return varies ? mean + deviation * random.normal() : 1;
      });
    };
    const OwnedStack a = stack_of(1.5);
    const OwnedStack b = stack_of(1);
    const ImageFamily family = image_pyramid({a.view(), b.view()});
    EXPECT_LT(family.log_p, std::log(1e-6));
    EXPECT_EQ(family.winner.window, place);
    EXPECT_FALSE(family.winner.alternation);
    EXPECT_EQ(family.winner.adjusted_log_p, family.log_p);
  }
}

// A column that is too bright has the p-value of signs in turn, and a place.
TEST(ImagePyramid, SignsInTurnWinOnlyWhereNoCellTells) {
  const ImageExtent extent{32, 32, 1};
  Philox random(856);
  const auto stack_of = [&](auto&& mean) {
    return draw_stack(extent, 64, [&](std::size_t e) { return mean(e) + random.normal(); });
  };
  const OwnedStack b = stack_of([](std::size_t) { return 0.0; });
  const OwnedStack column = stack_of([](std::size_t e) { return e % 32 == 9 ? 1.5 : 0.0; });
  const ImageFinding there = image_pyramid({column.view(), b.view()}).winner;
  EXPECT_FALSE(there.alternation);
  EXPECT_TRUE(there.window.x <= 9 && 9 < there.window.x + there.window.width);
  const OwnedStack turns = stack_of([](std::size_t e) { return e % 32 % 2 == 0 ? 0.1 : -0.1; });
  EXPECT_EQ(image_pyramid({turns.view(), b.view()}).winner.alternation, Alternation::columns);
}

TEST(ImagePyramid, EqualConstantsEverywhereAreNoEvidence) {
  const OwnedStack a = draw_stack(small, 16, [](std::size_t e) { return static_cast<double>(e); });
  const ImageFamily family = image_pyramid({a.view(), a.view()});
  EXPECT_EQ(family.log_p, 0);
  EXPECT_EQ(family.equal_constants, small.elements());
}

TEST(ImagePyramid, SharesAddUpToTheLevel) {
  for (const ImageExtent& extent :
       {ImageExtent{1, 1, 1}, ImageExtent{1, 9, 1}, ImageExtent{128, 128, 3},
        ImageExtent{100, 7, 1}, ImageExtent{2, 2, 1}}) {
    double total = 0;
    for (const WindowGroup& group : window_groups(extent)) total += group.share;
    EXPECT_NEAR(total, 1, 1e-12);
  }
}

TEST(ImagePyramid, EveryElementIsInOneAlignedWindowOfEveryLevel) {
  const ImageExtent extent{21, 13, 1};
  for (const WindowGroup& group : window_groups(extent)) {
    if (group.grid != Grid::aligned) continue;
    std::vector<int> covered(extent.elements());
    for (const Rectangle& w : group.windows) {
      for (std::size_t y = w.y; y < w.y + w.height; ++y) {
        for (std::size_t x = w.x; x < w.x + w.width; ++x) ++covered[y * 21 + x];
      }
    }
    EXPECT_EQ(covered, std::vector<int>(extent.elements(), 1)) << group.size;
  }
}

// With 64 images a side the mean difference of 256 values errs by sqrt(2 / 64 / 256). What is to be
// found with probability .99 is missed more than 3 times in 40 with probability 7e-4. A third of it
// is 2.3 errors, which the cell itself finds with probability .01. Of the few cells that overlap it
// some are as clear.
TEST(ImagePyramid, ATypicalCellTellsWhatIsFound) {
  Philox random(878);
  const ImageExtent extent{64, 48, 1};
  constexpr double error = 0.011049;
  std::array<int, 2> found = {};
  for (int run = 0; run < 40; ++run) {
    const auto draw = [&](std::size_t) { return random.normal(); };
    OwnedStack a = draw_stack(extent, 64, draw);
    const OwnedStack b = draw_stack(extent, 64, draw);
    const TypicalCell typical = image_pyramid({a.view(), b.view()}).typical;
    EXPECT_EQ(typical.group.count, 12);
    EXPECT_NEAR(std::sqrt(typical.noise.at(0).variance) / error, 1, 0.15);
    const double errors =
        normal_quantile({Tail::upper, std::log(0.005 * typical.group.share / 12)}) +
        normal_quantile({Tail::upper, std::log(0.01)});
    const double effect = errors * standard_error_at(typical.noise[0], errors);
    for (std::size_t part = 0; part < 2; ++part) {
      for (std::vector<float>& image : a.images) {
        for (std::size_t y = 16; y < 32; ++y) {
          for (std::size_t x = 32; x < 48; ++x) {
            image[y * 64 + x] += static_cast<float>(part == 0 ? effect : -2 * effect / 3);
          }
        }
      }
      found[part] += image_pyramid({a.view(), b.view()}).log_p <= std::log(0.01) ? 1 : 0;
    }
  }
  EXPECT_GE(found[0], 37);
  EXPECT_LE(found[1], 20);
}

TEST(ImagePyramid, ASkewedNoiseGrowsWithWhatItHides) {
  // x^2 = 1 + 3 * 0.5 * x
  EXPECT_DOUBLE_EQ(standard_error_at({.variance = 1, .growth = 0.5}, 3), 2);
}

// Several bands of rows, and more elements than are taken at a time.
TEST(ImagePyramid, IsTheSameInAnyOrder) {
  Philox random(877);
  const ImageExtent extent{137, 90, 3};
  const auto draw = [&](std::size_t) { return random.normal(); };
  const OwnedStack a = draw_stack(extent, 16, draw);
  const OwnedStack b = draw_stack(extent, 16, draw);
  std::vector<double> z(extent.elements());
  std::vector<double> other_z(extent.elements());
  const ImageFamily family = image_pyramid({a.view(), b.view()}, {.z = z});
  const ImageFamily other =
      image_pyramid({a.view(), b.view()}, {.z = other_z, .for_each = tests::last_first});
  EXPECT_EQ(z, other_z);
  EXPECT_EQ(family.tested, other.tested);
  ASSERT_EQ(family.groups.size(), other.groups.size());
  for (std::size_t g = 0; g < family.groups.size(); ++g) {
    EXPECT_EQ(family.groups[g].z, other.groups[g].z);
    EXPECT_EQ(family.groups[g].adjusted_log_p, other.groups[g].adjusted_log_p);
    EXPECT_EQ(family.groups[g].window.x, other.groups[g].window.x);
    EXPECT_EQ(family.groups[g].window.y, other.groups[g].window.y);
  }
}

}  // namespace
}  // namespace assay::stats
