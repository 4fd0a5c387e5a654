#pragma once

namespace assay::harness {

/// The first SIGINT, SIGTERM or SIGHUP from now on sets the flag that interrupted() reads. A second
/// one ends the process at once. A hang-up that nohup ignores stays ignored.
void watch_interrupts();

/// True if the user asked to stop. Anything that takes long polls it.
bool interrupted();

/// Throws std::runtime_error if the user asked to stop: pools are short then and must not be read.
void stop_if_interrupted();

}  // namespace assay::harness
