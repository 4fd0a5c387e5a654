#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/draws/sampler_setup.h"
#include "harness/families/evidence_draws.h"
#include "harness/families/families.h"
#include "harness/plan/frozen.h"
#include "harness/plan/planned_rates.h"
#include "harness/plan/sample_size.h"
#include "harness/question/question_sources.h"
#include "harness/run/evaluate.h"
#include "harness/run/observation_faults.h"
#include "harness/theta/critical.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

/// The probability that the claim counts, and its error.
struct CountedProbability {
  double value = 0;
  double error = 0;
};

/// A probability of a sampler's draws, less the claimed one. It is tested exactly.
class DrawsTheta : public Theta {
 public:
  DrawsTheta() : Theta({.of_single_values = true}) {}

  const std::vector<MethodRow>& methods() const override { return rows(); }

  void check_margin(const Question& question, const Margin& margin) const override {
    require_absolute(margin, "this is a probability");
    Theta::check_margin(question, margin);
  }
  std::optional<double> known_size(const Question&) const override { return std::nullopt; }

  std::uint64_t choose(const Question& question, const FamilyPlace&, const Pilots& pilots,
                       std::uint64_t, Plan& plan) const override {
    freeze(question, pilots, plan);
    return least_secondaries;
  }

  /// Draws that show a probability off by `detect`. Exact binomial tests are planned as normal
  /// ones, plus z^2 / room for discreteness.
  std::optional<std::uint64_t> secondaries(const Question& question, const ErrorShare& share,
                                           const Pilots&, const Plan& plan) const override {
    const Regions& regions = plan.regions[0];
    const double distance = distance_of(regions);
    if (!(distance > 0)) return std::nullopt;
    const CountedProbability known = counted(question);
    const double room = distance - 2 * known.error;
    if (!(room > 0)) return impossible_secondaries;
    const stats::ErrorRates rates = planned_rates(share, regions);
    const auto quantile = [](double level) {
      return stats::normal_quantile({stats::Tail::upper, std::log(level)});
    };
    const double z =
        quantile(rates.two_sided ? rates.alpha / 2 : rates.alpha) + quantile(rates.beta);
    const double p = std::clamp(known.value, 0.0, 0.5) + distance + regions.allow;
    const double variance = std::min(0.25, p * std::max(0.0, 1 - p));
    const double count = z * z * (variance / (room * room) + 1 / room);
    return count < 0x1p53 ? static_cast<std::uint64_t>(std::ceil(count)) : impossible_secondaries;
  }

 protected:
  virtual CountedProbability counted(const Question&) const = 0;

 private:
  static const std::vector<MethodRow>& rows();
};

class IntegralTheta final : public DrawsTheta {
 public:
  void require_density(const Question& question) const override {
    dynamic_cast<const SamplerSetup&>(*question.subjects[0].setup).density_cells();
  }
  std::string why_impossible(const Question& question) const override {
    const auto& draws = dynamic_cast<const SamplerSetup&>(*question.subjects[0].setup);
    return fmt::format(
        "no number of observations would decide this claim: the quadrature of the density is "
        "certain only to {:.1g}, too little for the margin; give a larger one, or let the "
        "sampler's panels() be finer",
        draws.density_cells().tolerance());
  }

 protected:
  CountedProbability counted(const Question& question) const override {
    const auto& draws = dynamic_cast<const SamplerSetup&>(*question.subjects[0].setup);
    return {.value = question.references[0].value - draws.density_cells().mass.total,
            .error = draws.density_cells().tolerance()};
  }
};

class InconsistencyTheta final : public DrawsTheta {
 public:
  std::string where_it_differs(const DrawnTest& test) const override {
    return first_contradiction(test);
  }

 protected:
  CountedProbability counted(const Question& question) const override {
    return {.value = question.references[0].value};
  }
};

const IntegralTheta integral_theta;
const InconsistencyTheta inconsistency_theta;

Evidence integral(const Method&, const Question& question, std::size_t,
                  std::span<const ChannelData> data) {
  return evidence_of_integral(question, data[0]);
}

Evidence inconsistency(const Method&, const Question& question, std::size_t,
                       std::span<const ChannelData> data) {
  return evidence_of_inconsistency(question, data[0]);
}

const std::vector<MethodRow>& DrawsTheta::rows() {
  static const std::vector<MethodRow> table{
      {"binomial",
       "exact: what a sampler's density integrates to",
       [](const Question& q) { return q.theta == &integral_theta; },
       Keeps::cells,
       integral,
       {.exact = true}},
      {"binomial",
       "exact: how often a draw contradicts its sampler",
       [](const Question& q) { return q.theta == &inconsistency_theta; },
       Keeps::cells,
       inconsistency,
       {.exact = true}}};
  return table;
}

void require_whole_sampler(const Source& source, const Estimators& estimators) {
  const Subject marginal = draws(source, estimators, Draws::cells);
  const std::vector<Channel> channels = marginal.setup->channels();
  if (channels[marginal.channels[0]].name == cell_channel) return;
  throw InputError(source.where,
                   fmt::format("`integral` and `inconsistency` are about a whole sampler: name "
                               "`{}.{}`",
                               source.estimator, marginal.purpose));
}

Question bind_draws(const TestEntry& test, const Estimators& estimators, const Theta& theta,
                    Draws what) {
  const Claim& claim = test.claim;
  require_whole_sampler(claim.left.source, estimators);
  return {.test = &test,
          .theta = &theta,
          .subjects = {draws(claim.left.source, estimators, what)},
          .references = {std::get<Constant>(claim.right)}};
}

}  // namespace

Question bind_integral(const TestEntry& test, const Estimators& estimators) {
  return bind_draws(test, estimators, integral_theta, Draws::cells);
}

Question bind_inconsistency(const TestEntry& test, const Estimators& estimators) {
  return bind_draws(test, estimators, inconsistency_theta, Draws::consistency);
}

const Theta& theta_of_draws() { return integral_theta; }

}  // namespace assay::harness
