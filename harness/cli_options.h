#pragma once

// Which commands and options there are, and what --help says of each.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace assay::harness {

using Texts = std::vector<std::string>;

/// Every option's text as it was typed; empty where it was not. CLI11 sorts the words, our own
/// functions read the values, so that messages are alike everywhere.
struct Given {
  std::string claim, source, what, plugin, record, test, observation, runs, samples;
  Texts suites, estimators, sets, reports, laws, alphas, records;
  std::string filter, seed, threads, alpha, coarsen, shard, ledger, inconclusive, colour, github;
  std::string detect, allow, method, primaries, secondaries, over, reference, cost, budget;
  bool quiet = false;
};

/// Adds every command with its options, whose texts go to `given`.
void define_options(CLI::App& app, Given& given);

}  // namespace assay::harness
