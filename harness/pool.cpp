#include "harness/pool.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <ctime>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "estimators/flush_denormals.h"
#include "estimators/ready_made.h"
#include "harness/group_variance.h"
#include "harness/kept_sums.h"
#include "harness/recorded_run.h"

namespace assay::harness {
namespace {

// A block is some milliseconds of work at a microsecond a primary: long against the cost of handing
// it out, short against a run.
constexpr std::uint64_t primaries_per_block = 16384;
constexpr std::uint64_t least_block = 8;
constexpr std::uint64_t most_block = 4096;
constexpr std::uint64_t most_observations = std::numeric_limits<std::uint64_t>::max();

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Pool::BlockSums sums_of(const Summary& block) {
  Pool::BlockSums sums{.count = block.count, .seconds = block.seconds};
  for (const ChannelSummary& channel : block.channels) sums.channels.push_back(channel.moments);
  return sums;
}

/// The observation that a picture of a file is.
std::span<const double> widened(std::span<const float> picture, std::span<double> out) {
  std::ranges::copy(picture, out.begin());
  out.back() = recorded::average_of(picture);
  return out;
}

/// Primaries that one observation is made of.
std::uint64_t primaries_of(const Setup& setup, std::uint64_t primaries) {
  const std::optional<ImageShape> image = setup.image();
  return image ? primaries * image->elements() : primaries;
}

const Summary* ready_made(const Setup& setup) {
  const RecordedRun* run = as_recorded_run(setup);
  return run == nullptr ? nullptr : &run->summary();
}

std::size_t channels_of(const Setup& setup) {
  const std::optional<std::size_t> unknown = recorded::unknown_channels(setup);
  return unknown ? *unknown : setup.channels().size();
}

bool is_plain(const ChannelPlan& plan) {
  return !(plan.histogram_low < plan.histogram_high) && plan.keep == 0 && plan.cells == 0 &&
         !plan.with_cost;
}

ObservationCost counted(const Cost& cost) {
  return {static_cast<double>(cost.rays()), static_cast<double>(cost.samples)};
}

// Of so many channels the sums of all do not stay in a cache from one observation to the next.
constexpr std::size_t many_channels = 4096;

/// Takes the observations of a block into its sums, in order. Of an image those that stay where
/// they are wait, and then some channels of all of them are taken before the next: each channel's
/// sums are as if they had been taken one by one.
class Intake {
 public:
  explicit Intake(std::vector<ChannelSummary>& channels)
      : channels_(channels), together_(channels.size() > many_channels) {}

  void take(std::span<const double> values, std::uint64_t index, const ObservationCost& cost,
            bool stays) {
    if (together_ && stays) {
      waiting_.push_back({values, index, cost});
      return;
    }
    take_waiting();
    for (std::size_t c = 0; c < values.size(); ++c) {
      add_observation(channels_[c], values[c], index, cost);
    }
  }
  void take_waiting() {
    if (waiting_.empty()) return;
    constexpr std::size_t at_a_time = 512;
    for (std::size_t first = 0; first < channels_.size(); first += at_a_time) {
      const std::size_t last = std::min(first + at_a_time, channels_.size());
      for (const Waiting& each : waiting_) {
        for (std::size_t c = first; c < last; ++c) {
          add_observation(channels_[c], each.values[c], each.index, each.cost);
        }
      }
    }
    waiting_.clear();
  }

