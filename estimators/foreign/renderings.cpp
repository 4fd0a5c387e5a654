#include "estimators/foreign/renderings.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/algorithm/string.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <ranges>
#include <stdexcept>
#include <thread>
#include <utility>

#include "estimators/core/mapped.h"
#include "estimators/core/quoting.h"
#include "estimators/core/waiting.h"
#include "estimators/foreign/child.h"
#include "estimators/foreign/protocol.h"

namespace assay::foreign {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t most_read = std::uintmax_t{16} << 20;
constexpr const char* part_prefix = "part-";

// Seeds of all renderings of this process.
SeedLedger seed_ledger;

/// FNV-1a of 128 bits (Fowler, Noll, Vo, Eastlake and Hansen 2019): files are told apart by it.
class Hash {
 public:
  void add(std::string_view text) {
    for (const char c : text) {
      state_ = (state_ ^ static_cast<unsigned char>(c)) * prime;
    }
    // The length, so that "ab" "c" is not "a" "bc".
    for (std::size_t n = text.size(), i = 0; i < 8; ++i, n >>= 8) {
      state_ = (state_ ^ (n & 0xff)) * prime;
    }
  }
  std::string text() const {
    constexpr const char* digits = "0123456789abcdef";
    std::string out;
    for (int shift = 124; shift >= 0; shift -= 4) {
      out += digits[static_cast<unsigned>(state_ >> shift) & 15U];
    }
    return out;
  }

 private:
  __extension__ using Word = unsigned __int128;
  static constexpr Word prime = (Word{1} << 88) + 0x13b;
  Word state_ = (Word{0x6c62272e07bb0142} << 64) + 0x62b821756295c58d;
};

fs::path if_executable(const fs::path& file) {
  std::error_code ignored;
  const bool good = fs::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0;
  return good ? file : fs::path();
}

/// Size and time of change, or the contents of a file that is not large.
std::string stamp_of(const fs::path& file, bool program) {
  const std::uintmax_t size = fs::file_size(file);
  if (program || size > most_read) {
    const auto changed = fs::last_write_time(file).time_since_epoch().count();
    return std::to_string(size) + " " + std::to_string(changed);
  }
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The words of an argument that may name a file: all of it, the part after a `=`, and the words of
/// a shell's line.
std::vector<std::string> names_in(const std::string& argument) {
  std::vector<std::string> names;
  boost::split(names, argument, boost::is_space() || boost::is_any_of("=;&|<>()\"'`"));
  std::erase_if(names, [&](const std::string& name) { return name.empty() || name == argument; });
  names.insert(names.begin(), argument);
  return names;
}

void add_files(const std::string& argument, const std::string& folder, Hash& hash) {
  const bool line = argument.find(' ') != argument.npos;  // as after `sh -c`
  std::error_code ignored;
  for (const std::string& name : names_in(argument)) {
    const fs::path file = fs::path(folder) / name;
    if (fs::is_regular_file(file, ignored)) {
      hash.add(stamp_of(file, false));
    } else if (const std::string program = line ? program_path(name, folder) : "";
               !program.empty()) {
      hash.add(stamp_of(program, true));
    }
  }
}

std::string stamp_of(const Rendering& rendering) {
  Hash hash;
  hash.add("command 2");
  std::error_code ignored;
  hash.add(fs::weakly_canonical(rendering.folder, ignored).string());
  hash.add(rendering.ending);
  for (const std::string& argument : rendering.command) hash.add(argument);
  const std::string program = program_path(rendering.command.front(), rendering.folder);
  if (fs::is_regular_file(program, ignored)) hash.add(stamp_of(program, true));
  for (const std::string& argument : rendering.command | std::views::drop(1)) {
    add_files(argument, rendering.folder, hash);
  }
  for (const std::string& file : rendering.depends) {
    const fs::path path = fs::path(rendering.folder) / file;
    if (!fs::is_regular_file(path, ignored)) {
      throw RenderingError(
          "depends", "there is no file `" + file + "`; the path starts at the suite's folder");
    }
    hash.add(stamp_of(path, false));
  }
  return hash.text();
}

/// Removes the unfinished files of programs that no longer run.
void remove_leftovers(const fs::path& folder) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(part_prefix)) continue;
    const int process = std::atoi(name.c_str() + std::string_view(part_prefix).size());
    const bool gone = process > 0 && ::kill(process, 0) != 0 && errno == ESRCH;
    if (gone) fs::remove_all(entry.path(), ignored);
  }
}

