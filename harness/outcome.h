#pragma once

// What came of a test: numbers of each channel, then a verdict in words.

#include <optional>
#include <string>
#include <vector>

#include "harness/decision.h"
#include "harness/family.h"
#include "harness/method.h"
#include "harness/question.h"
#include "reports/record.h"
#include "stats/test_result.h"

namespace assay::harness {

/// How a test will be made: frozen before its own data are drawn.
struct Plan {
  Method method;
  std::vector<std::uint64_t> primaries;  ///< of each subject
  std::uint64_t secondaries = 0;         ///< of each subject
  std::vector<Regions> regions;          ///< of each channel
  std::vector<reports::Gate> gates = {};
  std::optional<double> power = {};  ///< at `detect`, with the spread that was found
  std::string invalid = "";          ///< why no method is valid, if none is
};

/// One channel's numbers.
struct ChannelOutcome {
  std::string name;
  stats::TestResult at_null;  ///< statistic and distribution at the null value
  Evidence evidence;
  ChannelDecision decision;
  double log_p_adjusted = 0;
  reports::Effect effect = {};
  std::optional<double> detectable = {};  ///< least theta found with probability 1 - beta
  std::optional<double> reference = {};   ///< a number to mark among the observations
};

/// A test from claim to verdict.
struct TestOutcome {
  Question question;
  FamilyPlace place;
  Plan plan;
  std::vector<ChannelOutcome> channels = {};
  reports::Verdict verdict = reports::Verdict::skipped;
  std::string message = "";
};

}  // namespace assay::harness
