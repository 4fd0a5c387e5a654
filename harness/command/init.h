#pragma once

#include <string>
#include <vector>

namespace assay::harness {

struct InitArguments {
  std::vector<std::string> words;  ///< KIND [FOLDER]; a kind has one word or two
  std::string kind;                ///< a folder of command/init
  std::string folder = ".";
};

/// Every kind as a user writes it: "process python".
std::vector<std::string> kinds_of_example();

/// Takes kind and folder from the words. InputError for an unknown kind and a word too many.
void read_kind(InitArguments& arguments);

/// Writes the example of that kind and prints what to do with it. InputError, and nothing written,
/// if one of its files is there already.
int write_example(const InitArguments& arguments);

}  // namespace assay::harness
