#include "harness/record/comparisons.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "harness/sampling/beyond_doubles.h"
#include "stats/means/welch_t.h"
#include "stats/planning/holm.h"
#include "stats/variances/influence.h"

namespace assay::harness {
namespace {

stats::Moments moments_of(const reports::Moments& recorded) {
  return {.count = recorded.count,
          .mean = recorded.mean,
          .m2 = recorded.m2,
          .m3 = recorded.m3,
          .m4 = recorded.m4,
          .minimum = recorded.min,
          .maximum = recorded.max,
          .nonzero = recorded.nonzero,
          .rest = recorded.rest};
}

// More pairs would not be readable.
constexpr std::size_t most_estimators = 40;

using Pair = std::pair<std::string, std::string>;

std::set<Pair> pairs_of(const std::vector<std::vector<std::string>>& claimed) {
  std::set<Pair> pairs;
  for (const std::vector<std::string>& names : claimed) {
    if (names.size() == 2) pairs.insert(std::minmax(names[0], names[1]));
  }
  return pairs;
}

/// True if both estimate one quantity, as far as known.
bool comparable(const Pictured& first, const Pictured& second, const std::set<Pair>& claimed) {
  const auto untold = [](const Pictured& each) { return each.shown.image || !each.shown.drawn; };
  if (untold(first) || untold(second)) return false;
  if (claimed.contains(std::minmax(first.name, second.name))) return true;
  const std::vector<reports::ShardChannel>& mine = first.shown.channels;
  const std::vector<reports::ShardChannel>& theirs = second.shown.channels;
  if (mine.size() != theirs.size()) return false;
  for (std::size_t i = 0; i < mine.size(); ++i) {
    if (mine[i].name != theirs[i].name || !mine[i].reference || !theirs[i].reference) return false;
    // Two closed forms of one number may differ by rounding.
    const double scale = std::max(std::abs(*mine[i].reference), std::abs(*theirs[i].reference));
    if (std::abs(*mine[i].reference - *theirs[i].reference) > 1e-9 * scale) return false;
  }
  return true;
}

struct ComparedPair {
  reports::Comparison row;
  double log_mean_p = 0;
  double log_variance_p = 0;
};

ComparedPair compare(const Pictured& first, const Pictured& second, std::size_t channel) {
  const stats::Moments x = moments_of(first.shown.channels[channel].moments);
  const stats::Moments y = moments_of(second.shown.channels[channel].moments);
  ComparedPair pair{.row = {.first = first.name,
                            .second = second.name,
                            .channel = first.shown.channels[channel].name}};
  if (!has_spread(x) || !has_spread(y)) return pair;
  const double null = second.shown.averaged / first.shown.averaged;
  pair.log_mean_p = stats::log_p_two_sided(stats::welch_t(x, y, {}));
  pair.row.mean_p = std::exp(pair.log_mean_p);
  pair.row.log10_mean_p = pair.log_mean_p / std::log(10.0);
  // The variance of a primary and that of a secondary are two quantities.
  if (first.averages != second.averages) return pair;
  pair.log_variance_p = stats::log_p_two_sided(stats::influence_t(
      stats::influence_of_variance(x), stats::influence_of_variance(y), std::log(null)));
  pair.row.variance_p = std::exp(pair.log_variance_p);
  pair.row.log10_variance_p = pair.log_variance_p / std::log(10.0);
  const double ratio = x.variance() / y.variance() / null;
  if (std::isfinite(ratio)) pair.row.variance_ratio = ratio;
  return pair;
}

void mark_differences(std::vector<ComparedPair>& pairs, double alpha) {
  std::vector<double> log_p;
  for (const ComparedPair& pair : pairs) {
    log_p.push_back(pair.log_mean_p);
    log_p.push_back(pair.log_variance_p);
  }
  const std::vector<double> adjusted = stats::holm(log_p);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].row.means_differ = adjusted[2 * i] <= std::log(alpha);
    pairs[i].row.variances_differ = adjusted[2 * i + 1] <= std::log(alpha);
  }
}

}  // namespace

reports::Moments recorded(const stats::Moments& moments) {
  return {.count = moments.count,
          .mean = moments.mean,
          .m2 = moments.m2,
          .m3 = moments.m3,
          .m4 = moments.m4,
          .min = moments.minimum,
          .max = moments.maximum,
          .nonzero = moments.nonzero,
          .rest = moments.rest};
}

bool has_spread(const stats::Moments& moments) {
  return moments.count > 3 && moments.m2 > 0 && beyond_doubles(moments, "").empty();
}

std::vector<reports::Comparison> comparisons(const std::vector<Pictured>& estimators,
                                             const std::vector<std::vector<std::string>>& claimed,
                                             double alpha) {
  if (estimators.size() > most_estimators) return {};
  const std::set<Pair> together = pairs_of(claimed);
  std::vector<ComparedPair> pairs;
  for (std::size_t i = 0; i < estimators.size(); ++i) {
    for (std::size_t j = i + 1; j < estimators.size(); ++j) {
      const Pictured& first = estimators[i];
      const Pictured& second = estimators[j];
      if (!comparable(first, second, together)) continue;
      const std::size_t channels =
          std::min(first.shown.channels.size(), second.shown.channels.size());
      for (std::size_t c = 0; c < channels; ++c) pairs.push_back(compare(first, second, c));
    }
  }
  mark_differences(pairs, alpha);
  std::vector<reports::Comparison> rows;
  for (ComparedPair& pair : pairs) rows.push_back(std::move(pair.row));
  return rows;
}

}  // namespace assay::harness
