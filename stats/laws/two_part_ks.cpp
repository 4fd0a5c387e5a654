#include "stats/laws/two_part_ks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "stats/basics/check.h"
#include "stats/laws/band_walk.h"

namespace assay::stats {
namespace {

struct Parts {
  std::uint64_t atoms;
  std::vector<double> rest;
};

Parts split(std::span<const double> sorted, double atom) {
  check::at_least({"two_part_ks", "values"}, sorted.size(), 1);
  if (!std::is_sorted(sorted.begin(), sorted.end())) {
    check::fail({"two_part_ks", "values"}, sorted.size(), "sorted ascending");
  }
  check::finite({"two_part_ks", "smallest value"}, sorted.front());
  check::finite({"two_part_ks", "largest value"}, sorted.back());
  check::finite({"two_part_ks", "atom"}, atom);
  const auto [begin, end] = std::equal_range(sorted.begin(), sorted.end(), atom);
  Parts parts{static_cast<std::uint64_t>(end - begin), {sorted.begin(), begin}};
  parts.rest.insert(parts.rest.end(), end, sorted.end());
  return parts;
}

const TestResult nothing_to_say{0, {"bound", {}}, 0, 0, Exactness::exact};

double combined(const TestResult& atom, const TestResult& rest) {
  return std::min(0.0, std::numbers::ln2 + std::min(log_p_two_sided(atom), rest.log_p_upper));
}

// The number of x among the atoms of both, hypergeometric given their total.
TestResult proportions(std::uint64_t among_x, std::uint64_t atoms, BandWalk::Pool pool) {
  if (atoms == 0 || atoms == pool.total) return nothing_to_say;
  const BandWalk walk = BandWalk::two_samples(pool, {atoms});
  return {static_cast<double>(among_x),
          {"bound", {}},
          walk.log_lower(0, among_x),
          walk.log_upper(0, among_x),
          Exactness::exact};
}

}  // namespace

TwoPartTest two_part_ks(std::span<const double> sorted_x, std::span<const double> sorted_y,
                        double atom) {
  const Parts x = split(sorted_x, atom);
  const Parts y = split(sorted_y, atom);
  TwoPartTest result;
  result.atoms_x = x.atoms;
  result.atoms_y = y.atoms;
  result.atom =
      proportions(x.atoms, x.atoms + y.atoms, {sorted_x.size(), sorted_x.size() + sorted_y.size()});
  result.rest = x.rest.empty() || y.rest.empty() ? nothing_to_say
                                                 : kolmogorov_smirnov(ks_distance(x.rest, y.rest));
  result.log_p = combined(result.atom, result.rest);
  return result;
}

}  // namespace assay::stats
