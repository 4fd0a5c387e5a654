#pragma once

// Ranks draw blocks for rank 0. It alone plans, folds, judges and reports, so that a record does
// not depend on how many there are.

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/base/identity.h"
#include "harness/sampling/executor.h"

namespace assay::harness {

/// Messages between the ranks of a job: processes of one command that a launcher such as mpirun
/// started. Those of one sender arrive in their order.
class Messages {
 public:
  struct Message {
    int from;
    std::string bytes;
  };

  static constexpr int anyone = -1;

  virtual ~Messages() = default;
  virtual int size() const = 0;
  /// Does not wait for the receiver.
  virtual void send(int to, std::string bytes) = 0;
  /// The next message that is there; nullopt if none is. Nothing begins to arrive from others than
  /// `from`: they keep what they sent.
  virtual std::optional<Message> receive(int from) = 0;
  /// Bytes of messages that have begun to arrive.
  virtual std::size_t arriving() const = 0;
};

/// Every rank makes this of the suites by itself.
struct PreparedRank {
  Identity identity = {};
  NamedSetups setups = {};
  unsigned threads = 1;
  std::shared_ptr<const void> owner = {};  ///< of what the set-ups refer to
};

/// Rank 0: gives blocks to ranks that have room, draws too, and folds all in order. Blocks that a
/// rank keeps for too long are drawn again here.
class Ranks final : public Executor {
 public:
  /// Bytes of blocks that may wait on rank 0 for an earlier one.
  static constexpr std::size_t usual_window = 128'000'000;

  /// Other ranks begin to prepare, with this seed.
  Ranks(Messages& messages, std::optional<std::uint64_t> seed, Identity identity, unsigned threads,
        std::size_t window_bytes = usual_window);

  /// Waits for the ranks. Refuses by name one of another run, and one that could not prepare.
  void introduce(const NamedSetups& setups) override;
  void draw(Round& round) override;

 private:
  using Clock = std::chrono::steady_clock;
  class Window;
  struct Rank {
    std::string host = "";
    unsigned threads = 0;  ///< 0: it has not answered yet
    std::size_t batches = 0;
    std::set<std::size_t> recipes = {};
  };
  struct Batch {
    int rank;
    std::uint64_t round;
    std::vector<std::uint64_t> slots;
    Clock::time_point sent;
  };

  std::string name_of(int rank) const;
  void greet(const Messages::Message& message);
  bool take_replies(Window& window);
  void take_reply(const Messages::Message& message, Window& window);
  void give(Window& window);

  Messages& messages_;
  Identity identity_;
  unsigned threads_;
  std::size_t window_bytes_;
  Clock::time_point begun_ = Clock::now();
  std::vector<Rank> ranks_;
  std::map<std::shared_ptr<const Setup>, std::string> names_;
  std::map<std::uint64_t, Batch> batches_;  ///< by number; may be of earlier rounds
  std::uint64_t next_batch_ = 0;
  std::uint64_t round_ = 0;
};

/// Rank 0 says that nothing more is to be drawn. False if a rank does not answer.
bool dismiss(Messages& messages);

/// Another rank: prepares by rank 0's seed, and draws blocks until it is dismissed. After an
/// interruption it draws nothing: rank 0, which is interrupted too or draws again, decides.
void serve(Messages& messages,
           const std::function<PreparedRank(std::optional<std::uint64_t> seed)>& prepare);

}  // namespace assay::harness
