#pragma once

namespace assay::harness {

/// From now on the first SIGINT, SIGTERM or SIGHUP sets a flag that interrupted() reads, and a
/// second one ends the process at once. A hang-up that nohup had ignored stays so.
void watch_interrupts();

/// Whether the user asked to stop. Anything that takes long polls it.
bool interrupted();

/// Throws std::runtime_error where the user asked to stop: pools are short then and must not be
/// read.
void stop_if_interrupted();

}  // namespace assay::harness
