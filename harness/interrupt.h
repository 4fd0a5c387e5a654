#pragma once

namespace assay::harness {

/// From now on the first SIGINT sets a flag that interrupted() reads, and a second one ends the
/// process at once.
void watch_interrupts();

/// Whether the user asked to stop. Anything that takes long polls it.
bool interrupted();

}  // namespace assay::harness
