#include "render/share_table.h"

#include "tests/prelude.h"

namespace assay {
namespace {

// The probabilities by exhausting a grid, of as many shares as are counted and as are searched. The
// place within a share is uniform again.
TEST(ShareTable, PicksInProportion) {
  for (const std::size_t repeated : {1u, 2u}) {
    std::vector<double> shares;
    for (std::size_t i = 0; i < repeated; ++i) {
      for (const double share : {3, 0, 1, 4, 2, 6, 0}) shares.push_back(share);
    }
    const render::ShareTable table(shares);
    EXPECT_EQ(table.total(), 16 * repeated);
    std::vector<double> picked(shares.size());
    std::vector<double> places(shares.size());
    constexpr int steps = 3200;
    for (int i = 0; i < steps; ++i) {
      double x = (i + 0.5) / steps;
      const std::size_t index = table.pick(x);
      ASSERT_TRUE(x >= 0 && x <= 1) << x;
      picked[index] += 1.0 / steps;
      places[index] += x / steps;
    }
    for (std::size_t i = 0; i < shares.size(); ++i) {
      EXPECT_NEAR(picked[i], shares[i] / table.total(), 1.0 / steps);
      EXPECT_NEAR(places[i], picked[i] / 2, 1.0 / steps);
      if (shares[i] == 0) {
        EXPECT_EQ(picked[i], 0);
      }
    }
  }
}

}  // namespace
}  // namespace assay
