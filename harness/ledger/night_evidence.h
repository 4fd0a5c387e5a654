#pragma once

// What one run says of a claim, in a form that adds up over runs.
//
// Means and variances, by the methods whose estimate says nothing of its standard error (t, Welch,
// two one-sided tests, chi-square, F): score and information on theta at the last look taken,
//   V = 1 / e^2,   S = z E / e^2,
// e: the drawn data's standard error of theta (theta_error.h), E: hypot(e, what is the same in all
// runs), z: the normal quantile of the test's own p-value of theta = 0. For a mean that is
// S = sum (x - r) / sigma^2 and V = n / sigma^2 in units of theta, up to Student's t made normal.
// A run that stopped early gives the S and V it has. Its z is not normal then, since a small
// estimate stops sooner; but S is a Brownian motion observed at the time V, wherever it is stopped,
// and the ledger's E-value a martingale in V (optional stopping), so its level holds all the same.
//
// Everything else: ln of the e-value of the p-value over the looks taken, which is valid wherever
// one stops. A binomial count or a skewed mean that is small has a small standard error too: its
// score would drift night after night.

#include <string>

#include "harness/ledger/ledger_book.h"
#include "harness/question/pilot.h"
#include "harness/run/evaluate.h"

namespace assay::harness {

struct NightEvidence {
  EvidenceKind kind = EvidenceKind::score;
  stats::Evidence evidence = {};
  double log_e = 0;
  /// Of a series that begins: from this run's pilot, whose streams no test sees. The effect is
  /// sqrt(0.2) of the standard error that a run is expected to end with if theta = 0.
  stats::LedgerPrior prior = {};
  std::string missing = "";  ///< why there is none
};

/// A score by t, welch, tost, chi-square and F; ln of an e-value by any other method.
EvidenceKind evidence_kind(const TestOutcome& test);

NightEvidence night_evidence(const TestWork& work, std::size_t channel, const Pilots& pilots);

/// Hash of what a series is about: the claim, its margins, plugins, parameters and primaries of
/// its estimators, references, recorded data.
std::string series_hash(const TestWork& work, std::size_t channel);

}  // namespace assay::harness
