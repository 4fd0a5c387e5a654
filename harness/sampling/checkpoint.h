#pragma once

// A checkpoint keeps what pools have drawn in a file, so that a run that was killed goes on.
// Everything else follows from that: pilots, plans, looks and verdicts come again by themselves.

#include <chrono>
#include <map>
#include <memory>
#include <string>

#include "harness/base/identity.h"
#include "harness/sampling/executor.h"

namespace assay::harness {

/// Draws by another executor. Now and then, and when the user interrupts, it writes all that pools
/// have drawn, whole or not at all. Pools of the same set-ups and recipes begin there.
///
/// A pool whose source failed is drawn again. So are rows and pictures of files, and pools that are
/// compared by their seconds.
class Checkpoint final : public Executor {
 public:
  /// Reads the file if it is there. InputError if it is of another run, or cannot be written.
  Checkpoint(std::string file, std::chrono::duration<double> pause, Identity identity,
             std::shared_ptr<Executor> inner);

  void introduce(const NamedSetups& setups) override;
  void recall(const SomePools& pools) override;
  void draw(Round& round) override;
  /// Call it when the run's reports are written.
  void remove() const;

 private:
  void read();
  void write() const;
  void write_if_due();

  std::string file_;
  std::chrono::steady_clock::duration pause_;
  Identity identity_;
  std::shared_ptr<Executor> inner_;
  std::map<const Setup*, std::string> names_;
  std::map<std::string, std::string> read_;  ///< Packed blocks by packed recipe.
  std::map<std::string, std::shared_ptr<Pool>> pools_;
  std::chrono::steady_clock::time_point due_;
};

}  // namespace assay::harness
