#pragma once

// Theta is the number that a claim is about. It has a claimed and a forbidden region. Each family
// of claims derives from Theta, in a file of families/.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/theta/decision.h"
#include "harness/theta/gate.h"
#include "harness/theta/methods.h"
#include "stats/means/betting_mean.h"
#include "stats/planning/power.h"

namespace assay::harness {

class Pilots;
struct ChannelEvidence;
struct ChannelOutcome;
struct DrawnTest;
struct TestOutcome;

/// A channel's law as planning takes it: a secondary's standard deviations, and the unit of
/// margins. A ratio has the deviations of relative influence values.
struct PlannedChannel {
  Regions regions = {};
  std::array<double, 2> deviations = {};  ///< Each subject's, times its factor.
  std::array<double, 2> skewness = {};    ///< Each subject's, signed as in theta.
  double unit = 1;                        ///< Theta times this is in the estimator's unit.
  double reference_error = 0;
  bool unseen = false;      ///< The deviation is what a constant pilot may have missed.
  stats::Range range = {};  ///< Declared range of one mean's values.
  double null_value = 0;    ///< The value of one mean where theta is 0.
  std::shared_ptr<const stats::ValueCells> law = {};  ///< Values of a secondary, for bets.

  bool varies() const { return deviations[0] > 0 || deviations[1] > 0; }
};

/// A look of a test, with a channel's law.
struct Sized {
  const TestOutcome& test;
  std::size_t look;
  const PlannedChannel& channel;

  std::uint64_t secondaries() const;
  /// The errors that the size is planned for, and the sizes of the two subjects; one is both.
  stats::ErrorRates rates() const;
  stats::SampleSizes sizes() const;
};

/// More secondaries than any test is given: a larger plan is impossible.
inline constexpr std::uint64_t impossible_secondaries = std::uint64_t{1} << 53;

/// Standard errors of theta's estimate where theta = 0. The error `drawn` is new in every run. The
/// error `fixed` is the same in all: a reference's own error, recorded data.
struct ThetaError {
  double drawn = 0;
  double fixed = 0;
  /// Theta's estimate, if values without spread have one.
  std::optional<double> estimate = {};
  /// Observations of equal size that would give the error `drawn`: n over the kurtosis of their
  /// influence on the estimate. Unset if the family does not tell.
  std::optional<double> effective = {};
};

/// The verdict on a channel that needs no test.
struct ConstantVerdict {
  reports::Verdict verdict;
  std::string message;
};

/// An object has no data of a claim: every function takes the question. `""` and nullopt stand for
/// "nothing to say".
class Theta {
 public:
  Theta(const ThetaTraits& traits, std::vector<Method> rows)
      : is(traits), methods(std::move(rows)) {}
  virtual ~Theta() = default;
  Theta(const Theta&) = delete;
  Theta& operator=(const Theta&) = delete;

  const ThetaTraits is;
  const std::vector<Method> methods;  ///< The family's; the default is first.

  // ---- The claim

  /// Binds a claim to the suite's estimators: here of one source against an exact number, or of two
  /// against each other. InputError at the claim's place if it cannot.
  virtual Question bind(const TestEntry&, const Estimators&) const;
  virtual std::string channel_name(const Question&, std::size_t channel) const;
  /// The right side of the null hypothesis in words.
  virtual std::string claimed_value(const Question&, std::size_t channel) const;
  /// Parts of the null hypothesis that the claim leaves unsaid.
  virtual std::string circumstances(const Question&) const { return ""; }
  /// The family for images; null if there is no method for them.
  virtual const Theta* of_images() const { return nullptr; }
  /// The family for differences of observations that share their random numbers; null if there is
  /// no method for them.
  virtual const Theta* of_pairs(const Question&) const { return nullptr; }
  /// Throws InputError for a claim without a method.
  virtual void check(const Question&) const {}
  /// Throws InputError if the margin has no meaning here.
  virtual void check_margin(const Question&, const Margin&) const;
  /// The largest size that margins may be relative to, as the claim or the second side's pilot
  /// shows it; 0 if nothing tells.
  virtual double known_size(const Question&, const Pilots*) const;

