#pragma once

// Evidence of one run on a claim, in a form that pools over runs, and of all nights of a series.
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

#include <optional>
#include <string>
#include <vector>

#include "harness/ledger/ledger_book.h"
#include "harness/run/planned_run.h"
#include "harness/theta/decision.h"
#include "reports/record/record.h"

namespace assay::harness {

/// A value that nights can pool, or an obstacle: one of `value` and `obstacle` is set.
struct NightEvidence {
  std::optional<NightValue> value = {};
  std::optional<double> reference_error = {};  ///< Error that all runs share, beside an estimate.
  std::string obstacle = "";                   ///< Why there is no value that nights could pool.
};

NightEvidence night_evidence(const TestWork& work, std::size_t channel);

/// A hash of claim, margins, plugins, parameters and primaries of its estimators, references and
/// recorded data.
std::string series_hash(const TestWork& work, std::size_t channel);

/// ln E after each night, for the null hypothesis "theta is in the range". It is the least over the
/// range, which lies at the value nearest to the estimate of all nights so far. It is at most E at
/// the true theta, a martingale, so P(any >= 1 / alpha) <= alpha. P-values know no range.
std::vector<double> log_e_path(const LedgerSeries& series, const std::vector<LedgerNight>& nights,
                               const stats::Range& claimed);

/// The most likely first night of a change, and the range of likely nights. The range holds 90 % of
/// the posterior (stats::change_point).
struct Moved {
  std::size_t night = 0;
  std::size_t from = 0;
  std::size_t to = 0;
};
Moved moved(const LedgerSeries& series, const std::vector<LedgerNight>& nights,
            const stats::Range& claimed);

/// The share of a test's error budget for its k-th series: 1 / (zeta(3) k^3). The shares sum to 1,
/// so a claim keeps its budget however often it is changed or begun anew. The first has 0.83.
double generation_share(int generation);

// `--ledger FILE`: keeps the evidence of nights with fresh seeds, with its own error budget. Many
// nights together find a bias that each one misses.

/// InputError, before anything is sampled, if a ledger could not be kept. Reasons are an unreadable
/// file and a missing folder.
void require_ledger(const std::string& file);

/// Adds the evidence of every selected test inside its suite's family to the file, unless its seed
/// is there already. Returns what all nights of these tests mean together. An alarm is raised if E
/// reaches 1 / (budget * the channel's weight in its suite * generation_share). The file is locked
/// while it is read and replaced.
reports::Ledger add_to_ledger(const std::string& file, const reports::Record& record,
                              const SuiteRuns& runs);

}  // namespace assay::harness
