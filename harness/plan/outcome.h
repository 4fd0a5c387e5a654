#pragma once

// The outcome of a test: numbers of each channel, then a verdict in words.

#include <cstdint>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/image/image_evidence.h"
#include "harness/pilot/pilot.h"
#include "harness/question/question.h"
#include "harness/theta/decision.h"
#include "harness/theta/gate.h"
#include "harness/theta/methods.h"
#include "harness/theta/theta.h"
#include "reports/record/record.h"
#include "stats/images/image_covariance.h"
#include "stats/planning/looks.h"
#include "stats/planning/power.h"
#include "stats/tails/test_result.h"

namespace assay::harness {

/// A test's place in its suite's family.
struct FamilyPlace {
  bool inside = true;       ///< False for mutants and expected failures.
  double weight = 0;        ///< Weight of one channel; a family's weights sum to 1.
  ErrorShare share = {};    ///< Share of one channel.
  bool in_seconds = false;  ///< A budget in seconds, the test's or the suite's, bounds it.
};

/// Why a verdict is what it is, and what a reader can do about it.
struct Reason {
  std::string text = {};
  std::optional<reports::Advice> advice = {};

  Reason() = default;
  Reason(std::string words, std::optional<reports::Advice> next = {})  // NOLINT: words are one
      : text(std::move(words)), advice(std::move(next)) {}
  /// Words that end with the advice.
  static Reason advising(const std::string& before, const std::string& mend) {
    return {before + mend, reports::Advice{.words = mend}};
  }
  bool empty() const { return text.empty(); }
};

/// The design of a test, frozen before its own data are drawn.
struct Plan {
  Method method;
  /// The pilots choose the cells that both sides' points are counted in.
  std::shared_ptr<const stats::SampledCells> cells = {};
  /// Factors on the variance of the mean of rows, by subject and channel.
  std::map<std::pair<std::size_t, std::size_t>, double> row_allowances = {};
  std::vector<std::uint64_t> primaries = {};  ///< One a subject.
  /// What pilots show of a drawn channel's values, by subject and channel.
  std::map<std::pair<std::size_t, std::size_t>, stats::Moments> pilots = {};
  stats::LookSchedule looks = {};  ///< Sizes are the most that any subject takes.
  /// Larger sizes that the last look is put off to while no look is sound. More observations must
  /// mend the red gates. It is the only look then.
  std::vector<std::uint64_t> postponed = {};
  std::vector<Regions> regions = {};  ///< One a channel.
  std::vector<Gate> gates = {};       ///< Gates of the pilot.
  std::string caution = "";  ///< Possible slip of the user, shown unless the claim is refuted.
  Reason invalid = {};       ///< Why no method is valid, or empty.
  std::string error = "";    ///< Reason why nothing can be planned, or "".
  /// Reason why the pilot makes an error of a test with sound numbers, or "".
  std::string pilot_error = "";
  std::optional<stats::ImageNoise> image =
      {};  ///< Set where the sizes of looks at images are planned.

  std::uint64_t most_secondaries() const { return looks.sizes.back(); }
};

struct ChannelOutcome {
  std::size_t index = 0;  ///< Index in the question.
  std::string name;
  Regions regions = {};
  stats::TestResult at_null;  ///< Statistic and distribution at the null value.
  Evidence evidence;
  ChannelDecision decision = {};  ///< Decision over the looks taken.
  reports::Effect effect = {};
  std::optional<double> detectable = {};  ///< Least theta found with probability 1 - beta.
  bool finds_nothing = false;             ///< No theta in the range is found so.
  std::optional<double> reference = {};   ///< A number to mark among the observations.
  std::optional<ImageOutcome> image = {};
};

/// Natural logarithms of one channel's p-values at the looks taken, each as of a single look. It is
/// 0 if a red gate voided the look.
struct ChannelHistory {
  std::vector<double> log_p_claimed = {};
  std::vector<double> log_p_forbidden = {};
  std::vector<std::optional<reports::Effect>> effect = {};  ///< Absent where the look is void.
};

/// A test from claim to verdict. All but `history` is as of the last look.
struct TestOutcome {
  Question question;
  FamilyPlace place;
  Plan plan;
  std::size_t look = 0;  ///< Index of the look taken next, or taken last.
  bool decided = false;  ///< No further look will be taken.
  std::vector<ChannelHistory> history = {};
  std::vector<ChannelOutcome> channels = {};  ///< The worst first.
  std::vector<Gate> gates = {};               ///< Gates of the test's own data.
  std::optional<double> power = {};           ///< Power at `detect`, with the observed spread.
  reports::Verdict verdict = reports::Verdict::skipped;
  std::string message = "";
  std::optional<reports::Advice> advice = {};  ///< Belongs to the message.

