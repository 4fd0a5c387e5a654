#pragma once

// The pictures of the HTML report, each a piece of inline SVG; empty where there is nothing to
// draw.

#include <string>
#include <vector>

#include "reports/record/record.h"
#include "reports/words/kill_matrix.h"

namespace assay::reports {

/// Bars from zero with intervals, one row for each estimator that has the channel. Means are red
/// and variances blue; dashed lines mark exact values. The axis of variances is logarithmic if
/// their values span more than a factor of 50.
std::string mean_bars(const Suite& suite, const std::string& channel);
std::string variance_bars(const Suite& suite, const std::string& channel);

/// Pairs of a suite's estimators in one channel, for the first 40. Above the diagonal a cell says
/// if the means agree; below it, whose variance is smaller.
std::string pair_matrix(const Suite& suite, const std::string& channel);
inline constexpr std::size_t most_in_matrix = 40;

/// Mutants against methods (reports/kill_matrix.h). The fewer samples killed a mutant, the darker
/// the cell, a step for each decade. Empty if no mutant was tested by two methods.
std::string kill_chart(const Suite& suite, const KillMatrix& matrix);

/// A test's effect against none, `allow` and `detect`: one interval a channel, the first 40. A
/// logarithm of a ratio is drawn as the ratio.
std::string interval_chart(const Test&);
inline constexpr std::size_t most_in_interval_chart = 40;

/// The same for a table row: the worst channel alone, no labels.
std::string interval_sketch(const Test&);

/// Observations of one or two sources with the reference marked: counts per bin for one source,
/// densities for two. What lies outside the bins is said at the ends.
struct Observations {
  std::vector<const Sample*> samples;  ///< one or two
  Number reference;
};
std::string histogram_chart(const Observations&);

/// Normal quantile plot: a sample from a normal law follows the line mean + standard deviation * z.
std::string quantile_chart(const Sample&);

/// Empirical distribution functions within their bands, one or two, and the law that was claimed of
/// one.
std::string law_chart(const Channel&);

}  // namespace assay::reports
