#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "harness/draws/sampler_setup.h"
#include "harness/families/families.h"
#include "harness/language/laws.h"
#include "harness/run/evaluate.h"
#include "stats/basics/scores.h"
#include "stats/cells/chi_square.h"
#include "stats/gates/assumption_gates.h"
#include "stats/planning/power.h"

namespace assay::harness {
namespace {

std::string range_text(const std::string& name, const std::vector<double>& borders,
                       std::size_t part) {
  if (borders.empty()) return "any " + name;
  if (part == 0) return fmt::format("{} below {:.3g}", name, borders.front());
  if (part == borders.size()) return fmt::format("{} from {:.3g} on", name, borders.back());
  return fmt::format("{} {:.3g} to {:.3g}", name, borders[part - 1], borders[part]);
}

std::string describe(const stats::SampledCells& cells, const Subject& side, std::size_t cell) {
  if (cell == cells.size()) return "the draws without a point";
  const auto after = std::ranges::upper_bound(cells.before, cell);
  const auto band = static_cast<std::size_t>(after - cells.before.begin()) - 1;
  const std::string first = range_text(side.declared(0).name, cells.band_borders, band);
  if (side.channels.size() == 1) return first;
  return first + ", " +
         range_text(side.declared(1).name, cells.cut_borders[band], cell - cells.before[band]);
}

/// Name of a tested cell, or of sparse cells that were pooled.
std::string pool_text(const std::vector<std::size_t>& members,
                      const std::function<std::string(std::size_t)>& describe) {
  if (members.size() == 1) return describe(members.front());
  return fmt::format("{} sparse cells together (the first of them {})", members.size(),
                     describe(members.front()));
}

std::string worst_of(const stats::ChiSquareFit& fit, const DensityCells& density) {
  const auto part = [](const stats::PooledCell& cell) {
    const double difference = static_cast<double>(cell.observed) - cell.expected;
    return difference * difference / cell.expected;
  };
  const auto worst = std::ranges::max_element(fit.cells, {}, part);
  const auto describe = [&](std::size_t cell) { return density.cells.describe(cell); };
  std::string text;
  if (fit.impossible > 0)
    text =
        fmt::format("{} draws that the density rules out (it is 0 there, or they have no point); ",
                    fit.impossible);
  const bool of_integral = worst->members.back() + 1 == density.cells.size();
  return text + fmt::format("farthest off in {}, {} draws where {:.4g} are expected{}",
                            pool_text(worst->members, describe), worst->observed, worst->expected,
                            of_integral
                                ? fmt::format(", as the density lacks {:.2g} of its integral",
                                              density.missing())
                                : "");
}

Evidence cells_against_density(const Seen& seen) {
  const DensityCells& density = density_of(seen.question);
  stats::CellCounts counts{.observed = density.in_cells(seen.data[0].cells),
                           .probability = density.mass.probability,
                           .error = density.mass.error};
  counts.probability.push_back(density.missing());
  counts.error.push_back(density.mass.total_error);
  const stats::ChiSquareFit fit =
      stats::chi_square_fit(counts, {.probability_tolerance = density.tolerance()});
  Evidence evidence = stats::chi_square_evidence(fit);
  evidence.most_against = always(worst_of(fit, density));
  return evidence;
}

/// Two samples against each other in the plan's cells. One more cell counts draws without a
/// point. Throws std::domain_error if there are no cells.
Evidence cells_against_cells(const Seen& seen) {
  if (!seen.data[0].sampled_cells) throw std::domain_error("the pilots gave no cells to count in");
  const stats::SampledCells& cells = *seen.data[0].sampled_cells;
  const stats::ChiSquareTwoSample fit = stats::chi_square_two_sample(
      {.x = counts_in(cells, seen, 0), .y = counts_in(cells, seen, 1)});
  const stats::PooledPair& worst =
      *std::ranges::max_element(fit.cells, {}, &stats::PooledPair::part);
  const Subject& first = seen.question.subjects[0];
  const auto place = [&](std::size_t cell) { return describe(cells, first, cell); };
  Evidence evidence = stats::chi_square_evidence(fit);
  evidence.most_against = always(fmt::format("farthest apart in {}, {} against {}",
                                             pool_text(worst.members, place), worst.x, worst.y));
  return evidence;
}

Evidence by_distance(const Seen& seen) {
  if (seen.question.of_two())
    return stats::points_against_points(points_of(seen, 0), points_of(seen, 1));
  return stats::points_against_law(points_of(seen, 0), declared_law(seen.question, seen.channel));
}

/// True if a sampler's draws are tested against its density in cells of all coordinates.
bool of_whole_draws(const Question& question) {
  return question.subjects[0].declared(0).name == cell_channel;
}

stats::DistancePlan distance_plan(const TestOutcome& test, const stats::ErrorRates& rates,
                                  double allocation = 1) {
  return {.two_samples = test.question.of_two(),
          .allocation = allocation,
          .allow = test.plan.regions[0].allow,
          .rates = rates};
}

/// True if counts in cells are tested. A plan without frozen cells is invalid.
bool in_cells(const Plan& plan) {
  return plan.method.keeps == Keeps::cells || plan.cells != nullptr;
}

/// Degrees of freedom at so many observations. Cells that expect too few are pooled.
double degrees_of_freedom(const TestOutcome& test, double observations) {
  // Draws without a point are one more cell, so none is subtracted.
  if (const auto& cells = test.plan.cells) return static_cast<double>(cells->size());
  const DensityCells& density = density_of(test.question);
  const double least = stats::FitOptions{}.minimum_expected;
  double pools = 0;
  for (const double p : density.mass.probability) pools += std::min(1.0, observations * p / least);
  pools += std::min(1.0, observations * density.missing() / least);
  return std::max(1.0, pools - 1);
}

stats::FitPlan fit_plan(const TestOutcome& test, const stats::ErrorRates& rates,
                        double observations) {
  return {.degrees_of_freedom = degrees_of_freedom(test, observations),
          .allow = test.plan.regions[0].allow,
          .rates = rates};
}

/// Fewer observations fill fewer pools, which need fewer observations. Each round's number is
/// enough; four rounds save nearly all.
std::optional<std::uint64_t> fit_secondaries(const TestOutcome& test,
                                             const stats::ErrorRates& rates) {
  double observations = std::numeric_limits<double>::max();
  std::optional<std::uint64_t> enough;
  for (int round = 0; round < 4; ++round) {
    const auto found = stats::chi_square_fit_sample_size(fit_plan(test, rates, observations),
                                                         *test.plan.regions[0].detect);
    if (!found) return enough;
    enough = found;
    observations = static_cast<double>(*found);
  }
  return enough;
}

/// Observations of a single sample that are worth as much: m n / (m + n) of two.
double worth(const Sized& sized) {
  const stats::SampleSizes sizes = sized.sizes();
  return sized.test.question.of_two() ? sizes.x / (1 + sizes.x / sizes.y) : sizes.x;
}

bool of_one_law(const Question& question) {
  return !question.of_two() && (!question.law.name.empty() || !of_whole_draws(question));
}

// 64 pilot points of both sides to a cell.
constexpr stats::CellNumbers plane_cells{.bands = 16, .cuts = 16};
constexpr stats::CellNumbers line_cells{.bands = 64, .cuts = 1};

std::vector<double> pilot_values(const TestOutcome& test, std::size_t subject, std::size_t channel,
                                 const Pilots& pilots) {
  const Subject& side = test.question.subjects[subject];
  if (pilot_of(side, pilots) == nullptr) return {};
  // Rows choose only if no side has a pilot of its own.
  if (is_recorded(side) && !std::ranges::all_of(test.question.subjects, is_recorded)) return {};
  return as_secondaries(side, pilot_channel(test.question, subject, channel, pilots).values,
                        test.plan.primaries[subject]);
}

/// Both sides' pilot points, without draws that yield none.
std::vector<stats::PlanePoint> pilot_points(const TestOutcome& test, const Pilots& pilots) {
  std::vector<stats::PlanePoint> points;
  for (std::size_t subject = 0; subject < test.question.subjects.size(); ++subject) {
    const Subject& side = test.question.subjects[subject];
    const std::vector<double> first = pilot_values(test, subject, 0, pilots);
    const std::vector<double> second = side.channels.size() > 1
                                           ? pilot_values(test, subject, 1, pilots)
                                           : std::vector<double>(first.size(), 0);
    const std::optional<double> none = no_point_of(side);
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (first[i] != none && std::isfinite(first[i]) && std::isfinite(second[i])) {
        points.push_back({first[i], second[i]});
      }
    }
  }
  return points;
}

constexpr MethodTraits of_distinct_values{.of_distinct_values = true};

/// Theta is a distance between two laws: of their distribution functions, or Cohen's effect size
/// over cells.
class LawTheta : public Theta {
 public:
  explicit LawTheta(const ThetaTraits& traits)
      : Theta(traits,
              {{"ks", "Kolmogorov-Smirnov: values against a law", of_one_law, Keeps::values,
                by_distance, of_distinct_values},
               {"ks", "Kolmogorov-Smirnov: two laws; a frequent value is compared by its count",
                [](const Question& q) { return q.of_two() && !q.is().joins_channels; },
                Keeps::values, by_distance},
               {"chi-square-two-sample",
                "chi-square: two laws, counted in cells of one or two coordinates", of_two,
                Keeps::points, cells_against_cells},
               {"chi-square-fit",
                "chi-square: draws against their declared density, counted in cells",
                [](const Question& q) { return !q.of_two() && !of_one_law(q); }, Keeps::cells,
                cells_against_density}}) {}

