#pragma once

// A checkpoint keeps what pools have drawn in two files, so that a run that was killed goes on.
// Everything else follows from that: pilots, plans, looks and verdicts come again by themselves.

#include <chrono>
#include <map>
#include <memory>
#include <string>

#include "harness/base/identity.h"
#include "harness/base/text_file.h"
#include "harness/sampling/executor.h"

namespace assay::harness {

/// This part of FILE.kept has what a pool keeps of a block.
struct KeptPart {
  std::uint64_t place;
  std::uint64_t size;
};

/// A pool's observations when it was last written.
struct WrittenPool {
  Pool::Block sums;  ///< It keeps nothing.
  std::vector<KeptPart> kept = {};
  std::weak_ptr<Pool> pool = {};  ///< The pool lives as long as this run needs it.
};

/// Draws by another executor. Now and then, at the end of a round and when the user interrupts, it
/// writes what pools have drawn. FILE holds their sums and is written whole or not at all.
/// FILE.kept holds what they keep, and only grows. Pools of the same set-ups and recipes begin
/// there.
///
/// Observations that no writing holds are drawn again. So are rows and pictures of files, and pools
/// that are compared by their seconds.
class Checkpoint final : public Executor {
 public:
  /// Reads FILE if it is there. InputError if it is of another run. std::runtime_error if a file
  /// cannot be written, or if another run writes it.
  Checkpoint(std::string file, std::chrono::duration<double> pause, Identity identity,
             std::shared_ptr<Executor> inner);

  void introduce(const NamedSetups& setups) override;
  void recall(const SomePools& pools) override;
  void draw(Round& round) override;
  /// Call it when the run's reports are written.
  void remove() const;

  static std::string kept_file(const std::string& file) { return file + ".kept"; }

 private:
  using Clock = std::chrono::steady_clock;

  void read();
  void open_kept(bool is_resumed);
  void write();
  void update(const std::string& recipe, WrittenPool& written, const Pool& pool);
  /// False if it fails, which is said: a full disk must not end a long run.
  bool try_to_write();
  void resume(const std::string& recipe, const WrittenPool& written, Pool& pool) const;

  std::string file_;
  Clock::duration pause_;
  Identity identity_;
  std::shared_ptr<Executor> inner_;
  std::map<std::shared_ptr<const Setup>, std::string> names_;
  std::unique_ptr<GrowingFile> kept_;
  std::map<std::string, WrittenPool> pools_;  ///< By packed recipe.
  Clock::time_point soonest_;                 ///< Writing again may begin.
  Clock::time_point due_;
};

}  // namespace assay::harness
