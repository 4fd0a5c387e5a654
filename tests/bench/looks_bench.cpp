// What the engine takes for itself between looks: gates, evidence, verdicts, intervals. Of each
// suite that is named, run on one thread, the CPU time of sampling in looks without that of the
// draws, as a share of the draws.
//   looks_bench SUITE...

#include <cstdio>
#include <ctime>

#include "harness/looks.h"
#include "harness/planned_run.h"

namespace {

using namespace assay;

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void report(const char* file) {
  harness::Silence silence;
  const harness::PlannedRun planned =
      harness::plan_run({harness::load_suite(file)}, {.threads = 1}, silence);
  std::vector<harness::TestWork*> tests;
  for (harness::TestWork& work : planned.suites[0]->tests) tests.push_back(&work);
  const double start = processor_seconds();
  harness::sample_in_looks(tests, planned.pools.all(), 1, silence);
  const double whole = processor_seconds() - start;
  double drawing = 0;
  for (const auto& pool : planned.pools.all()) {
    const std::uint64_t most = pool->largest_prefix();
    if (most > 0) drawing += pool->prefix(most).seconds;
  }
  std::printf("%-32s %3zu tests: draws %.3f s, the engine %.3f s, %.2f %%\n", file, tests.size(),
              drawing, whole - drawing, 100 * (whole - drawing) / drawing);
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) report(argv[i]);
}
