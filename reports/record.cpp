#include "reports/record.h"

#include <set>
#include <tuple>

namespace assay::reports {

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::fail:
      return "fail";
    case Verdict::inconclusive:
      return "inconclusive";
    case Verdict::invalid:
      return "invalid";
    case Verdict::error:
      return "error";
    case Verdict::skipped:
      break;
  }
  return "skipped";
}

Outcome outcome(const Test& test) {
  if (test.verdict == Verdict::skipped) return Outcome::skipped;
  if (test.ok) return Outcome::passed;
  return test.verdict == Verdict::inconclusive ? Outcome::inconclusive : Outcome::failed;
}

Tally tally(const Suite& suite) {
  Tally result;
  for (const Test& test : suite.tests) {
    switch (outcome(test)) {
      case Outcome::passed:
        ++result.passed;
        break;
      case Outcome::failed:
        ++result.failed;
        break;
      case Outcome::inconclusive:
        ++result.inconclusive;
        break;
      case Outcome::skipped:
        ++result.skipped;
        break;
    }
  }
  return result;
}

Tally tally(const Record& record) {
  Tally result;
  for (const Suite& suite : record.suites) {
    const Tally part = tally(suite);
    result.passed += part.passed;
    result.failed += part.failed;
    result.inconclusive += part.inconclusive;
    result.skipped += part.skipped;
  }
  return result;
}

int alarms(const Ledger& ledger) {
  int count = 0;
  for (const LedgerSeries& series : ledger.series) count += series.alarm;
  return count;
}

Record without_times(Record record) {
  record.started.clear();
  record.seconds = 0;
  record.environment.threads = 0;
  for (Suite& suite : record.suites) {
    for (EstimatorSummary& estimator : suite.estimators) estimator.cost.seconds = 0;
    for (Test& test : suite.tests) {
      for (Sample& sample : test.samples) sample.cost.seconds = 0;
    }
  }
  return record;
}

Cost total_cost(const Test& test) {
  Cost sum;
  std::set<std::tuple<std::string, std::string, std::string>> seen;
  for (const Sample& sample : test.samples) {
    if (!seen.emplace(sample.estimator, sample.plugin, sample.parameters).second) continue;
    sum.camera_rays += sample.cost.camera_rays;
    sum.closest_hit_rays += sample.cost.closest_hit_rays;
    sum.shadow_rays += sample.cost.shadow_rays;
    sum.samples += sample.cost.samples;
    sum.seconds += sample.cost.seconds;
  }
  return sum;
}

}  // namespace assay::reports
