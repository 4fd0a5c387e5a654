// Functions that take images rows after rows give the bits of those that take them whole.

#include "stats/images/image_equivalence.h"
#include "stats/images/image_moments.h"
#include "stats/pyramids/image_pyramid.h"
#include "tests/prelude.h"
#include "tests/stats/image_samples.h"

namespace assay::stats {
namespace {

// Rows of 150, which is no multiple of what a thread takes; the last window has no whole tile.
constexpr ImageExtent extent{50, 150, 3};
constexpr std::size_t count = 33;

// A light of 8 x 8 lies across the rows 64, so that the largest cells of every size do.
OwnedStack skewed_stack(std::uint32_t key, double light) {
  tests::Philox random(key);
  return tests::draw_stack(extent, count, [&](std::size_t e) {
    const std::size_t x = e / extent.channels % extent.width;
    const std::size_t y = e / extent.row();
    const bool lit = x >= 10 && x < 18 && y >= 60 && y < 68;
    return 1 + static_cast<double>(e % 7) + (lit ? light : 0) - std::log1p(-random.uniform());
  });
}

/// Holds only the rows that are said to be there. Beside them stands a value that would spoil every
/// sum.
class Window {
 public:
  Window(const OwnedStack& whole, RowRange rows) : stack_{extent, {}, rows.elements(extent)} {
    for (const std::vector<float>& image : whole.images) {
      std::vector<float>& copy =
          copies_.emplace_back(image.size(), std::numeric_limits<float>::quiet_NaN());
      std::copy(image.begin() + static_cast<std::ptrdiff_t>(stack_.there.first),
                image.begin() + static_cast<std::ptrdiff_t>(stack_.there.last),
                copy.begin() + static_cast<std::ptrdiff_t>(stack_.there.first));
    }
    for (const std::vector<float>& copy : copies_) {
      stack_.images.push_back(
          std::span<const float>(copy).subspan(stack_.there.first, stack_.there.size()));
    }
  }
  const ImageStack& stack() const { return stack_; }

 private:
  std::vector<std::vector<float>> copies_;
  ImageStack stack_;
};

/// Calls take(pair, rows) for rows after rows, with as many ahead of them.
template <class Take>
void for_each_window(const OwnedStack& a, const OwnedStack& b, std::size_t ahead,
                     const Take& take) {
  constexpr std::size_t at_a_time = 64;
  for (std::size_t row = 0; row < extent.height; row += at_a_time) {
    const RowRange rows{row, std::min(row + at_a_time, extent.height)};
    const RowRange there{row, std::min(rows.last + ahead, extent.height)};
    const Window first(a, there);
    const Window second(b, there);
    take(ImagePair(first.stack(), second.stack()), rows);
  }
}

class ImageRows : public ::testing::Test {
 protected:
  const OwnedStack a_ = skewed_stack(880, 1.5);
  const OwnedStack b_ = skewed_stack(881, 0);
};

void expect_same(const ImageFamily& rows, const ImageFamily& whole) {
  EXPECT_EQ(rows.tested, whole.tested);
  EXPECT_EQ(rows.log_p, whole.log_p);
  ASSERT_EQ(rows.groups.size(), whole.groups.size());
  for (std::size_t g = 0; g < rows.groups.size(); ++g) {
    EXPECT_EQ(rows.groups[g].z, whole.groups[g].z) << g;
    EXPECT_EQ(rows.groups[g].log_p, whole.groups[g].log_p) << g;
    EXPECT_EQ(rows.groups[g].adjusted_log_p, whole.groups[g].adjusted_log_p) << g;
    EXPECT_EQ(rows.groups[g].window, whole.groups[g].window) << g;
    EXPECT_EQ(rows.groups[g].channel, whole.groups[g].channel) << g;
  }
}

TEST_F(ImageRows, MakeTheFamilyOfTheWhole) {
  using Pyramid = RowPyramid;
  std::vector<double> z(extent.elements());
  std::vector<double> z_of_whole(extent.elements());
  Pyramid pyramid({a_.view(), b_.view()}, {.z = z, .for_each = tests::last_first});
  for_each_window(a_, b_, Pyramid::rows_ahead,
                  [&](const auto& pair, RowRange rows) { pyramid.take(pair, rows); });
  const ImageFamily rows = pyramid.family();
  const ImageFamily whole = image_pyramid({a_.view(), b_.view()}, {.z = z_of_whole});
  expect_same(rows, whole);
  EXPECT_EQ(z, z_of_whole);
  EXPECT_EQ(rows.weights, whole.weights);
  EXPECT_EQ(rows.hidden_squares, whole.hidden_squares);
  const std::vector<double> zeros(extent.elements());
  EXPECT_GT(image_pyramid({a_.view(), ImageReference{extent, zeros}}).hidden_squares, 0);
}

TEST_F(ImageRows, HaveTheDistanceOfTheWhole) {
  RowDistance distance;
  for_each_window(a_, b_, 0, [&](const auto& pair, RowRange rows) {
    distance.take(pair, rows, tests::last_first);
  });
  const ImageDistance rows = distance.distance();
  const ImageDistance whole = image_distance({a_.view(), b_.view()});
  EXPECT_EQ(rows.squared_bias, whole.squared_bias);
  EXPECT_EQ(rows.squared_norm, whole.squared_norm);
  EXPECT_EQ(rows.bias_variance, whole.bias_variance);
  EXPECT_EQ(rows.norm_variance, whole.norm_variance);
  EXPECT_EQ(rows.covariance, whole.covariance);
  EXPECT_EQ(rows.degrees, whole.degrees);
}

TEST_F(ImageRows, AddUpToTheSumsOfTheWholesChannels) {
  const std::span<const float> image = a_.images[0];
  ChannelSums sums(extent.channels);
  constexpr std::size_t some = 77;  // Neither whole rows nor whole pixels.
  for (std::size_t i = 0; i < image.size(); i += some) {
    sums.add(image.subspan(i, std::min(some, image.size() - i)));
  }
  const std::vector<double> whole = image_channel_sums(a_.view());
  EXPECT_TRUE(std::ranges::equal(sums.sums(), std::span(whole).first(extent.channels)));
}

}  // namespace
}  // namespace assay::stats