  Question bind(const TestEntry& test, const Estimators& estimators) const override;
  const Theta* of_images() const override { return &theta_of_image_laws(); }

  std::string channel_name(const Question& question, std::size_t channel) const override {
    return is.joins_channels ? "cells" : Theta::channel_name(question, channel);
  }

  std::string claimed_value(const Question& question, std::size_t channel) const override {
    return question.of_two() ? Theta::claimed_value(question, channel) : to_string(question.law);
  }

  void check_margin(const Question&, const Margin& margin) const override {
    require_absolute(margin, "a distance between laws is a probability, and 1 per cent is 0.01");
  }

  /// The pilots' points choose the cells. Rows of a file are their own pilot, both sides together;
  /// beside drawn values they are not used.
  std::uint64_t choose(TestOutcome& test, const Pilots& pilots) const override {
    if (test.plan.method.keeps != Keeps::points) return least_secondaries;
    std::vector<stats::PlanePoint> points = pilot_points(test, pilots);
    if (points.empty()) {
      test.plan.invalid = Reason("the pilots gave no point to choose cells by");
      return least_secondaries;
    }
    const bool plane = test.question.subjects[0].channels.size() > 1;
    test.plan.cells = std::make_shared<const stats::SampledCells>(
        stats::sampled_cells(std::move(points), plane ? plane_cells : line_cells));
    return least_secondaries;
  }

