// The cost of an estimator elsewhere, in numbers a second. It takes the interface of a library, the
// pipes of a program, draws and densities of a sampler either way, and a program in Python.
//
//   foreign_bench EXAMPLES HEADERS ASSAY
//
// EXAMPLES and HEADERS are the folders of the example programs and of plugin_abi.h. ASSAY is the
// program that hosts libraries.
//
// The measured programs do next to nothing, so that the way alone costs time. The best of nine
// wall-clock times counts. A program in Python is compared with its own loop by medians of ratios
// in pairs. The ratio of processor times is reliable on a busy machine; that of the clock is not.

#include <stdlib.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "estimators/catalogue.h"
#include "estimators/core/thread_seconds.h"
#include "estimators/library_host.h"
#include "tests/bench/paired.h"

namespace {

using namespace assay;

constexpr int repetitions = 9;
constexpr StreamKey key{0x123456789abcdef};

// An observation of CHANNELS numbers, none of them worth the name.
constexpr const char* library_source = R"(#include "plugin_abi.h"
static int secondary(AssayCall *call) {
  const double value = assay_uniform(call->random);
  for (size_t i = 0; i < call->out_count; ++i) call->out[i] = value + (double)i;
  return 0;
}
#define NAMED(n) {.size = sizeof(AssayChannel), .name = n}
static const AssayChannel x[] = {
    NAMED("a"), NAMED("b"), NAMED("c"), NAMED("d"), NAMED("e"), NAMED("f"), NAMED("g"), NAMED("h"),
    NAMED("i"), NAMED("j"), NAMED("k"), NAMED("l"), NAMED("m"), NAMED("n"), NAMED("o"), NAMED("p")};
static int sample(const void *setup, AssayStream *random, AssayDraw *draw) {
  (void)setup;
  draw->point[0] = assay_uniform(random);
  draw->density = draw->weight = 1;
  return 0;
}
static double one(const void *setup, const double *point) { (void)setup; (void)point; return 1; }
static const AssaySampler flat = {.size = sizeof flat, .name = "flat", .domain = ASSAY_INTERVAL,
    .low = 0, .high = 1, .sample = sample, .density = one, .evaluate = one};
static const AssayEstimator mine = {.size = sizeof mine, .name = "mine", .channels = x,
    .channel_count = CHANNELS, .secondary = secondary, .samplers = &flat, .sampler_count = 1};
static const AssayLibrary table = {sizeof table, ASSAY_ABI_VERSION, &mine, 1};
const AssayLibrary *assay_library(void) { return &table; }
)";

constexpr const char* program_source = R"(#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
int main(void) {
  uint64_t question[4];
  setvbuf(stdout, NULL, _IOFBF, 1 << 20);
  puts("assay 1 binary\n" SHAPE "\nready");
  double *numbers = malloc(4096 * sizeof(double) * WIDTH);
  for (; !fflush(stdout) && fread(question, 8, 4, stdin) == 4; fwrite(question, 8, 4, stdout)) {
    for (uint64_t i = 0; i < question[2] * WIDTH; ++i) numbers[i] = (double)((question[0] + question[1]) * WIDTH + i);
    fwrite(numbers, sizeof(double), question[2] * WIDTH, stdout);
  }
}
)";

// The loop of darts.py by itself: what the program could do if nobody asked it anything.
constexpr const char* bare_loop = R"(import random, sys, time
def area(rng):
    x = 2 * rng.random() - 1
    y = 2 * rng.random() - 1
    return 4 if x * x + y * y < 1 else 0
start, cpu = time.perf_counter(), time.process_time()
for index in range(int(sys.argv[1])):
    rng = random.Random(123456 << 64 | index)
    sum([area(rng) for _ in range(int(sys.argv[2]))])
print(time.perf_counter() - start, time.process_time() - cpu)
)";

double best_of(const auto& work) {
  double best = bench::seconds(work);
  for (int i = 1; i < repetitions; ++i) best = std::min(best, bench::seconds(work));
  return best;
}

