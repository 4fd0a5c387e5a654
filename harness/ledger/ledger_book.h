#pragma once

// The ledger as data and as text: what nights with fresh seeds said of each claim.
//
//   assay-ledger 1 budget 0.003
//   series 5f2a… score effect 0.0012 reference 0 weight 0.25 "suite/test" "channel" | 1a2b3c4d
//   night 2026-11-21T02:00:01Z seed 17 commit 14467a0 series 5f2a… score 12.2 information 3e4
//         "suite/test" "channel" | 5d6e7f80                                    (one line)
//   night … series 77aa… log-e -0.69 "suite/other" "channel" | …
//   begin "suite/test"                                      written by hand: a new series
//   # a comment, by hand, anywhere
//   end 2                                                   nights in the file
//
// The number behind the bar is a checksum of the line and of all series and night lines before it,
// the first of the header: a line that was changed, taken out or moved is found, and `end` finds
// lines missing at the end. Not a seal against intent.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "stats/planning/evidence_ledger.h"

namespace assay::harness {

/// The share of the error budget that is the default of a new ledger: over all its nights.
inline constexpr double default_ledger_budget = 3e-3;

enum class EvidenceKind {
  score,  ///< score and information on theta: means and variances
  log_e   ///< ln of an e-value: distances between laws
};

/// One channel of one claim of a test, as long as neither changes. What is fixed before the first
/// night: the prior of its e-value.
struct LedgerSeries {
  std::string hash;  ///< of claim, margins and parameters
  EvidenceKind kind = EvidenceKind::score;
  stats::LedgerPrior prior = {};  ///< of a score
  /// The test's share of the budget when the series began; of files written before it was kept: 0.
  double weight = 0;
  std::string test;  ///< id
  std::string channel;
  bool operator==(const LedgerSeries& other) const;
};

/// What one run with a fresh seed added to a series.
struct LedgerNight {
  std::string date;  ///< UTC, ISO 8601
  std::uint64_t seed = 0;
  std::string commit;
  std::size_t series = 0;         ///< index in the book
  stats::Evidence evidence = {};  ///< of a score
  double log_e = 0;               ///< of a log_e
  bool operator==(const LedgerNight&) const = default;
};

/// Everything in a ledger, in the order of its lines.
class LedgerBook {
 public:
  explicit LedgerBook(double budget = default_ledger_budget);

  double budget() const { return budget_; }
  const std::vector<LedgerSeries>& series() const { return series_; }
  const std::vector<LedgerNight>& nights() const { return nights_; }
  std::vector<LedgerNight> nights_of(std::size_t series) const;

  /// The series of a test's channel that is not closed and has this hash, if any.
  const LedgerSeries* open_series(const LedgerSeries& wanted) const;
  /// How many series the test's channel had up to this one: 1 for its first.
  int generation(std::size_t series) const;
  /// Whether this seed has added to any series of the test's channel.
  bool has_seed(const LedgerSeries& of, std::uint64_t seed) const;

  /// The index of the open series like `wanted`, which is opened with its prior if there is none.
  std::size_t open(const LedgerSeries& wanted);
  void add(const LedgerNight& night);
  /// Closes every series of a test: its next night begins a new one.
  void begin(const std::string& test);

  /// The whole file.
  std::string text() const;

  /// Reads a ledger. InputError with file, line and what to do for anything that is not as `text`
  /// writes it, comments and `begin` lines apart.
  static LedgerBook parse(const std::string& text, const std::string& file);

 private:
  friend class LedgerReader;
  void keep(const std::string& line) { lines_.push_back(line); }
  void keep_checked(const std::string& line);

  double budget_;
  std::vector<LedgerSeries> series_;
  std::vector<bool> closed_;
  std::vector<LedgerNight> nights_;
  std::vector<std::string> lines_;  ///< all but `end`, as they are in the file
  std::uint64_t check_;             ///< of the header and all checked lines
};

}  // namespace assay::harness
