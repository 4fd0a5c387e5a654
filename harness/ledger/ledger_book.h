#pragma once

// The ledger as data and as text: the evidence of nights with fresh seeds on each claim.
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

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "stats/planning/evidence_ledger.h"

namespace assay::harness {

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

/// A whole ledger, in the order of its lines.
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
  friend class LedgerReader;
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

}  // namespace assay::harness