 private:
  struct Waiting {
    std::span<const double> values;
    std::uint64_t index;
    ObservationCost cost;
  };
  std::vector<ChannelSummary>& channels_;
  bool together_;
  std::vector<Waiting> waiting_;
};

/// Observations below it have channels whose values are kept.
std::uint64_t most_kept(std::span<const ChannelPlan> plan) {
  std::uint64_t most = 0;
  for (const ChannelPlan& channel : plan) most = std::max(most, channel.keep);
  return most;
}

}  // namespace

std::uint64_t block_size_of(std::uint64_t primaries) {
  return std::bit_floor(std::clamp(primaries_per_block / primaries, least_block, most_block));
}

Pool::Pool(std::shared_ptr<const Setup> setup, StreamKey key, std::uint64_t primaries)
    : setup_(std::move(setup)),
      ready_made_(ready_made(*setup_)),
      key_(key),
      primaries_(primaries),
      block_size_(block_size_of(primaries_of(*setup_, primaries))),
      channels_(channels_of(*setup_)) {}

std::vector<ChannelPlan>& Pool::plans() {
  plan_.resize(channels_);
  return plan_;
}

Summary Pool::no_sums() const { return sums_later_ ? Summary() : Summary(channels_, plan_); }

void Pool::mark(std::uint64_t count) {
  const bool known = !prefixes_.try_emplace(count, std::make_shared<const Summary>()).second;
  if (!known && count <= drawn()) throw std::logic_error("a prefix was marked after it was drawn");
}

void Pool::request(std::uint64_t count) {
  mark(count);
  if (!is_ready_made()) requested_ = std::max(requested_, count);
}

std::shared_ptr<const Summary> Pool::shared(std::uint64_t count) const {
  if (is_ready_made()) return {setup_, ready_made_};  // as long as its set-up
  return prefixes_.at(count);
}

const Summary& Pool::prefix(std::uint64_t count) const { return *shared(count); }

std::uint64_t Pool::largest_prefix() const {
  if (is_ready_made()) return ready_made_->count;
  const auto beyond = prefixes_.upper_bound(drawn());
  return beyond == prefixes_.begin() ? 0 : std::prev(beyond)->first;
}

std::span<const double> Pool::values(std::size_t channel, std::uint64_t count) const {
  if (is_ready_made()) return {};
  if (values_.empty()) return {};
  const std::vector<double>& kept = values_.at(channel);
  return {kept.data(), std::min<std::size_t>(kept.size(), count)};
}

Observations Pool::observations(std::uint64_t count) const {
  return (known_ ? known_ : kept_)->first(count);
}

std::uint64_t Pool::block_end(std::uint64_t first) const {
  return std::min(first + block_size_, setup_->observations().value_or(most_observations));
}

Observations KeptObservations::first(std::uint64_t count) const {
  const std::size_t most = std::min<std::size_t>(size(), count);
  if (!pictures.empty()) return std::span(pictures).first(most);
  return std::span(values).first(most);
}

void KeptObservations::append(KeptObservations&& next) {
  std::ranges::move(next.values, std::back_inserter(values));
  std::ranges::move(next.texels, std::back_inserter(texels));
  std::ranges::move(next.pictures, std::back_inserter(pictures));
  std::ranges::move(next.costs, std::back_inserter(costs));
}

/// A picture goes from its file to where it is kept, and into an observation where sums are taken
/// of it at once.
std::span<const double> Pool::keep_picture(Estimator& estimator, std::uint64_t index,
                                           std::span<double> out, Block& block) const {
  const std::size_t elements = channels_ - 1;
  KeptObservations& kept = block.observations;
  if (kept.texels.empty()) {
    kept.texels.push_back(std::make_unique_for_overwrite<float[]>(block.size * elements));
  }
  const std::span<float> picture(kept.texels[0].get() + kept.pictures.size() * elements, elements);
  recorded::read_picture(estimator, index, picture, block.whole.cost);
  kept.pictures.emplace_back(picture);
  return sums_later_ ? std::span<const double>() : widened(picture, out);
}

/// One observation, kept where that was asked for: in `out`, or where it stays.
std::span<const double> Pool::observe(Estimator& estimator, std::uint64_t index,
                                      std::span<double> out, Block& block) const {
  if (known_ && index < known_->size()) {
    block.whole.cost += known_->costs[index];
    if (known_->pictures.empty()) return known_->values[index];
    return sums_later_ ? std::span<const double>() : widened(known_->pictures[index], out);
  }
  const bool kept = !known_ && index < kept_observations_;
  // Counted where the sum stands: to load as a whole what an estimator has just stored in parts
  // would hold up every observation.
  Cost before;
  if (kept) before = block.whole.cost;
  std::span<const double> drawn = out;
  if (kept && recorded::unknown_channels(*setup_)) {
    drawn = keep_picture(estimator, index, out, block);
  } else {
    Stream random(key_, index);
    estimator.secondary(random, primaries_, out, block.whole.cost);
    if (kept) drawn = block.observations.values.emplace_back(out.begin(), out.end());
  }
  if (kept) block.observations.costs.push_back(block.whole.cost - before);
  return drawn;
}

Pool::Block Pool::draw(Estimator& estimator, std::uint64_t first, std::uint64_t last) const {
  const std::uint64_t values_kept = most_kept(plan_);
  Block block{.whole = no_sums(),
              .values = std::vector<std::vector<double>>(values_kept > 0 ? channels_ : 0),
              .observations = {},
              .partial = {},
              .trouble = {},
              .size = last - first};
  const bool in_place = sums_later_ && recorded::unknown_channels(*setup_);
  std::vector<double> out(in_place ? 0 : channels_);
  Intake intake(block.whole.channels);
  auto mark = prefixes_.upper_bound(first);
  const auto seconds = [&estimator] { return thread_seconds() + estimator.seconds_elsewhere(); };
  const double start = seconds();
  std::uint64_t index = first;
  GroupVariance groups(grouped_channels_);
  const bool counts_costs = std::any_of(plan_.begin(), plan_.end(),
                                        [](const ChannelPlan& each) { return each.with_cost; });
  ObservationCost cost{};
  const FlushDenormals flush;
  try {
    estimator.announce({.key = key_, .first = first, .last = last});
    for (; index < last; ++index) {
      Cost before;
      if (counts_costs) before = block.whole.cost;
      const std::span<const double> drawn = observe(estimator, index, out, block);
      if (counts_costs) cost = counted(block.whole.cost - before);
      if (!sums_later_) intake.take(drawn, index, cost, drawn.data() != out.data());
      for (std::size_t c = 0; index < values_kept && c < drawn.size(); ++c) {
        if (index < plan_[c].keep) block.values[c].push_back(drawn[c]);
      }
      if (const auto variance = groups.add(drawn)) block.whole.group_variances.add(*variance);
      ++block.whole.count;
      if (mark != prefixes_.end() && index + 1 == mark->first) {
        intake.take_waiting();
        block.partial.emplace_back(mark->first, block.whole);
        block.partial.back().second.seconds = seconds() - start;
        ++mark;
      }
    }
  } catch (const InputError&) {
    throw;  // a file that cannot be read is a mistake of the user's and no verdict
  } catch (const std::exception& error) {
    block.trouble = fmt::format("observation {}: {}", index, error.what());
  }
  intake.take_waiting();
  block.whole.seconds = seconds() - start;
  return block;
}

bool Pool::sums_later() const {
  if (is_ready_made() || !setup_->image() || !setup_->observations()) return false;
  const std::uint64_t pictures = *setup_->observations();
  const bool kept = known_ ? known_->size() >= pictures : kept_observations_ >= pictures;
  return kept && grouped_channels_.empty() && !keeps_blocks_ &&
         std::ranges::all_of(plan_, is_plain);
}

void Pool::begin_drawing() {
  if (!started_) sums_later_ = sums_later();
}

void Pool::end_drawing() {
  if (!sums_later_) return;
  const std::shared_ptr<const KeptObservations> kept = known_ ? known_ : kept_;
  for (auto& [count, prefix] : prefixes_) {
    if (count > drawn() || count == 0 || !prefix->channels.empty()) continue;
    const auto shared = kept->sums.find(count);
    if (shared != kept->sums.end()) {
      prefix = shared->second;
      continue;
    }
    auto summed = std::make_shared<Summary>(*prefix);
    summed->channels = sums_of_kept(observations(count));
    prefix = std::move(summed);
    if (!known_) kept_->sums[count] = prefix;
  }
}

void Pool::fold(Block&& block) {
  if (!started_) {
    running_ = no_sums();
    if (most_kept(plan_) > 0) values_.resize(channels_);
    started_ = true;
  }
  if (!trouble_.empty()) return;
  for (auto& [count, partial] : block.partial) {
    auto prefix = std::make_shared<Summary>(running_);
    prefix->append(partial);
    prefixes_.at(count) = std::move(prefix);
  }
  running_.append(block.whole);
  if (keeps_blocks_) blocks_.push_back(sums_of(block.whole));
  for (std::size_t c = 0; c < values_.size(); ++c) {
    values_[c].insert(values_[c].end(), block.values[c].begin(), block.values[c].end());
  }
  kept_->append(std::move(block.observations));
  trouble_ = std::move(block.trouble);
}

std::vector<double> draw_observation(const Setup& setup, StreamKey key, std::uint64_t primaries,
                                     std::uint64_t index) {
  const FlushDenormals flush;
  std::vector<double> out(setup.channels().size());
  Stream random(key, index);
  Cost cost;
  setup.make()->secondary(random, primaries, out, cost);
  return out;
}

}  // namespace assay::harness
