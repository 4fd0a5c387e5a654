// assay-mpi: the program `assay` whose runs are drawn by all ranks of an MPI job.

#include <fmt/format.h>
#include <mpi.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <list>
#include <map>
#include <set>

#include "estimators/library_host.h"
#include "harness/command/program.h"
#include "harness/ranks/ranks.h"

namespace assay::harness {
namespace {

class MpiMessages final : public Messages {
 public:
  MpiMessages() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }

  int rank() const { return rank_; }
  int size() const override { return size_; }

  void send(int to, std::string bytes) override {
    forget_sent();
    sending_.push_back({std::move(bytes), {}});
    Sending& all = sending_.back();
    // MPI counts in int.
    for (std::size_t first = 0; first < all.bytes.size(); first += most) {
      const std::size_t size = std::min(most, all.bytes.size() - first);
      const bool last = first + size == all.bytes.size();
      MPI_Isend(all.bytes.data() + first, static_cast<int>(size), MPI_BYTE, to,
                last ? last_part : a_part, MPI_COMM_WORLD, &all.requests.emplace_back());
    }
  }

  std::optional<Message> receive(int from) override {
    int there = 0;
    MPI_Message message{};
    MPI_Status status{};
    const auto probe = [&] {
      MPI_Improbe(from == anyone ? MPI_ANY_SOURCE : from, MPI_ANY_TAG, MPI_COMM_WORLD, &there,
                  &message, &status);
    };
    // A large message moves on only while MPI is called. A call may give the core away for
    // milliseconds, and the message of a rank that stopped never goes.
    const auto end = Clock::now() + std::chrono::microseconds(500);
    do {
      probe();
      forget_sent();
    } while (there == 0 && !(sending_.empty() && receiving_.empty()) && Clock::now() < end);
    if (there != 0) {
      int size = 0;
      MPI_Get_count(&status, MPI_BYTE, &size);
      Receiving& part =
          receiving_.emplace_back(Receiving{status.MPI_SOURCE, status.MPI_TAG == last_part});
      part.bytes.resize(static_cast<std::size_t>(size));
      MPI_Imrecv(part.bytes.data(), size, MPI_BYTE, &message, &part.request);
    }
    return received();
  }

  std::size_t arriving() const override {
    std::size_t bytes = 0;
    for (const Receiving& part : receiving_) bytes += part.bytes.size();
    for (const auto& [from, part] : parts_) bytes += part.size();
    return bytes;
  }

  void wait_until_sent() {
    for (Sending& each : sending_) {
      MPI_Waitall(static_cast<int>(each.requests.size()), each.requests.data(),
                  MPI_STATUSES_IGNORE);
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  static constexpr std::size_t most = std::size_t{1} << 30;
  static constexpr int last_part = 0;
  static constexpr int a_part = 1;

  struct Sending {
    std::string bytes;
    std::vector<MPI_Request> requests;
  };

  /// A part that is on its way. Its sender may stop for ever, so nothing waits for it.
  struct Receiving {
    int from;
    bool last;
    std::string bytes = "";
    MPI_Request request = MPI_REQUEST_NULL;
  };

  /// A message whose last part is there. Parts of one sender are taken in their order.
  std::optional<Message> received() {
    std::set<int> unfinished;
    for (auto part = receiving_.begin(); part != receiving_.end();) {
      int done = 0;
      if (!unfinished.contains(part->from)) MPI_Test(&part->request, &done, MPI_STATUS_IGNORE);
      if (done == 0) {
        unfinished.insert((part++)->from);
        continue;
      }
      std::string& bytes = parts_[part->from];
      bytes = bytes.empty() ? std::move(part->bytes) : bytes + part->bytes;
      const auto [from, last] = std::pair(part->from, part->last);
      part = receiving_.erase(part);
      if (last) return Message{from, std::exchange(bytes, {})};
    }
    return std::nullopt;
  }

  void forget_sent() {
    std::erase_if(sending_, [](Sending& each) {
      int done = 0;
      MPI_Testall(static_cast<int>(each.requests.size()), each.requests.data(), &done,
                  MPI_STATUSES_IGNORE);
      return done != 0;
    });
  }

  int rank_ = 0;
  int size_ = 1;
  std::list<Sending> sending_;
  std::list<Receiving> receiving_;
  std::map<int, std::string> parts_;
};

// Seconds. Thousands of ranks meet in a fraction of it.
constexpr unsigned most_until_met = 120;

void end_unmet(int) {
  constexpr char words[] =
      "assay: the ranks have not met after two minutes: one of them hangs or was stopped; start "
      "the job again\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, words, sizeof words - 1);
  _exit(2);
}

/// MPI_Init waits for all ranks, for ever. A rank that ends makes the launcher end the others.
void meet() {
  std::signal(SIGALRM, end_unmet);
  alarm(most_until_met);
  int granted = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &granted);
  alarm(0);
}

int joined_program(const std::vector<std::string>& arguments) {
  meet();
  MpiMessages messages;
  int code = 2;
  const unsigned tasks = launched_tasks();
  if (messages.size() == 1 && tasks > 1) {
    fmt::print(stderr,
               "assay: a launcher started {} tasks that MPI does not connect; start them by the "
               "mpirun of the MPI that Assay was built with, or by `srun --mpi=pmix`\n",
               tasks);
  } else {
    code = messages.rank() > 0 ? program_of_rank(arguments, messages)
                               : program(arguments, messages.size() > 1 ? &messages : nullptr);
  }
  std::fflush(nullptr);
  if (messages.rank() == 0 && !dismiss(messages)) MPI_Abort(MPI_COMM_WORLD, code);
  messages.wait_until_sent();
  MPI_Finalize();
  return code;
}

}  // namespace
}  // namespace assay::harness

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  // A host of a library is no rank.
  const bool hosts = !arguments.empty() && arguments.front() == assay::library_host_word;
  return hosts ? assay::harness::program(arguments) : assay::harness::joined_program(arguments);
}
