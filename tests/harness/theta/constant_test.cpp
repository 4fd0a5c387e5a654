#include "harness/theta/decision.h"
#include "harness/theta/methods.h"
#include "harness/theta/theta.h"
#include "tests/harness/prelude.h"
#include "tests/harness/questions.h"

namespace assay::harness {
namespace {

std::unique_ptr<Asked> asked_of_constants(const std::string& test) {
  return ask_text(R"(suite: constants
estimators:
  zero: {plugin: analytic/zero_variance}                # its range is the constant, to rounding
  normal: {plugin: analytic/normal, mean: 2, deviation: 0}   # no range is declared
  nil: {plugin: analytic/normal, deviation: 0}
  none: {plugin: analytic/normal, deviation: 0}
  spike: {plugin: analytic/rare_spike, height: 10}      # values in [0.5, 10.5]
  dimmer: {plugin: analytic/rare_spike, height: 10}
tests:
  - {claim: )" + test +
                  "}\n");
}

Regions regions_of(const TestEntry& test) {
  Regions regions{.relation = test.claim.relation};
  if (regions.within()) regions.detect = test.claim.margin.value;
  if (test.allow) regions.allow = test.allow->value;
  if (test.detect) regions.detect = test.detect->value;
  return regions;
}

/// A test whose subjects were seen `count` times, always at `seen`.
struct ConstantCase {
  const char* test;
  std::uint64_t count;
  std::vector<double> seen;
  Verdict verdict;
  const char* why = "";
};

ConstantVerdict judge(const ConstantCase& of) {
  const auto asked = asked_of_constants(of.test);
  const Question& question = asked->questions[0];
  std::vector<ChannelData> data(of.seen.size());
  for (std::size_t i = 0; i < of.seen.size(); ++i) {
    for (std::uint64_t k = 0; k < of.count; ++k) data[i].moments.add(of.seen[i]);
  }
  TestOutcome outcome{.question = question};
  outcome.plan.regions = {regions_of(*question.test)};
  return question.theta->settled(outcome, {question, 0, data}).value();
}

/// The same by bets on the declared range, at alpha = beta = .01.
Verdict bet_on(const ConstantCase& of) {
  const auto asked = asked_of_constants(of.test);
  const Question& question = asked->questions[0];
  std::vector<std::vector<double>> values;
  for (const double value : of.seen) values.emplace_back(of.count, value);
  std::vector<ChannelData> data(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    data[i].values = values[i];
    for (const double value : values[i]) data[i].moments.add(value);
  }
  const Regions regions = regions_of(*question.test);
  const Evidence evidence = find_method(question, "betting").evidence({question, 0, data});
  return decide({{.log_p_claimed = log_p_claimed(evidence, regions),
                  .log_p_forbidden = log_p_forbidden(evidence, regions),
                  .rejected = log_p_claimed(evidence, regions) <= std::log(.01)}},
                regions, .01);
}

const double integral = std::expm1(3) / 3;

TEST(Constant, IsSpreadWithinTheDeclaredRounding) {
  const auto rounded = asked_of_constants("mean(zero) < 7");
  stats::Moments moments;
  moments.add(integral);
  moments.add(integral * (1 + 0x1p-45));
  EXPECT_TRUE(is_constant(rounded->questions[0].subjects[0], 0, moments));
  EXPECT_FALSE(
      is_constant(asked_of_constants("mean(normal) == 3")->questions[0].subjects[0], 0, moments))
      << "declares no rounding";
  moments.add(integral * (1 + 0x1p-30));
  EXPECT_FALSE(is_constant(rounded->questions[0].subjects[0], 0, moments));
}

TEST(Constant, WithoutARangeNothingBoundsWhatWasNotSeen) {
  for (const ConstantCase& each : std::vector<ConstantCase>{
           {"mean(spike) == 0.5", 10, {0.5}, Verdict::pass, "classical"},
           {"mean(normal) == 2, detect: 1%", 100000, {2}, Verdict::inconclusive},
           {"mean(normal) == 3", 100000, {2}, Verdict::invalid},
           {"mean(spike) == 0.4 +- 0.5",
            100000,
            {0.5},
            Verdict::invalid,
            "0.1 off a reference known to 0.5 refutes nothing"},
           {"mean(nil) == mean(none)", 1000, {0, 0}, Verdict::pass, "0 relative to 0 is none"},
           {"mean(nil) == mean(none), detect: 1%", 1000, {0, 0}, Verdict::inconclusive},
           {"mean(spike) == mean(normal), detect: 1%", 1000, {0.5, 2}, Verdict::invalid},
           {"mean(spike) == 0.25 * mean(normal), detect: 0.4",
            1000,
            {0.5, 2},
            Verdict::inconclusive}}) {
    const ConstantVerdict judged = judge(each);
    EXPECT_EQ(judged.verdict, each.verdict) << each.test << " " << each.why;
    EXPECT_EQ(judged.message.find("declare the range") == std::string::npos,
              judged.verdict == Verdict::pass)
        << judged.message;
  }
}

// Each value takes (0.6 - 0.5) / (10.5 - 0.6) of the stake from "the mean is at least 0.6". To 100
// times the 23 bets of the mixture it takes ln(2300) / ln(1.0101) = 770 values. (10.49 / 10.5)^n <=
// 0.005 from n = 5561 on, and a mixture of 23 takes ln(4600) / ln(10 / 9.99).
TEST(Constant, IsJudgedByBetsOnItsRange) {
  for (const ConstantCase& each : std::vector<ConstantCase>{
           {"mean(spike) == 0.5, detect: 0.1", 775, {0.5}, Verdict::pass},
           {"mean(spike) == 0.5, detect: 0.1",
            458,
            {0.5},
            Verdict::inconclusive,
            "(1 - 0.01)^458 is above 0.01: no test excludes it"},
           {"mean(spike) == 0.51", 5200, {0.5}, Verdict::pass, "nothing is forbidden"},
           {"mean(spike) == 0.51", 8500, {0.5}, Verdict::fail},
           {"mean(spike) == 0.4", 2, {0.5}, Verdict::fail, "nothing lies on that side"},
           {"mean(spike) <= 0.7", 10, {0.5}, Verdict::pass},
           {"mean(spike) <= 0.7, detect: 10%", 10, {0.5}, Verdict::inconclusive},
           {"mean(spike) <= 0.7, detect: 10%", 1000, {0.5}, Verdict::pass},
           {"mean(spike) >= 0.7", 10, {0.5}, Verdict::pass, "nothing is forbidden"},
           {"mean(spike) >= 0.7", 1000, {0.5}, Verdict::fail},
           {"mean(zero) < 7", 2, {integral}, Verdict::pass},
           {"mean(spike) > 0.49", 2, {0.5}, Verdict::pass},
           {"mean(spike) < 0.5",
            10,
            {0.5},
            Verdict::inconclusive,
            "0.5 is the least value there is, so the mean cannot be shown to be below it"},
           {"mean(zero) within 1% of 6.36", 2, {integral}, Verdict::pass},
           {"mean(zero) within 1% of 7", 2, {integral}, Verdict::fail},
           {"mean(spike) == 0.499, allow: 1%, detect: 20%", 1000, {0.5}, Verdict::pass},
           {"mean(spike) == mean(dimmer), detect: 0.4", 1000, {0.5, 9}, Verdict::fail},
           {"mean(spike) == mean(dimmer), detect: 0.4", 2000, {0.5, 0.5}, Verdict::pass},
           {"mean(spike) == mean(dimmer), detect: 0.4", 10, {0.5, 0.5}, Verdict::inconclusive}}) {
    EXPECT_EQ(bet_on(each), each.verdict) << each.test << " " << each.count << " " << each.why;
  }
}

}  // namespace
}  // namespace assay::harness
