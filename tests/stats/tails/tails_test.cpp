#include "stats/tails/tails.h"

#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

template <class Tails>
void expect_table(const std::string& name, double tolerance, const Tails& tails) {
  for (const Row& row : read_table(name)) {
    const LogTails computed = tails(row);
    const std::string where =
        name + " row " + row.text("log_lower") + " / " + row.text("log_upper");
    EXPECT_LE(log_p_error(computed.lower, row["log_lower"]), tolerance)
        << where << ": lower " << computed.lower;
    EXPECT_LE(log_p_error(computed.upper, row["log_upper"]), tolerance)
        << where << ": upper " << computed.upper;
  }
}

TEST(Tails, AgreeWithTwentyFiveDigitsOrQuadrature) {
  const auto whole = [](double value) { return static_cast<std::uint64_t>(value); };
  expect_table("normal", 1e-12, [](const Row& r) { return normal_tails(r["x"]); });
  expect_table("student_t", 1e-10, [](const Row& r) { return student_t_tails(r["t"], r["nu"]); });
  expect_table("chi_square", 1e-10, [](const Row& r) { return chi_square_tails(r["x"], r["nu"]); });
  expect_table("f", 1e-10, [](const Row& r) { return f_tails(r["f"], {r["nu1"], r["nu2"]}); });
  expect_table("binomial", 1e-10, [&](const Row& r) {
    return binomial_tails(whole(r["k"]), {whole(r["n"]), r["p"]});
  });
  expect_table("noncentral_chi_square", 1e-10, [](const Row& r) {
    return noncentral_chi_square_tails(r["x"], {r["nu"], r["ncp"]});
  });
  expect_table("noncentral_t", 1e-10, [](const Row& r) {
    return noncentral_t_tails(r["t"], {r["nu"], r["ncp"]});
  });
}

TEST(Tails, LogarithmsStayFiniteFarBeyondTheRangeOfProbabilities) {
  const LogTails t = student_t_tails(1000, 1e6);
  // ln of (1 + t^2/nu)^(-nu/2), the leading factor, is -5e5 ln 2 = -346573.6.
  EXPECT_NEAR(t.upper, -346581.1, 1);
  EXPECT_LT(normal_tails(1e5).upper, -4.9e9);
  for (const LogTails tails :
       {normal_tails(1e200), student_t_tails(1e300, 3), chi_square_tails(1e300, 2),
        f_tails(1e300, {4, 4}), chi_square_tails(0, 2), f_tails(0, {4, 4}),
        binomial_tails(0, {10, 1.0}), noncentral_chi_square_tails(0, {2, 3})}) {
    EXPECT_TRUE(std::isfinite(tails.lower));
    EXPECT_TRUE(std::isfinite(tails.upper));
    EXPECT_LE(std::max(tails.lower, tails.upper), 0);
  }
}

// A mixture of 3e5 Poisson terms up to here, a saddlepoint beyond. They join in both tails, in the
// middle and at 1e-300.
TEST(Tails, NoncentralChiSquareOfALargeNoncentralityJoinsTheMixture) {
  constexpr double border = 1e8;
  for (const double degrees : {1.0, 4.0, 300.0}) {
    const double deviation = std::sqrt(2 * (degrees + 2 * border));
    for (const double z : {-37.0, -6.0, -1.0, -1e-3, 0.0, 1e-3, 1.0, 6.0, 37.0}) {
      const double x = border + degrees + z * deviation;
      const LogTails below = noncentral_chi_square_tails(x, {degrees, border});
      const LogTails above =
          noncentral_chi_square_tails(x, {degrees, std::nextafter(border, 2 * border)});
      EXPECT_NEAR(below.lower, above.lower, 1e-9 * (1 - below.lower)) << degrees << " " << z;
      EXPECT_NEAR(below.upper, above.upper, 1e-9 * (1 - below.upper)) << degrees << " " << z;
    }
  }
  const LogTails huge = noncentral_chi_square_tails(1e18 + 2e9, {2, 1e18});
  EXPECT_NEAR(huge.upper, normal_tails(1).upper, 1e-8);
}

