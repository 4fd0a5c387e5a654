#include "stats/basics/mean_rounding.h"

#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

struct Blocks {
  double offset;
  std::uint64_t size;
  int count;
};

struct Rounded {
  // Error of the mean of one sample.
  double off;
  Moments moments;
};

/// Normal values of deviation 1 around the offset. Their distances from it are exact, and summed
/// without the offset.
Rounded sample(const Blocks& blocks, tests::Philox& random) {
  Moments all;
  Moments distances;
  for (int k = 0; k < blocks.count; ++k) {
    Moments block;
    for (std::uint64_t i = 0; i < blocks.size; ++i) {
      const double value = blocks.offset + random.normal();
      block.add(value);
      distances.add(value - blocks.offset);
    }
    all.merge(block);
  }
  return {(all.mean - blocks.offset) - distances.mean, all};
}

// For a uniform law the root mean square of 200 has a standard deviation of 3.2 %. A fifth more or
// less is six away.
TEST(MeanRounding, IsAsMeasured) {
  tests::Philox random(1717);
  for (const Blocks& blocks : {Blocks{1e8, 256, 1}, Blocks{1e10, 256, 16}, Blocks{1e12, 1024, 1},
                               Blocks{1e13, 64, 64}, Blocks{1e14, 1024, 32}}) {
    double squares = 0;
    double expected = 0;
    for (int run = 0; run < 200; ++run) {
      const Rounded rounded = sample(blocks, random);
      squares += rounded.off * rounded.off / 200;
      expected = rounding_of_mean(rounded.moments);
    }
    EXPECT_GT(std::sqrt(squares), expected * 0.8) << blocks.offset << " " << blocks.size;
    EXPECT_LT(std::sqrt(squares), expected * 1.2) << blocks.offset << " " << blocks.size;
  }
}

TEST(MeanRounding, OfValuesThatDoNotVaryIsNone) {
  Moments constant;
  for (int i = 0; i < 10; ++i) constant.add(1e15);
  EXPECT_EQ(rounding_of_mean(constant), 0);
  EXPECT_EQ(rounding_of_mean({}), 0);
}

}  // namespace
}  // namespace assay::stats
