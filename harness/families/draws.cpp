#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "harness/draws/sampler_setup.h"
#include "harness/families/families.h"
#include "harness/run/evaluate.h"
#include "stats/means/binomial.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

std::uint64_t sum(std::span<const std::uint64_t> counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

std::string per_cent(double part) { return fmt::format("{:.3g} %", 100 * part); }

/// theta = S + q - claimed. Here S is the density's integral over the domain plus its point masses,
/// by quadrature with a known error. The other part, q, is the probability of a draw without a
/// point, by exact binomial tests at both ends of that error.
Evidence integral(const Seen& seen) {
  const std::span<const std::uint64_t> counts = seen.data[0].cells;
  const DensityCells& cells = density_of(seen.question);
  Evidence evidence = stats::probability_evidence(
      {.successes = cells.in_cells(counts).back(), .trials = sum(counts)},
      cells.mass.total - seen.reference().value, cells.tolerance());
  evidence.quantity = fmt::format(
      "total probability (density {:.10g} +- {:.1g}, plus draws without a point) less {:g}",
      cells.mass.total, cells.tolerance(), seen.reference().value);
  return evidence;
}

/// theta = q - claimed. q is the probability of an inconsistent draw (sampler_setup.h), by
/// exact binomial tests. One such draw disproves "q = 0".
Evidence inconsistency(const Seen& seen) {
  const std::span<const std::uint64_t> counts = seen.data[0].cells;
  const auto& draws = dynamic_cast<const ConsistencySetup&>(*seen.question.subjects[0].setup);
  const std::uint64_t draws_made = sum(counts);
  const std::uint64_t inconsistent = draws_made - counts[0];
  const double claimed = seen.reference().value;
  Evidence evidence =
      stats::probability_evidence({.successes = inconsistent, .trials = draws_made}, -claimed);
  evidence.quantity = "probability of an inconsistent draw";
  if (claimed != 0) evidence.quantity += fmt::format(", less {:g},", claimed);
  constexpr double considerable = 0.1;
  const auto most = std::max_element(counts.begin() + 1, counts.end());
  if (static_cast<double>(*most) > considerable * static_cast<double>(inconsistent)) {
    const auto cell = static_cast<std::size_t>(most - counts.begin()) - 1;
    evidence.most_against =
        always(fmt::format("more in one cell than in any other, {} of them, in {}",
                           per_cent(static_cast<double>(*most) / static_cast<double>(inconsistent)),
                           draws.cells().describe(cell)));
  }
  return evidence;
}

struct CountedProbability {
  double value = 0;
  double error = 0;
};

/// A probability of a sampler's draws, less the claimed one. It is tested exactly.
class DrawsTheta : public Theta {
 public:
  /// `tests` counts the sampler's `draws`.
  DrawsTheta(Draws draws, const char* summary, Evidence (*tests)(const Seen&))
      : Theta({.of_single_values = true, .absolute = "this is a probability"},
              {{"binomial", summary, any_question, Keeps::cells, tests, exact_at_any_size}}),
        draws_(draws) {}

  Question bind(const TestEntry& test, const Estimators& estimators) const override {
    const Source& source = test.claim.left.source;
    const Subject whole = draws(source, estimators, Draws::cells);
    if (whole.declared(0).name != cell_channel) {
      refuse(source.where, "`integral` and `inconsistency` are about a whole sampler: name `{}.{}`",
             source.estimator, whole.purpose);
    }
    return {.test = &test,
            .theta = this,
            .subjects = {draws(source, estimators, draws_)},
            .references = {std::get<Constant>(test.claim.right)}};
  }
  /// Draws that show a probability off by `detect`. Exact binomial tests are planned as normal
  /// ones, plus z^2 / room for discreteness.
  std::optional<std::uint64_t> secondaries(const TestOutcome& test, const ErrorShare& share,
                                           const Pilots&) const override {
    const Regions& regions = test.plan.regions[0];
    const double distance = distance_of(regions);
    if (!(distance > 0)) return std::nullopt;
    const CountedProbability known = counted(test.question);
    const double room = distance - 2 * known.error;
    if (!(room > 0)) return impossible_secondaries;
    const stats::ErrorRates rates = planned_rates(share, regions);
    const double z =
        critical_value(rates.alpha, rates.two_sided) + stats::upper_normal_quantile(rates.beta);
    const double p = std::clamp(known.value, 0.0, 0.5) + distance + regions.allow;
    const double variance = std::min(0.25, p * std::max(0.0, 1 - p));
    const double count = z * z * (variance / (room * room) + 1 / room);
    return whole_secondaries(count);
  }

 protected:
  virtual CountedProbability counted(const Question& question) const {
    return {.value = question.references[0].value};
  }

 private:
  const Draws draws_;
};

class IntegralTheta final : public DrawsTheta {
 public:
  IntegralTheta()
      : DrawsTheta(Draws::cells, "exact: the integral of a sampler's density", integral) {}

  void require_density(const Question& question) const override { density_of(question); }
  std::string why_impossible(const Question& question) const override {
    return fmt::format(
        "no number of observations would decide this claim: the quadrature of the density is "
        "certain only to {:.1g}, too little for the margin; give a larger one, or let the "
        "sampler's panels() be finer",
        density_of(question).tolerance());
  }

 protected:
  CountedProbability counted(const Question& question) const override {
    const DensityCells& cells = density_of(question);
    return {.value = question.references[0].value - cells.mass.total, .error = cells.tolerance()};
  }
};

class InconsistencyTheta final : public DrawsTheta {
 public:
  InconsistencyTheta()
      : DrawsTheta(Draws::consistency, "exact: how often a draw contradicts its sampler",
                   inconsistency) {}

  std::string caveat(const DrawnTest& test) const override { return first_contradiction(test); }
};

}  // namespace

const Theta& theta_of_integrals() { return one<IntegralTheta>(); }
const Theta& theta_of_inconsistencies() { return one<InconsistencyTheta>(); }

}  // namespace assay::harness
