#include "stats/images/image_dependence.h"

#include "tests/prelude.h"
#include "tests/stats/image_samples.h"

namespace assay::stats {
namespace {

constexpr ImageExtent extent{40, 24, 3};

// Heavy noise with fireflies.
double noise(Philox& random) {
  return 1 - std::log(random.uniform()) + (random.uniform() < 1e-3 ? 30 / random.uniform() : 0);
}

// A pixel that is mostly black has few values, as with one sample of a lamp.
double sparse(Philox& random) { return random.uniform() < .05 ? .25 : 0; }

OwnedStack independent(Philox& random, double (*law)(Philox&), std::size_t replicates = 16) {
  return draw_stack(extent, replicates, [&](std::size_t) { return law(random); });
}

ImageDependence found(const OwnedStack& a, const OwnedStack& b) {
  const ImageStack first = a.view();
  const ImageStack second = b.view();
  return image_dependence({first, second});
}

void copy_tile(const std::vector<float>& from, std::vector<float>& to) {
  for (std::size_t y = 8; y < 16; ++y) {
    for (std::size_t i = 16 * 3; i < 24 * 3; ++i)
      to[y * extent.row() + i] = from[y * extent.row() + i];
  }
}

TEST(ImageDependence, IsNotSeenInIndependentImages) {
  Philox random(7301);
  for (int i = 0; i < 100; ++i) {
    for (const auto law : {noise, sparse}) {
      const OwnedStack a = independent(random, law);
      const ImageDependence one = found(a, independent(random, law));
      EXPECT_FALSE(one.repeated);
      EXPECT_FALSE(one.alike);
    }
  }
}

TEST(ImageDependence, NamesATileThatTwoImagesShare) {
  Philox random(7302);
  OwnedStack a = independent(random, noise);
  OwnedStack b = independent(random, noise);
  copy_tile(a.images[11], a.images[3]);
  const ImageDependence inside = found(a, b);
  ASSERT_TRUE(inside.repeated);
  EXPECT_EQ(inside.repeated->tile, (Rectangle{16, 8, 8, 8}));
  EXPECT_EQ(inside.repeated->one.index, 3u);
  EXPECT_EQ(inside.repeated->other.index, 11u);
  EXPECT_EQ(inside.repeated->tiles, 1u);
  a = independent(random, noise);
  copy_tile(a.images[5], b.images[2]);
  const ImageDependence across = found(a, b);
  ASSERT_TRUE(across.repeated);
  EXPECT_EQ(across.repeated->one.side, 0u);
  EXPECT_EQ(across.repeated->other.side, 1u);
  EXPECT_EQ(across.repeated->other.index, 2u);
}

// A value in most images tells none apart.
TEST(ImageDependence, LeavesTilesWithoutNoiseAlone) {
  Philox random(7303);
  OwnedStack a = independent(random, noise);
  OwnedStack b = independent(random, noise);
  for (std::size_t r = 0; r < 12; ++r) {
    copy_tile(a.images[15], a.images[r]);
    copy_tile(a.images[15], b.images[r]);
  }
  EXPECT_FALSE(found(a, b).repeated);
}

TEST(ImageDependence, SeesNeighboursThatShareHalfTheirNumbers) {
  Philox random(7304);
  for (int i = 0; i < 20; ++i) {
    OwnedStack a = independent(random, noise, 17);
    for (std::size_t r = 0; r < 16; ++r) {
      for (std::size_t e = 0; e < extent.elements(); ++e) a.images[r][e] += a.images[r + 1][e];
    }
    a.images.pop_back();
    const ImageDependence shared = found(independent(random, noise), a);
    ASSERT_TRUE(shared.alike);
    EXPECT_FALSE(shared.alike->across);
    EXPECT_EQ(shared.alike->side, 1u);
    EXPECT_NEAR(shared.alike->correlation, .4, .1);
  }
}

TEST(ImageDependence, SeesOneSeedOnBothSides) {
  Philox random(7305);
  for (int i = 0; i < 20; ++i) {
    const OwnedStack a = independent(random, noise);
    OwnedStack b = a;
    for (auto& image : b.images) {
      for (float& value : image) value = std::sqrt(value) + static_cast<float>(random.normal());
    }
    const ImageDependence shared = found(a, b);
    ASSERT_TRUE(shared.alike);
    EXPECT_TRUE(shared.alike->across);
  }
}

// The four levels of a picture of two bits.
double levels(Philox& random) { return std::floor(4 * random.uniform()); }

TEST(ImageDependence, FollowsTheFrequenciesOfValues) {
  Philox random(7307);
  OwnedStack a = independent(random, levels);
  const OwnedStack b = independent(random, levels);
  EXPECT_FALSE(found(a, b).repeated);
  copy_tile(a.images[0], a.images[9]);
  EXPECT_TRUE(found(a, b).repeated);
  // Two pixels of four levels agree by chance, and 8 over which a filter spreads one number.
  OwnedStack narrow = draw_stack({2, 1, 1}, 64, [&](std::size_t) { return levels(random); });
  EXPECT_FALSE(found(narrow, narrow).repeated);
  narrow = draw_stack({8, 1, 1}, 64, [&, last = 0.](std::size_t e) mutable {
    return last = e == 0 ? std::floor(1000 * random.uniform()) : last + 1;
  });
  EXPECT_FALSE(found(narrow, narrow).repeated);
}

// A lamp that is off leaves many pixels black together, and others of a tile as they are.
TEST(ImageDependence, LeavesShadowsAlone) {
  Philox random(7308);
  const auto lit = [&](std::size_t replicates) {
    OwnedStack stack = draw_stack(extent, replicates, [&](std::size_t) { return noise(random); });
    for (std::size_t r = 0; r < replicates; ++r) {
      for (std::size_t e = 0; e < extent.elements(); ++e) {
        float& value = stack.images[r][e];
        value = e % extent.row() < 36 ? 15 : r % 2 == 0 ? 0 : value;
      }
    }
    return stack;
  };
  EXPECT_FALSE(found(lit(16), lit(16)).repeated);
}

TEST(ImageDependence, IsTheSameRowByRow) {
  Philox random(7306);
  const OwnedStack sound = independent(random, noise);
  OwnedStack repeats = independent(random, noise);
  copy_tile(repeats.images[0], repeats.images[1]);
  OwnedStack neighbours = independent(random, noise);
  for (std::size_t r = 1; r < neighbours.images.size(); ++r) {
    for (std::size_t e = 0; e < extent.elements(); ++e) {
      neighbours.images[r - 1][e] += neighbours.images[r][e];
    }
  }
  OwnedStack same_seed = sound;
  for (float& value : same_seed.images[0]) value *= 2;
  for (const OwnedStack* other : {&repeats, &neighbours, &same_seed}) {
    const ImageStack first = sound.view();
    const ImageStack second = other->view();
    RowDependence rows;
    for (std::size_t y = 0; y < extent.height; y += 8) {
      rows.take({first, second}, {y, y + 8});
    }
    const ImageDependence by_rows = rows.found();
    const ImageDependence whole = found(sound, *other);
    EXPECT_TRUE(whole.repeated || whole.alike);
    EXPECT_EQ(by_rows, whole);
  }
}

}  // namespace
}  // namespace assay::stats
