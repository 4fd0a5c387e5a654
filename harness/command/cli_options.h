#pragma once

// Which commands and options there are, what --help says of each, and the words of a command line
// sorted by them.

#include <string>
#include <vector>

namespace assay::harness {

using Texts = std::vector<std::string>;

/// Every option's text as it was typed; empty where it was not. CLI11 sorts the words (and is seen
/// by cli_options.cpp alone, as it takes ten seconds to compile), our own functions read the
/// values, so that messages are alike everywhere.
struct Given {
  std::string claim, source, what, plugin, record, test, observation, runs, samples;
  Texts suites, estimators, sets, reports, methods, laws, alphas, records, filters, tags;
  std::string seed, threads, alpha, coarsen, shard, ledger, inconclusive, colour, github;
  std::string candidate, pictures, channels, pixels, picture_samples, within;
  std::string detect, allow, method, primaries, secondaries, over, reference, cost, budget;
  bool quiet = false;
};

struct SortedWords {
  std::string command;  ///< as "run"; empty where the version or help was asked for
  Given given;
  bool version = false;
  std::string help;  ///< the text that was asked for
};

/// An InputError about the command line.
[[noreturn]] void usage_error(const std::string& why);

/// InputError on a command or option that there is not, or an argument too many.
SortedWords sorted_words(const Texts& arguments);

}  // namespace assay::harness
