#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace assay::harness {

/// A text that the program carries: a template of `assay init`, a script of `assay completion`, or
/// what suites/README.md says of claims.
struct CarriedFile {
  std::string_view path;  ///< below harness/command, as "init/suite/mine.yaml"; or "claims.md"
  std::string_view text;
};

/// In the order of their paths.
const std::vector<CarriedFile>& carried_files();

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
