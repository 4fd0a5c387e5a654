#pragma once

// Evidence of one run on a claim, in a form that pools over runs, and of all nights of a series.
//
// A claim about a number gives an estimate of theta at the last look taken, others a p-value.
//
// A run that stopped early gives the estimate it has. That is not normal then, since a small one
// stops sooner. But observations times estimate is a random walk, wherever it is stopped. The
// ledger's E is a martingale in the observations (optional stopping), so its level holds.
//
// A night is left out for what its pilots say and for errors. Its own data never leave it out, as
// the others would be those that look well: samples without their rare values.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/run/planned_run.h"
#include "harness/theta/decision.h"
#include "reports/record/record.h"
#include "stats/planning/evidence_ledger.h"

namespace assay::harness {

// ---- The ledger as data and as text: the evidence of nights with fresh seeds on each claim.
//
//  `assay-ledger 2 budget 0.003
//   series 5f2a… estimates reference 0 weight 0.25 "suite/test" "channel" | 1a2b3c4d
//   night 2026-11-21T02:00:01Z seed 17 commit 14467a0 series 5f2a… estimate 0.0004 error 0.0012
//         observations 4096 effective 1365 "suite/test" "channel" | 5d6e7f80   (one line)
//   night … series 77aa… log-p -0.69 "suite/other" "channel" | …
//   begin "suite/test"                                      written by hand: a new series
//   # a comment, by hand, anywhere
//   end 2                                                   nights in the file`.
//
// The number behind the bar is a checksum of the line and of all series and night lines before it.
// The first one includes the header. Checksums reveal lines that were changed, removed or moved.
// `end` reveals missing lines at the end. Neither protects against intent.

/// The default error budget of a new ledger, over all its nights.
inline constexpr double default_ledger_budget = 3e-3;

/// ln p of a night on a claim without an estimate: a distance between laws or images.
using NightLogP = double;
using NightValue = std::variant<stats::NightEstimate, NightLogP>;

/// The nights of one channel of one claim, as long as neither changes.
struct LedgerSeries {
  std::string hash;  ///< hash of claim, margins and parameters
  /// The error that all nights share; nullopt if nights have p-values.
  std::optional<double> reference_error = {};
  double weight = 0;  ///< The test's share of the budget when the series began.
  std::string test;   ///< the test's id
  std::string channel;
  bool closed = false;  ///< A `begin` line followed.

  bool has_estimates() const { return reference_error.has_value(); }
};

/// The evidence that one run with a fresh seed added to a series.
struct LedgerNight {
  std::string date;  ///< UTC, ISO 8601
  std::uint64_t seed = 0;
  std::string commit;
  std::size_t series = 0;  ///< index in the book
  NightValue value = {};
  bool operator==(const LedgerNight&) const = default;
};

class LedgerBook {
 public:
  explicit LedgerBook(double budget = default_ledger_budget);

  double budget() const { return budget_; }
  const std::vector<LedgerSeries>& series() const { return series_; }
  const std::vector<LedgerNight>& nights() const { return nights_; }
  std::vector<LedgerNight> nights_of(std::size_t series) const;

  /// The index of the open series of its test's channel and hash, if there is one.
  std::optional<std::size_t> open_series(const LedgerSeries& wanted) const;
  /// The number of the series among those of its test's channel, from 1.
  int generation(std::size_t series) const;
  /// True if this seed has added to any series of the test's channel.
  bool has_seed(const LedgerSeries& of, std::uint64_t seed) const;

  /// The index of the open series like `wanted`. It opens one if there is none.
  std::size_t open(const LedgerSeries& wanted);
  void add(const LedgerNight& night);
  /// Closes every series of a test: its next night begins a new one.
  void begin(const std::string& test);

  std::string text() const;

  /// Reads a ledger. InputError with file, line and remedy for anything that `text` would not
  /// write, except comments and `begin` lines.
  static LedgerBook parse(const std::string& text, const std::string& file);

 private:
  void take_begin(const std::string& line, const Location& at);
  void take_series(const std::string& line);
  void take_night(const std::string& line, const Location& at);
  void take_checked(const std::string& line, const Location& at);
  std::string end() const { return "end " + std::to_string(nights_.size()); }
  void keep(const std::string& line) { lines_.push_back(line); }
  void keep_checked(const std::string& line);

  double budget_;
  std::vector<LedgerSeries> series_;
  std::vector<LedgerNight> nights_;
  std::vector<std::string> lines_;  ///< all but `end`, as in the file
  std::uint64_t check_;             ///< checksum of the header and all checked lines
};

/// The text in double quotes, with the escapes \" \\ \n \t \r.
std::string in_quotes(std::string_view text);

// ---- Evidence

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
