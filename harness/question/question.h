#pragma once

// A claim about the estimators of a suite: which observations it is about and what they are held
// against, channel by channel.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/sampling/prepare.h"
#include "harness/suite/suite.h"

namespace assay::harness {

/// The observations of one side of a claim: an estimator's secondary estimates, or a sampler's
/// draws.
struct Subject {
  const PreparedEstimator* estimator;
  std::shared_ptr<const Setup> setup;  ///< what is sampled
  std::string purpose = "";            ///< tells the streams of a sampler from its estimator's
  std::uint32_t copy = 0;
  std::vector<std::size_t> channels;     ///< of the set-up, those the claim is about
  bool averages = true;                  ///< variance falls like 1 / primaries
  std::optional<ImageShape> image = {};  ///< what these channels are together
  /// Where `estimator` is this question's own: a point of a sweep.
  std::shared_ptr<const PreparedEstimator> own = nullptr;

  /// Observations that it has in a look of this size: all rows of a file where these are fewer.
  std::uint64_t secondaries(std::uint64_t look) const {
    return std::min(look, setup->observations().value_or(look));
  }

  /// Of how many primaries an observation is the average: its variance and cost times this are
  /// those of one primary.
  double averaged(std::uint64_t primaries) const {
    return averages ? static_cast<double>(primaries) : 1;
  }
};

enum class QuestionKind {
  mean_of_one,  ///< mean against a number
  mean_of_two,
  image,            ///< all elements' means of one image against numbers, or of two
  variance_of_one,  ///< of one primary where the estimator averages
  variance_of_two,
  fit_to_density,  ///< a sampler's draws against its declared density, in cells
  fit_to_law,      ///< values against a law's distribution function
  same_law,        ///< values of two against each other
  same_cells,      ///< values of two, one or two channels together, counted in cells
  cost,            ///< of one primary where the estimator averages; the kinds from here on are
  efficiency,      ///< of one estimator against a number or of two, as the subjects say
  quantile,
  total_variance,  ///< summed over the channels
  integral,        ///< of a sampler's density, against a number
  inconsistency,   ///< probability of a draw that contradicts its sampler, against a number
  slope            ///< a power law over the subjects, one a point of the sweep
};

/// The method that makes a claim about two laws one about cells of all their channels together.
inline constexpr const char* two_sample_cells = "chi-square-two-sample";

/// What a claim asks of the suite's estimators.
struct Question {
  const TestEntry* test;
  QuestionKind kind;
  std::vector<Subject> subjects;  ///< one or two (a slope: one a point), then perhaps a reference
  double factor = 1;              ///< first against factor * second
  double offset = 0;              ///< of a bias: E x against the reference + offset
  /// A number per channel of the subject, for the kinds "of one".
  std::vector<Constant> references = {};
  Law law = {};                        ///< for fit_to_law
  bool has_reference_subject = false;  ///< the last subject's mean is the truth of the others
  /// Of each subject and channel the truth its error is taken about: of a mean squared error in an
  /// efficiency, of a bias in a slope. Empty: the variance, the mean itself.
  std::vector<std::vector<Constant>> truths = {};
  std::vector<double> sizes = {};  ///< of a slope: the values of the swept parameter

  /// One number from all channels together.
  bool pooled() const {
    return kind == QuestionKind::cost || kind == QuestionKind::total_variance ||
           kind == QuestionKind::same_cells || kind == QuestionKind::image;
  }
  std::size_t channel_count() const { return pooled() ? 1 : subjects[0].channels.size(); }
  std::string channel_name(std::size_t channel) const;
  /// Subjects without a reference.
  std::size_t compared() const { return subjects.size() - (has_reference_subject ? 1 : 0); }
  /// The most ready-made observations of a subject; nothing where all are drawn.
  std::optional<std::uint64_t> most_rows() const;
  bool of_two() const { return kind != QuestionKind::slope && compared() == 2; }
  bool of_means() const {
    return kind == QuestionKind::mean_of_one || kind == QuestionKind::mean_of_two;
  }
  bool of_variances() const {
    return kind == QuestionKind::variance_of_one || kind == QuestionKind::variance_of_two;
  }
  /// Theta is the logarithm of a ratio.
  bool on_log_scale() const {
    return of_variances() || kind == QuestionKind::cost || kind == QuestionKind::efficiency ||
           kind == QuestionKind::total_variance;
  }
  /// What is tested is or contains a variance.
  bool of_spread() const;
  /// What is tested is or contains a variance or a cost: its tests have to know the tails of
  /// values.
  bool rests_on_tails() const { return of_spread() || kind == QuestionKind::cost; }
  /// The law of single values is the subject, not a mean over them.
  bool of_laws() const {
    return kind == QuestionKind::fit_to_density || kind == QuestionKind::fit_to_law ||
           kind == QuestionKind::same_law || kind == QuestionKind::same_cells ||
           kind == QuestionKind::quantile || of_draws();
  }
  /// A sampler's own bookkeeping is the subject.
  bool of_draws() const {
    return kind == QuestionKind::integral || kind == QuestionKind::inconsistency;
  }
};

/// InputError at the claim's place: a part that does not exist, an analytic reference that the
/// plugin does not know, channels that do not pair, a margin in per cent where there is nothing to
/// take it of, an estimator of the sweep that its plugin refuses.
/// Sources that would share a stream under this seed are told apart.
Question ask(const TestEntry& test, const std::map<std::string, PreparedEstimator>& estimators,
             std::uint64_t seed);

/// The `detect` of a claim about laws where nothing says how many observations to take.
inline constexpr double default_law_effect = 0.05;

/// `ask` of a test as its user wrote it. Gives a claim about laws its default `detect`, unless the
/// test has `detect` or `secondaries` or its rows are given. InputError at a margin that is larger
/// than its reference, or than any probability: nearly always a per cent sign is missing.
Question ask_as_written(TestEntry& test, const std::map<std::string, PreparedEstimator>& estimators,
                        std::uint64_t seed);

/// A key of the test as its user writes it: "`test: t`", or "`--test t`" of the command line.
std::string written_key(const TestEntry& test, const std::string& key, const std::string& value);

/// The margins that a test has: `detect`, `allow` and that of `within`.
std::vector<Margin> margins_of(const TestEntry& test);

/// Whether a number is so far from 0 that its error cannot be why: 8 standard errors. Of a mean near
/// 0 margins are no part.
inline bool exceeds_its_error(double value, double standard_error) {
  return std::abs(value) > 8 * standard_error;
}

/// Says how an absolute margin larger than `size`, what it is held against, is written in per cent.
/// "" for any other margin.
std::string missing_per_cent(const Margin& margin, double size);

}  // namespace assay::harness
