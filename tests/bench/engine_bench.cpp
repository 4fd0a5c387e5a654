// The harness's time over the bare loop of an estimator, and the gain of a second thread.
//
// The bare loop calls the estimator's secondary() once with all primaries, on one stream. The
// harness draws the same number of primaries in observations of 64 (`auto`'s least). It adds
// blocks, streams, moments, histograms and kept values. Ratios are taken in pairs, in one process.

#include <cstdio>
#include <memory>
#include <vector>

#include "estimators/catalogue.h"
#include "estimators/core/flush_denormals.h"
#include "harness/sampling/executor.h"
#include "harness/sampling/pool.h"
#include "tests/bench/paired.h"

namespace {

using namespace assay;

constexpr std::uint64_t primaries = 64;

std::shared_ptr<const Setup> set_up(const char* plugin) {
  const Entry& entry = find_plugin(plugin, {});
  Parameters parameters(plugin, entry.information.parameters, Value::map({}), ".");
  return entry.prepare(parameters);
}

double bare(const Setup& setup, std::uint64_t total) {
  const FlushDenormals flush;
  const std::unique_ptr<Estimator> estimator = setup.make();
  std::vector<double> out(setup.channels().size());
  Stream random(stream_key(1, "bench", "", 0), 0);
  Cost cost;
  estimator->secondary(random, total, out, cost);
  return out[0];
}

double by_harness(const std::shared_ptr<const Setup>& setup, std::uint64_t total,
                  unsigned threads) {
  auto pool = std::make_shared<harness::Pool>(setup, stream_key(1, "bench", "", 0), primaries);
  for (harness::ChannelPlan& channel : pool->plans()) {
    channel = {.histogram_low = 0, .histogram_high = 10, .keep = 2000};
  }
  pool->request(total / primaries);
  harness::draw_all({pool}, *harness::threads(threads), "sampling", harness::silence);
  return std::get<harness::Drawn>(pool->sample(total / primaries))
      .summary()
      .channels[0]
      .moments.mean;
}

void report(const char* plugin, std::uint64_t total) {
  const std::shared_ptr<const Setup> setup = set_up(plugin);
  volatile double sink = 0;
  const auto loop = [&] { sink = bare(*setup, total); };
  const auto one = [&] { sink = by_harness(setup, total, 1); };
  const auto two = [&] { sink = by_harness(setup, total, 2); };
  const bench::PairedTimes added = bench::time_in_pairs(one, loop, 15);
  const bench::PairedTimes gained = bench::time_in_pairs(one, two, 15);
  std::printf(
      "%-32s %6.1f ns a primary bare; harness / bare %.3f (%.3f to %.3f); "
      "one thread / two %.2f (%.2f to %.2f)\n",
      plugin, 1e9 * added.second / static_cast<double>(total), added.ratio, added.least, added.most,
      gained.ratio, gained.least, gained.most);
}

}  // namespace

int main() {
  report("luminaire/area", 4'000'000);
  report("luminaire/hemisphere", 4'000'000);
  report("analytic/exponential_uniform", 16'000'000);
  report("analytic/dart_throwing", 32'000'000);
}
