#pragma once

#include "stats/basics/moments.h"

namespace assay::stats {

// One-pass moments of pairs (x, cost): those of each, and two mixed sums of their joint law.
// Updating and merging formulas: Pebay, SAND2008-6212, section 3, by moving both means
// (joint_moments.cpp has the identity). Values must be finite. A constant cost keeps cost.m2, m11
// and m21 at exactly zero.
struct JointMoments {
  Moments x;
  Moments cost;
  double m11 = 0;  // Sum of (x - mean x) (cost - mean cost).
  double m21 = 0;  // Sum of (x - mean x)^2 (cost - mean cost).

  void add(double value, double its_cost);

  // Same as adding the other sample's pairs here. Merging in a fixed order gives fixed bits.
  void merge(const JointMoments& other);

  friend bool operator==(const JointMoments&, const JointMoments&) = default;
};

}  // namespace assay::stats
