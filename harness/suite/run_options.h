#pragma once

// What a command line says of a run.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "harness/suite/selection.h"

namespace assay::harness {

struct RunOptions {
  std::optional<std::uint64_t> seed = {};                   ///< else the suite's, else 1
  unsigned threads = 0;                                     ///< 0: all cores
  std::optional<double> alpha = {};                         ///< instead of every suite's
  double coarsen = 1;                                       ///< multiplies every `detect`
  Selection selection = {};                                 ///< of tests; empty selects all
  std::optional<std::pair<unsigned, unsigned>> shard = {};  ///< I of N, I from 1
  bool shard_of_runner = false;  ///< a test runner's, for which a shard without tests is no mistake
  std::string ledger = "";       ///< file to add the evidence to; "": none
  std::string command = "";      ///< how to run the same again, for replay lines
};

}  // namespace assay::harness
