#pragma once

// The part of the record that tells of a ledger: what many nights with fresh seeds say together.

#include <string>
#include <vector>

#include "reports/record/record_effect.h"

namespace assay::reports {

/// The evidence of one night, and of all nights up to it.
struct LedgerNight {
  std::string date;  ///< UTC, ISO 8601
  std::string commit;
  Number estimate, low, high;  ///< Theta by this night, with its own 95 % interval.
  Number log_p;                ///< ln of the p-value of a night without an estimate.
  Number log_e;                ///< ln of the e-value of all nights up to it.
  ASSAY_FIELDS(LedgerNight, date, commit, estimate, low, high, log_p, log_e)
};

/// One channel of one claim in the ledger: what all nights with fresh seeds say together.
struct LedgerSeries {
  std::string test;  ///< id
  std::string channel;
  std::string series;    ///< hash of claim, margins and parameters: another one is another series
  std::string quantity;  ///< theta, as in Effect; empty where nights have p-values
  bool relative = false;
  std::vector<LedgerNight> nights;   ///< In their order.
  Number estimate, standard_error;   ///< Of theta, by all nights.
  Number reference_error;            ///< The standard error of theta that all nights share.
  Number limit;                      ///< The ln E that is an alarm.
  bool alarm = false;                ///< ln E reached the limit after some night.
  std::string since;                 ///< The first such night.
  std::string moved;                 ///< The night at which theta most likely moved, of an alarm.
  std::string moved_commit;          ///< The commit of that night.
  std::string moved_from, moved_to;  ///< First and last of the nights that hold 90 % of it.
  bool added = false;                ///< This run is one of the nights.
  std::string note;                  ///< Why it is not, or that a new series began.

  /// ln of the e-value of all nights.
  Number log_e() const { return nights.empty() ? Number() : nights.back().log_e; }
  ASSAY_FIELDS(LedgerSeries, test, channel, series, quantity, relative, nights, estimate,
               standard_error, reference_error, limit, alarm, since, moved, moved_commit,
               moved_from, moved_to, added, note)
};

/// The ledger that a run added to, of the tests it ran. An empty file name: none was kept.
struct Ledger {
  std::string file;
  Number budget;  ///< of each suite, over all nights
  std::vector<LedgerSeries> series;
  ASSAY_FIELDS(Ledger, file, budget, series)
};

/// Series with an alarm.
int alarms(const Ledger&);

}  // namespace assay::reports