  /// Size of this look: the most that any subject takes.
  std::uint64_t secondaries() const { return plan.looks.sizes[look]; }
  std::uint64_t secondaries(std::size_t subject) const {
    return question.subjects[subject].secondaries(secondaries());
  }
  /// Levels at which this look rejects in one channel.
  ErrorShare share() const { return share_at(look); }
  ErrorShare share_at(std::size_t k) const {
    return {.alpha = plan.looks.alpha[k], .beta = plan.looks.beta[k]};
  }
};

std::string gate_sentence(const Gate& gate);
/// One such sentence for each red gate; "" if none is red.
std::string red_gates(const std::vector<Gate>& gates);

/// The message of an error from stats as a sentence, without the leading "function: ".
std::string in_words(const std::exception& error);

/// "rows" or "pictures" of a file.
const char* rows_noun(const Question&);

/// The look's size times `factor`: "1200", or "1200 and 750" if the subjects' sizes differ.
std::string sizes_text(const TestOutcome& outcome, double factor);

/// So many times the observations that are drawn, as a setting that `does` something.
Reason more_drawn(const TestOutcome& outcome, double factor, const std::string& does);

/// Advice that would turn red gates green: more rows, or more primaries and secondaries. For heavy
/// tails it is a claim that needs no moments, or tails that end. Empty if the gates say it
/// themselves. It continues a sentence.
Reason what_would_help(const TestOutcome& outcome);

// ---- Sizes of tests: levels at which they are planned, secondaries of each subject, floors

/// The normal quantile beyond which a test at this level rejects.
double critical_value(double alpha, bool two_sided);

// Fewer observations do not show their own shape.
inline constexpr std::uint64_t least_secondaries = 100;
// Size of a test without `detect`.
inline constexpr std::uint64_t usual_secondaries = 1000;

// Replicates of a claim on images without `detect`.
inline constexpr std::uint64_t classical_replicates = 64;

// Primaries below which no mean without a declared range is decided. No test knows of a rare bright
// value that it never drew (Bahadur & Savage 1956).
inline constexpr std::uint64_t floor_of_evidence = std::uint64_t{1} << 14;

/// Looks that a test has at most: one may end after 1/181 of the last. With a budget in seconds,
/// which the first look is not to exceed, one may end after 1/740,000.
std::size_t most_looks(const FamilyPlace& place);

/// True if `detect` or `within` determines the size.
bool has_planned_size(const Question& question);

/// The excess kurtosis up to which F and chi-square serve this test, 0.2 at most. At it they have
/// 1.25 times the nominal level at the test's critical value x. There x is divided by sqrt(1 +
/// excess / 2). The level is an even part of the test's share for each look. A look with a smaller
/// level need not keep it better.
double kurtosis_limit(const Question& question, const FamilyPlace& place);

/// An alarm rejects the claimed region at alpha and misses with beta. A proof rejects the forbidden
/// region at beta. For `within` both sides are rejected, and each misses with beta / 2.
stats::ErrorRates planned_rates(const ErrorShare& share, const Regions& regions);

/// The t test of a channel's mean, or of its two means, for the subjects' own sizes. The true theta
/// is above (1) or below (-1) the reference. Theta is taken for such a mean where it is the
/// logarithm of a ratio.
stats::MeanPlan mean_plan(const Sized& sized, int side);
/// Secondaries, as many of each subject, with which a t test finds the channel's `detect`.
std::uint64_t secondaries_by_t(const Method& method, const stats::ErrorRates& rates,
                               const PlannedChannel& channel);

/// Secondaries that the floor of evidence asks for, at least `least_secondaries`. Rows
/// of a file, pictures and files that a program writes are as many as somebody paid for: they have
/// no floor.
std::uint64_t secondaries_of_floor(const TestOutcome& test);

stats::LookSchedule one_look(std::uint64_t secondaries, const ErrorShare& share);

/// Primaries of a look of this size, all subjects together; of an image, in all its elements.
std::uint64_t primaries_of_look(const TestOutcome& test, std::uint64_t look);

/// A computed count, rounded up; `impossible_secondaries` if it is too large or NaN.
std::uint64_t whole_secondaries(double count);

bool all_piloted(const Question& question, const Pilots& pilots);

/// The distance to find from the claimed region's edge; 0 if there is none.
double distance_of(const Regions& regions);

/// The least theta that a test of that size finds with probability 1 - beta. For `within` it is the
/// least margin that the test proves if theta is 0. Returns nullopt if no formula tells.
std::optional<double> detectable_effect(const Sized& sized);

}  // namespace assay::harness
