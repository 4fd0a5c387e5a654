#include "stats/basics/search.h"

#include "tests/prelude.h"

namespace assay::stats {
namespace {

TEST(Root, LiesBetweenAnInfiniteValueAndAFiniteOne) {
  EXPECT_NEAR(root([](double x) { return std::log(x); }, {0, 4}, 44), 1, 1e-12);
}

}  // namespace
}  // namespace assay::stats
