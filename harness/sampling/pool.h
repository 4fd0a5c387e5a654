#pragma once

// A pool of observations: one stream key, one number of primaries, drawn in blocks. Tests with
// equal estimator, parameters and primaries read prefixes of the same pool.

#include <algorithm>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "estimators/cost.h"
#include "estimators/estimator.h"
#include "harness/sampling/image_views.h"
#include "harness/sampling/summary.h"
#include "stats/basics/moments.h"
#include "stats/gates/assumption_gates.h"

namespace assay::harness {

/// The reason why a source yields no more numbers: it threw something.
struct Fault {
  std::optional<std::uint64_t> observation = {};  ///< The observation that could not be drawn, if
                                                  ///< drawing began.
  std::string words = "";                         ///< In the source's own words.
};

/// "`darts` stopped in the pilot at observation 17: the lamp burnt out" with `when` " in the
/// pilot".
std::string sentence_of(const Fault& fault, const std::string& estimator,
                        const std::string& when = "");

/// The words of an exception, never empty. An InputError's place stands before them.
std::string words_of(const std::exception_ptr& thrown);

/// Observed images, and the channels that follow each. Images without elements are empty.
struct KeptObservations {
  std::vector<std::vector<float>> images = {};
  std::vector<std::vector<double>> values = {};
  std::vector<Cost> costs = {};
  /// Moments of the first observations, by their number.
  std::map<std::uint64_t, std::shared_ptr<const Summary>> sums = {};

  std::size_t size() const { return costs.size(); }
  void whole(std::size_t index, std::span<double> out) const;
  /// The summary of every channel over observations [begin, end) of images.
  std::vector<ChannelSummary> sums_of(std::uint64_t begin, std::uint64_t end) const;
  void append(KeptObservations&& next);
};

/// Values of the first observations, by channel.
using KeptValues = std::map<std::size_t, std::vector<double>>;

/// Primaries of an observation; for an image those of every pixel and component.
std::uint64_t primaries_of_observation(const Setup& setup, std::uint64_t primaries);

/// Observations of a block: a power of two that depends on an observation's `primaries` alone. An
/// image's are those of all its elements.
std::uint64_t block_size_of(std::uint64_t primaries);

/// Observations of a test that show their order. Offsets of a few per cent that hundreds of
/// neighbours share take thousands.
inline constexpr std::uint64_t ordered_values = 16384;

/// All that decides the numbers of a pool's blocks, beside its set-up.
struct Recipe {
  StreamKey key = {};
  std::uint64_t primaries = 1;
  std::vector<ChannelPlan> plan = {};
  std::vector<std::size_t> grouped_channels = {};
  std::uint64_t kept_observations = 0;
  std::vector<std::uint64_t> marks = {};
};

class Drawn;
/// Drawn observations, or the fault that prevented them.
using Sample = std::variant<Drawn, Fault>;

class Pool {
 public:
  Pool(std::shared_ptr<const Setup> setup, Recipe recipe);
  Pool(std::shared_ptr<const Setup> setup, StreamKey key, std::uint64_t primaries)
      : Pool(std::move(setup), {.key = key, .primaries = primaries}) {}

  std::shared_ptr<const Setup> setup() const { return setup_; }
  StreamKey key() const { return recipe_.key; }
  std::uint64_t primaries() const { return recipe_.primaries; }

  std::size_t channels() const { return channels_; }
  /// The first channels, of an image; 0 without one.
  std::size_t elements() const { return elements_; }
  /// The plan of each channel, to be changed before anything is drawn. An image's millions of
  /// channels need none: the list may be emptied.
  std::vector<ChannelPlan>& plans();

  /// Sums the variances of these channels in groups. Call it before anything is drawn.
  void keep_group_variances(std::vector<std::size_t> channels) {
    recipe_.grouped_channels = std::move(channels);
  }
  /// Keeps every block's sums, some hundred bytes for each 16384 primaries. Call it before anything
  /// is drawn.
  void keep_blocks() { keeps_blocks_ = true; }
  bool keeps_blocks() const { return keeps_blocks_; }
  /// Stores the first `count` observations of an image whole. Call it before anything is drawn. Its
  /// numbers are rounded to single precision when they are drawn, as those of files.
  void keep_observations(std::uint64_t count) {
    recipe_.kept_observations = std::max(recipe_.kept_observations, count);
  }

  std::shared_ptr<const KeptObservations> kept() const { return kept_; }
  /// Takes these observations, rows of files, instead of drawing them. Call it before anything is
  /// drawn.
  void take_known(std::shared_ptr<const KeptObservations> known) { known_ = std::move(known); }

  /// Allows [0, count) to be read as a prefix. std::logic_error once they are drawn.
  void mark(std::uint64_t count);
  /// Marks `count` and has everything up to it drawn next.
  void request(std::uint64_t count);
  std::uint64_t most_marked() const { return prefixes_.empty() ? 0 : prefixes_.rbegin()->first; }
  std::uint64_t requested() const { return requested_; }

