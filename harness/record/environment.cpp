#include "harness/record/environment.h"

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <string>
#include <thread>

#include "estimators/instruction_set.h"
#include "harness/base/version.h"

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

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[sizeof "2000-01-01T00:00:00Z"];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

}  // namespace assay::harness
