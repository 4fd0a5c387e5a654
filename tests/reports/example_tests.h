#pragma once

// The tests of the example record, one of each verdict, and the parts they are made of.

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// A law by its mean, deviation and a skewness-like bend of its quantiles.
struct Law {
  double mean = 0;
  double deviation = 1;
  double bend = 0;
};

/// A test's sample of one estimator whose observations follow this law.
Sample sample(const std::string& estimator, const Law& law);

/// The relative difference of two means, with its 99 % interval.
Effect mean_effect(double estimate, double half_width);

/// A channel of a test that finds nothing.
Channel channel(const std::string& name, const Effect& effect);

/// The common part of all tests: the claim, which is also the name, and its line in the suite.
Test base(const std::string& name, int line);

Test passing();
Test proof();

/// With an image and its maps.
Test failing();

Test caught_mutant();

/// The mutant of caught_mutant() under another method, which is blind to it.
Test unseen_mutant();

Test surviving_mutant();
Test undecided();
Test invalid();
Test broken();
Test not_run();

}  // namespace assay::reports
