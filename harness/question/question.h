#pragma once

// A claim bound to the estimators of a suite: its observations, and what each channel is compared
// with.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <ranges>
#include <string>
#include <vector>

#include "harness/sampling/image_views.h"
#include "harness/sampling/prepare.h"
#include "harness/sampling/summary.h"
#include "harness/suite/suite.h"
#include "stats/means/student_t.h"

namespace assay::harness {

struct Fault;

class Theta;

/// One side of a claim: secondary estimates, or a sampler's draws.
struct Subject {
  const PreparedEstimator* estimator;
  std::shared_ptr<const Setup> setup;
  std::string purpose = "";  ///< Separates a sampler's streams from its estimator's.
  std::uint32_t copy = 0;
  ChannelList channels;
  bool averages = true;  ///< True if the variance falls like 1 / primaries.
  std::optional<ImageShape> image = {};
  /// Owns `estimator` if it is a point of a sweep.
  std::shared_ptr<const PreparedEstimator> own = nullptr;

  /// Observations in a look of this size, at most all rows of a file.
  std::uint64_t secondaries(std::uint64_t look) const {
    return std::min(look, setup->observations().value_or(look));
  }

  Channel declared(std::size_t channel) const { return setup->channel(channels[channel]); }
  auto declared() const {
    return std::views::iota(std::size_t{0}, channels.size()) |
           std::views::transform([this](std::size_t channel) { return declared(channel); });
  }

  /// The estimator's name, with the channel's if there are several: "area.red".
  std::string name_of(std::size_t channel) const {
    return estimator->name + (channels.size() > 1 ? "." + declared(channel).name : "");
  }

  /// The number of primaries that an observation averages. Its variance and cost times this are
  /// those of one primary.
  double averaged(std::uint64_t primaries) const {
    return averages ? static_cast<double>(primaries) : 1;
  }
};

inline bool is_recorded(const Subject& subject) {
  return subject.setup->observations().has_value();
}

/// The fault of a subject's source: "`darts` stopped in the pilot: …" with `when` " in the pilot".
/// The words of a file name it, so that nothing stopped.
std::string sentence_of(const Fault& fault, const Subject& subject, const std::string& when = "");

/// Facts about a theta that others act on.
struct ThetaTraits {
  bool joins_channels = false;     ///< All channels together make one number.
  bool logarithm = false;          ///< Theta is the logarithm of a ratio.
  bool of_moments = false;         ///< The moments of single channels tell theta and its error.
  bool of_spread = false;          ///< Theta is or contains a variance.
  bool of_single_values = false;   ///< Theta is about the law of observations, not their mean.
  bool of_a_law = false;           ///< Theta is a distance between distribution functions.
  bool of_images = false;          ///< All elements of images are compared together.
  bool of_pairs = false;           ///< Observations share random numbers and are subtracted.
  bool batches_serve = false;      ///< Means of consecutive rows serve as well as the rows.
  bool fit_decides = false;        ///< Without a fit, a rejected theta says nothing: no pass.
  bool may_be_unbounded = false;   ///< Data may exclude nothing at all (Theta::not_excluded).
  const char* absolute = nullptr;  ///< Why margins cannot be in per cent; null if they can.
};

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
  std::vector<double> sizes = {};    ///< For a slope: the values of the swept parameter.
  std::vector<Margin> written = {};  ///< The user's margins, before `--coarsen`.
  bool chosen = true;                ///< The run selects the test.

  const ThetaTraits& is() const;
  std::size_t channel_count() const {
    return is().joins_channels ? 1 : subjects[0].channels.size();
  }
  std::string channel_name(std::size_t channel) const;
  std::size_t compared() const { return subjects.size() - (has_reference_subject ? 1 : 0); }
  /// The most ready-made observations of a subject; nullopt if all subjects are drawn.
  std::optional<std::uint64_t> most_rows() const;
  bool of_two() const { return sizes.empty() && compared() == 2; }
  /// Factor on a subject's standard deviation in the comparison.
  double factor_of(std::size_t subject) const { return subject == 0 ? 1 : std::abs(factor); }
  /// The sign that a subject's mean has in theta.
  int sign_of(std::size_t subject) const { return subject == 0 || factor < 0 ? 1 : -1; }
  /// The second side's value on the first's scale.
  double mapped(double second) const { return factor * second + offset; }
};

inline bool has_rows(const Question& question) {
  return std::ranges::any_of(question.subjects, is_recorded);
}

/// The source's estimator. InputError, with a near name, if the suite has none.
const PreparedEstimator& estimator_of(const Source& source, const Estimators& estimators);

/// The estimator's secondary estimates: all tested channels, or the one that the part names.
Subject estimates(const Source& source, const PreparedEstimator& estimator);
Subject estimates(const Source& source, const Estimators& estimators);

/// Views of a sampler's draws: cells of the whole domain, marginals (all or one), or consistency.
enum class Draws { cells, marginals, consistency };
Subject draws(const Source& source, const Estimators& estimators, Draws what);

/// The source of a distribution: the channel that the part names, else a sampler.
Subject values(const Source& source, const Estimators& estimators);

/// The number that the channel's plugin knows. InputError if it knows none.
Constant analytic(const Quantity& quantity, const Channel& channel);

/// "32 x 32 irradiance".
std::string image_name(const ImageShape& shape);
/// InputError unless all subjects have as many channels, and all or none are images of one size.
void require_one_size(const Question& question);
/// InputError if the first subject and the other leave out different pixels, which would be 0 on
/// one side alone. Both are images.
void require_equal_pixels(const Question& question, const Subject& other);

StreamKey stream_of(const Subject& subject, std::uint64_t seed);

/// Gives the draws of a sampler cells by the suite's seed (SamplerSetup), the same in a replay.
void seed_cells(Subject& subject, const Location& where, std::uint64_t seed);

/// Null if a number or a law stands on the right.
const ScaledQuantity* other_side(const Claim& claim);

/// The true mean of each channel: the number of `reference:`, else the plugin's; zeros if it is
/// drawn.
std::vector<Constant> truths_of(const TestEntry& test, const Subject& subject,
                                const Source& source);

void add_reference(Question& question, const Estimators& estimators);

void require_absolute(const Margin& margin, const char* reason);

/// The largest relative error of a number that is drawn: an image's are in single precision.
double relative_rounding(const Setup& setup);

/// Names a value outside the range that its channel declares (`low`, `high`), beyond rounding; ""
/// if there is none. The range decides on methods, above all `betting`. Mutants (which
/// have their original's declaration), images and ready-made data are not checked.
std::string outside_of_range(const Subject& subject, const Summary& drawn);

/// A channel's declared range; for recorded data the range of their values.
stats::Range range_of(const Subject& side, std::size_t channel, const stats::Moments& moments);

/// The rounding that a channel declares of its values, and that of their mean in single precision.
double rounding_of(const Subject& side, std::size_t channel);

/// True if the values differ by no more than twice the channel's declared rounding.
bool is_constant(const Subject& side, std::size_t channel, const stats::Moments& moments);

/// The value of a subject's channel that stands for "no point"; only samplers have one.
std::optional<double> no_point_of(const Subject& side, std::size_t channel = 0);

}  // namespace assay::harness
