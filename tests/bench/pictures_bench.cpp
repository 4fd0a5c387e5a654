// `assay images` on 64 + 64 OpenEXR pictures, beside the bare decoding of the same files by the
// library. Both use as many threads. Prints processor seconds and elapsed seconds. The pictures
// have R, G and B, a ramp with noise: floats by ZIP, halves by ZIP and by PIZ.
//   pictures_bench ASSAY [WIDTH HEIGHT [REPETITIONS]]      Default 480 270 3.

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <sys/resource.h>

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "tests/bench/paired.h"
#include "tests/estimators/exr.h"

namespace {

using namespace assay;

constexpr std::size_t pictures = 128;

/// Processor seconds so far, RUSAGE_SELF or RUSAGE_CHILDREN.
double cpu_seconds(int who) {
  rusage usage{};
  getrusage(who, &usage);
  const auto of = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return of(usage.ru_utime) + of(usage.ru_stime);
}

/// The times of each run.
struct Times {
  std::vector<double> cpu = {};
  std::vector<double> elapsed = {};

  template <class Work>
  void take(int who, const Work& work) {
    const double before = cpu_seconds(who);
    elapsed.push_back(bench::seconds(work));
    cpu.push_back(cpu_seconds(who) - before);
  }
};

/// Most memory of any program run so far, in GB.
double most_memory() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024e-9;
}

std::string name_of(const std::string& folder, std::size_t i) {
  return folder + (i < pictures / 2 ? "/a" : "/b") + std::to_string(100 + i) + ".exr";
}

/// The finaliser of SplitMix64 on a Weyl sequence. A congruential generator of 32 bits would
/// correlate numbers that are a multiple of a power of two apart, as pixels are.
std::uint64_t scattered(std::uint64_t count) {
  std::uint64_t z = count * 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

struct Kind {
  const char* name;
  Imf::PixelType type;
  Imf::Compression compression;
};

constexpr Kind kinds[] = {{"float, ZIP", Imf::FLOAT, Imf::ZIP_COMPRESSION},
                          {"half, ZIP", Imf::HALF, Imf::ZIP_COMPRESSION},
                          {"half, PIZ", Imf::HALF, Imf::PIZ_COMPRESSION}};

void write_pictures(const std::string& folder, const Kind& kind, int width, int height) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < pictures; ++i) {
    draws::Picture picture{width, height, {"R", "G", "B"}, {}, kind.type, kind.compression};
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < 3 * width; ++x) {
        const float u = static_cast<float>(scattered(++count) >> 40) * 0x1p-24F;
        picture.values.push_back(
            (0.5F + static_cast<float>(x % width) / static_cast<float>(width)) * (0.8F + 0.4F * u));
      }
    }
    draws::write_exr(name_of(folder, i), picture);
  }
}

void decode(const std::string& file) {
  Imf::InputFile input(file.c_str(), 0);
  const Imath::Box2i window = input.header().dataWindow();
  const auto width = static_cast<std::size_t>(window.max.x + 1);
  std::vector<float> values(3 * width * static_cast<std::size_t>(window.max.y + 1));
  Imf::FrameBuffer buffer;
  std::size_t c = 0;
  for (const char* const channel : {"R", "G", "B"}) {
    buffer.insert(channel,
                  Imf::Slice::Make(Imf::FLOAT, values.data() + c++, window, 12, 12 * width));
  }
  input.setFrameBuffer(buffer);
  input.readPixels(window.min.y, window.max.y);
}

void decode_all(const std::string& folder, unsigned threads) {
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> running;
  for (unsigned t = 0; t < threads; ++t) {
    running.emplace_back([&] {
      for (std::size_t i = next++; i < pictures; i = next++) decode(name_of(folder, i));
    });
  }
  for (std::thread& thread : running) thread.join();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc == 3 || argc > 5) {
    std::fprintf(stderr, "pictures_bench ASSAY [WIDTH HEIGHT [REPETITIONS]]\n");
    return 2;
  }
  const int width = argc > 2 ? std::atoi(argv[2]) : 480;
  const int height = argc > 2 ? std::atoi(argv[3]) : 270;
  const int repetitions = argc > 4 ? std::atoi(argv[4]) : 3;
  const unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / "assay_pictures_bench";
  std::filesystem::create_directories(folder);
  const std::string command = std::string(argv[1]) + " images --quiet --candidate '" +
                              folder.string() + "/a*.exr' --reference '" + folder.string() +
                              "/b*.exr' --pixels independent --threads " + std::to_string(threads) +
                              " >/dev/null";
  int failed = 0;
  for (const Kind& kind : kinds) {
    write_pictures(folder.string(), kind, width, height);
    Times decoding;
    Times testing;
    int code = 0;
    for (int i = 0; i < repetitions; ++i) {
      decoding.take(RUSAGE_SELF, [&] { decode_all(folder.string(), threads); });
      testing.take(RUSAGE_CHILDREN, [&] { code = std::system(command.c_str()); });
    }
    failed += code == 0 ? 0 : 1;
    std::printf("64 + 64 pictures of %d x %d, %s, %u threads, %.2f GB so far (wait status %d)\n",
                width, height, kind.name, threads, most_memory(), code);
    const auto show = [](const char* name, const std::vector<double>& bare,
                         const std::vector<double>& whole) {
      std::printf("%s: decoding %.3f s, assay images %.3f s, %.2f times\n", name,
                  bench::median(bare), bench::median(whole),
                  bench::median(whole) / bench::median(bare));
    };
    show("processor", decoding.cpu, testing.cpu);
    show("elapsed", decoding.elapsed, testing.elapsed);
    std::fflush(stdout);
  }
  std::filesystem::remove_all(folder);
  return failed;
}
