#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "harness/suite/suite.h"

namespace assay::harness {

struct Selection {
  /// Globs on whole ids, suite/name. A glob that begins with `-` excludes tests.
  std::vector<std::string> filters = {};
  std::vector<std::string> tags = {};

  bool empty() const { return filters.empty() && tags.empty(); }
};

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

/// True if the test has one of the tags, matches an including filter, and matches no excluding one.
/// An empty list selects everything.
bool selects(const Selection& selection, const TestEntry& test);

/// An option's words for a shell, each after a blank: " --tag 'a b' --tag c". Without a name they
/// are arguments.
std::string option_words(const std::string& option, const std::vector<std::string>& values);

/// The options that make the selection, each after a blank: " --filter '*/mean*' --tag slow".
std::string options_text(const Selection& selection);

/// An error message if a tag or an including filter matches nothing, or no test is left; else "".
/// It lists the tags, or the nearest ids.
std::string unmatched(const std::vector<Suite>& suites, const Selection& selection);

}  // namespace assay::harness
