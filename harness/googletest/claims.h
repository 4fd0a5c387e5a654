#pragma once

// Claims about Monte Carlo estimators in GoogleTest. A source is any callable that draws from a
// Stream. Its claim is planned, sampled and tested as by `assay check`.
//
//   const assay::googletest::DeclaredClaims budget{{.claims = 2}};
//
//   TEST(Mine, IsUnbiased) {
//     using namespace assay::googletest;
//     EXPECT_CLAIM("mean(mine) == 0.25", primary("mine", [](assay::Stream& random) {
//                    return std::pow(random.uniform(), 3);
//                  }), detect("1%"));
//   }

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "estimators/stream.h"

namespace assay {
class Setup;
}

namespace assay::googletest {

/// A source under its name in the claim. Several threads call the callable at a time; it must be a
/// function of its stream alone.
struct Source {
  std::string name;
  std::shared_ptr<const Setup> setup;
  bool averages;  ///< True if an observation may be the mean of several draws.
};

/// A source of primaries: each call draws one. Observations are means of as many as the pilot asks
/// for. No value lies outside the range, as in `primary("mine", cube, 0, 1)`. Without a range,
/// values too rare to be drawn may move a mean.
Source primary(const std::string& name, std::function<double(Stream&)> estimate,
               double low = -HUGE_VAL, double high = HUGE_VAL);

/// A source of secondaries: each call draws one, with this number of channels. They are named
/// value, or value1, value2, …
Source secondary(const std::string& name, std::size_t channels,
                 std::function<void(Stream&, std::span<double>)> estimate, double low = -HUGE_VAL,
                 double high = HUGE_VAL);

/// A key of the test, as in a suite: `detect` and `allow` are "0.5%" or "0.002". `secondaries` is
/// the number of observations.
struct Key {
  std::string name;
  std::string text;
};
Key detect(const std::string& text);
Key allow(const std::string& text);
Key secondaries(std::uint64_t count);

using Part = std::variant<Source, Key>;

/// True if the claim passes; else the message says what was found, as a report does. The k-th claim
/// of a test writes the test properties `claim_k`, `verdict_k`, `method_k`, `estimate_k`, `low_k`,
/// `high_k`, `log10_p_k` and `secondaries_k`. A claim that cannot be read, more claims than
/// declared, and a name without a source are failures.
testing::AssertionResult claim_holds(const std::string& claim, const std::vector<Part>& parts);

/// The error rates of the binary and the number of claims that its tests make. Each claim gets
/// alpha / claims. If all claims hold, the binary fails with probability at most alpha, whichever
/// tests run. The seed applies to all streams; the environment's ASSAY_SEED overrides it.
struct ClaimBudget {
  std::uint64_t claims = 0;
  double alpha = 0.01;
  double beta = 0.01;
  std::uint64_t seed = 1;
};

/// Declares the budget: make one object of this class before the tests run. std::logic_error for a
/// second object, and for invalid rates or numbers.
class DeclaredClaims {
 public:
  explicit DeclaredClaims(const ClaimBudget& budget);
};

}  // namespace assay::googletest

/// EXPECT_CLAIM("mean(a) == mean(b)", primary("a", …), primary("b", …), detect("1%"))
#define EXPECT_CLAIM(claim, ...) EXPECT_TRUE(::assay::googletest::claim_holds(claim, {__VA_ARGS__}))
#define ASSERT_CLAIM(claim, ...) ASSERT_TRUE(::assay::googletest::claim_holds(claim, {__VA_ARGS__}))
