#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "harness/draws/sampler_setup.h"
#include "harness/families/families.h"
#include "harness/families/law_evidence.h"
#include "harness/language/quantities.h"
#include "harness/plan/independence.h"
#include "harness/plan/pilot_shape.h"
#include "harness/plan/sizes.h"
#include "harness/question/question_sources.h"
#include "harness/run/evaluate.h"
#include "stats/basics/sorted.h"
#include "stats/cells/chi_square_fit.h"
#include "stats/gates/assumption_gates.h"
#include "stats/planning/power.h"

namespace assay::harness {
namespace {

// ---- Evidence

Evidence law_against_law(const Method&, const Question& question, std::size_t channel,
                         std::span<const ChannelData> data) {
  return points_against_points(points_of(question, 0, channel, data[0].values),
                               points_of(question, 1, channel, data[1].values));
}

Evidence values_against_law(const Method&, const Question& question, std::size_t channel,
                            std::span<const ChannelData> data) {
  return points_against_law(points_of(question, 0, channel, data[0].values),
                            declared_law(question, channel));
}

/// True if a sampler's draws are tested against its density in cells of all coordinates.
bool of_whole_draws(const Question& question) {
  const Subject& draws = question.subjects[0];
  return draws.setup->channels()[draws.channels[0]].name == cell_channel;
}

// ---- Sizes

stats::ErrorRates rates_of(const ErrorShare& share) {
  return {.alpha = share.alpha, .beta = share.beta, .two_sided = false};
}

stats::DistancePlan distance_plan(const Question& question, const ErrorShare& share, double allow,
                                  double allocation = 1) {
  return {.two_samples = question.of_two(),
          .allocation = allocation,
          .allow = allow,
          .rates = rates_of(share)};
}

/// True if counts in cells are tested. A plan without frozen cells is invalid.
bool in_cells(const Plan& plan) {
  return plan.method.keeps == Keeps::cells || plan.method.frozen.cells != nullptr;
}

/// Degrees of freedom at so many observations. Cells that expect too few are pooled.
double degrees_of_freedom(const Question& question, const Plan& plan, double observations) {
  // Draws without a point are one more cell, so none is subtracted.
  if (plan.method.frozen.cells) return static_cast<double>(plan.method.frozen.cells->size());
  const auto& draws = dynamic_cast<const SamplerSetup&>(*question.subjects[0].setup);
  const double least = stats::FitOptions{}.minimum_expected;
  double pools = 0;
  for (const double p : draws.density_cells().mass.probability) {
    pools += std::min(1.0, observations * p / least);
  }
  pools += std::min(1.0, observations * draws.density_cells().missing() / least);
  return std::max(1.0, pools - 1);
}

stats::FitPlan fit_plan(const Question& question, const Plan& plan, const ErrorShare& share,
                        double observations) {
  return {.degrees_of_freedom = degrees_of_freedom(question, plan, observations),
          .allow = plan.regions[0].allow,
          .rates = rates_of(share)};
}

/// Fewer observations fill fewer pools, which need fewer observations. Each round's number is
/// enough; four rounds save nearly all.
std::optional<std::uint64_t> fit_secondaries(const Question& question, const ErrorShare& share,
                                             const Plan& plan) {
  double observations = std::numeric_limits<double>::max();
  std::optional<std::uint64_t> enough;
  for (int round = 0; round < 4; ++round) {
    const auto found = stats::chi_square_fit_sample_size(
        fit_plan(question, plan, share, observations), *plan.regions[0].detect);
    if (!found) return enough;
    enough = found;
    observations = static_cast<double>(*found);
  }
  return enough;
}

/// Observations of each side worth one of a single sample, by m n / (m + n).
std::uint64_t sides(const Question& question) { return question.of_two() ? 2 : 1; }

double worth(const Question& question, const TestSize& size) {
  const stats::SampleSizes sizes = sizes_of(question, size.secondaries);
  return question.of_two() ? sizes.x / (1 + sizes.x / sizes.y) : sizes.x;
}

/// Theta is a distance between two laws: of their distribution functions, or Cohen's effect size
/// over cells.
class LawTheta : public Theta {
 public:
  using Theta::Theta;

  const std::vector<MethodRow>& methods() const override { return rows(); }
  const Theta* of_images() const override { return &theta_of_image_laws(); }

  void check_margin(const Question& question, const Margin& margin) const override {
    require_absolute(margin, "a distance between laws is a probability");
    Theta::check_margin(question, margin);
  }

