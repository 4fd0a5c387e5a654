#pragma once

// Evidence of one run on a claim, in a form that pools over runs.
//
// A claim about a number gives an estimate of theta at the last look taken. Its standard error
// (theta.h) and the observations that it rests on come with it. A family that tells no error gives
// half its interval of one standard deviation. Claims about distances, of laws and of images, give
// the p-value over the looks taken.
//
// A run that stopped early gives the estimate it has. That is not normal then, since a small one
// stops sooner. But observations times estimate is a random walk, wherever it is stopped. The
// ledger's E is a martingale in the observations (optional stopping), so its level holds.
//
// A night is left out for what its pilots say and for errors. Its own data never leave it out, as
// the others would be those that look well: samples without their rare values.

#include <string>
#include <variant>

#include "harness/ledger/ledger_book.h"
#include "harness/run/evaluate.h"

namespace assay::harness {

struct NightEvidence {
  NightValue value = {};
  double reference_error = 0;  ///< The error that all runs share; 0 beside a p-value.
};

/// Why a test gives nothing that nights could pool.
struct NoEvidence {
  std::string why;
};

std::variant<NightEvidence, NoEvidence> night_evidence(const TestWork& work, std::size_t channel);

/// A hash of claim, margins, plugins, parameters and primaries of its estimators, references and
/// recorded data.
std::string series_hash(const TestWork& work, std::size_t channel);

}  // namespace assay::harness
