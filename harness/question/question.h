#pragma once

// A claim bound to the estimators of a suite: its observations, and what each channel is compared
// with.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "harness/sampling/image_views.h"
#include "harness/sampling/prepare.h"
#include "harness/suite/suite.h"

namespace assay::harness {

class Theta;

/// One side of a claim: an estimator's secondary estimates, or a sampler's draws.
struct Subject {
  const PreparedEstimator* estimator;
  std::shared_ptr<const Setup> setup;
  std::string purpose = "";  ///< Separates a sampler's streams from its estimator's.
  std::uint32_t copy = 0;
  ChannelList channels;  ///< The channels that the claim is about.
  bool averages = true;  ///< True if the variance falls like 1 / primaries.
  std::optional<ImageShape> image = {};
  /// Owns `estimator` if it is a point of a sweep.
  std::shared_ptr<const PreparedEstimator> own = nullptr;

  /// Observations in a look of this size, at most all rows of a file.
  std::uint64_t secondaries(std::uint64_t look) const {
    return std::min(look, setup->observations().value_or(look));
  }

  /// The estimator's name, with the channel's if there are several: "area.red".
  std::string name_of(std::size_t channel) const {
    return estimator->name +
           (channels.size() > 1 ? "." + setup->channels()[channels[channel]].name : "");
  }

  /// The number of primaries that an observation averages. Its variance and cost times this are
  /// those of one primary.
  double averaged(std::uint64_t primaries) const {
    return averages ? static_cast<double>(primaries) : 1;
  }
};

/// True if a subject's observations are ready-made.
inline bool is_recorded(const Subject& subject) {
  return subject.setup->observations().has_value();
}

/// Facts about a theta that others act on.
struct ThetaTraits {
  bool joins_channels = false;    ///< All channels together make one number.
  bool logarithm = false;         ///< Theta is the logarithm of a ratio.
  bool of_moments = false;        ///< The moments of single channels tell theta and its error.
  bool of_spread = false;         ///< Theta is or contains a variance.
  bool of_single_values = false;  ///< Theta is about the law of observations, not their mean.
  bool of_a_law = false;          ///< Theta is a distance between distribution functions.
  bool of_images = false;         ///< All elements of images are compared together.
  bool of_pairs = false;          ///< Observations share random numbers and are subtracted.
  bool batches_serve = false;     ///< Means of consecutive rows serve as well as the rows.
  bool fit_decides = false;       ///< Without a fit, a rejected theta says nothing: no pass.
};

/// A claim, bound to the suite's estimators.
struct Question {
  const TestEntry* test;
  const Theta* theta;             ///< The number that the claim is about.
  std::vector<Subject> subjects;  ///< One or two (for a slope one a point), then perhaps a
                                  ///< reference.
  double factor = 1;              ///< Compares the first with factor * second.
  double offset = 0;              ///< For a bias: compares E x with the reference + offset.
  /// A number for each channel, of a claim about one estimator.
  std::vector<Constant> references = {};
  Law law = {};                        ///< The claimed law of values.
  bool has_reference_subject = false;  ///< The last subject's mean is the truth for the others.
  /// The truth for each subject and channel, about which a mean squared error in an efficiency or a
  /// bias in a slope is taken. Empty: the variance, or the mean itself.
  std::vector<std::vector<Constant>> truths = {};
  std::vector<double> sizes = {};  ///< For a slope: the values of the swept parameter.

  const ThetaTraits& is() const;
  std::size_t channel_count() const {
    return is().joins_channels ? 1 : subjects[0].channels.size();
  }
  std::string channel_name(std::size_t channel) const;
  /// The number of subjects without the reference.
  std::size_t compared() const { return subjects.size() - (has_reference_subject ? 1 : 0); }
  /// The most ready-made observations of a subject; nullopt if all subjects are drawn.
  std::optional<std::uint64_t> most_rows() const;
  bool of_two() const { return sizes.empty() && compared() == 2; }
};

/// True if any subject's observations are ready-made.
inline bool has_rows(const Question& question) {
  return std::ranges::any_of(question.subjects, is_recorded);
}

}  // namespace assay::harness
