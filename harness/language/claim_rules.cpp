#include "harness/language/claim_rules.h"

#include <fmt/format.h>

#include <cmath>

#include "harness/language/laws.h"

namespace assay::harness {

namespace {

[[noreturn]] void refuse(const Location& where, const std::string& why) {
  throw InputError(where, why);
}

void check_arguments(const Quantity& q) {
  if (!q.row->of_a_probability) {
    if (q.arguments.empty()) return;
    refuse(q.where, fmt::format("`{}` takes an estimator alone; only `quantile` has a number",
                                q.row->word));
  }
  if (q.arguments.size() != 1) {
    refuse(q.where, "`quantile` takes an estimator and one probability: `quantile(x, 0.5)`");
  }
  if (!(q.arguments[0] > 0 && q.arguments[0] < 1)) {
    refuse(q.where, fmt::format("the probability of a quantile lies between 0 and 1, but it is {}",
                                q.arguments[0]));
  }
}

void check_quantity(const Quantity& q) {
  check_arguments(q);
  if (q.row->over_all_channels && !q.source.part.empty()) {
    refuse(q.source.where,
           fmt::format("`{}` is over all channels; name the estimator alone, or use "
                       "`variance`",
                       q.row->word));
  }
  if (q.slope && q.row->of_a_sampler) {
    refuse(q.where, fmt::format("`{}` is about a sampler, which has no slope", q.row->word));
  }
  if (q.slope && q.row->of_a_law) refuse(q.where, "a distribution has no slope");
}

void check_side(const Claim& claim, const ScaledQuantity& side) {
  const Quantity& q = side.quantity;
  check_quantity(q);
  const Quantity& left = claim.left;
  if (left.slope || q.slope) refuse(q.where, "a slope is compared with a number");
  if (left.row->of_a_sampler) {
    refuse(q.where, fmt::format("`{}` is compared with a number", left.row->word));
  }
  if (q.row != left.row) {
    refuse(q.where, fmt::format("`{}` on the left cannot be compared with `{}`; both sides must be "
                                "the same quantity",
                                left.row->word, q.row->word));
  }
  if (side.factor == 1) return;
  if (q.row->of_a_law) refuse(q.where, "a distribution cannot be multiplied");
  if (side.factor == 0) refuse(q.where, "a factor of 0 leaves nothing to compare; give the number");
  if (q.row->never_negative && side.factor < 0) {
    refuse(q.where,
           fmt::format("`{}` is never negative; the factor must be above 0", q.row->word));
  }
}

void check_side(const Claim& claim, const Constant& side) {
  const Quantity& left = claim.left;
  if (left.row->of_a_law) {
    refuse(left.where, "a distribution is compared with `density`, a law or another distribution");
  }
  if (left.row->of_a_sampler && side.standard_error > 0) {
    refuse(left.where, fmt::format("`{}` is held against an exact number: `+-` has no method here",
                                   left.row->word));
  }
  if (left.row->never_negative && !left.slope && side.value < 0) {
    refuse(left.where, fmt::format("`{}` is never negative, but it is compared with {}",
                                   left.row->word, side.value));
  }
  if (left.row->tested_as_a_ratio && !left.slope && side.value == 0) {
    refuse(left.where,
           fmt::format("`{}` is tested as a ratio: give a number above 0", left.row->word));
  }
  const bool has_unit = left.row->relative_to_0 && !left.slope;
  if (claim.relation == Relation::within && claim.margin.relative && side.value == 0 && !has_unit) {
    refuse(left.where, "a margin in per cent of 0 is no margin; give a number");
  }
}

void check_side(const Claim& claim, const Analytic&) {
  const Quantity& left = claim.left;
  if (left.slope || !left.row->may_be_analytic) {
    refuse(left.where,
           fmt::format("`analytic` is a mean or a variance; there is none of `{}`{}",
                       left.slope ? "slope" : left.row->word.c_str(),
                       left.row->relative_to_0 && !left.slope ? "; claim `bias(…) == 0`" : ""));
  }
}

void check_side(const Claim& claim, const Law& side) {
  if (!claim.left.row->of_a_law || claim.left.slope) {
    refuse(side.where,
           fmt::format("`{}` is a law, to which only `distribution(…)` can be equal", side.name));
  }
  if (side.name != "density") check_law(side);
}

}  // namespace

void check_claim(const Claim& claim) {
  check_quantity(claim.left);
  if (claim.left.row->of_a_law && claim.relation != Relation::equal) {
    refuse(claim.left.where, fmt::format("laws are equal or not: `distribution(…)` goes with `==`, "
                                         "not with `{}`",
                                         to_string(claim.relation)));
  }
  if (claim.relation == Relation::within && claim.margin.value == 0) {
    refuse(claim.left.where, "a margin of 0 can never be shown; give one above 0");
  }
  std::visit([&](const auto& side) { check_side(claim, side); }, claim.right);
}

}  // namespace assay::harness
