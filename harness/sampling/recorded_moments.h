#pragma once

#include "reports/record/record.h"
#include "stats/basics/moments.h"

namespace assay::harness {

inline reports::Moments recorded(const stats::Moments& moments) {
  return {.count = moments.count,
          .mean = moments.mean,
          .m2 = moments.m2,
          .m3 = moments.m3,
          .m4 = moments.m4,
          .minimum = moments.minimum,
          .maximum = moments.maximum,
          .nonzero = moments.nonzero,
          .rest = moments.rest};
}

inline stats::Moments moments_of(const reports::Moments& recorded) {
  return {.count = recorded.count,
          .mean = recorded.mean,
          .m2 = recorded.m2,
          .m3 = recorded.m3,
          .m4 = recorded.m4,
          .minimum = recorded.minimum,
          .maximum = recorded.maximum,
          .nonzero = recorded.nonzero,
          .rest = recorded.rest};
}

}  // namespace assay::harness
