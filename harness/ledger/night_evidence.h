#pragma once

// Evidence of one run on a claim, in a form that adds up over runs.
//
// Means and variances by t, Welch, two one-sided tests, chi-square and F give score and information
// on theta at the last look taken:
//   V = 1 / e^2,   S = z E / e^2.
// e is the standard error of theta from the drawn data (theta.h). E is hypot(e, the error
// that all runs share). z is the normal quantile of the test's p-value of theta = 0. A mean has S =
// sum (x - r) / sigma^2 and V = n / sigma^2 in units of theta, up to Student's t made normal. These
// methods' estimates say nothing of their standard errors.
//
// A run that stopped early gives the S and V it has. Its z is not normal then, since a small
// estimate stops sooner. But S is a Brownian motion observed at time V, wherever it is stopped. The
// ledger's E is a martingale in V (optional stopping), so its level holds.
//
// Everything else gives the ln of the p-value's e-value over the looks taken, which is valid
// wherever one stops. A small binomial count or skewed mean has a small standard error too: its
// score would drift.

#include <string>

#include "harness/ledger/ledger_book.h"
#include "harness/pilot/pilot.h"
#include "harness/run/evaluate.h"

namespace assay::harness {

struct NightEvidence {
  EvidenceKind kind = EvidenceKind::score;
  stats::Evidence evidence = {};
  double log_e = 0;
  /// The prior of a series that begins, from this run's pilot, whose streams no test sees. Its
  /// effect is sqrt(0.2) of the standard error that a run is expected to end with if theta = 0.
  stats::LedgerPrior prior = {};
  std::string missing = "";
};

/// A score for t, welch, tost, chi-square and F; ln of an e-value for any other method.
EvidenceKind evidence_kind(const TestOutcome& test);

NightEvidence night_evidence(const TestWork& work, std::size_t channel, const Pilots& pilots);

/// A hash of claim, margins, plugins, parameters and primaries of its estimators, references and
/// recorded data.
std::string series_hash(const TestWork& work, std::size_t channel);

}  // namespace assay::harness
