#include "estimators/sampler.h"

#include "tests/prelude.h"

namespace assay {
namespace {

TEST(Marginals, DirectionsHaveThetaAndPhi) {
  for (const Domain domain : {Domain::hemisphere, Domain::sphere}) {
    const auto list = marginals(domain);
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].name, "theta");
    EXPECT_EQ(list[1].name, "phi");
    EXPECT_DOUBLE_EQ(list[0].high, domain == Domain::sphere ? pi : pi / 2);
    EXPECT_DOUBLE_EQ(list[0].coordinate({0, 0, 1}), 0);
    EXPECT_DOUBLE_EQ(list[0].coordinate({1, 0, 0}), pi / 2);
    EXPECT_DOUBLE_EQ(list[0].coordinate({0, 0, -1}), pi);
    EXPECT_DOUBLE_EQ(list[1].coordinate({0, -1, 0}), 1.5 * pi);
  }
}

TEST(Marginals, PhiStaysBelowTwoPi) {
  const double phi = marginals(Domain::sphere)[1].coordinate({1, -1e-300, 0});
  EXPECT_GE(phi, 0);
  EXPECT_LT(phi, 2 * pi);
}

TEST(Marginals, ThetaIsAccurateAtThePole) {
  EXPECT_DOUBLE_EQ(marginals(Domain::sphere)[0].coordinate({1e-9, 0, 1}), 1e-9);
}

TEST(Marginals, FlatDomainsHaveTheirCoordinates) {
  EXPECT_EQ(marginals(Domain::interval).size(), 1u);
  for (const Domain domain : {Domain::square, Domain::triangle}) {
    const auto list = marginals(domain);
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].coordinate({.25, .5, 0}), .25);
    EXPECT_EQ(list[1].coordinate({.25, .5, 0}), .5);
  }
}

}  // namespace
}  // namespace assay