  /// Counts in cells are planned by the noncentral chi-square, distances by Hoeffding's bound.
  std::optional<std::uint64_t> secondaries(const TestOutcome& test, const ErrorShare& share,
                                           const Pilots&) const override {
    const Regions& regions = test.plan.regions[0];
    if (!regions.detect) return std::nullopt;
    const stats::ErrorRates rates = planned_rates(share, regions);
    if (in_cells(test.plan)) {
      const auto alone = fit_secondaries(test, rates);
      if (!alone) return impossible_secondaries;
      return test.question.of_two() ? 2 * *alone : *alone;
    }
    return stats::ks_sample_size(distance_plan(test, rates), *regions.detect);
  }

  std::optional<double> detectable(const Sized& sized) const override {
    const TestOutcome& test = sized.test;
    if (in_cells(test.plan)) {
      const double observations = worth(sized);
      return stats::chi_square_fit_detectable(fit_plan(test, sized.rates(), observations),
                                              observations);
    }
    const stats::SampleSizes sizes = sized.sizes();
    return stats::ks_detectable(distance_plan(test, sized.rates(), sizes.y / sizes.x), sizes.x);
  }

  /// The probability, or a lower bound of it.
  std::optional<double> power(const Sized& sized, double effect) const override {
    const TestOutcome& test = sized.test;
    if (in_cells(test.plan)) {
      const double observations = worth(sized);
      return stats::chi_square_fit_power(fit_plan(test, sized.rates(), observations), observations,
                                         effect);
    }
    const stats::SampleSizes sizes = sized.sizes();
    return stats::ks_power_bound(distance_plan(test, sized.rates(), sizes.y / sizes.x), sizes.x,
                                 effect);
  }

  /// Judges the rows of a file: coarsely rounded values break the level of a fit.
  std::vector<Gate> gates(const TestOutcome& outcome, const Seen& seen, double) const override {
    const std::span<const double> values = seen.data[0].values;
    if (!has_rows(seen.question) || seen.question.of_two() ||
        !outcome.plan.method.is.of_distinct_values || values.size() < 2) {
      return {};
    }
    const std::vector<double> sorted = stats::sorted({values.begin(), values.end()});
    return {gate_of(stats::quantisation_gate(sorted, outcome.share().alpha),
                    channel_suffix(seen.question, seen.channel))};
  }
};

class DensityTheta final : public LawTheta {
 public:
  DensityTheta() : LawTheta({.of_single_values = true, .of_a_law = true}) {}

  /// Cells of fewer expected draws are one cell. The floor keeps those rare of which `detect` says
  /// nothing.
  std::uint64_t choose(TestOutcome& test, const Pilots&) const override {
    return secondaries_of_floor(test);
  }

