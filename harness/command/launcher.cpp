#include "harness/command/launcher.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "estimators/core/value.h"

namespace assay::harness {

unsigned launched_tasks(const Environment& environment) {
  unsigned most = 1;
  // Open MPI; MPICH and its kin; srun, which says nothing of the kind to a batch script.
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"}) {
    const std::string text = environment(name);
    unsigned tasks = 1;
    std::from_chars(text.data(), text.data() + text.size(), tasks);
    most = std::max(most, tasks);
  }
  return most;
}

void join_tasks(const std::vector<std::string>& arguments, const Environment& environment) {
  const unsigned tasks = launched_tasks(environment);
  const bool samples =
      !arguments.empty() && (arguments.front() == "run" || arguments.front() == "check");
  if (tasks == 1 || !samples) return;
  std::error_code failure;
  const auto program =
      std::filesystem::read_symlink("/proc/self/exe", failure).parent_path() / joining_program;
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(pointers.front(), pointers.data());
  throw InputError(
      {},
      fmt::format("a launcher started {} tasks, and {} is missing, which joins them to one run: "
                  "build Assay where CMake finds MPI (libopenmpi-dev), or start one task",
                  tasks, program.string()));
}

}  // namespace assay::harness
