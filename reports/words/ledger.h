#pragma once

// The ledger of nights in words, the same in every format.

#include <string>
#include <vector>

#include "reports/record/record.h"

namespace assay::reports {

/// "Ledger nightly.ledger: 2 alarms in 57 series (false alarms: at most 0.003 a suite)".
std::string ledger_title(const Ledger&);

/// "luminaire/mean(area) == analytic", with the channel where the test has several.
std::string series_name(const Ledger&, const LedgerSeries&);

/// E = exp(log_e) in two to four digits, also far beyond a double's range.
std::string e_text(const Number& log_e);

/// "12 nights since 2026-11-10: relative difference +0.031 % +- 0.005 %, E = 1.3e+05, alarm at
/// 667".
std::string series_sentence(const LedgerSeries&);

/// Sentences on the first night of an alarm, and the night at which theta most likely moved. Empty
/// without an alarm.
std::string alarm_sentence(const LedgerSeries&);

/// The command that lists the commits between the night before theta moved and that night. Empty
/// where they are one commit, or theta need not have moved.
std::string changes(const LedgerSeries&);

/// One sentence for all series without an alarm: their number, and which stands highest.
std::string quiet_sentence(const Ledger&);

/// Notes on what this run added, those of several series in one sentence.
std::vector<std::string> ledger_notes(const Ledger&);

}  // namespace assay::reports
