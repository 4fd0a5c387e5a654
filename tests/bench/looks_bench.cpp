// The engine's own CPU seconds in each named suite, run on one thread as `assay run` does. Budgets
// in seconds are left out.

//   set-up    Plugins' scenes, tables and references.
//   pilots    Drawing them.
//   plans     Methods, sizes, and the masses in cells that a size depends on.
//   tables    The other densities' masses in cells, and distribution functions, once a run.
//   draws     All observations.
//   looks     Gates, evidence, verdicts, effects and sentences between the draws, and after them.
//   record    The numbers that reports draw.
// The last lines give the looks, and all of the engine (plans, tables, looks, record), as shares of
// the draws.
//   looks_bench SUITE...

#include <cstdio>
#include <ctime>

#include "harness/draws/sampler_setup.h"
#include "harness/families/families.h"
#include "harness/record/record_of.h"
#include "harness/run/planned_run.h"
#include "harness/sampling/executor.h"

namespace {

using namespace assay;

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Since when, and then for how long.
class Clock {
 public:
  double lap() {
    const double before = since_;
    since_ = processor_seconds();
    return since_ - before;
  }

 private:
  double since_ = processor_seconds();
};

/// The time before, in and after the phase of pilots.
class Phases final : public harness::Progress {
 public:
  void begin(const harness::Phase&) override { before += clock_.lap(); }
  void advance(std::uint64_t) override {}
  void end() override { inside += clock_.lap(); }
  double after() { return clock_.lap(); }

  double before = 0, inside = 0;

 private:
  Clock clock_;
};

void make_tables(const std::vector<harness::TestWork*>& tests) {
  for (const harness::TestWork* work : tests) {
    const harness::Question& question = work->outcome.question;
    if (question.theta != &harness::theta_of_laws()) continue;
    dynamic_cast<const harness::SamplerSetup&>(*question.subjects[0].setup).density_cells();
    if (work->outcome.plan.method.keeps != harness::Keeps::values) continue;
    for (std::size_t channel = 0; channel < question.channel_count(); ++channel) {
      harness::declared_law(question, channel);
    }
  }
}

struct Rounds {
  double draws = 0, looks = 0;
};

Rounds sample(std::vector<harness::TestWork*> open,
              const std::vector<std::shared_ptr<harness::Pool>>& pools) {
  Rounds seconds;
  Clock clock;
  while (!open.empty()) {
    for (harness::TestWork* work : open) {
      for (const auto& pool : work->pools) pool->request(work->outcome.secondaries());
    }
    harness::draw_all(pools, *harness::threads(1), "sampling", harness::silence);
    seconds.draws += clock.lap();
    std::erase_if(open, [](harness::TestWork* work) {
      harness::take_look(*work, true);
      if (!work->outcome.decided) ++work->outcome.look;
      return work->outcome.decided;
    });
    seconds.looks += clock.lap();
  }
  return seconds;
}

void report(const char* file) {
  const harness::RunOptions options{.threads = 1};
  Phases phases;
  const harness::PlannedRun planned =
      harness::plan_run({harness::load_suite(file)}, options, phases);
  const double plans = phases.after();
  Clock clock;
  std::vector<harness::TestWork*> tests;
  for (harness::TestWork& work : planned.suites[0]->tests) tests.push_back(&work);
  make_tables(tests);
  const double tables = clock.lap();
  const Rounds rounds = sample(tests, planned.pools.all());
  clock.lap();
  harness::record_of(planned.suites, options);
  const double record = clock.lap();
  const double engine = plans + tables + rounds.looks + record;
  std::printf("%-36s %5zu %7.3f %7.3f %7.3f %7.3f %8.3f %7.3f %7.3f %8.2f %% %8.2f %%\n", file,
              tests.size(), phases.before, phases.inside, plans, tables, rounds.draws, rounds.looks,
              record, 100 * rounds.looks / rounds.draws, 100 * engine / rounds.draws);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::printf("%-36s %5s %7s %7s %7s %7s %8s %7s %7s %10s %10s\n", "CPU seconds", "tests", "set-up",
              "pilots", "plans", "tables", "draws", "looks", "record", "looks", "engine");
  for (int i = 1; i < argc; ++i) report(argv[i]);
}