/// A name in the folder that nobody else has, removed with whatever stands there at the end.
class Unfinished {
 public:
  Unfinished(const std::string& folder, const std::string& ending) {
    static std::atomic<std::uint64_t> count{0};
    path_ = folder + "/" + part_prefix + std::to_string(getpid()) + "-" + std::to_string(count++) +
            ending;
  }
  ~Unfinished() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

void SeedLedger::note(StreamKey key, std::uint64_t observation) {
  const std::scoped_lock lock(mutex_);
  std::uint64_t& count = counts_[key.bits];
  if (observation < count) return;
  if (observation >= render_seeds) {
    throw std::runtime_error("there are no more than 2^31 - 1 seeds for observations");
  }
  count = observation + 1;
  const std::uint64_t begin = first_render_seed(key);
  for (const auto& [other, length] : counts_) {
    if (other == key.bits) continue;
    // Two arcs of a circle meet where one begins within the other.
    const std::uint64_t there = first_render_seed({other});
    const std::uint64_t ahead = (there + render_seeds - begin) % render_seeds;
    const std::uint64_t behind = (begin + render_seeds - there) % render_seeds;
    if (ahead >= count && behind >= length) continue;
    throw std::runtime_error(
        "observation " + std::to_string(observation) +
        " would have a seed that another estimator of this run has used, and the pictures would "
        "not be independent; choose another --seed");
  }
}

bool has_place(const std::vector<std::string>& command, std::string_view place) {
  return std::ranges::any_of(
      command, [&](const std::string& word) { return word.find(place) != word.npos; });
}

Renderings::Renderings(Rendering rendering)
    : rendering_(std::move(rendering)),
      stamp_(stamp_of(rendering_)),
      free_jobs_(static_cast<std::ptrdiff_t>(rendering_.jobs)) {}

std::string Renderings::folder_of(std::uint64_t samples) {
  const std::scoped_lock lock(mutex_);
  std::string& folder = folders_[samples];
  if (!folder.empty()) return folder;
  Hash hash;
  hash.add(stamp_);
  hash.add(std::to_string(samples));
  const std::string path = (fs::path(rendering_.cache) / hash.text()).string();
  std::error_code error;
  fs::create_directories(path, error);
  if (error) {
    throw RenderingError("cache", "the folder `" + path + "` cannot be made: " + error.message());
  }
  remove_leftovers(path);
  std::ofstream(path + "/command.txt") << listed(rendering_.command, " ") << "\nin "
                                       << rendering_.folder << ", samples " << samples << "\n";
  return folder = path;
}

std::string Renderings::path_of(std::uint64_t samples, std::uint32_t seed) {
  return folder_of(samples) + "/" + std::to_string(seed) + "." + rendering_.ending;
}

std::vector<Renderings::Task> Renderings::tasks_of(const Wanted& wanted) {
  std::vector<std::uint32_t> seeds;
  for (std::uint64_t i = wanted.first; i < wanted.last; ++i) {
    seed_ledger.note(wanted.key, i);
    const std::uint32_t seed = render_seed(wanted.key, i);
    const bool failed = !failure_of(wanted.samples, seed).empty();
    if (!failed && !fs::exists(path_of(wanted.samples, seed))) seeds.push_back(seed);
  }
  if (rendering_.takes_several()) {
    if (seeds.empty()) return {};
    return {{.seeds = std::move(seeds), .samples = wanted.samples}};
  }
  return mapped(seeds, [&](std::uint32_t seed) -> Task { return {{seed}, wanted.samples}; });
}

std::vector<std::string> Renderings::words_of(const Task& task, const std::string& out) const {
  const auto text_of = [](std::uint32_t seed) { return std::to_string(seed); };
  const std::string seeds = listed(mapped(task.seeds, text_of), ",");
  return mapped(rendering_.command, [&](std::string word) {
    boost::replace_all(word, "{seeds}", seeds);
    boost::replace_all(word, "{seed}", std::to_string(task.seeds.front()));
    boost::replace_all(word, "{samples}", std::to_string(task.samples));
    boost::replace_all(word, "{out}", out);
    return word;
  });
}

/// Why it failed, "" where it ended well. Its CPU seconds are added.
std::string Renderings::run_program(const Task& task, const std::string& out, double& cpu_seconds) {
  const Launch launch{
      .command = words_of(task, out), .folder = rendering_.folder, .memory = rendering_.memory};
  const double seconds = rendering_.timeout * static_cast<double>(task.seeds.size());
  std::string failure;
  Child child(launch);
  const Deadline deadline = std::chrono::steady_clock::now() +
                            std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * seconds));
  child.close_input();
  try {
    std::array<char, 4096> said{};
    while (child.receive(said, deadline) > 0) {
    }
    if (!child.ends_by(deadline)) throw TimeOut("time-out");
    const std::string ending = child.ending();
    if (ending != "ended with exit status 0") failure = ending;
  } catch (const TimeOut&) {
    child.kill();
    failure =
        "took more than " + shortest_text(seconds) + " s and was ended; give it a larger `timeout`";
  }
  cpu_seconds += child.cpu_seconds();
  if (failure.empty()) return "";
  return "`" + listed(launch.command, " ") + "` " + failure + ending_with(child.last_errors());
}

