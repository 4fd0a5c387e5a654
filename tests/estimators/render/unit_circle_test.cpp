#include "estimators/stream.h"
#include "render/hemisphere.h"
#include "tests/prelude.h"

namespace assay::render {
namespace {

// In the 64-bit mantissas of long double, whose sine and cosine are another program's.
double error_at(double t) {
  const long double angle = 2 * std::numbers::pi_v<long double> * static_cast<long double>(t);
  const auto [x, y] = on_unit_circle(t);
  return static_cast<double>(
      std::max(std::abs(x - std::cos(angle)), std::abs(y - std::sin(angle))));
}

TEST(UnitCircle, IsWhatTheCLibrarySaysInLongDouble) {
  Stream random(stream_key(1, "unit circle", "", 0), 0);
  double most = 0;
  for (int i = 0; i < 1'000'000; ++i) most = std::max(most, error_at(random.uniform()));
  for (int i = 0; i <= 4096; ++i) most = std::max(most, error_at(i / 4096.));
  RecordProperty("greatest error", std::to_string(most * 0x1p53) + " x 2^-53");
  EXPECT_LT(most, 2.2e-16);
}

TEST(UnitCircle, HasSmallSinesToTheirLastDigits) {
  for (double t = 0.1; t > 1e-300; t /= 7) {
    const double sine = on_unit_circle(t).y;
    const auto angle = 2 * std::numbers::pi_v<long double> * static_cast<long double>(t);
    EXPECT_NEAR(sine / static_cast<double>(std::sin(angle)), 1, 4e-16) << t;
  }
}

TEST(UnitCircle, IsExactAtQuarterTurns) {
  for (const double whole : {0., 1., 7., 1024.}) {
    const CirclePoint points[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (int quarter = 0; quarter < 4; ++quarter) {
      const auto [x, y] = on_unit_circle(whole + quarter / 4.);
      EXPECT_EQ(x, points[quarter].x);
      EXPECT_EQ(y, points[quarter].y);
    }
  }
}

TEST(UnitCircle, TurnsTheOtherWayForNegativeTurns) {
  for (double t = 1 / 64.; t < 1; t += 1 / 32.) {
    EXPECT_EQ(on_unit_circle(-t).x, on_unit_circle(t).x);
    EXPECT_EQ(on_unit_circle(-t).y, -on_unit_circle(t).y);
  }
}

}  // namespace
}  // namespace assay::render
