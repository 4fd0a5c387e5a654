#pragma once

// What came of a test: numbers of each channel, then a verdict in words.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/image/image_evidence.h"
#include "harness/question/question.h"
#include "harness/theta/decision.h"
#include "harness/theta/family.h"
#include "harness/theta/method.h"
#include "reports/record/record.h"
#include "stats/planning/looks.h"
#include "stats/tails/test_result.h"

namespace assay::harness {

/// How a test will be made: frozen before its own data are drawn.
struct Plan {
  Method method;
  std::vector<std::uint64_t> primaries = {};  ///< of each subject
  stats::LookSchedule looks = {};             ///< sizes are the most that any subject takes
  std::vector<Regions> regions = {};          ///< of each channel
  std::vector<reports::Gate> gates = {};      ///< of the pilot
  std::uint32_t smallest_cell = 1;            ///< of an image: smaller ones do not keep their level
  /// Of an image: too little skewness that its elements' differences have in common for their
  /// squares to add up to a finding. The sum of squares takes part then.
  bool symmetric = true;
  std::string hint = "";     ///< what the pilot saw of images that explains a fail, if anything
  std::string caution = "";  ///< what the user may not have meant, of a claim that is not refuted
  /// Whether red gates on the test's own data make a look count for nothing. A forced method runs
  /// as asked: its gates are shown only.
  bool gates_invalidate = true;
  std::string invalid = "";  ///< why no method is valid, if none is
  std::string error = "";    ///< why nothing can be planned, if nothing can
  /// Why the pilot makes an error of a test whose own numbers are sound, if it does.
  std::string pilot_error = "";
  /// Of pictures that were looked at when they were read.
  std::shared_ptr<const PictureLook> look = {};

  std::uint64_t most_secondaries() const { return looks.sizes.back(); }
};

/// One channel's numbers.
struct ChannelOutcome {
  std::size_t index = 0;  ///< in the question
  std::string name;
  Regions regions = {};
  stats::TestResult at_null;  ///< statistic and distribution at the null value
  Evidence evidence;
  ChannelDecision decision = {};  ///< over the looks taken
  double log_p_adjusted = 0;
  reports::Effect effect = {};
  std::optional<double> detectable = {};  ///< least theta found with probability 1 - beta
  bool finds_nothing = false;             ///< no theta that the range allows is found so
  std::optional<double> reference = {};   ///< a number to mark among the observations
  std::optional<ImageOutcome> image = {};
};

/// Natural logarithms of the p-values of one channel at the looks taken, each as of a single look;
/// 0 where a gate was red and the look counts for nothing.
struct ChannelHistory {
  std::vector<double> log_p_claimed = {};
  std::vector<double> log_p_forbidden = {};
};

/// A test from claim to verdict. Everything but `history` is as of the last look.
struct TestOutcome {
  Question question;
  FamilyPlace place;
  Plan plan;
  std::size_t look = 0;  ///< which of the plan's looks is taken next, or was taken last
  bool decided = false;  ///< no further look will be taken
  std::vector<ChannelHistory> history = {};
  std::vector<ChannelOutcome> channels = {};  ///< the worst first
  std::vector<reports::Gate> gates = {};      ///< of the test's own data
  std::optional<double> power = {};           ///< at `detect`, with the spread that was found
  reports::Verdict verdict = reports::Verdict::skipped;
  std::string message = "";

  /// The size of this look, the most that any subject takes.
  std::uint64_t secondaries() const { return plan.looks.sizes[look]; }
  std::uint64_t secondaries(std::size_t subject) const {
    return question.subjects[subject].secondaries(secondaries());
  }
  double weight() const { return plan.looks.weights[look]; }
  /// What one channel may spend at this look.
  ErrorShare share() const {
    return {.alpha = place.share.alpha * weight(), .beta = place.share.beta * weight()};
  }
};

}  // namespace assay::harness