/// Makes the files and removes their seeds from the task. Why those that are left could not be
/// made.
std::string Renderings::attempt(Task& task, const std::string& part, double& cpu_seconds) {
  const bool several = rendering_.takes_several();
  fs::remove_all(part);
  if (several) fs::create_directories(part);
  // A file that was made before a program of several failed may or may not be whole.
  const std::string failure = run_program(task, part, cpu_seconds);
  if (!failure.empty()) return failure;
  std::erase_if(task.seeds, [&](std::uint32_t seed) {
    const std::string name = std::to_string(seed) + "." + rendering_.ending;
    std::error_code error;
    fs::rename(several ? part + "/" + name : part, path_of(task.samples, seed), error);
    return !error;
  });
  if (task.seeds.empty()) return "";
  return "`" + listed(rendering_.command, " ") + "` succeeded but wrote no file for the seed " +
         std::to_string(task.seeds.front()) +
         (several ? ": it must write SEED." + rendering_.ending + " in the folder `{out}`"
                  : ": it must write the file `{out}`");
}

/// CPU seconds. Failures are kept, not thrown.
double Renderings::run(Task task) {
  double seconds = 0;
  std::string failure;
  try {
    const Unfinished part(folder_of(task.samples),
                          rendering_.takes_several() ? "" : "." + rendering_.ending);
    failure = attempt(task, part.path(), seconds);
    const std::string of_all = " of " + std::to_string(rendering_.retries);
    for (std::uint64_t retry = 1; !failure.empty() && retry <= rendering_.retries; ++retry) {
      notice(failure + "; it is started again, retry " + std::to_string(retry) + of_all);
      {
        const std::scoped_lock lock(mutex_);
        for (const std::uint32_t seed : task.seeds) retries_.push_back({seed, retry, failure});
      }
      failure = attempt(task, part.path(), seconds);
    }
    if (!failure.empty() && rendering_.retries > 0) {
      failure += "; it has failed " + std::to_string(rendering_.retries + 1) +
                 " times (`retries: " + std::to_string(rendering_.retries) + "`)";
    }
  } catch (const std::exception& error) {
    failure = error.what();  // an interruption, or a program that cannot be started
  }
  const std::scoped_lock lock(mutex_);
  for (const std::uint32_t seed : task.seeds) failures_[{task.samples, seed}] = failure;
  return seconds;
}

double Renderings::make(const Wanted& wanted) {
  const std::vector<Task> tasks = tasks_of(wanted);
  std::atomic<std::size_t> next{0};
  std::atomic<double> seconds{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < tasks.size(); i = next++) {
      free_jobs_.acquire();
      seconds += run(tasks[i]);
      free_jobs_.release();
    }
  };
  const std::size_t helpers = std::min<std::size_t>(tasks.size(), rendering_.jobs);
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < helpers; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  return seconds;
}

std::vector<MissingFile> Renderings::missing(StreamKey key, std::uint64_t count,
                                             std::uint64_t samples) {
  std::vector<MissingFile> files;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint32_t seed = render_seed(key, i);
    const std::string file = path_of(samples, seed);
    if (fs::exists(file)) continue;
    // No process has this number: the next run does not take it for a leftover.
    const std::string part = folder_of(samples) + "/" + part_prefix + "of-" + std::to_string(seed);
    const bool several = rendering_.takes_several();
    const std::string out = several ? part : part + "." + rendering_.ending;
    std::string line = "cd " + shell_quoted(fs::absolute(rendering_.folder).string()) + " &&";
    if (several) line += " mkdir -p " + shell_quoted(out) + " &&";
    for (const std::string& word : words_of({{seed}, samples}, out)) {
      line += " " + shell_quoted(word);
    }
    const std::string made = several ? out + "/" + fs::path(file).filename().string() : out;
    line += " && mv " + shell_quoted(made) + " " + shell_quoted(file);
    if (several) line += " && rmdir " + shell_quoted(out);
    files.push_back({line, seed, file});
  }
  return files;
}

std::vector<Retry> Renderings::retries() {
  const std::scoped_lock lock(mutex_);
  std::vector<Retry> all = retries_;
  std::ranges::sort(all, {}, [](const Retry& each) { return std::pair(each.seed, each.retry); });
  return all;
}

std::string Renderings::failure_of(std::uint64_t samples, std::uint32_t seed) {
  const std::scoped_lock lock(mutex_);
  const auto found = failures_.find({samples, seed});
  return found == failures_.end() ? "" : found->second;
}

std::string Renderings::path_of(StreamKey key, std::uint64_t observation, std::uint64_t samples) {
  return path_of(samples, render_seed(key, observation));
}

std::string Renderings::file(StreamKey key, std::uint64_t observation, std::uint64_t samples) {
  const std::uint32_t seed = render_seed(key, observation);
  const std::string failure = failure_of(samples, seed);
  if (!failure.empty()) throw std::runtime_error(failure);
  return path_of(samples, seed);
}

fs::path program_path(const std::string& word, const fs::path& folder) {
  if (word.find('/') != word.npos) return if_executable(folder / word);
  const char* const variable = std::getenv("PATH");
  std::string rest = variable == nullptr ? "/usr/bin:/bin" : variable;
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    const fs::path found = if_executable(fs::path(rest.substr(0, colon)) / word);
    if (!found.empty()) return found;
    rest.erase(0, colon + 1);
  }
  return {};
}

}  // namespace assay::foreign
