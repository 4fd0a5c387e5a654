#include <fmt/format.h>

#include <cstdio>

#include "harness/command/program.h"

int main(int argc, char** argv) {
  using namespace assay::harness;
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    join_tasks(arguments);
  } catch (const assay::InputError& error) {
    fmt::print(stderr, "{}", failure_text(error, ""));
    return 2;
  }
  return program(arguments);
}
