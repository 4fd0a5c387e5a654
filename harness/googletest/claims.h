#pragma once

// Claims about Monte Carlo estimators in GoogleTest: any callable that draws from a Stream is a
// source, its claim is planned, sampled and tested as `assay check` would.
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

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "estimators/stream.h"

namespace assay::googletest {

/// What a claim is about, under the name that it has in the claim. The callable is called from
/// several threads at a time and is a function of its stream alone.
struct Source {
  std::string name;
  /// Writes one observation, of one number per channel.
  std::function<void(Stream&, std::span<double>)> draw;
  std::size_t channels = 1;  ///< named value, or value1, value2, …
  bool averages = false;     ///< an observation may be the mean of several draws
};

/// One primary estimate a call: observations are means of as many as the pilot asks for.
Source primary(const std::string& name, std::function<double(Stream&)> estimate);

/// One secondary estimate a call, of so many channels.
Source secondary(const std::string& name, std::size_t channels,
                 std::function<void(Stream&, std::span<double>)> estimate);

/// `detect` and `allow` of the test, as in a suite: "0.5%" or "0.002".
struct Margin {
  bool detects;
  std::string text;
};
Margin detect(const std::string& text);
Margin allow(const std::string& text);

using Part = std::variant<Source, Margin>;

/// Whether the claim passes. Else the message says what was found, as a report does. Numbers go to
/// the test's properties: of the k-th claim of a test `claim_k`, `verdict_k`, `method_k`,
/// `estimate_k`, `low_k`, `high_k`, `log10_p_k`, `secondaries_k`. A claim that cannot be read, more
/// claims than were declared, and a name without a source are failures.
testing::AssertionResult claim_holds(const std::string& claim, const std::vector<Part>& parts);

/// The error rates of the binary and how many claims its tests make: each gets alpha / claims, so
/// that a binary whose claims all hold fails with probability alpha at most, whichever tests run.
/// The seed is of all streams; the environment's ASSAY_SEED comes before it.
struct ClaimBudget {
  std::uint64_t claims = 0;
  double alpha = 0.01;
  double beta = 0.01;
  std::uint64_t seed = 1;
};

/// Declares them: one object of this class in the binary, before its tests run. std::logic_error
/// for a second one and for rates or numbers that are none.
class DeclaredClaims {
 public:
  explicit DeclaredClaims(const ClaimBudget& budget);
};

}  // namespace assay::googletest

/// EXPECT_CLAIM("mean(a) == mean(b)", primary("a", …), primary("b", …), detect("1%"))
#define EXPECT_CLAIM(claim, ...) EXPECT_TRUE(::assay::googletest::claim_holds(claim, {__VA_ARGS__}))
#define ASSERT_CLAIM(claim, ...) ASSERT_TRUE(::assay::googletest::claim_holds(claim, {__VA_ARGS__}))