  /// No sampler can follow a density whose integral exceeds 1. One draw where the density is 0
  /// refutes the claim, whatever its margins.
  std::optional<ConstantVerdict> settled(const TestOutcome&, const Seen& seen) const override {
    const DensityCells& density = density_of(seen.question);
    if (density.mass.total - 1 > density.tolerance()) {
      return ConstantVerdict{
          reports::Verdict::fail,
          fmt::format("the declared density integrates to {:.6g} over its domain (quadrature error "
                      "{:.1g}): more than 1, so no sampler can have it",
                      density.mass.total, density.tolerance())};
    }
    if (!of_whole_draws(seen.question)) return std::nullopt;
    const auto counts = density.impossible(seen.data[0].cells);
    const std::uint64_t all = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
    if (all == 0) return std::nullopt;
    const auto most = static_cast<std::size_t>(std::ranges::max_element(counts) - counts.begin());
    return ConstantVerdict{
        reports::Verdict::fail,
        fmt::format("{} of {} draws lie where the declared density is 0, {} of them in {}: a "
                    "sampler of this density never draws there",
                    all, seen.moments(0).count, counts[most], density.cells.describe(most))};
  }

  std::string claimed_value(const Question&, std::size_t) const override {
    return "its declared density";
  }

  void require_density(const Question& question) const override { density_of(question); }
};

/// Values against a law's distribution function, or of two subjects.
const LawTheta values_theta({.of_single_values = true, .of_a_law = true});
/// All channels together, in cells.
const LawTheta planes_theta({.joins_channels = true, .of_single_values = true});

/// Cells need one or two coordinates, the same on both sides.
void require_plane(const Question& question) {
  const std::size_t first = question.subjects[0].channels.size();
  const std::size_t second = question.subjects[1].channels.size();
  if (first == second && first <= 2) return;
  refuse(question.test->place_of("test"),
         "`{}` counts in cells of one or two coordinates, equal on both sides, which have {} and "
         "{}; name one channel of each",
         *question.test->method, first, second);
}

std::string channel_names(const Subject& side) {
  return fmt::format("{}", fmt::join(mapped(side.declared(), &Channel::name), ", "));
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
  refuse(where,
         "the first sampler's points are {}, the second's {}: name one marginal of each to compare "
         "them",
         names, others);
}

}  // namespace

const DensityCells& density_of(const Question& question) {
  return dynamic_cast<const SamplerSetup&>(*question.subjects[0].setup).density_cells();
}

stats::Points points_of(const Seen& seen, std::size_t subject) {
  const std::span<const double> values = seen.data[subject].values;
  stats::Points points{.sorted = {values.begin(), values.end()}, .draws = values.size()};
  if (const auto none = no_point_of(seen.question.subjects[subject], seen.channel)) {
    points.of_a_sampler = true;
    std::erase(points.sorted, *none);
  }
  points.sorted = stats::sorted(std::move(points.sorted));
  return points;
}

stats::DeclaredLaw declared_law(const Question& question, std::size_t channel) {
  const auto* draws = dynamic_cast<const SamplerSetup*>(question.subjects[0].setup.get());
  stats::DeclaredLaw declared;
  if (!question.law.name.empty()) {
    declared.law = find_law(question.law.name)->cdf(question.law.arguments);
  } else {
    const stats::TabulatedLaw& table = draws->marginal_law(question.channel_name(channel));
    declared.law = std::cref(table);
    declared.error = table.error;
  }
  if (draws != nullptr) {
    declared.missing = draws->density_cells().without_density();
    declared.missing_error = draws->density_cells().tolerance();
  }
  return declared;
}

std::vector<std::uint64_t> counts_in(const stats::SampledCells& cells, const Seen& seen,
                                     std::size_t subject) {
  const ChannelData& data = seen.data[subject];
  std::vector<std::uint64_t> counts(cells.size() + 1);
  const std::span<const double> first = data.all_values[0];
  const bool plane = data.all_values.size() > 1;
  const std::optional<double> none = no_point_of(seen.question.subjects[subject]);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const bool point = first[i] != none;
    ++counts[point ? cells.index({first[i], plane ? data.all_values[1][i] : 0}) : cells.size()];
  }
  return counts;
}

Question LawTheta::bind(const TestEntry& test, const Estimators& estimators) const {
  const Claim& claim = test.claim;
  const Source& source = claim.left.source;
  if (const auto* other = std::get_if<ScaledQuantity>(&claim.right)) {
    const bool cells = std::ranges::any_of(methods, [&](const Method& row) {
      return test.method == row.name && row.keeps == Keeps::points;
    });
    Question question{
        .test = &test,
        .theta = cells ? &planes_theta : &values_theta,
        .subjects = {values(source, estimators), values(other->quantity.source, estimators)}};
    require_same_marginals(question, other->quantity.where);
    if (cells) require_plane(question);
    return question;
  }
  const Law& law = std::get<Law>(claim.right);
  if (law.name == "density") {
    return {.test = &test,
            .theta = &theta_of_laws(),
            .subjects = {draws(source, estimators, Draws::cells)}};
  }
  return {
      .test = &test, .theta = &values_theta, .subjects = {values(source, estimators)}, .law = law};
}

const Theta& theta_of_laws() { return one<DensityTheta>(); }

}  // namespace assay::harness
