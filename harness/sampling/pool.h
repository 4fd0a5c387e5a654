#pragma once

// A pool of observations: one stream key, one number of primaries, drawn in blocks. Every test on
// the same estimator, parameters and primaries reads a prefix of the same pool.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "estimators/estimator.h"
#include "harness/sampling/image_views.h"
#include "harness/sampling/kept_observations.h"
#include "harness/sampling/sample.h"
#include "harness/sampling/summary.h"

namespace assay::harness {

/// Primaries that an observation takes: of an image those of every pixel and component.
std::uint64_t primaries_of_observation(const Setup& setup, std::uint64_t primaries);

/// Observations of a block, a power of two that depends on `primaries` alone; of an image they are
/// those of all its elements.
std::uint64_t block_size_of(std::uint64_t primaries);

class Pool {
 public:
  Pool(std::shared_ptr<const Setup> setup, StreamKey key, std::uint64_t primaries);

  std::shared_ptr<const Setup> setup() const { return setup_; }
  StreamKey key() const { return key_; }
  std::uint64_t primaries() const { return primaries_; }

  std::size_t channels() const { return channels_; }
  /// What to keep of each channel, before anything is drawn; none: of no channel more than its
  /// moments, and an image's millions need no plans.
  void plan(std::vector<ChannelPlan> channels) { plan_ = std::move(channels); }
  const std::vector<ChannelPlan>& plan() const { return plan_; }
  /// One for each channel, to be changed.
  std::vector<ChannelPlan>& plans();

  /// To sum the variances of these channels in groups; before anything is drawn.
  void keep_group_variances(std::vector<std::size_t> channels) {
    grouped_channels_ = std::move(channels);
  }
  /// To keep every block by itself (some hundred bytes for each 16384 primaries); before anything
  /// is drawn.
  void keep_blocks() { keeps_blocks_ = true; }
  bool keeps_blocks() const { return keeps_blocks_; }
  /// To store the first `count` observations whole; before anything is drawn.
  void keep_observations(std::uint64_t count) {
    kept_observations_ = std::max(kept_observations_, count);
  }

  /// The observations that were kept, to share with another pool.
  std::shared_ptr<const KeptObservations> kept() const { return kept_; }
  /// Not to draw these but to take them: rows of files, which are the same whoever reads them.
  /// Before anything is drawn.
  void take_known(std::shared_ptr<const KeptObservations> known) { known_ = std::move(known); }

  /// Observations [0, count) may be read as a prefix. std::logic_error once they are drawn.
  void mark(std::uint64_t count);
  /// Marks `count` and asks for everything up to it to be drawn next.
  void request(std::uint64_t count);
  std::uint64_t most_marked() const { return prefixes_.empty() ? 0 : prefixes_.rbegin()->first; }
  /// The most that is requested.
  std::uint64_t requested() const { return requested_; }

  /// The first `count` observations, once drawn, or why they cannot be; `count` as marked.
  /// std::logic_error before they are drawn.
  Sample sample(std::uint64_t count) const;
  /// Not to draw from a source that failed before.
  void fail(const Fault& fault) { fault_ = fault; }
  /// Why drawing ended early, if it did: nothing more will be drawn.
  const std::optional<Fault>& fault() const { return fault_; }
  /// CPU seconds of drawing up to the largest marked count that is drawn.
  double seconds() const;

  // The scheduler's side. Observations per block are a function of `primaries` alone.
  std::uint64_t block_size() const { return block_size_; }
  /// Where the block that begins at `first` ends. Blocks are drawn whole, even where less was
  /// requested: a later look then continues as if it had been one run. The last one ends with what
  /// is marked, as nobody asks for more: an observation of another program may take seconds.
  std::uint64_t block_end(std::uint64_t first) const;

  /// A drawn block, and copies of it at the marked counts that lie inside.
  struct Block {
    Summary whole;
    std::vector<std::vector<double>> values;  ///< of each channel, where they are kept
    KeptObservations observations;            ///< where they are kept
    std::vector<std::pair<std::uint64_t, Summary>> partial;
    std::optional<Fault> fault;
    std::uint64_t size = 0;  ///< observations that it is to have
  };
  /// Draws observations [first, last) of one block with a worker's estimator, which it may have to
  /// make. Thread-safe. Whatever the source throws becomes the block's fault.
  Block draw(const std::function<Estimator&()>& estimator, std::uint64_t first,
             std::uint64_t last) const;
  /// Takes the next block, in order.
  void fold(Block&& block);
  /// After the last block that is drawn for now, by one thread, on all of them: pictures of files
  /// are summed when all are there, an element over all of them at a time instead of picture by
  /// picture (kept_sums.h). Whatever else is kept of them, so that their numbers do not depend on
  /// it.
  void end_drawing();
  std::uint64_t drawn() const { return running_.count; }
  /// Moments of an earlier run: nothing is drawn, and every prefix is the whole.
  bool is_ready_made() const { return ready_made_ != nullptr; }

 private:
  std::shared_ptr<const Setup> setup_;
  const Summary* ready_made_;  ///< of `setup_`
  StreamKey key_;
  std::uint64_t primaries_;
  std::uint64_t block_size_;
  std::size_t channels_;
  /// Pictures of files, which stay and are summed when all are there.
  bool sums_later_;
  std::vector<ChannelPlan> plan_;
  friend class Drawn;
  std::span<const double> values(std::size_t channel, std::uint64_t count) const;
  Observations observations(std::uint64_t count) const;
  std::span<const BlockSums> blocks() const { return blocks_; }

  Summary no_sums() const;
  const KeptObservations& all_kept() const { return known_ ? *known_ : *kept_; }
  std::shared_ptr<const Summary> sums_of_first(std::uint64_t count, const Summary& drawn);
  void take_details(Summary& summary) const;
  void keep_values();
  std::span<const double> observe(Estimator& estimator, std::uint64_t index, std::span<double> out,
                                  Block& block) const;
  void keep_picture(Estimator& estimator, std::uint64_t index, Block& block) const;
  void keep_block(const Summary& block, std::uint64_t first);

  std::map<std::uint64_t, std::shared_ptr<const Summary>> prefixes_;
  std::uint64_t requested_ = 0;
  Summary running_;
  std::vector<std::vector<double>> values_;
  std::vector<std::size_t> grouped_channels_;
  std::shared_ptr<KeptObservations> kept_ = std::make_shared<KeptObservations>();
  std::shared_ptr<const KeptObservations> known_;
  std::uint64_t kept_observations_;
  std::uint64_t values_taken_ = 0;  ///< of kept observations, for `values_`
  bool keeps_blocks_ = false;
  std::vector<BlockSums> blocks_;
  bool started_ = false;
  std::optional<Fault> fault_;
};

/// One observation alone, all channels.
std::vector<double> draw_observation(const Setup& setup, StreamKey key, std::uint64_t primaries,
                                     std::uint64_t index);

}  // namespace assay::harness
