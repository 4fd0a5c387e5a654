#include "harness/run/looks.h"

#include <algorithm>
#include <map>
#include <set>

#include "harness/base/interrupt.h"
#include "harness/sampling/scheduler.h"

namespace assay::harness {
namespace {

/// One progress for all rounds, out of the work that remains if no test ends early.
class Rounds final : public Progress {
 public:
  Rounds(Progress& progress, std::uint64_t total) : progress_(progress) {
    progress_.begin("sampling", total);
  }
  ~Rounds() override { progress_.end(); }
  Rounds(const Rounds&) = delete;
  Rounds& operator=(const Rounds&) = delete;

  void begin(const std::string&, std::uint64_t total) override {
    before_ += round_;
    round_ = total;
  }
  void advance(std::uint64_t done) override { progress_.advance(before_ + done); }
  void end() override {}

 private:
  Progress& progress_;
  std::uint64_t before_ = 0;
  std::uint64_t round_ = 0;
};

std::uint64_t most_work(const std::vector<std::shared_ptr<Pool>>& pools) {
  std::uint64_t total = 0;
  for (const auto& pool : pools) total += pool->most_marked() * pool->primaries();
  return total;
}

/// CPU seconds of suites with a budget in seconds; each pool counts once.
using Clocks = std::map<const Budget*, double>;

Clocks read_clocks(const std::vector<TestWork*>& tests) {
  std::map<const Budget*, std::set<const Pool*>> pools;
  for (const TestWork* work : tests) {
    if (work->suite_budget == nullptr || !work->suite_budget->seconds) continue;
    for (const auto& pool : work->pools) pools[work->suite_budget].insert(pool.get());
  }
  Clocks clocks;
  for (const auto& [budget, drawn] : pools) {
    for (const Pool* pool : drawn) clocks[budget] += pool->seconds();
  }
  return clocks;
}

/// The size of the next look; of the last, what it may be put off to.
std::uint64_t next_size(const TestOutcome& outcome) {
  const Plan& plan = outcome.plan;
  if (outcome.look + 1 < plan.looks.count()) return plan.looks.sizes[outcome.look + 1];
  return plan.postponed.empty() ? outcome.secondaries() : plan.postponed.front();
}

void go_on(TestOutcome& outcome) {
  Plan& plan = outcome.plan;
  if (outcome.look + 1 < plan.looks.count()) {
    ++outcome.look;
    return;
  }
  plan.looks.sizes.back() = plan.postponed.front();
  plan.postponed.erase(plan.postponed.begin());
  outcome.history.clear();
}

/// True if a budget in seconds is spent, or the next look would spend it.
bool is_spent(const TestWork& work, const Clocks& clocks) {
  const double growth = static_cast<double>(next_size(work.outcome)) /
                        static_cast<double>(work.outcome.secondaries());
  const auto clock = clocks.find(work.suite_budget);
  if (clock != clocks.end() && growth * clock->second > *work.suite_budget->seconds) return true;
  const std::optional<Budget>& budget = work.outcome.question.test->budget;
  if (!budget || !budget->seconds) return false;
  const std::optional<DrawnTest> test = drawn(work);
  if (!test) return false;
  double seconds = 0;
  for (const Drawn& sample : test->samples) seconds += sample.summary().seconds;
  return growth * seconds > *budget->seconds;
}

bool take_next(TestWork& work, const Clocks& clocks) {
  TestOutcome& outcome = work.outcome;
  const bool spent = is_spent(work, clocks);
  take_look(work, !spent);
  const bool ended_early = outcome.look + 1 < outcome.plan.looks.count() &&
                           outcome.verdict == reports::Verdict::inconclusive;
  if (spent && ended_early) outcome.message += "; its budget in seconds ended here";
  if (!outcome.decided) go_on(outcome);
  return !outcome.decided;
}

}  // namespace

void sample_in_looks(const std::vector<TestWork*>& tests,
                     const std::vector<std::shared_ptr<Pool>>& pools, unsigned threads,
                     Progress& progress) {
  Rounds rounds(progress, most_work(pools));
  std::vector<TestWork*> open = tests;
  do {
    for (TestWork* work : open) {
      for (std::size_t i = 0; i < work->pools.size(); ++i) {
        work->pools[i]->request(work->outcome.secondaries(i));
      }
    }
    draw_all(pools, {.threads = threads}, rounds);
    if (interrupted()) return;
    const Clocks clocks = read_clocks(tests);
    std::erase_if(open, [&](TestWork* work) { return !take_next(*work, clocks); });
  } while (!open.empty());
}

}  // namespace assay::harness
