#pragma once

// `assay` under a launcher of several tasks, such as mpirun or srun: they become ranks of one run.

#include <string>
#include <vector>

#include "harness/base/environment_variables.h"

namespace assay::harness {

/// How many tasks of this command a launcher's environment tells of; 1 without one.
unsigned launched_tasks(const Environment& environment);

/// The program that joins several tasks to one run: `assay-mpi` beside `assay`.
inline const std::string joining_program = "assay-mpi";

/// Replaces the process by joining_program if it is one of several tasks of a command that samples.
/// Returns if it is not; InputError if that program is missing.
void join_tasks(const std::vector<std::string>& arguments, const Environment& environment);

}  // namespace assay::harness
