#pragma once

// The pilot: a few primaries of each estimator, from streams of their own, by which the sizes and
// methods of the tests are chosen. No test ever sees these numbers.

#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "harness/base/progress.h"
#include "harness/question/question.h"
#include "harness/sampling/picture_look.h"
#include "harness/sampling/pool.h"

namespace assay::harness {

/// What a pilot tells of an estimator, by channel.
struct Pilot {
  /// The sums of secondaries of `primaries` primaries.
  std::shared_ptr<const Summary> sums = {};
  std::vector<std::vector<double>> values = {};  ///< of the first channels, as drawn
  std::uint64_t primaries = 1;
  /// Of an image: whole observations, and whose they are.
  Observations images = {};
  std::shared_ptr<const KeptObservations> kept = {};
  /// At pictures, in place of `images`: they were looked at when they were read.
  std::shared_ptr<const PictureLook> look = {};
  /// More observations, these among them, where claims on variances and costs need them; or why
  /// they could not be drawn.
  std::shared_ptr<const Pilot> larger = {};
  std::optional<Fault> larger_fault = {};

  std::size_t image_count() const {
    if (look) return look->piloted;
    return std::visit([](const auto& each) { return each.size(); }, images);
  }
  stats::Moments moments(std::size_t channel) const { return sums->moments(channel); }
};

/// Observations of a pilot of an estimator that averages, primaries then, and the most of others.
inline constexpr std::uint64_t many_observations = 8192;

/// Images that a pilot takes of an estimator of them.
std::optional<std::uint64_t> usual_images(const Setup& setup, std::uint64_t primaries);
/// Of estimators of no more channels a pilot keeps their values.
inline constexpr std::size_t most_kept_channels = 64;

/// By pilot_name, the pilots that were drawn and why others could not be. Averaging estimators are
/// piloted at one primary, others at the suite's `primaries`. Of ready-made data a pilot is all
/// rows, which are the test's own: only the method is chosen by them.
class Pilots {
 public:
  /// Null where there is none, or a fault.
  const Pilot* find(const std::string& name) const;
  /// Throws std::out_of_range where find() gives null.
  const Pilot& at(const std::string& name) const { return drawn_.at(name); }
  /// Null where there is none, or a pilot.
  const Fault* fault(const std::string& name) const;
  /// Why an estimator could not be piloted, or its sampler's draws for `purpose`; null where they
  /// could.
  const Fault* fault(const std::string& estimator, const std::string& purpose) const;
  bool empty() const { return drawn_.empty() && faults_.empty(); }

  void add(const std::string& name, std::variant<Pilot, Fault> pilot);
  void add_larger(const std::string& name, std::variant<Pilot, Fault> larger);
  void merge(Pilots others);

 private:
  std::map<std::string, Pilot> drawn_;
  std::map<std::string, Fault> faults_;
};

struct PilotRun {
  std::uint64_t seed;
  unsigned threads;
  std::set<std::string> with_cost = {};  ///< names of those whose costs are wanted
  /// Names of those whose variances or costs are tested, with the most observations that a pilot of
  /// them is worth.
  std::map<std::string, std::uint64_t> on_tails = {};
  std::vector<const Subject*> draws = {};  ///< samplers whose draws are wanted besides
};

/// The estimator's name. Of a sampler's draws their purpose follows after a dot.
std::string pilot_name(const Subject& subject);

/// Which subject's pilot stopped, where, and why; empty where all went well that the question rests
/// on.
std::string where_pilots_stopped(const Question& question, const Pilots& pilots);

/// The pilot of a subject, if it has one that went well.
const Pilot* pilot_of(const Subject& subject, const Pilots& pilots);
/// The same for one of a question's subjects: the larger one where there is one that it needs.
const Pilot* pilot_of(const Question& question, std::size_t subject, const Pilots& pilots);

struct PilotChannel {
  stats::Moments moments;
  std::span<const double> values;  ///< empty beyond the channels that are kept
};
/// One channel of a subject in its pilot.
PilotChannel pilot_channel(const Subject& subject, const Pilot& pilot, std::size_t channel);
/// The same of one of a question's subjects, which must have a pilot. It is looked up by name: not
/// for each of an image's channels.
PilotChannel pilot_channel(const Question& question, std::size_t subject, std::size_t channel,
                           const Pilots& pilots);

Pilots run_pilots(const std::vector<const PreparedEstimator*>& estimators, const PilotRun& run,
                  Progress& progress);

}  // namespace assay::harness
