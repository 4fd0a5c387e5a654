#pragma once

// What the nights of a series say together.

#include <optional>
#include <vector>

#include "harness/ledger/ledger_book.h"
#include "harness/theta/decision.h"

namespace assay::harness {

/// Values of theta at which the claim holds.
struct ClaimedRange {
  double low;
  double high;
};
ClaimedRange claimed_range(const Regions& regions);

/// ln E after each night, of the null hypothesis "theta is in the range": the least over the range,
/// which is E at the value nearest to the estimate of all nights so far. Each of these is below E
/// at the true theta, a martingale, so P(any >= 1 / alpha) <= alpha.
std::vector<double> log_e_path(const LedgerSeries& series, const std::vector<LedgerNight>& nights,
                               const ClaimedRange& claimed);

/// When theta moved: the most likely first night of it, and the first and last of the most likely
/// nights that share 90 % of the posterior (stats::change_point); of e-values the night from which
/// they multiply to the most, alone.
struct Moved {
  std::size_t night = 0;
  std::size_t from = 0;
  std::size_t to = 0;
};
Moved moved(const LedgerSeries& series, const std::vector<LedgerNight>& nights);

/// The share of a test's error budget that its k-th series may spend: 1 / (zeta(3) k^3). They sum
/// to 1, so that a claim that is changed or begun anew any number of times keeps the budget; the
/// first has 0.83.
double generation_share(int generation);

}  // namespace assay::harness
