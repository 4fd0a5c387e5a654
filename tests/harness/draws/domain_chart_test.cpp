#include "harness/draws/draw_cells.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

// More values than the table has places, each asked for again after all others.
TEST(RememberedCoordinates, AreTheValuesOwnWhateverWasAskedBefore) {
  RememberedCoordinates remembered(chart_by(Domain::sphere, 0));
  constexpr int values = 20000;
  for (int again = 0; again < 2; ++again) {
    for (int i = 0; i < values; ++i) {
      const double phi = 2 * std::numbers::pi * i / values;
      const Coordinate& found = remembered(phi);
      ASSERT_EQ(found.value, phi);
      ASSERT_EQ(found.cosine, std::cos(phi));
      ASSERT_EQ(found.sine, std::sin(phi));
    }
  }
}

}  // namespace
}  // namespace assay::harness
