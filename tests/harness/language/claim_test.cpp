#include "harness/language/claim.h"

#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

Claim parsed(const std::string& text) { return parse_claim(text, {"suite.yaml", 3, 11}); }

std::string refused(const std::string& text) {
  return refusal([&] { parse_claim(text, {"claim", 1, 1}); });
}

TEST(Claim, ReadsAMeanAgainstTheAnalyticReference) {
  const Claim claim = parsed("mean(area) == analytic");
  EXPECT_EQ(claim.text, "mean(area) == analytic");
  EXPECT_EQ(claim.left.row->word, "mean");
  EXPECT_EQ(claim.left.source, (Source{"area", ""}));
  EXPECT_EQ(claim.relation, Relation::equal);
  EXPECT_TRUE(std::holds_alternative<Analytic>(claim.right));
}

TEST(Claim, ReadsAConstantWithItsStandardError) {
  const Constant constant = std::get<Constant>(parsed("mean(area)==.481+-1e-4").right);
  EXPECT_EQ(constant.value, 0.481);
  EXPECT_EQ(constant.standard_error, 1e-4);
  EXPECT_EQ(std::get<Constant>(parsed("mean(a) == -3").right).value, -3);
  EXPECT_EQ(std::get<Constant>(parsed("mean(a) == +3").right).value, 3);
}

TEST(Claim, ReadsEveryRelation) {
  EXPECT_EQ(parsed("variance(a) <= 0.07").relation, Relation::at_most);
  EXPECT_EQ(parsed("variance(a) >= 0.07").relation, Relation::at_least);
  EXPECT_EQ(parsed("variance(a)<variance(b)").relation, Relation::less);
  EXPECT_EQ(parsed("variance(a) > variance(b)").relation, Relation::greater);
}

TEST(Claim, ReadsMarginsFactorsSlopesArgumentsAndLaws) {
  const Claim relative = parsed("mean(path) within 0.5% of analytic");
  EXPECT_EQ(relative.relation, Relation::within);
  EXPECT_EQ(relative.margin.value, 0.005);
  EXPECT_TRUE(relative.margin.relative);
  EXPECT_FALSE(parsed("mean(path) within 2e-3 of 1").margin.relative);
  const auto side = std::get<ScaledQuantity>(parsed("efficiency(w) > 1.1*efficiency(r)").right);
  EXPECT_EQ(side.factor, 1.1);
  EXPECT_EQ(side.quantity.source.estimator, "r");
  const Claim slope = parsed("slope(bias(wis)) within 0.1 of -1");
  EXPECT_TRUE(slope.left.slope);
  EXPECT_EQ(slope.left.row->word, "bias");
  EXPECT_EQ(parsed("quantile(a, 0.25) <= 3").left.arguments, std::vector<double>{0.25});
  const Law law = std::get<Law>(parsed("distribution(a) == normal(1, 2)").right);
  EXPECT_EQ(law.name, "normal");
  EXPECT_EQ(law.arguments, (std::vector<double>{1, 2}));
  EXPECT_EQ(std::get<Law>(parsed("distribution(ward) == density").right).name, "density");
  // A part begins at the first dot.
  EXPECT_EQ(parsed("distribution(ward.direction.theta) == uniform(0, 1)").left.source,
            (Source{"ward", "direction.theta"}));
  EXPECT_EQ(parsed("mean(luminaire/area-2_x.0) == analytic").left.source,
            (Source{"luminaire/area-2_x", "0"}));
}

TEST(Claim, PutsPlacesOnTheColumnsOfTheFile) {
  const Claim claim = parsed("mean(area) == 2 * mean(hemisphere)");
  EXPECT_EQ(claim.left.where.column, 11);
  EXPECT_EQ(claim.left.source.where.column, 16);
  const auto& right = std::get<ScaledQuantity>(claim.right).quantity;
  EXPECT_EQ(right.where.column, 29);
  EXPECT_EQ(right.source.where.column, 34);
  EXPECT_EQ(right.source.where.line, 3);
}

TEST(Claim, IsRefusedWithThePlaceAndTheReason) {
  std::ifstream file(ASSAY_SOURCE_DIR "/tests/tables/refused_claims.txt");
  const std::string more = "…";
  int count = 0;
  for (std::string claim, message; std::getline(file, claim);) {
    if (claim.empty() || claim.starts_with('#')) continue;
    ASSERT_TRUE(std::getline(file, message) && message.starts_with("  ")) << claim;
    std::string said = refused(claim == R"("")" ? "" : claim);
    message = message.substr(2);
    if (message.ends_with(more)) said.replace(message.size() - more.size(), said.npos, more);
    EXPECT_EQ(said, message) << claim;
    ++count;
  }
  EXPECT_GT(count, 60);
}

TEST(Margin, IsAHundredthRoundedOnce) {
  EXPECT_EQ(parse_margin("0.1%", {}, "x").value, 0.001);
  EXPECT_EQ(parse_margin("0.1e0 %", {}, "x").value, 0.001);
  EXPECT_EQ(parse_margin("7 %", {}, "x").value, 0.07);
  EXPECT_EQ(to_string(parse_margin("7%", {}, "x")), "7%");
  EXPECT_EQ(to_string(Margin{0.002, false}), "0.002");
}

TEST(Source, IsAnEstimatorWithPerhapsAPart) {
  EXPECT_EQ(parse_source("ward.direction.theta", {}), (Source{"ward", "direction.theta"}));
  EXPECT_EQ(to_string(Source{"ward", "direction.theta"}), "ward.direction.theta");
  EXPECT_EQ(refusal([] {
              parse_source("a b", {"claim", 1, 1});
            }),
            "1:3: the source ends before `b`");
}

TEST(EstimatorName, IsWhatAClaimCanName) {
  for (const char* good : {"a", "_x", "luminaire/area", "MIS-2_b"}) {
    EXPECT_TRUE(is_estimator_name(good)) << good;
  }
  for (const char* bad : {"", "2a", "a.b", "a b", "-a", "a+", "ä", "a\n b"}) {
    EXPECT_FALSE(is_estimator_name(bad)) << bad;
  }
}

}  // namespace
}  // namespace assay::harness
