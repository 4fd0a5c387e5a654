#pragma once

// The record of the approved files, tests/golden/record.json, and its parts: every verdict, several
// channels, missing numbers, and text that every writer must escape. A new key of the record gets a
// value there by hand.

#include <string>
#include <vector>

#include "reports/record/record.h"

namespace assay::reports {

/// Three suites, about twenty tests. Every member differs from its default somewhere. The text of
/// the second suite is as a careless author or a broken child process would send it.
Record example_record();

// Tests of its first suite.
Test passing();
Test failing();  ///< with an image and its maps
Test caught_mutant();
Test surviving_mutant();
Test undecided();
Test not_run();

/// A test with nothing but its verdict. It is ok if the verdict is the expected one.
Test judged(Verdict verdict, Verdict expected = Verdict::pass);

/// A suite of these tests alone.
Record record_of(const std::vector<Test>& tests);

/// A test of this claim, which is also its name, without samples and channels.
Test base(const std::string& claim);

/// A test's sample of an estimator whose values are about 0.48.
Sample sample(const std::string& estimator);

/// A channel of a test that finds nothing.
Channel channel(const Effect& effect);

/// The relative difference of two means, with its 99 % interval.
Effect mean_effect(double estimate, double half_width);

}  // namespace assay::reports
