#pragma once

// Matchers over a callable double(Stream&), the estimator `it`:
//   EXPECT_THAT(mine, HasMean("0.481 +- 0.0001"));
//   EXPECT_THAT(mine, SatisfiesClaim("variance(it) <= 0.07"));

#include <gmock/gmock.h>

#include <string>

#include "harness/googletest/claims.h"

namespace assay::googletest {

MATCHER_P(SatisfiesClaim, claim, "satisfies " + std::string(claim)) {
  const testing::AssertionResult result = claim_holds(std::string(claim), {primary("it", arg)});
  *result_listener << result.message();
  return static_cast<bool>(result);
}

/// A number, or a number with its standard error: "0.481 +- 0.0001".
inline auto HasMean(const std::string& value) { return SatisfiesClaim("mean(it) == " + value); }
inline auto HasVarianceAtMost(const std::string& value) {
  return SatisfiesClaim("variance(it) <= " + value);
}

}  // namespace assay::googletest
