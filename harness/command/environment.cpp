#include "harness/command/environment.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "harness/command/options.h"

namespace assay::harness {

void take_shard_from(const Environment& environment, RunOptions& options) {
  if (options.shard) return;
  for (const std::string prefix : {"GTEST_", "TEST_"}) {
    const std::string total_name = prefix + "TOTAL_SHARDS";
    const std::string index_name = prefix + "SHARD_INDEX";
    const bool has_total = !environment(total_name).empty();
    const bool has_index = !environment(index_name).empty();
    if (has_total != has_index) {
      refuse({}, "{} is set and {} is not: set both, or neither",
             has_total ? total_name : index_name, has_total ? index_name : total_name);
    }
    if (has_total && !options.shard) {
      const unsigned total = read_part(environment(total_name), total_name, 1);
      const unsigned index = read_part(environment(index_name), index_name, 0);
      if (index >= total) {
        refuse({}, "{} is {}, but of {} shards the last is {}", index_name, index, total,
               total - 1);
      }
      options.shard = {index + 1, total};
      options.shard_of_runner = true;
    }
    const std::string status = environment(prefix + "SHARD_STATUS_FILE");
    if (!status.empty() && !std::ofstream(status, std::ios::app)) {
      refuse({.file = status}, "the status file that the environment names cannot be written");
    }
  }
  if (options.shard && options.shard->second == 1) options.shard.reset();
}

unsigned launched_tasks() {
  unsigned most = 1;
  // Open MPI; MPICH and its kin; srun, which says nothing of the kind to a batch script.
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"}) {
    most = std::max(most, read_as<unsigned>(system_environment(name)).value_or(1));
  }
  return most;
}

void join_tasks(const std::vector<std::string>& arguments) {
  const unsigned tasks = launched_tasks();
  const bool samples =
      !arguments.empty() && (arguments.front() == "run" || arguments.front() == "check");
  if (tasks == 1 || !samples) return;
  std::error_code failure;
  const auto program =
      std::filesystem::read_symlink("/proc/self/exe", failure).parent_path() / "assay-mpi";
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(pointers.front(), pointers.data());
  refuse({},
         "a launcher started {} tasks, and {} is missing, which joins them to one run: build Assay "
         "where CMake finds MPI (libopenmpi-dev), or start one task",
         tasks, program.string());
}

}  // namespace assay::harness
