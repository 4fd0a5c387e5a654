#pragma once

// Claims run whole under many seeds, 1, 2, 3, …: from the text of a suite to the p-values and
// verdicts of its tests.

#include "harness/run/evaluate.h"
#include "harness/run/planned_run.h"
#include "harness/sampling/executor.h"
#include "tests/harness/planned.h"
#include "tests/stats/calibration.h"

namespace assay::harness {

/// The outcomes of one test, seed after seed.
struct Outcomes {
  std::vector<double> log_p;       ///< of the claimed region; 0 where there was no test
  std::vector<double> log_p_pass;  ///< of the forbidden region, likewise
  std::vector<reports::Verdict> verdicts;

  double share(reports::Verdict verdict) const {
    return static_cast<double>(std::count(verdicts.begin(), verdicts.end(), verdict)) /
           static_cast<double>(verdicts.size());
  }
};

inline double log_of(reports::Number log10_p) { return log10_p ? *log10_p * std::log(10.0) : 0; }

/// By name of the test, over seeds 1 to `runs`; `text` makes each seed's suite.
inline std::map<std::string, Outcomes> over_seeds(
    std::uint64_t runs, const std::function<std::string(std::uint64_t)>& text) {
  const Workplace place;
  std::map<std::string, Outcomes> outcomes;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    const std::string file = place.write("suite.yaml", text(seed));
    const reports::Record record = run_files({file}, {.seed = seed, .threads = 1});
    for (const reports::Test& test : record.suites[0].tests) {
      Outcomes& mine = outcomes[test.name];
      const bool tested = !test.channels.empty() && test.verdict != reports::Verdict::invalid &&
                          test.verdict != reports::Verdict::error;
      mine.log_p.push_back(tested ? log_of(test.channels[0].log10_p) : 0);
      mine.log_p_pass.push_back(tested ? log_of(test.channels[0].log10_p_pass) : 0);
      mine.verdicts.push_back(test.verdict);
    }
  }
  return outcomes;
}

/// Takes ln p of both regions at the first look of every test, without what a record adds. A record
/// takes a hundred times as long. Another test checks that a run finds the same numbers.
inline void take_first_looks(const Prepared& prepared, std::uint64_t seed,
                             std::map<std::string, Outcomes>& outcomes) {
  for (std::size_t i = 0; i < prepared.plans.size(); ++i) {
    const Question& question = prepared.asked->questions[i];
    const Plan& plan = prepared.plans[i];
    TestWork work{.outcome = {.question = question, .place = prepared.place[i], .plan = plan}};
    Pools pools;
    work.pools = pools.for_question(question, plan, seed, prepared.pilots);
    for (const auto& pool : work.pools) pool->request(plan.looks.sizes.front());
    draw_all(pools.all(), *threads(1), "sampling", silence);
    const Evidence evidence = plan.method.evidence({question, 0, data_of(*drawn(work), 0)});
    Outcomes& mine = outcomes[question.test->name];
    mine.log_p.push_back(log_p_claimed(evidence, plan.regions[0]));
    mine.log_p_pass.push_back(log_p_forbidden(evidence, plan.regions[0]));
    const ErrorShare& share = prepared.place[i].share;
    const ChannelDecision decision{.log_p_claimed = mine.log_p.back(),
                                   .log_p_forbidden = mine.log_p_pass.back(),
                                   .rejected = mine.log_p.back() <= std::log(share.alpha)};
    mine.verdicts.push_back(decide({decision}, plan.regions[0], share.beta));
  }
}

inline std::map<std::string, Outcomes> first_looks(std::uint64_t runs, const std::string& text) {
  const Prepared prepared = prepare_text(text, 1);
  std::map<std::string, Outcomes> outcomes;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) take_first_looks(prepared, seed, outcomes);
  return outcomes;
}

/// Whole runs of the seeds 1 to 4 have these very numbers in their records.
inline void expect_as_in_runs(const std::string& text) {
  constexpr std::uint64_t runs = 4;
  const auto whole = over_seeds(runs, [&](std::uint64_t) { return text; });
  std::map<std::string, Outcomes> looks;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    take_first_looks(prepare_text(text, seed), seed, looks);
  }
  for (const auto& [name, outcomes] : whole) {
    EXPECT_LT(outcomes.share(reports::Verdict::invalid), 1) << name << ": never compared";
    for (std::size_t i = 0; i < runs; ++i) {
      if (outcomes.verdicts[i] == reports::Verdict::invalid) continue;
      const double scale = 1e-12 * (1 + std::abs(looks.at(name).log_p[i]));
      EXPECT_NEAR(outcomes.log_p[i], looks.at(name).log_p[i], scale) << name;
      const double pass = looks.at(name).log_p_pass[i];
      EXPECT_NEAR(outcomes.log_p_pass[i], pass, 1e-12 * (1 + std::abs(pass))) << name;
    }
  }
}

/// How often a logarithm of a p-value is at most that of `level`.
inline double rate_at(const std::vector<double>& log_p, double level) {
  const auto below = std::count_if(log_p.begin(), log_p.end(),
                                   [&](double each) { return each <= std::log(level); });
  return static_cast<double>(below) / static_cast<double>(log_p.size());
}

/// P(p <= a) <= a at a = .1, .01 and .001, and uniform where `shape` says so: tests/stats/
/// calibration.h. A sound p-value is called wrong with probability 1.3e-5 at most.
inline void expect_p_value(const std::string& name, const std::vector<double>& log_p,
                           tests::Shape shape) {
  const tests::Calibration calibration = tests::calibrate(log_p, shape);
  const double at_tenth = rate_at(log_p, 0.1);
  const bool ok =
      calibration.ok && !tests::too_many(at_tenth, 0.1, static_cast<double>(log_p.size()));
  EXPECT_TRUE(ok) << name << ": P(p<=.1) = " << at_tenth << ", " << calibration.text();
  EXPECT_LT(*std::min_element(log_p.begin(), log_p.end()), 0) << name << ": was never tested";
}

}  // namespace assay::harness
