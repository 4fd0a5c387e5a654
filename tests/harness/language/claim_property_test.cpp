// Claims are made from a description, written and read again. Every text makes a claim or an
// InputError.

#include <rapidcheck/gtest.h>

#include "estimators/stream.h"
#include "harness/language/claim.h"
#include "harness/language/laws.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

using namespace rc;

Gen<std::string> word() {
  return gen::map(
      gen::pair(gen::elementOf(std::string("abcXYZ_")),
                gen::container<std::string>(gen::elementOf(std::string("abcXYZ_-/0123456789")))),
      [](const auto& p) { return std::string(1, p.first) + p.second; });
}

Gen<double> finite() {
  return gen::map(gen::arbitrary<double>(), [](double x) { return x == 0 ? 0.5 : x; });
}
Gen<double> positive() {
  return gen::map(finite(), [](double x) { return std::abs(x); });
}

Gen<Source> source() {
  return gen::map(gen::tuple(word(), gen::inRange(0, 3), word(), word()), [](const auto& t) {
    const auto& [estimator, dots, first, second] = t;
    return Source{estimator, dots == 0 ? "" : dots == 1 ? first : first + "." + second};
  });
}

Quantity quantity(const QuantityRow& row, Source of, double u) {
  Quantity q{.row = &row, .source = std::move(of)};
  if (row.over_all_channels) q.source.part = "";
  if (row.of_a_probability) q.arguments = {u};
  return q;
}

Law some_law() {
  const LawInformation& law = *gen::elementOf(laws());
  Law made{.name = law.name};
  double last = -1;
  // Ascending and positive: right for every law, `low` and `high` included.
  for (std::size_t i = 0; i < law.parameters.size(); ++i) {
    last = std::abs(last) + 1 + *gen::inRange(0, 1000) / 7.0;
    made.arguments.push_back(last);
  }
  return made;
}

/// A valid claim of any kind.
Claim some_claim() {
  const std::size_t index = *gen::inRange<std::size_t>(0, quantities().size());
  const QuantityRow& row = quantities()[index];
  const double u = *gen::inRange(1, 999) / 1000.0;
  Claim claim{.left = quantity(row, *source(), u)};
  if (row.of_a_law) {
    const int kind = *gen::inRange(0, 3);
    if (kind == 0) claim.right = ScaledQuantity{1, quantity(row, *source(), u)};
    if (kind == 1) claim.right = Law{.name = "density"};
    if (kind == 2) claim.right = some_law();
    return claim;
  }
  claim.relation = static_cast<Relation>(*gen::inRange(0, 6));
  if (claim.relation == Relation::within) {
    claim.margin = {*positive(), *gen::arbitrary<bool>()};
    // A per cent of the least doubles is no double.
    if (claim.margin.relative && claim.margin.value < 1e-300) claim.margin.value = 1e-300;
  }
  if (row.of_a_sampler) {
    claim.right = Constant{*positive(), 0};
    return claim;
  }
  claim.left.slope = row.slope != nullptr && *gen::arbitrary<bool>();
  const int kind = *gen::inRange(0, 3);
  if (kind == 0 && !claim.left.slope) {
    claim.right = ScaledQuantity{*positive(), quantity(row, *source(), u)};
  } else if (kind == 1 && row.analytic != nullptr && !claim.left.slope) {
    claim.right = Analytic{};
  } else {
    const bool has_error = row.takes_standard_error && !claim.left.slope;
    claim.right = Constant{*positive(), has_error && *gen::arbitrary<bool>() ? *positive() : 0};
  }
  return claim;
}

void expect_same(const Quantity& a, const Quantity& b) {
  RC_ASSERT(a.row == b.row && a.source == b.source && a.arguments == b.arguments &&
            a.slope == b.slope);
}
void expect_same_side(const ScaledQuantity& a, const ScaledQuantity& b) {
  RC_ASSERT(a.factor == b.factor);
  expect_same(a.quantity, b.quantity);
}
void expect_same_side(const Constant& a, const Constant& b) {
  RC_ASSERT(a.value == b.value && a.standard_error == b.standard_error);
}
void expect_same_side(const Analytic&, const Analytic&) {}
void expect_same_side(const Law& a, const Law& b) {
  RC_ASSERT(a.name == b.name && a.arguments == b.arguments);
}

RC_GTEST_PROP(ClaimProperty, TextOfAClaimReadsBackAsTheSameClaim, ()) {
  const Claim claim = some_claim();
  const std::string text = to_string(claim);
  RC_LOG() << text;
  const Claim again = parse_claim(text, {});
  expect_same(claim.left, again.left);
  RC_ASSERT(claim.relation == again.relation);
  RC_ASSERT(claim.margin.value == again.margin.value);
  RC_ASSERT(claim.margin.relative == again.margin.relative);
  RC_ASSERT(claim.right.index() == again.right.index());
  std::visit(
      [&](const auto& side) {
        expect_same_side(side, std::get<std::decay_t<decltype(side)>>(again.right));
      },
      claim.right);
  RC_ASSERT(to_string(again) == text);
}

/// A claim or an InputError whose column is in the text or just behind it; anything else fails.
bool is_read_or_refused(const std::string& text) {
  try {
    parse_claim(text, {"claim", 1, 1});
    return true;
  } catch (const InputError& e) {
    const int column = e.where().column;
    return column >= 1 && column <= static_cast<int>(text.size()) + 1;
  }
}

TEST(ClaimFuzz, AnyBytesAreAClaimOrAnInputError) {
  for (std::uint64_t i = 0; i < 20000; ++i) {
    Stream random({1}, i);
    std::string text(random() % 40, '\0');
    for (char& c : text) c = static_cast<char>(random());
    ASSERT_TRUE(is_read_or_refused(text)) << i;
  }
}

TEST(ClaimFuzz, AnyTokensAreAClaimOrAnInputError) {
  const std::vector<std::string> tokens{"mean",     "variance", "distribution",
                                        "quantile", "slope",    "bias",
                                        "(",        ")",        ",",
                                        ".",        "==",       "<=",
                                        ">",        "within",   "of",
                                        "%",        "+-",       "*",
                                        "1",        "-0.5",     "1e309",
                                        "0e999999", "analytic", "density",
                                        "normal",   "uniform",  "area",
                                        "a.b.c",    " ",        "\n",
                                        "\xff",     "=",        "!"};
  int claims = 0;
  for (std::uint64_t i = 0; i < 100000; ++i) {
    Stream random({2}, i);
    std::string text = random() % 2 ? "mean(area) " : "";
    for (std::uint64_t n = random() % 12; n > 0; --n)
      text += tokens[random() % tokens.size()] + " ";
    ASSERT_TRUE(is_read_or_refused(text)) << text;
    try {
      claims += !parse_claim(text, {}).text.empty();
    } catch (const InputError&) {
    }
  }
  EXPECT_GT(claims, 0) << "no text got through: the test no longer reaches the rules";
}

}  // namespace
}  // namespace assay::harness
