// The family of an image pair with its z map, on two stacks of 64 images of WIDTH x HEIGHT x 3
// floats in memory. It runs on one thread and on all processors, and also prints the rate of
// reading memory. tests/bench/image_scipy.py has Welch's test of every element by scipy.

//   image_bench [WIDTH HEIGHT]      Default 1920 1080: 3.2 GB.

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <thread>
#include <vector>

#include "stats/pyramids/image_pyramid.h"
#include "tests/bench/paired.h"

namespace {

using namespace assay;

constexpr std::size_t replicates = 64;
constexpr std::size_t repetitions = 5;

struct Stack {
  std::vector<std::vector<float>> images;
  stats::ImageStack view;
};

// Squares of uniforms from a multiplicative hash of the index: any values will do for the time.
Stack make_stack(const stats::ImageExtent& extent, std::uint32_t seed) {
  Stack stack{{}, {extent, {}}};
  std::uint32_t state = seed;
  for (std::size_t r = 0; r < replicates; ++r) {
    std::vector<float>& image = stack.images.emplace_back(extent.elements());
    for (float& value : image) {
      state = state * 1664525U + 1013904223U;
      const float u = static_cast<float>(state >> 8) * 0x1p-24F;
      value = u * u;
    }
  }
  for (const auto& image : stack.images) stack.view.images.emplace_back(image);
  return stack;
}

// work(first, size) on equal parts of the elements.
template <class Work>
void on_threads(std::size_t threads, std::size_t elements, const Work& work) {
  std::vector<std::thread> running;
  for (std::size_t t = 0; t < threads; ++t) {
    const std::size_t first = elements * t / threads;
    running.emplace_back(work, first, elements * (t + 1) / threads - first);
  }
  for (std::thread& thread : running) thread.join();
}

// Medians of wall time and of processor time, all threads together: the two agree on a quiet
// machine.
struct Times {
  double wall;
  double processor;
};
template <class Work>
Times median_times(const Work& work) {
  work();
  std::vector<double> wall;
  std::vector<double> processor;
  for (std::size_t i = 0; i < repetitions; ++i) {
    const std::clock_t start = std::clock();
    wall.push_back(bench::seconds(work));
    processor.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return {bench::median(wall), bench::median(processor)};
}

// Every value is read once, image by image, into eight integer sums that a compiler can vectorise.
std::uint64_t read_all(const Stack& stack, std::size_t first, std::size_t size) {
  std::uint64_t total = 0;
  for (const auto& image : stack.images) {
    const auto* const words = reinterpret_cast<const std::uint32_t*>(image.data()) + first;
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < size; ++i) sum += words[i];
    total += sum;
  }
  return total;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t width = argc > 2 ? std::strtoul(argv[1], nullptr, 10) : 1920;
  const std::size_t height = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 1080;
  const stats::ImageExtent extent{width, height, 3};
  const Stack a = make_stack(extent, 1);
  const Stack b = make_stack(extent, 2);
  std::vector<double> z(extent.elements());
  const double gigabytes =
      2.0 * static_cast<double>(replicates * extent.elements() * sizeof(float)) / 1e9;
  std::printf("2 x %zu images of %zu x %zu x 3 floats, %.2f GB\n", replicates, width, height,
              gigabytes);
  std::vector<std::size_t> counts{1};
  if (std::thread::hardware_concurrency() > 1)
    counts.push_back(std::thread::hardware_concurrency());
  for (const std::size_t threads : counts) {
    const stats::ForEach for_each = [&](std::size_t count, const auto& work) {
      std::atomic<std::size_t> next = 0;
      on_threads(threads, threads, [&](std::size_t, std::size_t) {
        for (std::size_t i = next++; i < count; i = next++) work(i);
      });
    };
    const Times family = median_times([&] {
      stats::image_pyramid({a.view, b.view}, {.z = z, .for_each = for_each});
    });
    std::atomic<std::uint64_t> sink = 0;
    const Times read = median_times([&] {
      on_threads(threads, extent.elements(), [&](std::size_t first, std::size_t size) {
        sink += read_all(a, first, size) + read_all(b, first, size);
      });
    });
    std::printf(
        "%zu thread%s: family %.3f s wall, %.3f s processor; reading alone %.3f and %.3f s, "
        "%.1f GB/s; share of the bandwidth %.0f %% by wall, %.0f %% by processor time\n",
        threads, threads == 1 ? "" : "s", family.wall, family.processor, read.wall, read.processor,
        gigabytes / read.wall, 100 * read.wall / family.wall,
        100 * read.processor / family.processor);
  }
}
