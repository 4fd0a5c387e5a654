#pragma once

// A claim about the estimators of a suite: which observations it is about and what they are held
// against, channel by channel.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/prepare.h"
#include "harness/suite.h"

namespace assay::harness {

/// The observations of one side of a claim: an estimator's secondary estimates, or a sampler's
/// draws.
struct Subject {
  const PreparedEstimator* estimator;
  std::shared_ptr<const Setup> setup;  ///< what is sampled
  std::string purpose = "";            ///< tells the streams of a sampler from its estimator's
  std::uint32_t copy = 0;
  std::vector<std::size_t> channels;  ///< of the set-up, those the claim is about
  bool averages = true;               ///< variance falls like 1 / primaries
};

enum class QuestionKind {
  mean_of_one,  ///< mean against a number
  mean_of_two,
  variance_of_one,  ///< of one primary where the estimator averages
  variance_of_two,
  fit_to_density,  ///< a sampler's draws against its declared density, in cells
  fit_to_law,      ///< values against a law's distribution function
  same_law         ///< values of two against each other
};

/// What a claim asks of the suite's estimators.
struct Question {
  const TestEntry* test;
  QuestionKind kind;
  std::vector<Subject> subjects;          ///< one or two
  double factor = 1;                      ///< first against factor * second
  std::vector<Constant> references = {};  ///< a number per channel, for the kinds "of one"
  Law law = {};                           ///< for fit_to_law

  std::size_t channel_count() const { return subjects[0].channels.size(); }
  std::string channel_name(std::size_t channel) const;
  bool of_two() const { return subjects.size() == 2; }
  bool of_means() const {
    return kind == QuestionKind::mean_of_one || kind == QuestionKind::mean_of_two;
  }
  bool of_variances() const {
    return kind == QuestionKind::variance_of_one || kind == QuestionKind::variance_of_two;
  }
};

/// InputError at the claim's place: a part that does not exist, an analytic reference that the
/// plugin does not know, channels that do not pair, a quantity there is no method for, a margin in
/// per cent where there is nothing to take it of.
/// Two sources that would share a stream under this seed are told apart.
Question ask(const TestEntry& test, const std::map<std::string, PreparedEstimator>& estimators,
             std::uint64_t seed);

}  // namespace assay::harness
