#pragma once

// Files that another program makes, one an observation, kept on disk.

#include <cstdint>
#include <map>
#include <mutex>
#include <semaphore>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "estimators/rendered.h"
#include "estimators/stream.h"

namespace assay::foreign {

// Seeds for programs that take a positive 31-bit integer.

inline constexpr std::uint64_t render_seeds = 0x7fffffff;  ///< 2^31 - 1, a prime: seeds 1 to this

/// The first seed of a stream, before seeds are scattered.
constexpr std::uint64_t first_render_seed(StreamKey key) { return key.bits % render_seeds; }

/// The seed of one observation: 1 + a (key + observation) mod p, with p = 2^31 - 1. The multiplier
/// a = 630360016 is that of Payne, Rabung and Bogyo (1969). Multiplying is one-to-one: the first p
/// observations of a stream have different seeds. Neighbours have seeds far apart.
constexpr std::uint32_t render_seed(StreamKey key, std::uint64_t observation) {
  const std::uint64_t place = (first_render_seed(key) + observation % render_seeds) % render_seeds;
  return static_cast<std::uint32_t>(1 + 630360016 * place % render_seeds);
}

/// The seeds that streams have used in this process. Two streams of n and m observations meet by
/// chance with probability about (n + m) / 2^31. Their pictures would then be the same.
class SeedLedger {
 public:
  /// Notes an observation. Throws std::runtime_error where its seed is another stream's.
  void note(StreamKey key, std::uint64_t observation);

 private:
  std::mutex mutex_;
  std::map<std::uint64_t, std::uint64_t> counts_;  ///< of each key, observations up to the last
};

/// True if a word of the command has this place, as `{seed}`.
bool has_place(const std::vector<std::string>& command, std::string_view place);

/// How a file is made. In the words of the command `{seed}`, `{samples}` and `{out}` stand for the
/// seed, the number of primaries and the file to write. With `{seeds}` one program makes several:
/// it is given seeds with commas between, and `{out}` is the folder in which it writes SEED.ENDING.
struct Rendering {
  std::vector<std::string> command;
  std::vector<std::string> depends = {};  ///< Files that also change the result.
  std::string folder = "";                ///< Folder in which the program runs.
  std::string cache = "";                 ///< Folder of the files that are kept.
  std::string ending = "exr";             ///< Ending of the files.
  double timeout = 600;                   ///< Seconds for one file, from a program's start.
  std::uint64_t retries = 0;              ///< Times that a failed program is started again.
  double memory = 0;                      ///< MiB; 0: no limit.
  std::uint64_t jobs = 1;                 ///< Programs at a time.

  bool takes_several() const { return has_place(command, "{seeds}"); }
};

/// A rendering that cannot be made, and which member of it is to blame: `depends` or `cache`.
class RenderingError : public std::runtime_error {
 public:
  RenderingError(std::string member, const std::string& why)
      : std::runtime_error(why), member_(std::move(member)) {}
  const std::string& member() const { return member_; }

 private:
  std::string member_;
};

/// A run of observations, each of so many primaries.
struct Wanted {
  StreamKey key;
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  std::uint64_t samples = 1;
};

/// The files of one rendering. Thread-safe.
///
/// They stand in `cache`/HASH/SEED.ENDING; the file command.txt beside them says what they are.
/// HASH is of the command before it is filled in, the samples, the folder, and every file that the
/// command or `depends` names. A file counts by its contents; a program, or a file beyond 16 MiB,
/// by size and time of change. An argument names files by itself, as `--scene=FILE`, and as a line
/// of a shell does.
///
/// A file is renamed from another name once the program has ended with status 0. So every file is
/// whole, and an interrupted run goes on where it stopped.
class Renderings {
 public:
  /// Throws RenderingError where a file of `depends` is not there.
  explicit Renderings(Rendering rendering);

  /// Makes what is missing, `jobs` at a time. A program that fails is started again by the same
  /// words, which notice() tells. The last failures are kept for file() to tell. CPU seconds of
  /// the programs, without those of programs that they start and do not wait for. Throws
  /// RenderingError where the cache cannot be made.
  double make(const Wanted& wanted);
  /// The files of a stream's first observations that are not there, each with a shell's line that
  /// makes it under another name and renames it.
  std::vector<MissingFile> missing(StreamKey key, std::uint64_t count, std::uint64_t samples);
  /// The programs that were started again, by seed.
  std::vector<Retry> retries();
  bool takes_samples() const { return has_place(rendering_.command, "{samples}"); }
  /// The file of one observation, made or not.
  std::string path_of(StreamKey key, std::uint64_t observation, std::uint64_t samples);
  /// The file of one observation, which has been made. Throws std::runtime_error with the command,
  /// how it ended and the end of its standard error.
  std::string file(StreamKey key, std::uint64_t observation, std::uint64_t samples);

 private:
  struct Task {
    std::vector<std::uint32_t> seeds;
    std::uint64_t samples;
  };

  std::string folder_of(std::uint64_t samples);
  std::string path_of(std::uint64_t samples, std::uint32_t seed);
  std::vector<Task> tasks_of(const Wanted& wanted);
  double run(Task task);
  std::vector<std::string> words_of(const Task& task, const std::string& out) const;
  std::string attempt(Task& task, const std::string& part, double& cpu_seconds);
  std::string run_program(const Task& task, const std::string& out, double& cpu_seconds);
  std::string failure_of(std::uint64_t samples, std::uint32_t seed);

  Rendering rendering_;
  std::string stamp_;  ///< of the command and what it reads
  std::counting_semaphore<> free_jobs_;
  std::mutex mutex_;
  std::map<std::uint64_t, std::string> folders_;  ///< by samples
  std::map<std::pair<std::uint64_t, std::uint32_t>, std::string> failures_;
  std::vector<Retry> retries_;
};

}  // namespace assay::foreign
