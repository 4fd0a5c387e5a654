#include "harness/image_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>

namespace assay::harness {
namespace {

// Of each number of a picture: as it is kept, and of each element besides: moments of pilot, test
// and of what is under way, weights and maps. Measured (README.md).
constexpr double bytes_of_number = 4;
constexpr double bytes_of_element = 225;
constexpr double gigabyte = 1e9;

constexpr double unknown = std::numeric_limits<double>::infinity();

double bytes_of(const PreparedEstimator& estimator) {
  const auto image = estimator.setup->image();
  const auto pictures = estimator.setup->observations();
  if (!image || !pictures || *pictures == 0) return 0;
  return static_cast<double>(image->elements()) *
         (bytes_of_number * static_cast<double>(*pictures) + bytes_of_element);
}

/// The number in a file of one.
double number_in(const char* file) {
  double value = unknown;
  std::ifstream stream(file);
  return stream >> value ? value : unknown;
}

double of_system() {
  std::ifstream stream("/proc/meminfo");
  for (std::string word; stream >> word;) {
    double kibibytes = 0;
    if (word == "MemAvailable:" && stream >> kibibytes) return 1024 * kibibytes;
  }
  return unknown;
}

double of_control_group() {
  const double most = number_in("/sys/fs/cgroup/memory.max");
  const double taken = number_in("/sys/fs/cgroup/memory.current");
  return most < unknown && taken < unknown ? most - taken : unknown;
}

}  // namespace

double picture_bytes(const std::map<std::string, PreparedEstimator>& estimators) {
  double bytes = 0;
  for (const auto& [name, estimator] : estimators) bytes += bytes_of(estimator);
  return bytes;
}

double available_bytes() { return std::min(of_system(), of_control_group()); }

void require_memory(const std::map<std::string, PreparedEstimator>& estimators, double available) {
  const double needed = picture_bytes(estimators);
  if (needed <= available) return;
  const auto largest = std::max_element(
      estimators.begin(), estimators.end(),
      [](const auto& a, const auto& b) { return bytes_of(a.second) < bytes_of(b.second); });
  const PreparedEstimator& estimator = largest->second;
  const ImageShape shape = *estimator.setup->image();
  throw InputError(
      estimator.where,
      fmt::format("{} pictures of {} x {} pixels of {} components and those beside them take about "
                  "{:.1f} GB to test, and {:.1f} GB are free; take fewer pictures (16 a side or "
                  "more), one of their channels at a time, or smaller pictures",
                  *estimator.setup->observations(), shape.width, shape.height,
                  shape.components.size(), needed / gigabyte, available / gigabyte));
}

}  // namespace assay::harness