/// Prints how many millions a second a work of so many makes.
void report(const std::string& what, double count, const auto& work) {
  work();  // to warm up, and to find how much to ask for
  std::printf("%-52s %7.2f million numbers a second\n", what.c_str(), 1e-6 * count / best_of(work));
}

class Workshop {
 public:
  explicit Workshop(std::string headers) : headers_(std::move(headers)) {
    char name[] = "/tmp/assay_bench_XXXXXX";
    folder_ = mkdtemp(name);
  }
  ~Workshop() { std::filesystem::remove_all(folder_); }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  std::string compile(const std::string& name, const std::string& text,
                      const std::string& flags) const {
    const std::string file = (folder_ / name).string();
    const std::string command = "cc -std=c11 -O2 " + flags + " -I " + headers_ + " " +
                                write(name + ".c", text) + " -o " + file;
    if (std::system(command.c_str()) != 0) throw std::runtime_error("cc failed");
    return file;
  }

 private:
  std::filesystem::path folder_;
  std::string headers_;
};

std::shared_ptr<const Setup> set_up(const std::string& plugin, Value given) {
  const Entry& entry = find_plugin(plugin, {});
  Parameters parameters(plugin, entry.information.parameters, given, ".");
  return entry.prepare(parameters);
}

std::shared_ptr<const Setup> process(const std::vector<std::string>& command) {
  std::vector<Value> words;
  for (const std::string& word : command) words.push_back(Value::scalar(word));
  return set_up("process", Value::map({{"command", Value::list(std::move(words))}}));
}

/// Draws as the harness does: blocks are announced.
struct Drawn {
  std::uint64_t observations;
  std::uint64_t block;
  std::uint64_t primaries = 1;
};
void draw_once(Estimator& worker, const Drawn& what, std::size_t channels) {
  std::vector<double> out(channels);
  Cost cost;
  for (std::uint64_t i = 0; i < what.observations; ++i) {
    if (i % what.block == 0) worker.announce({key, i, i + what.block});
    Stream random(key, i);
    worker.secondary(random, what.primaries, out, cost);
  }
}

void report_numbers(const std::string& what, const Setup& setup, const Drawn& drawn) {
  const std::unique_ptr<Estimator> worker = setup.make();
  const std::size_t channels = setup.channels().size();
  report(what, static_cast<double>(drawn.observations * channels),
         [&] { draw_once(*worker, drawn, channels); });
}

std::shared_ptr<const Setup> library(const Workshop& workshop, const std::string& channels,
                                     const char* isolated) {
  const std::string file = workshop.compile("mine" + channels + ".so", library_source,
                                            "-fPIC -shared -DCHANNELS=" + channels);
  return set_up("library",
                Value::map({{"file", Value::scalar(file)}, {"isolated", Value::scalar(isolated)}}));
}

/// Asks as tables do: for all densities of a level of halvings at once, or for one.
void ask_densities(const Sampler& sampler, std::size_t count, std::size_t at_once) {
  const std::vector<Point> points(at_once, Point{.5, 0, 0});
  std::vector<double> densities(at_once);
  for (std::size_t asked = 0; asked < count; asked += at_once) {
    for (std::size_t done = 0; done < at_once;) {
      done += sampler.densities(std::span(points).subspan(done), densities);
    }
  }
}

void ask_draws(const Sampler& sampler, std::uint64_t count) {
  constexpr std::uint64_t block = 4096;
  std::vector<SamplerDraw> draws(block);
  for (std::uint64_t done = 0; done < count;) {
    std::vector<Stream> streams;
    for (std::uint64_t i = 0; i < block; ++i) streams.emplace_back(key, done + i);
    done += sampler.samples(streams, draws);
  }
}

