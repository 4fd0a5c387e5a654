#include "harness/families/evidence_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "harness/draws/sampler_setup.h"
#include "harness/families/law_evidence.h"
#include "harness/question/declared_range.h"
#include "stats/cells/chi_square_fit.h"
#include "stats/cells/chi_square_two_sample.h"

namespace assay::harness {
namespace {

constexpr const char* effect_over_cells = "effect size w over the cells";

std::string range_text(const std::string& name, const std::vector<double>& borders,
                       std::size_t part) {
  if (borders.empty()) return "any " + name;
  if (part == 0) return fmt::format("{} below {:.3g}", name, borders.front());
  if (part == borders.size()) return fmt::format("{} from {:.3g} on", name, borders.back());
  return fmt::format("{} {:.3g} to {:.3g}", name, borders[part - 1], borders[part]);
}

std::string describe(const stats::SampledCells& cells, const Subject& side, std::size_t cell) {
  if (cell == cells.size()) return "the draws without a point";
  const std::vector<Channel> channels = side.setup->channels();
  const auto after = std::upper_bound(cells.before.begin(), cells.before.end(), cell);
  const auto band = static_cast<std::size_t>(after - cells.before.begin()) - 1;
  const std::string first = range_text(channels[side.channels[0]].name, cells.band_borders, band);
  if (side.channels.size() == 1) return first;
  return first + ", " +
         range_text(channels[side.channels[1]].name, cells.cut_borders[band],
                    cell - cells.before[band]);
}

const stats::PooledPair& farthest(const stats::ChiSquareTwoSample& fit) {
  return *std::max_element(fit.cells.begin(), fit.cells.end(),
                           [](const auto& a, const auto& b) { return a.part < b.part; });
}

/// Name of a tested cell, or of sparse cells that were pooled.
std::string pool_text(const std::vector<std::size_t>& members,
                      const std::function<std::string(std::size_t)>& describe) {
  if (members.size() == 1) return describe(members.front());
  return fmt::format("{} sparse cells together (the first of them {})", members.size(),
                     describe(members.front()));
}

std::string worst_of(const stats::ChiSquareFit& fit, const SamplerSetup& draws) {
  const auto part = [](const stats::PooledCell& cell) {
    const double difference = static_cast<double>(cell.observed) - cell.expected;
    return difference * difference / cell.expected;
  };
  const auto worst =
      std::max_element(fit.cells.begin(), fit.cells.end(),
                       [&](const auto& a, const auto& b) { return part(a) < part(b); });
  const auto describe = [&](std::size_t cell) {
    return draws.density_cells().cells.describe(cell);
  };
  std::string text;
  if (fit.impossible > 0) {
    text = fmt::format("; {} draws where the density is 0", fit.impossible);
  }
  return text + fmt::format("; farthest off in {}, {} draws where {:.4g} are expected",
                            pool_text(worst->members, describe), worst->observed, worst->expected);
}

}  // namespace

std::vector<std::uint64_t> counts_in(const stats::SampledCells& cells, const Subject& side,
                                     const ChannelData& data) {
  std::vector<std::uint64_t> counts(cells.size() + 1);
  const std::span<const double> first = data.all_values[0];
  const bool plane = data.all_values.size() > 1;
  const std::optional<double> none = no_point_of(side);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const bool point = first[i] != none;
    ++counts[point ? cells.index({first[i], plane ? data.all_values[1][i] : 0}) : cells.size()];
  }
  return counts;
}

Evidence cells_against_density(const Question& question, const ChannelData& data) {
  const auto& draws = dynamic_cast<const SamplerSetup&>(*question.subjects[0].setup);
  const stats::CellProbabilities& mass = draws.density_cells().mass;
  stats::CellCounts counts{.observed = draws.density_cells().in_cells(data.cells),
                           .probability = mass.probability,
                           .error = mass.error};
  counts.probability.push_back(draws.density_cells().missing());
  counts.error.push_back(mass.total_error);
  const stats::ChiSquareFit fit =
      stats::chi_square_fit(counts, {.probability_tolerance = draws.density_cells().tolerance()});
  const auto at = [fit](double theta) {
    return theta == 0 ? fit.test : stats::chi_square_fit_effect(fit, std::max(0.0, theta));
  };
  const auto interval = [fit](double confidence) {
    return stats::chi_square_fit_interval(fit, confidence);
  };
  return {.estimate = fit.effect,
          .at = at,
          .interval = interval,
          .most_against = always(worst_of(fit, draws)),
          .quantity = effect_over_cells,
          .distance = true};
}

Evidence cells_against_cells(const Method& method, const Question& question,
                             std::span<const ChannelData> data) {
  if (!method.frozen.cells) throw std::domain_error("the pilots gave no cells to count in");
  const stats::SampledCells& cells = *method.frozen.cells;
  const stats::ChiSquareTwoSample fit =
      stats::chi_square_two_sample({.x = counts_in(cells, question.subjects[0], data[0]),
                                    .y = counts_in(cells, question.subjects[1], data[1])});
  const auto at = [fit](double theta) {
    return theta <= 0 ? fit.test : stats::chi_square_effect(fit.statistic, theta);
  };
  const auto interval = [fit](double confidence) {
    return stats::chi_square_effect_interval(fit.statistic, confidence);
  };
  const stats::PooledPair& worst = farthest(fit);
  const auto place = [&](std::size_t cell) { return describe(cells, question.subjects[0], cell); };
  return {.estimate = fit.statistic.effect(),
          .at = at,
          .interval = interval,
          .most_against = always(fmt::format("; farthest apart in {}, {} against {}",
                                             pool_text(worst.members, place), worst.x, worst.y)),
          .quantity = effect_over_cells,
          .distance = true};
}

}  // namespace assay::harness