  /// True if theta is in units of the reference.
  virtual bool is_relative(const Question&, std::size_t) const { return false; }

  // ---- The plan

  /// Throws NoDensity before any draw if a density that the claim needs cannot be had.
  virtual void require_density(const Question&) const {}
  /// True if an observation of the claim is a single primary.
  virtual bool takes_single_primaries(const Question&, const Pilots&) const {
    return is.of_single_values;
  }
  /// Chooses among the methods by the pilots, and notes their gates. Returns the fewest secondaries
  /// that the method takes.
  virtual std::uint64_t choose(TestOutcome&, const Pilots&) const;
  /// Secondaries of each subject that find `detect`, or prove `within`, with this share of errors
  /// in every channel. `impossible_secondaries` if no number does. By default the most that a
  /// channel needs, if all subjects have pilots.
  virtual std::optional<std::uint64_t> secondaries(const TestOutcome&, const ErrorShare&,
                                                   const Pilots&) const;
  /// The number that finds one channel's `detect`; nullopt if nothing tells.
  virtual std::optional<std::uint64_t> secondaries_of(const TestOutcome&, std::size_t /*channel*/,
                                                      const stats::ErrorRates&,
                                                      const Pilots&) const {
    return std::nullopt;
  }
  virtual std::string why_impossible(const Question&) const;
  virtual std::string too_few(const TestOutcome&) const { return ""; }

  // ---- Power. `channel` is from pilots or from the test's own data.

  /// The channel as pilots show it; nullopt if they say nothing of it.
  virtual std::optional<PlannedChannel> planned(const TestOutcome&, std::size_t channel,
                                                const Pilots&) const;
  virtual PlannedChannel observed(const Seen&, const Regions& regions) const {
    return {.regions = regions};
  }
  /// The least theta that a test of that size finds with probability 1 - beta. For `within` it is
  /// the least margin that the test proves if theta is 0. By default that of the t test of a
  /// channel that varies (plan/outcome.h), on the side where more is needed.
  virtual std::optional<double> detectable(const Sized&) const;
  /// True if no theta in the declared range is found with probability 1 - beta.
  virtual bool finds_nothing(const Sized&) const { return false; }
  /// Probability of failing the claim if theta is `effect`. For `<` and `>` it is that of passing
  /// with this advantage, for `within` that of passing at theta = 0. By default it is that of
  /// the same t test, and for `within` the bound 2 P(one margin is excluded) - 1.
  virtual std::optional<double> power(const Sized&, double effect) const;

  // ---- The test's own data

  virtual std::optional<ThetaError> error(const Seen&) const { return std::nullopt; }
  /// The verdict that needs no test: on a channel without spread, by what no law allows, or on
  /// numbers that cannot be tested.
  virtual std::optional<ConstantVerdict> settled(const TestOutcome&, const Seen&) const;
  /// Gates on one channel's data, beyond which tests at this critical value reject.
  virtual std::vector<Gate> gates(const TestOutcome&, const Seen&, double) const { return {}; }
  virtual ChannelEvidence evidence(const DrawnTest&, const Seen&) const;
  /// A number to mark among the observations.
  virtual std::optional<double> marked(const Seen&) const { return std::nullopt; }

  // ---- Words

  /// The thing that the interval does not exclude although it speaks against the claim: "exponent".
  virtual std::string not_excluded(const ChannelOutcome&) const { return ""; }
  /// The step that lets the interval exclude it.
  virtual const char* how_to_exclude() const {
    return "take more of them, or say with `detect` how large an error must not pass";
  }
  /// A clause that fails need, and passes whose interval excludes the claim: another reason for
  /// what the data say, or the draw that shows it.
  virtual std::string caveat(const DrawnTest&) const { return ""; }
};

}  // namespace assay::harness
