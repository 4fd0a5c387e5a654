#include "harness/run/image_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "harness/run/picture_stream.h"

namespace assay::harness {
namespace {

// For each number of a picture: itself, and its share of a sum over a block of 4 x 4.
constexpr double bytes_of_number = 4;
constexpr double bytes_of_block = .5;
// For each element: moments of pilot, test and blocks in flight, weights and maps. A streamed
// picture takes less.
constexpr double bytes_of_element = 143;
constexpr double bytes_of_streamed_element = 43;
constexpr double gigabyte = 1e9;

constexpr double unknown = std::numeric_limits<double>::infinity();

/// The side of a streamed claim that this estimator is, or null.
const Subject* streamed_side(const PreparedEstimator& estimator, const StreamedClaims& streamed) {
  for (const Question* const question : streamed) {
    for (const Subject& side : question->subjects) {
      if (side.estimator->name == estimator.name) return &side;
    }
  }
  return nullptr;
}

double bytes_of(const PreparedEstimator& estimator, const StreamedClaims& streamed) {
  const auto image = estimator.setup->image();
  const auto pictures = estimator.setup->observations();
  if (!image || !pictures || *pictures == 0) return 0;
  const auto elements = static_cast<double>(image->elements());
  const auto numbers = elements * static_cast<double>(*pictures);
  if (const Subject* const side = streamed_side(estimator, streamed)) {
    return streamed_bytes(*side) + numbers * bytes_of_block + elements * bytes_of_streamed_element;
  }
  return numbers * (bytes_of_number + bytes_of_block) + elements * bytes_of_element;
}

/// The number in a file that holds one.
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

double picture_bytes(const std::map<std::string, PreparedEstimator>& estimators,
                     const StreamedClaims& streamed) {
  double bytes = 0;
  for (const auto& [name, estimator] : estimators) bytes += bytes_of(estimator, streamed);
  return bytes;
}

double available_bytes() { return std::min(of_system(), of_control_group()); }

void require_memory(const std::map<std::string, PreparedEstimator>& estimators,
                    const StreamedClaims& streamed, double available, const std::string& fault) {
  const double needed = picture_bytes(estimators, streamed);
  if (needed <= available) return;
  const auto largest =
      std::max_element(estimators.begin(), estimators.end(), [&](const auto& a, const auto& b) {
        return bytes_of(a.second, streamed) < bytes_of(b.second, streamed);
      });
  const PreparedEstimator& estimator = largest->second;
  const ImageShape shape = *estimator.setup->image();
  const std::string why = fault.empty() ? "" : fault + ", so that all are to be kept: ";
  throw InputError(
      estimator.where,
      fmt::format(
          "{}{} pictures of {} x {} pixels of {} components and those beside them take about "
          "{:.1f} GB to test, and {:.1f} GB are free; take fewer pictures (16 a side or "
          "more), one of their channels at a time, or smaller pictures",
          why, *estimator.setup->observations(), shape.width, shape.height, shape.components.size(),
          needed / gigabyte, available / gigabyte));
}

}  // namespace assay::harness
