#include "render/alias_table.h"

#include "tests/prelude.h"

namespace assay {
namespace {

// The probabilities by exhausting a grid of (u, v).
TEST(AliasTable, PicksInProportion) {
  const std::vector<double> weights{3, 0, 1, 4, 0, 2, 6};
  const render::AliasTable table(weights);
  EXPECT_EQ(table.total(), 16);
  std::vector<double> share(weights.size());
  constexpr int columns = 7, steps = 1600;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < steps; ++j) {
      share[table.pick((i + 0.5) / columns, (j + 0.5) / steps)] += 1.0 / (columns * steps);
    }
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    EXPECT_NEAR(share[i], weights[i] / 16, 1.0 / steps);
    if (weights[i] == 0) {
      EXPECT_EQ(share[i], 0);
    }
  }
}

TEST(AliasTable, RefusesWeightsWithoutAPositiveSum) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& weights : std::vector<std::vector<double>>{{}, {0, 0}, {1, -1}, {nan, 1}}) {
    EXPECT_THROW(render::AliasTable{weights}, std::invalid_argument);
  }
}

}  // namespace
}  // namespace assay