  std::uint64_t choose(const Question& question, const FamilyPlace&, const Pilots& pilots,
                       std::uint64_t, Plan& plan) const override {
    freeze(question, pilots, plan);
    return least_secondaries;
  }

  /// Counts in cells are planned by the noncentral chi-square, distances by Hoeffding's bound.
  std::optional<std::uint64_t> secondaries(const Question& question, const ErrorShare& share,
                                           const Pilots&, const Plan& plan) const override {
    const Regions& regions = plan.regions[0];
    if (!regions.detect) return std::nullopt;
    if (in_cells(plan)) {
      const auto alone = fit_secondaries(question, share, plan);
      return alone ? sides(question) * *alone : impossible_secondaries;
    }
    return stats::ks_sample_size(distance_plan(question, share, regions.allow), *regions.detect);
  }

  std::optional<double> detectable(const Question& question, const TestSize& size, const Plan& plan,
                                   const PlannedChannel&) const override {
    if (in_cells(plan)) {
      const double observations = worth(question, size);
      return stats::chi_square_fit_detectable(fit_plan(question, plan, size.share, observations),
                                              observations);
    }
    const stats::SampleSizes sizes = sizes_of(question, size.secondaries);
    return stats::ks_detectable(
        distance_plan(question, size.share, plan.regions[0].allow, sizes.y / sizes.x), sizes.x);
  }

  /// The probability, or a lower bound of it.
  std::optional<double> power(const Question& question, const TestSize& size, const Plan& plan,
                              const PlannedChannel&, double effect) const override {
    if (in_cells(plan)) {
      const double observations = worth(question, size);
      return stats::chi_square_fit_power(fit_plan(question, plan, size.share, observations),
                                         observations, effect);
    }
    const stats::SampleSizes sizes = sizes_of(question, size.secondaries);
    return stats::ks_power_bound(
        distance_plan(question, size.share, plan.regions[0].allow, sizes.y / sizes.x), sizes.x,
        effect);
  }

  /// Judges the rows of a file: coarsely rounded values break the level of a fit.
  std::vector<Gate> gates(const TestOutcome& outcome, std::size_t channel,
                          std::span<const ChannelData> data, double) const override {
    const Question& question = outcome.question;
    if (!has_rows(question) || question.of_two() || !outcome.plan.method.is.of_distinct_values ||
        data[0].values.size() < 2) {
      return {};
    }
    const std::vector<double> sorted =
        stats::sorted({data[0].values.begin(), data[0].values.end()});
    return {gate_of(stats::quantisation_gate(sorted, outcome.share().alpha),
                    channel_suffix(question, channel))};
  }

 private:
  static const std::vector<MethodRow>& rows();
};

/// A sampler's draws against its declared density.
class DensityTheta final : public LawTheta {
 public:
  using LawTheta::LawTheta;

  /// One draw where the density is 0 refutes the claim, whatever its margins.
  std::optional<ConstantVerdict> settled(const Question& question, std::size_t,
                                         std::span<const ChannelData> data, const Regions&,
                                         const ErrorShare&) const override {
    if (!of_whole_draws(question)) return std::nullopt;
    const auto& draws = dynamic_cast<const SamplerSetup&>(*question.subjects[0].setup);
    const auto counts = draws.density_cells().impossible(data[0].cells);
    const std::uint64_t all = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
    if (all == 0) return std::nullopt;
    const auto most = static_cast<std::size_t>(std::ranges::max_element(counts) - counts.begin());
    return ConstantVerdict{
        reports::Verdict::fail,
        fmt::format("{} of {} draws lie where the declared density is 0, {} of them in {}: no "
                    "sampler of this density draws there",
                    all, data[0].moments.count, counts[most],
                    draws.density_cells().cells.describe(most))};
  }

  std::string claimed_value(const Question&, std::size_t) const override {
    return "its declared density";
  }

  void require_density(const Question& question) const override {
    dynamic_cast<const SamplerSetup&>(*question.subjects[0].setup).density_cells();
  }

  /// No sampler can follow a density whose integral exceeds 1.
  std::optional<ConstantVerdict> settled_beforehand(const Question& question) const override {
    const auto& draws = dynamic_cast<const SamplerSetup&>(*question.subjects[0].setup);
    const double total = draws.density_cells().mass.total;
    if (total - 1 <= draws.density_cells().tolerance()) return std::nullopt;
    return ConstantVerdict{
        reports::Verdict::fail,
        fmt::format("the declared density integrates to {:.6g} over its domain (quadrature error "
                    "{:.1g}): more than 1, so no sampler can follow it",
                    total, draws.density_cells().tolerance())};
  }
};

/// Values against a law's distribution function.
class NamedLawTheta final : public LawTheta {
 public:
  using LawTheta::LawTheta;
  std::string claimed_value(const Question& question, std::size_t) const override {
    return to_string(question.law);
  }
};

/// Values of two subjects.
class TwoLawsTheta final : public LawTheta {
 public:
  using LawTheta::LawTheta;

