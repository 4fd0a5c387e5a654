#pragma once

#include <optional>
#include <string>

namespace assay::harness {

/// Messages between the ranks of a job: processes of one command that a launcher such as mpirun
/// started. Those of one sender arrive in their order.
class Messages {
 public:
  struct Message {
    int from;
    std::string bytes;
  };

  virtual ~Messages() = default;
  virtual int rank() const = 0;  ///< of this process, from 0
  virtual int size() const = 0;
  /// Does not wait for the receiver.
  virtual void send(int to, std::string bytes) = 0;
  /// The next message that is there; nullopt if none is.
  virtual std::optional<Message> receive() = 0;
};

}  // namespace assay::harness
