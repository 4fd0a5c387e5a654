#pragma once

// The pilot: a few primaries of each estimator, from their own streams. It decides sizes and
// methods of the tests. No test sees these numbers.

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "harness/base/work.h"
#include "harness/question/question.h"
#include "harness/sampling/executor.h"
#include "harness/sampling/summary.h"
#include "harness/theta/methods.h"

namespace assay::harness {

struct Pilot {
  /// Sums of secondaries with `primaries` primaries each.
  std::shared_ptr<const Summary> sums = {};
  std::uint64_t primaries = 1;
  std::shared_ptr<const KeptObservations> kept = {};
  /// The pool owns what was drawn. Pictures that were looked at while reading have neither.
  std::optional<Drawn> drawn = {};
  std::shared_ptr<const Pool> pool = {};
  Images images = {};  ///< Whole observations of an image.

  std::size_t image_count() const {
    return sums->look() != nullptr ? sums->look()->pictures : images.size();
  }
  stats::Moments moments(std::size_t channel) const { return sums->moments(channel); }
  /// The values of a channel, as drawn; empty if they are not kept.
  std::span<const double> values(std::size_t channel) const {
    return drawn ? drawn->values(channel) : std::span<const double>();
  }
};

/// A pilot keeps the values of estimators with at most so many channels.
inline constexpr std::size_t most_kept_channels = 64;

/// The pilots by pilot_name, and the faults of those that could not be drawn. Averaging estimators
/// have pilots of one primary, others of the suite's `primaries`. The pilot of ready-made data is
/// all rows, also the test's: it chooses only the method.
class Pilots {
 public:
  /// Null if there is none, or a fault.
  const Pilot* find(const std::string& name) const { return get<Pilot>(name); }
  /// Null if there is none, or no fault.
  const Fault* fault(const std::string& name) const { return get<Fault>(name); }
  bool empty() const { return all_.empty(); }
  void add(const std::string& name, std::variant<Pilot, Fault> pilot) {
    all_.emplace(name, std::move(pilot));
  }
  void merge(Pilots others) { all_.merge(others.all_); }
  /// All primaries that were drawn for them.
  double primaries() const;
  /// Frees what was drawn for the plans alone. Ready-made data stay: they are also the tests'.
  void drop_drawn();

 private:
  template <class Kind>
  const Kind* get(const std::string& name) const {
    const auto found = all_.find(name);
    return found == all_.end() ? nullptr : std::get_if<Kind>(&found->second);
  }

  std::map<std::string, std::variant<Pilot, Fault>> all_;
};

/// The estimator's name. For a sampler's draws a dot and their purpose follow.
std::string pilot_name(const Subject& subject);

/// Pilots take this part of a budget in primaries at most, but for a few observations of each.
inline constexpr double pilots_part = 0.25;

/// Primaries of the question's pilots that its budget, which is in primaries, has to pay.
std::uint64_t primaries_of_pilots(const Question& question, const Pilots& pilots);

/// Says which of the needed pilots stopped, where and why; "" if none did.
std::string where_pilots_stopped(const Question& question, const Pilots& pilots);

/// Observations of several primaries each, of an estimator that declares `averages`, as many
/// primaries as its pilot has. Null if it declares none, is a mutant, or always has one primary.
const Pilot* averaged_pilot_of(const Subject& subject, const Pilots& pilots);

/// The pilot of a subject; null if there is none or it has a fault.
const Pilot* pilot_of(const Subject& subject, const Pilots& pilots);

/// A channel as its pilot shows it. It has values if they are kept, and powers.
ChannelData pilot_channel(const Subject& subject, const Pilot& pilot, std::size_t channel);
/// The same for a question's subject, which must have a pilot. It looks the pilot up by name, which
/// is too slow for every channel of an image.
ChannelData pilot_channel(const Question& question, std::size_t subject, std::size_t channel,
                          const Pilots& pilots);

/// The pilot's values of one channel as secondaries of so many primaries. They stay as they are if
/// the subject does not average, or has rows of a file.
std::vector<double> as_secondaries(const Subject& side, std::span<const double> values,
                                   std::uint64_t primaries);

// Demands of a suite's claims on the pilots of its estimators. All questions decide what a pilot
// keeps, so a selection does not change it. The chosen ones decide whether a sampler's draws are
// piloted.

/// The pools of the pilots by their names. Nothing is drawn.
std::vector<std::pair<std::string, std::shared_ptr<Pool>>> pilot_pools(
    const std::vector<const PreparedEstimator*>& estimators, const std::vector<Question>& questions,
    std::uint64_t seed);

Pilots run_pilots(const std::vector<const PreparedEstimator*>& estimators,
                  const std::vector<Question>& questions, std::uint64_t seed, Executor& executor,
                  Progress& progress);

/// The pilots of these questions alone, drawn in silence.
Pilots pilots_of(const std::vector<Question>& questions, std::uint64_t seed, Executor& executor);

}  // namespace assay::harness