TEST(Tails, NoncentralTailsStayAccurateWhereTheirFactorsLeaveTheRangeOfDoubles) {
  // At nu = 2 the density is e^(-(x + ncp) / 2) I0(sqrt(ncp x)) / 2. That gives the log tail's
  // slope.
  //  d ln P / dx -> -1/2 + sqrt(ncp / x) / 2 - 1 / (4 x) + …
  const Noncentral law{2, 9};
  const double slope = (noncentral_chi_square_tails(1.001e6, law).upper -
                        noncentral_chi_square_tails(0.999e6, law).upper) /
                       2000;
  EXPECT_NEAR(slope, -.5 + std::sqrt(9e-6) / 2, 1e-6);
  EXPECT_LT(noncentral_chi_square_tails(1e8, law).upper, -4.9e7);
  EXPECT_LT(noncentral_chi_square_tails(1e-200, {40, 9}).lower, -9000);
}

TEST(Tails, FractionalDegreesOfFreedomJoinTheNormalLaw) {
  for (const double nu : {1e12, 1e15, 1e17, 1e19}) {
    for (const double t : {0.5, 3.0, 20.0}) {
      EXPECT_NEAR(student_t_tails(t, nu).upper, normal_tails(t).upper, 1e-6) << nu << " " << t;
    }
  }
}

TEST(Tails, NoncentralTOfManyDegreesJoinsTheNormalLawOnBothSidesOfTheNoncentrality) {
  // T <= t where Z <= t S - delta, and S is within 1e-6 of 1. So ln P moves by at most t 1e-6 times
  // the hazard rate, which is below 4 here.
  for (const double nu : {1e12, 1e13, 1e15}) {
    for (const double t : {4.5, 5.0 - 1e-9, 5.0, 5.0 + 1e-9, 7.0}) {
      const LogTails tails = noncentral_t_tails(t, {nu, 5});
      EXPECT_NEAR(tails.upper, normal_tails(t - 5).upper, 2e-5) << nu << " " << t;
      EXPECT_NEAR(tails.lower, normal_tails(t - 5).lower, 2e-5) << nu << " " << t;
    }
  }
}

TEST(Tails, QuantilesInvertTheTails) {
  for (const double log_p : {-1e-12, -0.1, -0.6931, -0.7, -3.0, -40.0, -690.0, -5000.0}) {
    for (const Tail tail : {Tail::lower, Tail::upper}) {
      const LogTail target{tail, log_p};
      const auto expect_target = [&](const LogTails& at) {
        const double found = tail == Tail::lower ? at.lower : at.upper;
        EXPECT_LE(log_p_error(found, log_p), 1e-9) << log_p;
      };
      const Noncentral law{40, 9};
      expect_target(normal_tails(normal_quantile(target)));
      expect_target(student_t_tails(student_t_quantile(target, 25.5), 25.5));
      expect_target(chi_square_tails(chi_square_quantile(target, 40), 40));
      expect_target(noncentral_chi_square_tails(noncentral_chi_square_quantile(target, law), law));
      // With 12 degrees below, the quantile overflows from -4000 on.
      if (log_p > -1000) expect_target(f_tails(f_quantile(target, {30, 12}), {30, 12}));
      // Its argument has no more digits near one.
      const bool is_resolved = log_p <= -0.1 && log_p >= -40 && tail == Tail::lower;
      if (is_resolved) expect_target(beta_tails(beta_quantile(target, {3, 40}), {3, 40}));
    }
  }
}

TEST(Tails, ImpossibleQuantilesAreInfinite) {
  EXPECT_TRUE(std::isinf(student_t_quantile({Tail::upper, -5000}, 1)));
  EXPECT_LT(student_t_quantile({Tail::lower, -5000}, 1), 0);
}

}  // namespace
}  // namespace assay::stats
