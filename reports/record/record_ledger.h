#pragma once

// The part of the record that tells of a ledger: what many nights with fresh seeds say together.

#include <cstdint>
#include <string>
#include <vector>

#include "reports/record/optional_number.h"

namespace assay::reports {

/// One channel of one claim in the ledger: what all nights with fresh seeds say together.
struct LedgerSeries {
  std::string test;  ///< id
  std::string channel;
  std::string series;    ///< hash of claim, margins and parameters: another one is another series
  std::string quantity;  ///< theta, as in Effect; empty where nights add up as e-values
  bool relative = false;
  std::uint64_t nights = 0;
  std::string first, last;           ///< dates of the first and the last night, UTC, ISO 8601
  Number score, information;         ///< sums over the nights; theta is about score / information
  Number reference_error;            ///< of theta, the same on all nights: no sum takes it away
  Number log_e;                      ///< ln of the e-value of all nights
  Number limit;                      ///< the ln E that is an alarm
  bool alarm = false;                ///< ln E was at the limit after some night
  std::string since;                 ///< the first such night
  std::string moved;                 ///< of an alarm: the night at which theta most likely moved
  std::string moved_commit;          ///< what ran then
  std::string moved_from, moved_to;  ///< first and last of the most likely nights, 90 % together
  bool added = false;                ///< this run is one of the nights
  std::string note;                  ///< why it is not, or that a new series began
  bool operator==(const LedgerSeries&) const = default;
};

/// The ledger that a run added to, of the tests it ran. An empty file name: none was kept.
struct Ledger {
  std::string file;
  Number budget;  ///< of each suite, over all nights
  std::vector<LedgerSeries> series;
  bool operator==(const Ledger&) const = default;
};

/// Series with an alarm.
int alarms(const Ledger&);

}  // namespace assay::reports