  std::string channel_name(const Question& question, std::size_t channel) const override {
    return is.joins_channels ? "cells" : Theta::channel_name(question, channel);
  }
};

const DensityTheta density_theta({.of_single_values = true, .of_a_law = true});
const NamedLawTheta named_law_theta({.of_single_values = true, .of_a_law = true});
const TwoLawsTheta two_laws_theta({.of_single_values = true, .of_a_law = true});
/// All channels together, in cells.
const TwoLawsTheta two_planes_theta({.joins_channels = true,
                                     .of_single_values = true,
                                     .pilots_draws = true});

bool of_one_law(const Question& question) {
  return !question.of_two() && (!question.law.name.empty() || !of_whole_draws(question));
}

const std::vector<MethodRow>& LawTheta::rows() {
  static const std::vector<MethodRow> table{
      {"ks",
       "Kolmogorov-Smirnov: values against a law",
       of_one_law,
       Keeps::values,
       values_against_law,
       {.of_distinct_values = true}},
      {"ks", "Kolmogorov-Smirnov: values of two, a frequent one apart",
       [](const Question& q) { return q.of_two() && !q.is().joins_channels; }, Keeps::values,
       law_against_law},
      {"chi-square-two-sample",
       "chi-square of two: one or two coordinates together, in cells",
       [](const Question& q) { return q.of_two(); },
       Keeps::points,
       cells_against_cells,
       {.joins_channels = true, .cells_of_pilots = true}},
      {"chi-square-fit", "chi-square: draws against their declared density, in cells",
       [](const Question& q) { return !q.of_two() && q.law.name.empty() && of_whole_draws(q); },
       Keeps::cells, cells_against_density}};
  return table;
}

// ---- Binding

/// Cells need one or two coordinates, the same on both sides.
void require_plane(const Question& question) {
  const std::size_t first = question.subjects[0].channels.size();
  const std::size_t second = question.subjects[1].channels.size();
  if (first == second && first <= 2) return;
  throw InputError(question.test->place_of("test"),
                   fmt::format("`{}` counts in cells of one or two coordinates, the same of both "
                               "sides, which have {} and {}; name one channel of each",
                               *question.test->method, first, second));
}

/// The compared marginals, as "u, v".
std::string channel_names(const Subject& side) {
  const std::vector<Channel> channels = side.setup->channels();
  std::vector<std::string> names;
  for (const std::size_t channel : side.channels) names.push_back(channels[channel].name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Two samplers are compared marginal by marginal, so both need the same ones.
void require_same_marginals(const Question& question, const Location& where) {
  const Subject& first = question.subjects[0];
  const Subject& second = question.subjects[1];
  const auto is_whole = [](const Subject& side) {
    return dynamic_cast<const SamplerSetup*>(side.setup.get()) != nullptr &&
           side.channels.size() > 1;
  };
  if (!is_whole(first) || !is_whole(second)) return;
  const std::string names = channel_names(first);
  const std::string others = channel_names(second);
  if (names == others) return;
  throw InputError(where, fmt::format("the first sampler's points are {}, the second's {}: name "
                                      "one marginal of each to compare them all the same",
                                      names, others));
}

}  // namespace

Question bind_distribution(const TestEntry& test, const Estimators& estimators) {
  const Claim& claim = test.claim;
  const Source& source = claim.left.source;
  if (const auto* other = std::get_if<ScaledQuantity>(&claim.right)) {
    const bool cells = test.method && joins_channels(*test.method);
    Question question{
        .test = &test,
        .theta = cells ? &two_planes_theta : &two_laws_theta,
        .subjects = {values(source, estimators), values(other->quantity.source, estimators)}};
    require_same_marginals(question, other->quantity.where);
    if (cells) require_plane(question);
    return question;
  }
  const Law& law = std::get<Law>(claim.right);
  if (law.name == "density") {
    return {.test = &test,
            .theta = &density_theta,
            .subjects = {draws(source, estimators, Draws::cells)}};
  }
  return {.test = &test,
          .theta = &named_law_theta,
          .subjects = {values(source, estimators)},
          .law = law};
}

const Theta& theta_of_laws() { return density_theta; }

}  // namespace assay::harness
