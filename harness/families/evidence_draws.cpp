#include "harness/families/evidence_draws.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "harness/draws/consistency_setup.h"
#include "stats/means/binomial.h"

namespace assay::harness {
namespace {

using stats::Interval;
using stats::TestResult;

constexpr double impossible = std::numeric_limits<double>::lowest();

/// theta = q + offset; the offset has an error.
struct Shifted {
  stats::Successes seen;
  double offset = 0;
  double error = 0;
};

/// log_p_upper of "q is at most `most`"; no probability is below 0.
double log_p_at_most(const stats::Successes& seen, double most) {
  return most < 0 ? impossible : stats::binomial(seen, std::min(most, 1.0)).log_p_upper;
}

double log_p_at_least(const stats::Successes& seen, double least) {
  return least > 1 ? impossible : stats::binomial(seen, std::max(least, 0.0)).log_p_lower;
}

Evidence from_probability(const Shifted& known) {
  const auto at = [known](double theta) {
    const double q = theta - known.offset;
    return TestResult{.statistic = static_cast<double>(known.seen.successes),
                      .distribution = {.family = "binomial",
                                       .parameters = {static_cast<double>(known.seen.trials),
                                                      std::clamp(q, 0.0, 1.0)}},
                      .log_p_lower = log_p_at_least(known.seen, q - known.error),
                      .log_p_upper = log_p_at_most(known.seen, q + known.error)};
  };
  const auto interval = [known](double confidence) -> Interval {
    const Interval q = stats::clopper_pearson(known.seen, confidence);
    return {q.low + known.offset - known.error, q.high + known.offset + known.error, confidence};
  };
  const double share =
      static_cast<double>(known.seen.successes) / static_cast<double>(known.seen.trials);
  return {.estimate = share + known.offset, .at = at, .interval = interval};
}

std::uint64_t sum(std::span<const std::uint64_t> counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

std::string per_cent(double part) { return fmt::format("{:.3g} %", 100 * part); }

}  // namespace

Evidence evidence_of_integral(const Question& question, const ChannelData& data) {
  const auto& draws = dynamic_cast<const SamplerSetup&>(*question.subjects[0].setup);
  const DensityCells& cells = draws.density_cells();
  Evidence evidence =
      from_probability({.seen = {.successes = data.cells.back(), .trials = sum(data.cells)},
                        .offset = cells.mass.total - question.references[0].value,
                        .error = cells.tolerance()});
  evidence.quantity = fmt::format(
      "integral of the density ({:.10g}, quadrature error {:.1g}) and the mass without a point, "
      "less "
      "{:g},",
      cells.mass.total, cells.tolerance(), question.references[0].value);
  return evidence;
}

Evidence evidence_of_inconsistency(const Question& question, const ChannelData& data) {
  const auto& draws = dynamic_cast<const ConsistencySetup&>(*question.subjects[0].setup);
  const std::uint64_t draws_made = sum(data.cells);
  const std::uint64_t inconsistent = draws_made - data.cells[0];
  Evidence evidence = from_probability({.seen = {.successes = inconsistent, .trials = draws_made},
                                        .offset = -question.references[0].value});
  evidence.quantity = "probability of an inconsistent draw";
  if (const double claimed = question.references[0].value; claimed != 0) {
    evidence.quantity += fmt::format(", less {:g},", claimed);
  }
  if (inconsistent > 0) {
    const auto most = std::max_element(data.cells.begin() + 1, data.cells.end());
    const auto cell = static_cast<std::size_t>(most - data.cells.begin()) - 1;
    evidence.most_against =
        always(fmt::format("; more in one cell than in any other, {} of them, in {}",
                           per_cent(static_cast<double>(*most) / static_cast<double>(inconsistent)),
                           draws.cells().describe(cell)));
  }
  return evidence;
}

}  // namespace assay::harness
