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

/// Bytes of a file.
struct FilePart {
  std::uint64_t first;
  std::uint64_t size;
};

/// What a pool has drawn, as the files have it.
struct DrawnPool {
  std::string sums = "";
  std::vector<FilePart> kept = {};
};

/// Draws by another executor. Now and then, and when the user interrupts, it writes the sums of all
/// that pools have drawn, whole or not at all. What pools keep grows, and is added to a second
/// file, of which the first names the parts. Pools of the same set-ups and recipes begin there.
///
/// What was drawn since the last writing is drawn again. So are rows and pictures of files, and
/// pools that are compared by their seconds.
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
  struct Known {
    DrawnPool drawn = {};           ///< As it stands in the files.
    std::uint64_t kept_end = 0;     ///< Of the observations in the second file.
    std::weak_ptr<Pool> pool = {};  ///< Once this process draws it, and as long as it needs it.
  };

  void read();
  void write();
  void update(Known& known, const Pool& pool);
  void write_if_due();
  void resume(Known& known, Pool& pool) const;
  std::string bytes_of(const FilePart& part) const;

  std::string file_;
  std::chrono::steady_clock::duration pause_;
  Identity identity_;
  std::shared_ptr<Executor> inner_;
  std::map<const Setup*, std::string> names_;
  std::string kept_file_;
  std::uint64_t kept_size_ = 0;
  std::map<std::string, Known> pools_;  ///< By packed recipe.
  std::chrono::steady_clock::time_point due_;
};

}  // namespace assay::harness
