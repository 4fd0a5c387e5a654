#pragma once

#include <stdexcept>

namespace assay::stats {

// Thrown where a statistic would divide by a zero variance. A constant sample is an outcome of its
// own, so callers can catch it by name. Every other bad argument is a plain std::domain_error.
class ZeroVariance : public std::domain_error {
 public:
  using std::domain_error::domain_error;
};

}  // namespace assay::stats
