#pragma once

#include "reports/record/record.h"

namespace assay::reports {

/// The record without what differs between two runs of the same suite, seed and program: `started`,
/// every `seconds`, and `environment.threads`. Two runs agree when these are equal byte for byte.
inline Record without_times(Record record) {
  record.started.clear();
  record.seconds = 0;
  record.environment.threads = 0;
  for (Suite& suite : record.suites) {
    suite.retries.clear();
    for (EstimatorSummary& estimator : suite.estimators) estimator.cost.seconds = 0;
    for (Test& test : suite.tests) {
      for (Sample& sample : test.samples) sample.cost.seconds = 0;
    }
  }
  return record;
}

}  // namespace assay::reports