  /// The first `count` observations, or why they cannot be drawn. `count` must be marked.
  /// std::logic_error before they are drawn.
  Sample sample(std::uint64_t count) const;
  /// Marks the source as failed: nothing is drawn.
  void fail(const Fault& fault) { fault_ = fault; }
  /// The reason if drawing ended early: nothing more will be drawn.
  const std::optional<Fault>& fault() const { return fault_; }
  Recipe recipe() const;
  /// True if another process can draw the blocks: they need neither files nor this one's clock.
  bool can_be_drawn_elsewhere() const;
  /// CPU seconds of drawing up to the largest marked count that was requested and is drawn.
  double seconds() const;

  std::uint64_t block_size() const { return block_size_; }
  /// The end of the block that begins at `first`. Blocks are drawn whole even beyond the request,
  /// so that a later look continues as one run. The last block ends at the last mark: another
  /// program's observation may take seconds.
  std::uint64_t block_end(std::uint64_t first) const;

  /// A drawn block, and copies of it at the marks inside.
  struct Block {
    Summary whole;
    KeptValues values = {};
    std::shared_ptr<KeptObservations> observations = std::make_shared<KeptObservations>();
    std::vector<std::pair<std::uint64_t, std::shared_ptr<const Summary>>> partial = {};
    std::optional<Fault> fault = {};

    void append_kept(Block&& next);
  };
  void draw_again(Estimator& estimator, std::uint64_t index, std::span<double> out) const;
  /// True for images that are all kept. Their blocks have no sums of channels, which end_drawing()
  /// makes.
  bool sums_later() const { return elements_ > 0 && recipe_.kept_observations >= most_marked(); }
  Summary no_sums() const;
  /// Sums of all that is drawn, as one block that keeps nothing.
  Block drawn_sums() const;
  /// Observations below it are kept whole, or some of their values.
  std::uint64_t kept_end() const;
  /// The block keeps what the pool keeps of observations [first, last). It has no sums.
  Block kept_block(std::uint64_t first, std::uint64_t last) const;
  /// Draws observations [first, last) of one block with a worker's estimator, made if needed.
  /// Thread-safe. An exception of the source becomes the block's fault.
  Block draw(const std::function<Estimator&()>& estimator, std::uint64_t first,
             std::uint64_t last) const;
  /// Adds the next block, in order.
  void fold(Block&& block);
  /// Call it on one thread after the last block of a round. Images that are all kept are summed
  /// here, element by element (sums_of_images).
  void end_drawing();
  std::uint64_t drawn() const { return running_.count; }
  bool holds(std::uint64_t count) const { return is_ready_made() || count <= drawn(); }
  /// True for moments of an earlier run: nothing is drawn, and every prefix is the whole.
  bool is_ready_made() const { return ready_made_ != nullptr; }

 private:
  std::shared_ptr<const Setup> setup_;
  const Summary* ready_made_ = nullptr;  ///< points into `setup_`
  Recipe recipe_;                        ///< without the marks, of which `prefixes_` has the sums
  std::uint64_t block_size_;
  std::size_t channels_;
  std::size_t elements_;
  friend class Drawn;

  const KeptObservations& all_kept() const { return known_ ? *known_ : *kept_; }
  std::shared_ptr<const Summary> sums_of_first(std::uint64_t count, const Summary& drawn);
  void take_details(Summary& summary) const;
  void observe(Estimator& estimator, std::uint64_t index, std::span<double> out,
               Block& block) const;
  void read_picture(std::uint64_t index, Block& block) const;
  void draw_one(Estimator& estimator, std::uint64_t index, std::span<double> out, Cost& cost) const;

  std::map<std::uint64_t, std::shared_ptr<const Summary>> prefixes_;
  std::uint64_t requested_ = 0;
  Summary running_;
  KeptValues values_;
  /// By channel and number of values: judged once for all tests and looks, on one thread.
  mutable std::map<std::pair<std::size_t, std::size_t>, std::vector<stats::Gate>> order_gates_;
  std::shared_ptr<KeptObservations> kept_ = std::make_shared<KeptObservations>();
  std::shared_ptr<const KeptObservations> known_;
  bool keeps_blocks_ = false;
  std::vector<Summary> blocks_;
  std::optional<Fault> fault_;
};

/// The observations of a pool up to a mark, all drawn. The pool must outlive it.
class Drawn {
 public:
  const Pool& pool() const { return *pool_; }
  const Summary& summary() const { return *summary_; }
  std::shared_ptr<const Summary> shared_summary() const { return summary_; }
  std::span<const double> values(std::size_t channel) const;
  /// Gates on the order of a channel's first kept values (stats::drawn_order_gates). Values that
  /// are not finite have no order.
  const std::vector<stats::Gate>& order_gates(std::size_t channel) const;
  Images images(std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) const;
  /// All blocks drawn so far, also of later observations, if the pool keeps them.
  std::span<const Summary> blocks() const { return pool_->blocks_; }

 private:
  friend class Pool;
  Drawn(const Pool& pool, std::uint64_t count, std::shared_ptr<const Summary> summary)
      : pool_(&pool), count_(count), summary_(std::move(summary)) {}

  const Pool* pool_;
  std::uint64_t count_;
  std::shared_ptr<const Summary> summary_;
};

}  // namespace assay::harness