void samplers(const Workshop& workshop) {
  for (const bool isolated : {true, false}) {
    const auto setup = library(workshop, "1", isolated ? "true" : "false");
    const Sampler& sampler = *setup->samplers()[0].sampler;
    const std::string where = isolated ? "isolated library, " : "library in process, ";
    report(where + "draws, 4096 at a time", 1 << 20, [&] { ask_draws(sampler, 1 << 20); });
    for (const std::size_t at_once : {648u, 36u, 1u}) {
      const std::size_t count = 10000 * std::min<std::size_t>(at_once, 100);
      report(where + "densities, " + std::to_string(at_once) + " at a time",
             static_cast<double>(count), [&] { ask_densities(sampler, count, at_once); });
    }
  }
}

void libraries(const Workshop& workshop) {
  for (const char* channels : {"1", "4", "16"}) {
    const auto setup = library(workshop, channels, "false");
    report_numbers(std::string("library in process, channels: ") + channels, *setup,
                   {.observations = 2'000'000, .block = 4096});
  }
}

void programs(const Workshop& workshop) {
  const auto compiled = [&](const char* name, const char* shape, const char* width) {
    return process({workshop.compile(name, program_source,
                                     std::string("-DSHAPE='\"") + shape + "\"' -DWIDTH=" + width)});
  };
  report_numbers("process, binary, one channel, blocks of 4096", *compiled("one", "channel x", "1"),
                 {.observations = 1'000'000, .block = 4096});
  report_numbers("process, binary, image of 64 x 64, blocks of 8",
                 *compiled("image", "image 64 64", "4096"), {.observations = 4000, .block = 8});
}

/// By the clock, and of processors.
struct Seconds {
  double wall = 0;
  double processor = 0;
};

Seconds of_the_bare_loop(const std::string& script, const Drawn& drawn) {
  const std::string command = "/usr/bin/python3 " + script + " " +
                              std::to_string(drawn.observations) + " " +
                              std::to_string(drawn.primaries);
  std::FILE* const pipe = popen(command.c_str(), "r");
  Seconds seconds;
  if (pipe == nullptr || std::fscanf(pipe, "%lf %lf", &seconds.wall, &seconds.processor) != 2) {
    throw std::runtime_error("python3 failed");
  }
  pclose(pipe);
  return seconds;
}

Seconds of_the_program(Estimator& worker, const Drawn& drawn) {
  const auto processors = [&] { return thread_seconds() + worker.seconds_elsewhere(); };
  const double before = processors();
  const double wall = bench::seconds([&] { draw_once(worker, drawn, 1); });
  return {.wall = wall, .processor = processors() - before};
}

void python(const Workshop& workshop, const std::string& examples) {
  constexpr int pairs = 15;
  const std::string script = workshop.write("bare.py", bare_loop);
  const auto setup = process(
      {"env", "PYTHONPATH=" + examples + "/../python", "/usr/bin/python3", examples + "/darts.py"});
  const Drawn drawn{.observations = 4096, .block = 256, .primaries = 64};
  const std::unique_ptr<Estimator> worker = setup->make();
  of_the_program(*worker, drawn);  // to warm up
  std::vector<double> wall;
  std::vector<double> processor;
  std::vector<double> cost;
  for (int i = 0; i < pairs; ++i) {
    const Seconds bare = of_the_bare_loop(script, drawn);
    const Seconds asked = of_the_program(*worker, drawn);
    wall.push_back(bare.wall / asked.wall);
    processor.push_back(bare.processor / asked.processor);
    cost.push_back(1e9 * asked.processor /
                   static_cast<double>(drawn.observations * drawn.primaries));
  }
  std::printf("%-52s %7.3f (processor time; by the clock %.3f; %.0f ns a primary)\n",
              "process, darts.py: rate against its own loop", bench::median(processor),
              bench::median(wall), bench::median(cost));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: foreign_bench EXAMPLES HEADERS ASSAY\n");
    return 2;
  }
  set_library_host(argv[3]);
  const Workshop workshop(argv[2]);
  libraries(workshop);
  samplers(workshop);
  programs(workshop);
  python(workshop, argv[1]);
}
