#pragma once

// A claim bound to the estimators of a suite: its observations, and what each channel is compared
// with.

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

/// One side of a claim: an estimator's secondary estimates, or a sampler's draws.
struct Subject {
  const PreparedEstimator* estimator;
  std::shared_ptr<const Setup> setup;
  std::string purpose = "";  ///< Separates a sampler's streams from its estimator's.
  std::uint32_t copy = 0;
  std::vector<std::size_t> channels;  ///< The channels that the claim is about.
  bool averages = true;               ///< True if the variance falls like 1 / primaries.
  std::optional<ImageShape> image = {};
  /// Owns `estimator` if it is a point of a sweep.
  std::shared_ptr<const PreparedEstimator> own = nullptr;

  /// Observations in a look of this size, at most all rows of a file.
  std::uint64_t secondaries(std::uint64_t look) const {
    return std::min(look, setup->observations().value_or(look));
  }

  /// The number of primaries that an observation averages. Its variance and cost times this are
  /// those of one primary.
  double averaged(std::uint64_t primaries) const {
    return averages ? static_cast<double>(primaries) : 1;
  }
};

enum class QuestionKind {
  mean_of_one,  ///< A mean against a number.
  mean_of_two,
  image,            ///< All means of one image against numbers, or of two images.
  variance_of_one,  ///< Of one primary if the estimator averages.
  variance_of_two,
  fit_to_density,  ///< A sampler's draws against its declared density, in cells.
  fit_to_law,      ///< Values against a law's distribution function.
  same_law,        ///< Values of two subjects against each other.
  same_cells,      ///< Values of two subjects, one or two channels, counted in cells.
  // The kinds below compare with a number or with a second subject.
  cost,        ///< Of one primary if the estimator averages.
  efficiency,  ///< 1 / (error x cost).
  quantile,
  total_variance,
  integral,       ///< Of a sampler's density, against a number.
  inconsistency,  ///< Probability of a draw that contradicts its sampler.
  slope           ///< A power law; each subject is a point of the sweep.
};

/// A claim, bound to the suite's estimators.
struct Question {
  const TestEntry* test;
  QuestionKind kind;
  std::vector<Subject> subjects;  ///< One or two (for a slope one a point), then perhaps a
                                  ///< reference.
  double factor = 1;              ///< Compares the first with factor * second.
  double offset = 0;              ///< For a bias: compares E x with the reference + offset.
  /// For the kinds "of one": a number for each channel.
  std::vector<Constant> references = {};
  Law law = {};                        ///< For fit_to_law.
  bool has_reference_subject = false;  ///< The last subject's mean is the truth for the others.
  /// The truth for each subject and channel, about which a mean squared error in an efficiency or a
  /// bias in a slope is taken. Empty: the variance, or the mean itself.
  std::vector<std::vector<Constant>> truths = {};
  std::vector<double> sizes = {};  ///< For a slope: the values of the swept parameter.

  /// True if all channels together make one number.
  bool pooled() const {
    return kind == QuestionKind::cost || kind == QuestionKind::total_variance ||
           kind == QuestionKind::same_cells || kind == QuestionKind::image;
  }
  std::size_t channel_count() const { return pooled() ? 1 : subjects[0].channels.size(); }
  std::string channel_name(std::size_t channel) const;
  /// The number of subjects without the reference.
  std::size_t compared() const { return subjects.size() - (has_reference_subject ? 1 : 0); }
  /// The most ready-made observations of a subject; nullopt if all subjects are drawn.
  std::optional<std::uint64_t> most_rows() const;
  bool of_two() const { return kind != QuestionKind::slope && compared() == 2; }
  bool of_means() const {
    return kind == QuestionKind::mean_of_one || kind == QuestionKind::mean_of_two;
  }
  bool of_variances() const {
    return kind == QuestionKind::variance_of_one || kind == QuestionKind::variance_of_two;
  }
  /// True if theta is the logarithm of a ratio.
  bool on_log_scale() const {
    return of_variances() || kind == QuestionKind::cost || kind == QuestionKind::efficiency ||
           kind == QuestionKind::total_variance;
  }
  /// True if the tested number is or contains a variance.
  bool of_spread() const;
  /// True if the tested number is or contains a variance or a cost. Such tests depend on the tails
  /// of values.
  bool rests_on_tails() const { return of_spread() || kind == QuestionKind::cost; }
  /// True if the claim is about the law of single values, not their mean.
  bool of_laws() const {
    return kind == QuestionKind::fit_to_density || kind == QuestionKind::fit_to_law ||
           kind == QuestionKind::same_law || kind == QuestionKind::same_cells ||
           kind == QuestionKind::quantile || of_draws();
  }
  /// True if the claim is about what a sampler declares.
  bool of_draws() const {
    return kind == QuestionKind::integral || kind == QuestionKind::inconsistency;
  }
};

/// Binds the claim. Sources that would share a stream under this seed get separate ones. InputError
/// at the claim's place for a part that does not exist, an unknown analytic reference, or channels
/// that do not pair. InputError also for a relative margin without a reference size, and for a
/// swept value that the plugin refuses.
Question ask(const TestEntry& test, const std::map<std::string, PreparedEstimator>& estimators,
             std::uint64_t seed);

/// The default `detect` of a claim about laws.
inline constexpr double default_law_effect = 0.05;

/// ask() for a test as its user wrote it. A claim about laws gets the default `detect`, unless the
/// test has `detect` or `secondaries` or its rows are given. InputError if a margin is larger than
/// its reference or than any probability: the per cent sign is probably missing.
Question ask_as_written(TestEntry& test, const std::map<std::string, PreparedEstimator>& estimators,
                        std::uint64_t seed);

/// A key of the test as its user writes it: "`test: t`", or "`--test t`" of the command line.
std::string written_key(const TestEntry& test, const std::string& key, const std::string& value);

/// The margins of a test: `detect`, `allow` and that of `within`.
std::vector<Margin> margins_of(const TestEntry& test);

/// True if the number is at least 8 standard errors from 0. Margins cannot be relative to a mean
/// near 0.
inline bool exceeds_its_error(double value, double standard_error) {
  return std::abs(value) > 8 * standard_error;
}

/// Suggests the per cent spelling of an absolute margin larger than its reference `size`; "" for
/// other margins.
std::string missing_per_cent(const Margin& margin, double size);

}  // namespace assay::harness
