#include "harness/language/claim_rules.h"

#include <fmt/format.h>

#include <cmath>

#include "harness/language/laws.h"

namespace assay::harness {

namespace {

using enum QuantityName;

[[noreturn]] void refuse(const Location& where, const std::string& why) {
  throw InputError(where, why);
}

bool of_a_sampler(QuantityName name) { return row_of(name).of_a_sampler; }

bool never_negative(QuantityName name) { return row_of(name).never_negative; }

void check_arguments(const Quantity& q) {
  if (q.name != quantile) {
    if (q.arguments.empty()) return;
    refuse(q.where, fmt::format("`{}` takes an estimator alone; only `quantile` has a number",
                                to_string(q.name)));
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
  if (row_of(q.name).over_all_channels && !q.source.part.empty()) {
    refuse(q.source.where,
           fmt::format("`{}` is over all channels; name the estimator alone, or use "
                       "`variance`",
                       to_string(q.name)));
  }
  if (q.slope && of_a_sampler(q.name)) {
    refuse(q.where, fmt::format("`{}` is about a sampler, which has no slope", to_string(q.name)));
  }
  if (q.slope && q.name == distribution) refuse(q.where, "a distribution has no slope");
}

void check_side(const Claim& claim, const ScaledQuantity& side) {
  const Quantity& q = side.quantity;
  check_quantity(q);
  const Quantity& left = claim.left;
  if (left.slope || q.slope) refuse(q.where, "a slope is compared with a number");
  if (of_a_sampler(left.name)) {
    refuse(q.where, fmt::format("`{}` is compared with a number", to_string(left.name)));
  }
  if (q.name != left.name) {
    refuse(q.where, fmt::format("`{}` on the left cannot be compared with `{}`; both sides must be "
                                "the same quantity",
                                to_string(left.name), to_string(q.name)));
  }
  if (side.factor == 1) return;
  if (q.name == distribution) refuse(q.where, "a distribution cannot be multiplied");
  if (side.factor == 0) refuse(q.where, "a factor of 0 leaves nothing to compare; give the number");
  if (never_negative(q.name) && side.factor < 0) {
    refuse(q.where,
           fmt::format("`{}` is never negative; the factor must be above 0", to_string(q.name)));
  }
}

void check_side(const Claim& claim, const Constant& side) {
  const Quantity& left = claim.left;
  if (left.name == distribution) {
    refuse(left.where, "a distribution is compared with `density`, a law or another distribution");
  }
  if (of_a_sampler(left.name) && side.standard_error > 0) {
    refuse(left.where, fmt::format("`{}` is held against an exact number: `+-` has no method here",
                                   to_string(left.name)));
  }
  if (never_negative(left.name) && !left.slope && side.value < 0) {
    refuse(left.where, fmt::format("`{}` is never negative, but it is compared with {}",
                                   to_string(left.name), side.value));
  }
  if (left.name == variance && !left.slope && side.value == 0) {
    refuse(left.where, "`variance` is tested as a ratio: give a number above 0");
  }
  // The margin of a bias is relative to its reference.
  const bool has_unit = left.name == bias && !left.slope;
  if (claim.relation == Relation::within && claim.margin.relative && side.value == 0 && !has_unit) {
    refuse(left.where, "a margin in per cent of 0 is no margin; give a number");
  }
}

void check_side(const Claim& claim, const Analytic&) {
  const Quantity& left = claim.left;
  if (left.slope || !row_of(left.name).may_be_analytic) {
    refuse(left.where,
           fmt::format("`analytic` is a mean or a variance; there is none of `{}`{}",
                       left.slope ? "slope" : to_string(left.name),
                       left.name == bias && !left.slope ? "; claim `bias(…) == 0`" : ""));
  }
}

void check_side(const Claim& claim, const Law& side) {
  if (claim.left.name != distribution || claim.left.slope) {
    refuse(side.where,
           fmt::format("`{}` is a law, to which only `distribution(…)` can be equal", side.name));
  }
  if (side.name != "density") check_law(side);
}

}  // namespace

void check_claim(const Claim& claim) {
  check_quantity(claim.left);
  if (claim.left.name == distribution && claim.relation != Relation::equal) {
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
