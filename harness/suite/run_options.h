#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "harness/suite/selection.h"

namespace assay::harness {

class Executor;
class Messages;

struct RunOptions {
  std::optional<std::uint64_t> seed = {};                   ///< Default: the suite's, else 1.
  unsigned threads = 0;                                     ///< 0: all cores.
  std::shared_ptr<Executor> executor = {};                  ///< Draws blocks; null: the threads.
  std::optional<double> alpha = {};                         ///< Replaces every suite's alpha.
  double coarsen = 1;                                       ///< Multiplies every `detect`.
  Selection selection = {};                                 ///< Empty: all tests.
  std::optional<std::pair<unsigned, unsigned>> shard = {};  ///< I of N, I from 1.
  bool shard_of_runner = false;  ///< Set by a test runner: a shard may be empty.
  bool fail_fast = false;        ///< Draws no more once a claim is broken, the cheapest look first.
  Messages* ranks = nullptr;     ///< Other ranks that draw; null: none.
  std::string checkpoint = "";   ///< File to go on from after a kill; "": none.
  double checkpoint_every = 60;  ///< Seconds between two writes of it.
  std::string ledger = "";       ///< File to add the evidence to; "": none.
  std::string command = "";      ///< Repeats the run, but for its suites; for replay lines.
  bool assigns = false;          ///< Parameters are set, perhaps those of one suite alone.
};

}  // namespace assay::harness
