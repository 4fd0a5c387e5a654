#pragma once

// Matchers over a callable double(Stream&), the estimator `it`:
//   EXPECT_THAT(mine, HasMean("0.481 +- 0.0001"));
//   EXPECT_THAT(mine, SatisfiesClaim("variance(it) <= 0.07"));

#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <utility>

#include "harness/googletest/claims.h"

namespace assay::googletest {

/// A claim with the last callable and its verdict.
struct AskedClaim {
  std::string text;
  std::shared_ptr<std::pair<const void*, testing::AssertionResult>> last;
};

/// GoogleTest asks first for the verdict, then for its reason: only the first is a claim.
MATCHER_P(SatisfiesAsked, claim, "satisfies " + claim.text) {
  const auto* const asked = reinterpret_cast<const void*>(&arg);
  const bool explains = result_listener->IsInterested();
  if (!explains || claim.last->first != asked) {
    *claim.last = {asked, claim_holds(claim.text, {primary("it", arg)})};
  }
  if (explains || claim.last->second) claim.last->first = nullptr;
  *result_listener << claim.last->second.message();
  return static_cast<bool>(claim.last->second);
}

inline auto SatisfiesClaim(const std::string& claim) {
  return SatisfiesAsked(
      AskedClaim{claim, std::make_shared<std::pair<const void*, testing::AssertionResult>>(
                            nullptr, testing::AssertionFailure())});
}

/// A number, or a number with its standard error: "0.481 +- 0.0001".
inline auto HasMean(const std::string& value) { return SatisfiesClaim("mean(it) == " + value); }

}  // namespace assay::googletest
