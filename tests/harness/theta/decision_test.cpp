#include "harness/theta/decision.h"

#include "stats/means/binomial.h"
#include "stats/means/student_t.h"
#include "tests/harness/normal_evidence.h"
#include "tests/stats/samples.h"

namespace assay::harness {
namespace {

using reports::Verdict;

/// P(Z >= z) and P(Z <= z) by the complementary error function alone.
double above(double z) { return std::erfc(z / std::sqrt(2.0)) / 2; }
double below(double z) { return above(-z); }

constexpr double estimate = 1.7;
constexpr double standard_error = 0.8;

double p_claimed(const Regions& regions) {
  return std::exp(log_p_claimed(normal_evidence(estimate, standard_error), regions));
}
double p_forbidden(const Regions& regions) {
  return std::exp(log_p_forbidden(normal_evidence(estimate, standard_error), regions));
}
double at(double theta) { return (estimate - theta) / standard_error; }

// Equality doubles the nearer tail and excludes both sides, a bound uses one tail, and a proof
// splits at zero or at its margin.
TEST(Decision, TakesTheTailsOfItsRelation) {
  struct Tails {
    Regions regions;
    double claimed;
    double forbidden;
  };
  for (const Tails& each :
       std::vector<Tails>{{{Relation::equal, .3, 2.5},
                           2 * above(at(.3)),
                           std::max(below(at(2.5)), above(at(-2.5)))},
                          {{Relation::at_most, .3, 2.5}, above(at(.3)), below(at(2.5))},
                          {{Relation::at_least, .3, 2.5}, below(at(-.3)), above(at(-2.5))},
                          {{Relation::less, 0, 2.5}, above(at(0)), below(at(0))},
                          {{Relation::greater, 0, 2.5}, below(at(0)), above(at(0))},
                          {{Relation::within, 0, .9},
                           std::min(1., 2 * above(at(.9))),
                           std::max(below(at(.9)), above(at(-.9)))}}) {
    EXPECT_NEAR(p_claimed(each.regions), each.claimed, 1e-14) << tail(each.regions);
    EXPECT_NEAR(p_forbidden(each.regions), each.forbidden, 1e-14) << tail(each.regions);
  }
}

TEST(Decision, OfEqualityIsTheSameSeenFromBelow) {
  const Regions regions{.relation = Relation::equal, .allow = 0.3, .detect = 2.5};
  EXPECT_NEAR(std::exp(log_p_claimed(normal_evidence(-estimate, standard_error), regions)),
              p_claimed(regions), 1e-14);
  EXPECT_NEAR(std::exp(log_p_forbidden(normal_evidence(-estimate, standard_error), regions)),
              p_forbidden(regions), 1e-14);
}

TEST(Decision, OfEqualityNeverExceedsOne) {
  EXPECT_EQ(log_p_claimed(normal_evidence(0, 1), {.relation = Relation::equal}), 0);
}

TEST(Decision, OfADistanceHasOneDirection) {
  Evidence evidence = normal_evidence(estimate, standard_error);
  evidence.distance = true;
  const Regions regions{.relation = Relation::equal, .allow = 0.3, .detect = 2.5};
  EXPECT_NEAR(std::exp(log_p_claimed(evidence, regions)), above(at(0.3)), 1e-14);
  EXPECT_NEAR(std::exp(log_p_forbidden(evidence, regions)), below(at(2.5)), 1e-14);
}

TEST(Decision, ClaimedRangesFollowTheRelation) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto range = [](Relation relation) {
    const stats::Range r = Regions{.relation = relation, .allow = 0.1, .detect = 0.3}.claimed();
    return std::pair(r.low, r.high);
  };
  EXPECT_EQ(range(Relation::equal), std::pair(-0.1, 0.1));
  EXPECT_EQ(range(Relation::at_most), std::pair(-infinity, 0.1));
  EXPECT_EQ(range(Relation::at_least), std::pair(-0.1, infinity));
  EXPECT_EQ(range(Relation::within), std::pair(-0.3, 0.3));
}

TEST(Decision, WithoutDetectAnAlarmHasNothingToExclude) {
  for (const Relation relation : {Relation::equal, Relation::at_most, Relation::at_least}) {
    EXPECT_FALSE(Regions{.relation = relation}.has_forbidden());
    EXPECT_EQ(p_forbidden({.relation = relation}), 1);
    EXPECT_EQ(decide({{.log_p_forbidden = 0}}, {.relation = relation}, 0.01), Verdict::pass);
  }
  for (const Relation relation : {Relation::less, Relation::greater, Relation::within}) {
    EXPECT_TRUE(Regions{.relation = relation}.has_forbidden());
  }
}

TEST(Decision, PassesOnlyWhenEveryChannelIsExcluded) {
  const Regions regions{.relation = Relation::equal, .detect = 1};
  const ChannelDecision excluded{.log_p_forbidden = std::log(0.009)};
  const ChannelDecision open{.log_p_forbidden = std::log(0.011)};
  const ChannelDecision rejected{.log_p_forbidden = std::log(0.009), .rejected = true};
  EXPECT_EQ(decide({excluded, excluded}, regions, 0.01), Verdict::pass);
  EXPECT_EQ(decide({excluded, open}, regions, 0.01), Verdict::inconclusive);
  EXPECT_EQ(decide({excluded, open, rejected}, regions, 0.01), Verdict::fail);
}

// A simulation checks the levels of p-values. For theta in C, "theta in C" is rejected at most as
// often as the level; the same holds for F. Where a region ends at one point, it is rejected
// exactly that often. An exact binomial test at 1e-7 judges each rate. Fewer than 100 rates give a
// false alarm below 1e-5.

using LogP = std::function<double(const Evidence&, const Regions&)>;
struct Decider {
  LogP claimed = log_p_claimed;
  LogP forbidden = log_p_forbidden;
};

struct Case {
  Regions regions;
  std::vector<double> in_claimed;
  std::vector<double> in_forbidden;
  bool sharp_claimed;    ///< the first of in_claimed is all that C's boundary is
  bool sharp_forbidden;  ///< the first of in_forbidden likewise
};

std::vector<Case> cases() {
  return {{{Relation::equal, 0, 6}, {0}, {6, -6, 7}, true, true},
          {{Relation::equal, .5, 1}, {.5, -.5, 0}, {1, -1, 2}, false, false},
          {{Relation::at_most, .5, 1}, {.5, 0, -3}, {1, 2}, true, true},
          {{Relation::at_least, .5, 1}, {-.5, 0, 3}, {-1, -2}, true, true},
          {{Relation::less}, {0, -1}, {0, 1}, true, true},
          {{Relation::greater}, {0, 1}, {0, -1}, true, true},
          {{Relation::within, 0, 6}, {5.999, -5.999, 0}, {6, -6, 7}, false, true}};
}

constexpr double level = 0.05;
constexpr std::uint64_t repetitions = 20000;

/// True if `log_p` is at most the level no more often than it may; when sharp, just as often.
bool keeps_level(const LogP& log_p, const Regions& regions, double theta, bool sharp,
                 tests::Philox& random) {
  std::uint64_t rejected = 0;
  for (std::uint64_t i = 0; i < repetitions; ++i) {
    const Evidence evidence = normal_evidence(theta + random.normal(), 1);
    rejected += log_p(evidence, regions) <= std::log(level);
  }
  const stats::TestResult test = stats::binomial({rejected, repetitions}, level);
  return test.log_p_upper > std::log(1e-7) && (!sharp || test.log_p_lower > std::log(1e-7));
}

bool keeps_promises(const Decider& decider) {
  tests::Philox random(901);
  bool kept = true;
  for (const Case& each : cases()) {
    for (std::size_t i = 0; i < each.in_claimed.size(); ++i) {
      kept &= keeps_level(decider.claimed, each.regions, each.in_claimed[i],
                          each.sharp_claimed && i == 0, random);
    }
    for (std::size_t i = 0; i < each.in_forbidden.size(); ++i) {
      kept &= keeps_level(decider.forbidden, each.regions, each.in_forbidden[i],
                          each.sharp_forbidden && i == 0, random);
    }
  }
  return kept;
}

TEST(Decision, ErrsNoMoreOftenThanItsLevels) { EXPECT_TRUE(keeps_promises({})); }

TEST(Decision, MutantsAreCaught) {
  const LogP undoubled = [](const Evidence& evidence, const Regions& regions) {
    const double p = log_p_claimed(evidence, regions);
    return regions.relation == Relation::equal ? p - std::log(2.0) : p;
  };
  const LogP without_allowance = [](const Evidence& evidence, Regions regions) {
    regions.allow = 0;
    return log_p_claimed(evidence, regions);
  };
  const LogP swapped = [](const Evidence& evidence, Regions regions) {
    if (regions.relation == Relation::at_most) regions.relation = Relation::at_least;
    return log_p_claimed(evidence, regions);
  };
  for (const LogP& claimed : {undoubled, without_allowance, swapped}) {
    EXPECT_FALSE(keeps_promises({.claimed = claimed}));
  }
  const LogP excludes_one_side = [](const Evidence& evidence, const Regions& regions) {
    if (!regions.within()) return log_p_forbidden(evidence, regions);
    return evidence.at(*regions.detect).log_p_lower;
  };
  const LogP at_half_its_level = [](const Evidence& evidence, const Regions& regions) {
    return log_p_forbidden(evidence, regions) + std::log(2.0);
  };
  for (const LogP& forbidden : {excludes_one_side, at_half_its_level}) {
    EXPECT_FALSE(keeps_promises({.forbidden = forbidden}));
  }
}

TEST(Decision, NamesTheTailThatSpeaksAgainstTheClaim) {
  EXPECT_EQ(tail({.relation = Relation::at_most}), "upper");
  EXPECT_EQ(tail({.relation = Relation::less}), "upper");
  EXPECT_EQ(tail({.relation = Relation::at_least}), "lower");
  EXPECT_EQ(tail({.relation = Relation::greater}), "lower");
  EXPECT_EQ(tail({.relation = Relation::equal}), "two-sided");
  EXPECT_EQ(tail({.relation = Relation::within}), "two-sided");
}

// The numerical inverse has a closed form here: mean -+ t s / sqrt n.
TEST(Inversion, OfStudentTIsItsInterval) {
  const stats::Moments x = tests::moments_of(tests::golden_x);
  for (const double confidence : {.5, .9, .99, 1 - 1e-8}) {
    const stats::Interval closed = stats::student_t_interval(x, {.value = .5}, confidence);
    const stats::Interval inverted = stats::interval_by_inversion(
        [&](double theta) { return stats::student_t(x, {.value = .5 + theta}); },
        {.estimate = x.mean - .5, .step = x.standard_error()}, confidence);
    EXPECT_NEAR(inverted.low, closed.low, 1e-9) << confidence;
    EXPECT_NEAR(inverted.high, closed.high, 1e-9) << confidence;
    EXPECT_EQ(inverted.confidence, confidence);
  }
}

TEST(Inversion, OfStudentTAgainstAnUncertainReferenceIsItsInterval) {
  const stats::Moments x = tests::moments_of(tests::golden_x);
  const stats::Interval closed = stats::student_t_interval(x, {.5, .3}, .95);
  const stats::Interval inverted = stats::interval_by_inversion(
      [&](double theta) {
        return stats::student_t(x, {.value = .5 + theta, .standard_error = .3});
      },
      {.estimate = x.mean - .5, .step = 1e-3}, .95);
  EXPECT_NEAR(inverted.low, closed.low, 1e-9);
  EXPECT_NEAR(inverted.high, closed.high, 1e-9);
}

TEST(Inversion, OfWhatIsNeverRejectedIsTheWholeLine) {
  const stats::Interval interval =
      stats::interval_by_inversion([](double) { return stats::TestResult{}; }, {}, .9);
  EXPECT_EQ(interval.low, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(interval.high, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace assay::harness
