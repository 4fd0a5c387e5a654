#pragma once

// Defines commands, options and their help, and sorts the words of a command line by them.

#include <string>
#include <vector>

namespace assay::harness {

using Texts = std::vector<std::string>;

/// Every option's text as it was typed; empty if it was not. CLI11 only sorts words, and only
/// cli_options.cpp includes it, since it compiles slowly. Our own functions read the values, so
/// that messages are alike everywhere.
struct Given {
  std::string claim, source, what, plugin, record, test, observation, runs, samples;
  Texts suites, estimators, sets, reports, methods, laws, alphas, records, filters, tags;
  std::string seed, threads, alpha, coarsen, shard, ledger, inconclusive, colour, github;
  std::string candidate, pictures, channels, pixels, picture_samples, within;
  std::string detect, allow, method, primaries, secondaries, over, reference, cost, budget;
  bool quiet = false;
};

struct SortedWords {
  std::string command;  ///< as "run"; empty for version and help
  Given given;
  bool version = false;
  std::string help;  ///< requested text
};

[[noreturn]] void usage_error(const std::string& why);

/// InputError for an unknown command or option, and for an extra argument.
SortedWords sorted_words(const Texts& arguments);

}  // namespace assay::harness
