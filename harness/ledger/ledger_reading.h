#pragma once

// Combines the nights of a series.

#include <vector>

#include "harness/ledger/ledger_book.h"
#include "harness/theta/decision.h"

namespace assay::harness {

/// ln E after each night, for the null hypothesis "theta is in the range". It is the least over the
/// range, which lies at the value nearest to the estimate of all nights so far. It is at most E at
/// the true theta, a martingale, so P(any >= 1 / alpha) <= alpha. P-values know no range.
std::vector<double> log_e_path(const LedgerSeries& series, const std::vector<LedgerNight>& nights,
                               const ThetaRange& claimed);

/// The most likely first night of a change, and the range of likely nights. The range holds 90 % of
/// the posterior (stats::change_point).
struct Moved {
  std::size_t night = 0;
  std::size_t from = 0;
  std::size_t to = 0;
};
Moved moved(const LedgerSeries& series, const std::vector<LedgerNight>& nights,
            const ThetaRange& claimed);

/// The nights' estimates, or the logarithms of their p-values: the series says which they have.
std::vector<stats::NightEstimate> estimates_of(const std::vector<LedgerNight>& nights);
std::vector<double> log_p_values_of(const std::vector<LedgerNight>& nights);

/// The share of a test's error budget for its k-th series: 1 / (zeta(3) k^3). The shares sum to 1,
/// so a claim keeps its budget however often it is changed or begun anew. The first has 0.83.
double generation_share(int generation);

}  // namespace assay::harness
