#include <fmt/format.h>

#include <fstream>
#include <string>
#include <thread>

#include "estimators/instruction_set.h"
#include "harness/record_of.h"
#include "harness/version.h"

namespace assay::harness {
namespace {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line)) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

}  // namespace

reports::Tool this_tool() { return {.name = "assay", .version = version(), .commit = commit()}; }

reports::Environment this_environment(unsigned threads) {
  return {
      .compiler = fmt::format("g++ {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__),
      .cpu = processor_name(),
      .isa = ray_instruction_set(),
      .threads = static_cast<int>(threads != 0 ? threads : std::thread::hardware_concurrency())};
}

}  // namespace assay::harness
