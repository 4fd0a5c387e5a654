#include "stats/laws/supremum_bound.h"

#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

// tests/tables/suprema.csv is the convolution itself, by quadrature; the grid may only add to it.
TEST(SupremumBound, IsTheConvolutionOfTheTwoLawsWhicheverIsLarger) {
  for (const tests::Row& row : tests::read_table("suprema")) {
    const TwoSizes sizes{static_cast<std::uint64_t>(row["m"]),
                         static_cast<std::uint64_t>(row["n"])};
    const double bound = log_two_suprema_bound(row["gap"], sizes);
    EXPECT_GE(bound, row["log_p"] - 1e-9) << row.text("m") << " and " << row.text("n");
    EXPECT_LE(bound, row["log_p"] + 0.03) << row.text("m") << " and " << row.text("n");
  }
}

TEST(SupremumBound, OfNoGapIsOne) { EXPECT_EQ(log_two_suprema_bound(0, {10, 20}), 0); }

}  // namespace
}  // namespace assay::stats
